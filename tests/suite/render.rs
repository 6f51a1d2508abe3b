//! View pictures and their figures, by identities.

use crate::shapes::{ORANGE, ball, grove, view};
use glam::{DMat4, DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::certify::camouflage::camouflage;
use pillarforest::index::FaceId;
use pillarforest::intake::load_model;
use pillarforest::mesh::TriMesh;
use pillarforest::render::turntable::{PICTURES, Turntable};
use pillarforest::render::{Likeness, camera, light_pictures, thumbnail, turntable, view_pictures};
use pillarforest::report::{Report, SolidReport, ViewReport};
use pillarforest::steps::{StepLine, StepSummary};
use pillarforest::view::View;

const EYE: DVec3 = DVec3::new(90.0, -40.0, 25.0);

fn owl() -> View {
    view(
        "owl",
        EYE,
        ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 24),
        ORANGE,
    )
}

fn likeness(view: &View, forest: &TriMesh) -> Likeness {
    view_pictures(view, forest, &Bvh::new(forest), None, None, 96).0
}

fn about_eye(factor: f64) -> DMat4 {
    DMat4::from_translation(EYE)
        * DMat4::from_scale(DVec3::splat(factor))
        * DMat4::from_translation(-EYE)
}

#[test]
fn a_forest_that_is_the_target_has_no_error() {
    let found = likeness(&owl(), &owl().models[0].mesh);
    assert!(found.pixels > 5000);
    assert_eq!((found.hit, found.mean_deg, found.p90_deg), (1.0, 0.0, 0.0));
}

#[test]
fn scaling_about_the_eye_changes_nothing() {
    let small = owl().models[0].mesh.transformed(about_eye(0.4));
    let found = likeness(&owl(), &small);
    // Rays that graze an edge may meet the neighbouring facet.
    assert!(
        found.hit > 0.999 && found.median_deg < 1e-6 && found.p90_deg < 1e-6,
        "{found:?}"
    );
}

#[test]
fn inside_out_is_as_wrong_as_can_be() {
    let mut forest = owl().models[0].mesh.clone();
    forest.faces.iter_mut().for_each(|f| f.swap(0, 1));
    let found = likeness(&owl(), &forest);
    assert!((found.mean_deg - 180.0).abs() < 1e-9 && found.hit == 1.0);
}

#[test]
fn no_forest_counts_as_ninety_degrees() {
    let found = likeness(&owl(), &TriMesh::default());
    assert_eq!(
        (found.hit, found.mean_deg, found.median_deg, found.p90_deg),
        (0.0, 90.0, 90.0, 90.0)
    );
}

/// A square plate around a point whose normal is turned from the direction to the eye by an angle about the vertical.
fn plate(middle: DVec3, half: f64, turn: f64) -> TriMesh {
    let normal =
        DMat4::from_rotation_z(turn).transform_vector3((EYE - middle).with_z(0.0).normalize());
    let side = DVec3::Z.cross(normal);
    let vertices = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, z)| middle + half * (x * side + z * DVec3::Z))
        .to_vec();
    TriMesh::new(vertices, [[0, 1, 2], [0, 2, 3]])
}

#[test]
fn a_turned_plate_is_off_by_its_turn() {
    let middle = DVec3::new(0.0, 0.0, 25.0);
    let view = view("plate", EYE, plate(middle, 5.0, 0.0), ORANGE);
    for degrees in [0.0f64, 3.0, 17.0, 40.0] {
        let found = likeness(&view, &plate(middle, 30.0, degrees.to_radians()));
        for figure in [found.mean_deg, found.median_deg, found.p90_deg] {
            assert!((figure - degrees).abs() < 1e-6, "{degrees}: {found:?}");
        }
    }
}

#[test]
fn half_a_forest_is_half_a_hit() {
    let middle = DVec3::new(0.0, 0.0, 25.0);
    let view = view("plate", EYE, plate(middle, 5.0, 0.0), ORANGE);
    let mut forest = plate(middle, 5.0, 0.0);
    forest.faces.truncate(1);
    let found = likeness(&view, &forest);
    assert!((found.hit - 0.5).abs() < 0.02, "{found:?}");
    assert!((found.mean_deg - 45.0).abs() < 2.0, "{found:?}");
}

#[test]
fn turning_everything_about_the_vertical_changes_nothing() {
    let forest = ball(DVec3::new(2.0, 2.5, 19.5), 10.0, 16);
    let before = likeness(&owl(), &forest);
    let turn = DMat4::from_rotation_z(0.7);
    let turned = view(
        "owl",
        turn.transform_point3(EYE),
        owl().models[0].mesh.transformed(turn),
        ORANGE,
    );
    let after = likeness(&turned, &forest.transformed(turn));
    assert!(
        (before.mean_deg - after.mean_deg).abs() < 0.1
            && (before.median_deg - after.median_deg).abs() < 0.1,
        "{before:?} {after:?}"
    );
}

fn grove_forest() -> (Vec<View>, TriMesh) {
    let (views, supports) = grove();
    let mut forest = TriMesh::default();
    supports.iter().for_each(|s| forest.append(&s.mesh));
    (views, forest)
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let (views, forest) = grove_forest();
    let bvh = Bvh::new(&forest);
    let colours = vec![ORANGE; forest.faces.len()];
    let draw = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            (
                view_pictures(&views[0], &forest, &bvh, Some(&colours), None, 64),
                thumbnail(&forest, &bvh, None, 64),
            )
        })
    };
    assert_eq!(draw(1), draw(3));
}

#[test]
fn pictures_show_three_panels_and_thumbnails_a_forest() {
    let (views, forest) = grove_forest();
    let bvh = Bvh::new(&forest);
    let picture = tiny_skia::Pixmap::decode_png(
        &view_pictures(&views[0], &forest, &bvh, None, None, 100)
            .1
            .sheet,
    )
    .unwrap();
    assert!(picture.width() >= 300 && picture.height() >= 100);
    let drawn = |p: &tiny_skia::Pixmap, left: u32, right: u32| {
        let inside = p
            .pixels()
            .iter()
            .enumerate()
            .filter(|(k, _)| (left..right).contains(&(*k as u32 % p.width())));
        inside
            .filter(|(_, c)| c.red().min(c.green()).min(c.blue()) < 250)
            .count()
    };
    for panel in 0..3 {
        assert!(
            drawn(
                &picture,
                panel * picture.width() / 3,
                (panel + 1) * picture.width() / 3
            ) > 1000
        );
    }
    let small = tiny_skia::Pixmap::decode_png(&thumbnail(&forest, &bvh, None, 100)).unwrap();
    let share = drawn(&small, 0, 100) as f64 / 10_000.0;
    assert!((0.3..0.95).contains(&share), "{share}");
    assert!(
        tiny_skia::Pixmap::decode_png(&thumbnail(
            &TriMesh::default(),
            &Bvh::new(&TriMesh::default()),
            None,
            20
        ))
        .is_ok()
    );
}

/// A line in the image of the owl's camera, which is 2 wide and 2 high.
fn step_line(ends: [DVec2; 2], height: f64) -> StepLine {
    let (plane, half) = camera(&owl());
    StepLine {
        ends: ends.map(|q| 3.0 * plane.direction(half * q)),
        height_mm: [height; 2],
        parallax: [0.0; 2],
        length_mm: 1.0,
    }
}

/// The owl as a forest of its own, with steps.
fn torn_owl(lines: &[StepLine]) -> tiny_skia::Pixmap {
    let forest = &owl().models[0].mesh;
    let summary = StepSummary {
        lines: lines.len(),
        ..StepSummary::default()
    };
    let steps = Some((lines, summary));
    let png = view_pictures(&owl(), forest, &Bvh::new(forest), None, steps, 200)
        .1
        .sheet;
    tiny_skia::Pixmap::decode_png(&png).unwrap()
}

/// Columns and rows of the pixels of the panels, above the captions, that differ.
fn differing(a: &tiny_skia::Pixmap, b: &tiny_skia::Pixmap) -> Vec<(u32, u32)> {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let places = (0..206).flat_map(|y| (0..a.width()).map(move |x| (x, y)));
    places
        .filter(|(x, y)| a.pixel(*x, *y) != b.pixel(*x, *y))
        .collect()
}

#[test]
fn a_step_line_is_drawn_over_the_errors_and_nowhere_else() {
    // Panels of 200 pixels with gaps of 6: the third begins at 418, and a quarter above its middle is row 81.
    let across = [DVec2::new(-0.9, 0.25), DVec2::new(0.9, 0.25)];
    let (none, line) = (torn_owl(&[]), torn_owl(&[step_line(across, 2.0)]));
    let found = differing(&none, &line);
    assert!(
        found
            .iter()
            .all(|(x, y)| (427..=609).contains(x) && (80..=81).contains(y)),
        "{found:?}"
    );
    assert!((429..=606).all(|x| found.contains(&(x, 80)) || found.contains(&(x, 81))));
    // The caption tells how many.
    assert_ne!(none.data(), line.data());
}

#[test]
fn higher_steps_are_darker_and_lines_out_of_the_picture_are_left_out() {
    let at = |y: f64| [DVec2::new(-0.5, y), DVec2::new(0.5, y)];
    let none = torn_owl(&[]);
    let two = torn_owl(&[step_line(at(0.505), 6.0), step_line(at(-0.505), 0.3)]);
    let light = |row: u32| {
        let c = two.pixel(518, row).unwrap();
        u32::from(c.red()) + u32::from(c.green()) + u32::from(c.blue())
    };
    let darkest = |rows: std::ops::Range<u32>| rows.map(light).min().unwrap();
    let (high, low) = (darkest(50..60), darkest(150..160));
    assert!(high + 150 < low, "{high} {low}");
    let outside = [
        step_line(at(1.2), 1.0),
        step_line([DVec2::ZERO, DVec2::new(0.0, 40.0)], 1.0),
        step_line([DVec2::splat(f64::NAN); 2], f64::NAN),
    ];
    assert_eq!(differing(&none, &torn_owl(&outside)), []);
}

#[test]
fn without_steps_only_the_caption_tells_whether_they_were_allowed() {
    let forest = &owl().models[0].mesh;
    let png = view_pictures(&owl(), forest, &Bvh::new(forest), None, None, 200)
        .1
        .sheet;
    let (never, none) = (tiny_skia::Pixmap::decode_png(&png).unwrap(), torn_owl(&[]));
    assert_eq!(differing(&never, &none), []);
    assert_ne!(never.data(), none.data());
}

#[test]
fn a_report_can_be_read_back_and_knows_no_clock() {
    let mut owl = owl();
    owl.models[0].matrix = DMat4::from_translation(DVec3::new(1.0, 2.0, -0.0));
    let figures = Likeness {
        hit: 0.5,
        mean_deg: 11.0,
        median_deg: 7.0,
        p90_deg: 20.0,
        pixels: 4,
    };
    let solid = pillarforest::mesh::Solid::new(owl.models[0].mesh.clone()).unwrap();
    let report = Report {
        scene: "grove".into(),
        views: vec![ViewReport::new(&owl).with_likeness(&figures)],
        solid: Some(SolidReport::new(&solid)),
        ..Report::default()
    };
    let json = report.json();
    assert!(json.ends_with("}\n") && !json.contains("seconds") && !json.contains("-0.0"));
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    let view = &value["views"][0];
    assert_eq!(view["eye"], serde_json::json!([90.0, -40.0, 25.0]));
    assert_eq!(view["models"][0]["file"], "owl.obj");
    assert_eq!(
        view["models"][0]["matrix"][1],
        serde_json::json!([0.0, 1.0, 0.0, 2.0]),
        "rows, translation last"
    );
    assert_eq!(view["normal_error_deg"]["p90"], 20.0);
    assert!(
        view.get("coverage").is_none(),
        "what was not measured is left out"
    );
    assert_eq!(value["solid"]["parts"], 1);
}

/// An owl in a wide forest.
fn wide() -> TriMesh {
    let mut forest = ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 24);
    forest.append(&ball(DVec3::new(20.0, -14.0, 6.0), 6.0, 12));
    forest
}

#[test]
fn the_turntables_eyes_go_around_at_one_height_and_distance() {
    let view = owl();
    let middle = DVec3::new(3.0, 2.0, 20.0);
    let table = Turntable::new(&view, &wide());
    assert!(!table.moved);
    let degrees: Vec<f64> = (0..PICTURES).map(turntable::angle_deg).collect();
    assert_eq!(degrees, [-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0]);
    assert!(table.planes[3].eye.distance(EYE) < 1e-9);
    for (plane, degrees) in table.planes.iter().zip(degrees) {
        let arm = plane.eye - middle;
        assert!((arm.length() - EYE.distance(middle)).abs() < 1e-9);
        assert!((plane.eye.z - EYE.z).abs() < 1e-9);
        // Positive angles are to the right of the eye.
        let aside = arm.dot(table.planes[3].right);
        let level = arm.truncate().length();
        assert!((aside - level * degrees.to_radians().sin()).abs() < 1e-9);
    }
}

#[test]
fn the_turntable_cuts_nothing_off_and_wastes_nothing() {
    let forest = wide();
    let table = Turntable::new(&owl(), &forest);
    let image = || {
        let planes = table.planes.iter();
        planes.flat_map(|p| forest.vertices.iter().filter_map(|v| p.project(*v)))
    };
    assert_eq!(image().count(), PICTURES * forest.vertices.len());
    assert!(image().all(|q| q.cmpge(table.lo).all() && q.cmple(table.hi).all()));
    let size = table.hi - table.lo;
    let top = image().map(|q| q.y).fold(f64::NEG_INFINITY, f64::max);
    let side = image().map(|q| q.x.abs()).fold(0.0, f64::max);
    assert!(table.hi.y - top < 0.05 * size.max_element());
    assert!(table.hi.x - side < 0.05 * size.max_element());
}

#[test]
fn an_eye_that_would_pass_through_the_solid_is_moved_out() {
    let mut near = owl();
    near.eye = DVec3::new(22.0, 2.0, 25.0);
    let forest = wide();
    let table = Turntable::new(&near, &forest);
    assert!(table.moved);
    let depths = table
        .planes
        .iter()
        .flat_map(|p| forest.vertices.iter().map(|v| p.depth(*v)));
    assert!(depths.fold(f64::INFINITY, f64::min) > 0.0);
}

#[test]
fn a_ball_looks_the_same_all_around_the_turntable() {
    let view = owl();
    let forest = view.models[0].mesh.clone();
    let bvh = Bvh::new(&forest);
    let draw = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| turntable(&view, &forest, &bvh, 100))
    };
    let png = draw(1);
    assert_eq!(png, draw(3));
    let strip = tiny_skia::Pixmap::decode_png(&png).unwrap();
    // Square pictures of 100 pixels with gaps of 2.
    assert_eq!((strip.width(), strip.height()), (7 * 102 + 2, 117));
    let grey =
        |k: u32, x: u32, y: u32| f64::from(strip.pixel(2 + 102 * k + x, 2 + y).unwrap().red());
    let mut dark = 0;
    for k in 0..7 {
        for x in 0..100 {
            assert_eq!(
                (grey(k, x, 0), grey(k, 0, x), grey(k, x, 99)),
                (255.0, 255.0, 255.0)
            );
            for y in 0..100 {
                dark += usize::from(grey(k, x, y) < 240.0);
            }
        }
        let apart =
            (0..10_000).map(|i| (grey(k, i % 100, i / 100) - grey(3, i % 100, i / 100)).abs());
        let mean = apart.sum::<f64>() / 10_000.0;
        assert!(mean < 1.0, "{k}: {mean}");
    }
    let share = dark as f64 / 70_000.0;
    assert!(
        (share - std::f64::consts::PI / 4.0 / 1.05f64.powi(2)).abs() < 0.02,
        "{share}"
    );
}

/// The faces of a ball that are turned to the eye, as an open sheet.
fn half_owl() -> TriMesh {
    let mut half = owl().models[0].mesh.clone();
    let all = half.clone();
    let mut faces = FaceId::all(all.faces.len());
    half.faces.retain(|_| {
        let face = faces.next().expect("as many");
        all.area_vector(face).dot(EYE - all.corners(face)[0]) > 0.0
    });
    half
}

#[test]
fn an_eye_sees_both_sides_of_an_open_surface() {
    let half = half_owl();
    let flipped = TriMesh {
        faces: half.faces.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        ..half.clone()
    };
    // Half of its faces the other way round; no reader would leave it so.
    let mixed = TriMesh {
        faces: half
            .faces
            .iter()
            .zip(&flipped.faces)
            .enumerate()
            .map(|(k, (f, g))| if k % 2 == 0 { *f } else { *g })
            .collect(),
        ..half.clone()
    };
    let forest = ball(DVec3::new(2.0, 2.5, 19.5), 10.0, 16);
    let bvh = Bvh::new(&forest);
    let drawn = |mesh: &TriMesh| {
        let view = view("owl", EYE, mesh.clone(), ORANGE);
        (
            view_pictures(&view, &forest, &bvh, None, None, 96),
            light_pictures(&view, &forest, &bvh),
            camouflage(&view, &forest, &bvh, 0.0),
        )
    };
    let wanted = drawn(&half);
    assert!(wanted.0.0.mean_deg < 30.0, "{:?}", wanted.0.0);
    for (name, mesh) in [("flipped", flipped), ("mixed", mixed)] {
        let found = drawn(&mesh);
        assert_eq!(found.0.0, wanted.0.0, "{name}");
        assert!(found.0.1 == wanted.0.1, "{name}: another picture");
        // Corners in another order round otherwise, and where shadows begin a ray may go either way.
        let lights =
            [&found.1.0, &wanted.1.0].map(|l| figures(&serde_json::to_value(l).expect("JSON")));
        assert!(!lights[0].is_empty() && lights[0].len() == lights[1].len());
        for (a, b) in lights[0].iter().zip(&lights[1]) {
            assert!((a - b).abs() < 0.01, "{name}: {a}, not {b}");
        }
        assert_eq!(found.2, wanted.2, "{name}");
    }
}

/// All numbers in a value.
fn figures(value: &serde_json::Value) -> Vec<f64> {
    match value {
        serde_json::Value::Number(n) => n.as_f64().into_iter().collect(),
        serde_json::Value::Array(list) => list.iter().flat_map(figures).collect(),
        serde_json::Value::Object(map) => map.values().flat_map(figures).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn a_surface_with_every_face_twice_is_seen_as_if_once() {
    let half = half_owl();
    let mut doubled = half.clone();
    doubled.append(&TriMesh {
        faces: half.faces.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        ..half.clone()
    });
    let loaded = |mesh: &TriMesh| {
        load_model("a.obj", &crate::shapes::obj(mesh), false)
            .expect("a model")
            .value
    };
    let (once, twice) = (loaded(&half), loaded(&doubled));
    assert_eq!(once.faces.len(), twice.faces.len());
    let forest = ball(DVec3::new(2.0, 2.5, 19.5), 10.0, 16);
    let drawn = |mesh: TriMesh| likeness(&view("owl", EYE, mesh, ORANGE), &forest);
    assert_eq!(drawn(once), drawn(twice));
}
