//! Pillars that are to be found, and layout files: what `Auto(...)` resolves to, what `File(...)` includes, that a plan written
//! down reads back as itself, and the commands `plan` and `repair`.

use crate::cli::{CUBE, folder, run};
use crate::shapes::flat_layer;
use glam::{DVec2, DVec3};
use pillarforest::compile;
use pillarforest::diag::{Diagnostic, Place, Warned};
use pillarforest::geom::{contains, polygon_area, to_segment};
use pillarforest::kinds::ReliefKind;
use pillarforest::planner::{Adjustment, Brief, Ended, Matters, Pillar, Planned, Watch};
use pillarforest::scene::{self, Scene};
use pillarforest::support::{Support, SupportKind};
use std::f64::consts::PI;
use std::fs;

/// Two eyes and one model; the rest of the scene, pillars among it, is `rest`.
fn text(rest: &str) -> String {
    format!(
        "(models: [(name: \"cube\", file: \"cube.obj\", place: Fit(height: 40, at: (1, 2, 5)))],\n\
         views: [\n(name: \"front\", eye: (0, -300, 60), models: [\"cube\"]),\n\
         (name: \"side\", eye: (300, 0, 60), models: [\"cube\"])],\n{rest})"
    )
}

fn read<'a>(layout: &'a [u8]) -> impl Fn(&str) -> Result<Vec<u8>, Diagnostic> + 'a {
    move |name| match name {
        "cube.obj" => Ok(CUBE.as_bytes().to_vec()),
        "layout.ron" => Ok(layout.to_vec()),
        _ => Err(Diagnostic::error(format!("no file {name}"))),
    }
}

fn resolve(rest: &str) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    scene::resolve(&text(rest), &read(b""))
}

fn good(rest: &str) -> Scene {
    let done = resolve(rest).unwrap_or_else(|problems| panic!("{rest}: {problems:?}"));
    assert!(done.warnings.is_empty(), "{rest}: {:?}", done.warnings);
    done.value
}

fn brief(rest: &str) -> Brief {
    good(rest).brief.expect("pillars are to be found")
}

/// The scene that includes a layout file.
fn including(layout: &str, rest: &str) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    let text = text(&format!("pillars: File(\"layout.ron\"), {rest}"));
    scene::resolve(&text, &read(layout.as_bytes()))
}

fn included(layout: &str, rest: &str) -> Scene {
    let done = including(layout, rest).unwrap_or_else(|problems| panic!("{layout}: {problems:?}"));
    assert!(done.warnings.is_empty(), "{layout}: {:?}", done.warnings);
    done.value
}

fn base(scene: &Scene) -> &[DVec2] {
    match &scene.supports.last().expect("supports").kind {
        SupportKind::Base { outline, .. } => outline,
        kind => panic!("no base but {kind:?}"),
    }
}

/// Distance of a point inside a polygon from its sides.
fn depth_inside(polygon: &[DVec2], p: DVec2) -> f64 {
    assert!(contains(polygon, p));
    let n = polygon.len();
    let sides = (0..n).map(|i| to_segment(p, polygon[i], polygon[(i + 1) % n]));
    sides.fold(f64::INFINITY, f64::min)
}

#[test]
fn an_empty_auto_is_what_the_schema_says() {
    let scene = good("pillars: Auto()");
    let brief = scene.brief.as_ref().expect("a brief");
    assert_eq!((brief.shapes.len(), brief.allowed), (1, 1));
    let shape = &brief.shapes[0];
    assert_eq!(shape.written, "Round(radius: 4)");
    assert!(shape.round && shape.profile.len() == 64 && (shape.reach - 4.0).abs() < 1e-12);
    assert_eq!(shape.heights, [90.0, 90.0]);
    assert_eq!(shape.layer, flat_layer(5.0, 2.0, 1.0));
    assert_eq!((brief.gap, brief.count), (0.5, [1, 200]));
    assert_eq!((brief.seed, brief.tries, brief.seconds), (1, 160_000, 60.0));
    assert_eq!(brief.hidden_from_deg, 10.0);
    let matters = Matters {
        camouflage: 1.0,
        tolerance: 1.0,
        pillars: 0.0,
        spread: 0.0,
    };
    assert_eq!(brief.matters, matters);
    assert_eq!(brief.tolerance_mm, [0.0, 0.0]);
    assert_eq!(
        (brief.freedom.turn, brief.freedom.scale, brief.freedom.shift),
        (0.0, 1.0, 0.0)
    );
    assert!(brief.given.is_empty());
    // A disc of 70 mm, and a base that holds it with the margin of every base.
    assert!(
        brief
            .region
            .outline()
            .iter()
            .all(|p| (p.length() - 70.0).abs() < 1e-9)
    );
    assert_eq!(scene.supports.len(), 1);
    let least = brief
        .region
        .outline()
        .iter()
        .map(|p| depth_inside(base(&scene), *p));
    assert!((least.fold(f64::INFINITY, f64::min) - 5.0).abs() < 0.03);
    let torn = matches!(scene.relief, ReliefKind::Torn(..));
    assert!(torn, "many pillars may come");
    assert_eq!(scene.adjusted, [Adjustment::NONE; 2]);
}

#[test]
fn every_field_of_auto_arrives_in_millimetres_and_radians() {
    let auto = "pillars: Auto(
        region: Rectangle(width: 12, depth: 8, centre: (1, -0.5), turn: 30),
        shapes: [Round(radius: 0.5, facets: 32), Polygon(sides: 6, radius: 0.4, turn: 15)],
        height: (6, 9), depth: (front: 0.3, back: 0.1, core: 0.05), gap: 0.07, count: (5, 60),
        seed: 7, tries: 1234, seconds: 2.5, hidden_from: 15, eye_tolerance: [0.3, 0.4],
        matters: (camouflage: 2, tolerance: 0.5, pillars: 0.1, spread: 0.2),
        models: (turn: 5, scale: 1.1, shift: 0.2),
    )";
    let centimetres = |rest: &str| {
        let text = text(&format!("units: cm, {rest}"));
        let text = text.replace("300", "30").replace("height: 40", "height: 4");
        let done = scene::resolve(&text, &read(b"")).unwrap_or_else(|p| panic!("{p:?}"));
        done.value.brief.expect("a brief")
    };
    let brief = centimetres(auto);
    assert!((polygon_area(brief.region.outline()) - 120.0 * 80.0).abs() < 1e-6);
    let middle = brief.region.outline().iter().sum::<DVec2>() / 4.0;
    assert!(middle.distance(DVec2::new(10.0, -5.0)) < 1e-9);
    let side = brief.region.outline()[1] - brief.region.outline()[0];
    assert!((side.to_angle() - PI / 6.0).abs() < 1e-9);
    let written: Vec<&str> = brief.shapes.iter().map(|s| s.written.as_str()).collect();
    assert_eq!(
        written,
        [
            "Round(radius: 5, facets: 32)",
            "Polygon(sides: 6, radius: 4, turn: 15)"
        ]
    );
    assert_eq!(
        (brief.shapes[0].profile.len(), brief.shapes[1].profile.len()),
        (32, 6)
    );
    for shape in &brief.shapes {
        assert_eq!(shape.heights, [60.0, 90.0]);
        let layer = shape.layer;
        let lengths = (layer.front, layer.back(), layer.core);
        assert_eq!(lengths, (3.0, 1.0, 0.5));
    }
    assert!((brief.gap - 0.7).abs() < 1e-12);
    assert_eq!((brief.count, brief.seed), ([5, 60], 7));
    assert_eq!((brief.tries, brief.seconds), (1234, 2.5));
    assert_eq!(brief.hidden_from_deg, 15.0);
    assert_eq!(brief.tolerance_mm, [3.0, 4.0]);
    let m = brief.matters;
    assert_eq!(
        [m.camouflage, m.tolerance, m.pillars, m.spread],
        [2.0, 0.5, 0.1, 0.2]
    );
    assert!((brief.freedom.turn.to_degrees() - 5.0).abs() < 1e-12);
    assert_eq!((brief.freedom.scale, brief.freedom.shift), (1.1, 2.0));
    let one = centimetres("pillars: Auto(eye_tolerance: 0.6, height: 7, count: 12, sizes: 1.5)");
    assert_eq!(one.tolerance_mm, [6.0, 6.0]);
    assert_eq!(one.shapes[0].heights, [70.0, 70.0]);
    assert_eq!(
        (one.count, one.shapes[0].written.as_str()),
        ([12, 12], "Round(radius: 6)")
    );
}

#[test]
fn the_region_is_the_base_without_its_rim_if_the_base_has_a_size() {
    for (base_text, area) in [
        ("Disc(radius: 50, facets: 40, centre: (5, 6))", None),
        ("Rectangle(width: 100, depth: 60)", Some(98.0 * 58.0)),
    ] {
        let scene = good(&format!("pillars: Auto(), base: {base_text}"));
        let region = &scene.brief.as_ref().expect("a brief").region;
        assert!(polygon_area(region.outline()) > 0.0, "counter-clockwise");
        let region = region.outline();
        let n = region.len();
        for i in 0..n {
            let middle = (region[i] + region[(i + 1) % n]) / 2.0;
            for p in [region[i], middle] {
                assert!((depth_inside(base(&scene), p) - 1.0).abs() < 1e-9, "{p}");
            }
        }
        if let Some(area) = area {
            assert!((polygon_area(region) - area).abs() < 1e-9);
        }
    }
    // A region of its own makes the base fit, whatever its shape and order.
    let clockwise = "Polygon(points: [(0, 0), (0, 60), (20, 60), (20, 20), (60, 20), (60, 0)])";
    let scene = good(&format!("pillars: Auto(region: {clockwise})"));
    let region = &scene.brief.as_ref().expect("a brief").region;
    assert!((polygon_area(region.outline()) - 2000.0).abs() < 1e-9);
    assert!((region.outline().iter()).all(|p| depth_inside(base(&scene), *p) > 4.9));
}

#[test]
fn sizes_are_even_steps_with_two_decimals_and_read_back_as_themselves() {
    let shapes = "[Round(radius: 4), Rectangle(width: 7.3, depth: 6.1, turn: 12.5), \
                  Profile(points: [(-4, -4), (4, -4), (4.4, 4), (-4, 4)], turn: 30)]";
    let brief = brief(&format!(
        "pillars: Auto(shapes: {shapes}, sizes: (0.9, 1.2))"
    ));
    assert_eq!((brief.shapes.len(), brief.allowed), (15, 15));
    let written: Vec<&str> = brief.shapes[..5]
        .iter()
        .map(|s| s.written.as_str())
        .collect();
    let radii = ["3.6", "3.9", "4.2", "4.5", "4.8"].map(|r| format!("Round(radius: {r})"));
    assert_eq!(written, radii);
    for shape in &brief.shapes {
        let number = |part: &str| part.trim_matches(|c: char| !c.is_ascii_digit()).to_string();
        let numbers = shape.written.split([',', '(']).map(number);
        for n in numbers.filter(|n| n.contains('.') && n != "12.5") {
            assert!(n.split('.').nth(1).is_some_and(|d| d.len() <= 2), "{n}");
        }
        let list = format!(
            "pillars: [(shape: {}, places: At([(0, 0)]))]",
            shape.written
        );
        let SupportKind::Pillar { profile, .. } = &good(&list).supports[0].kind else {
            panic!("a pillar");
        };
        assert_eq!(*profile, shape.profile, "{}", shape.written);
    }
    // Sizes that come to the same are one.
    let narrow = self::brief("pillars: Auto(sizes: (1, 1.003))");
    assert_eq!(narrow.shapes.len(), 2, "{:?}", narrow.shapes);
}

#[test]
fn fixed_pillars_stand_and_are_given_after_the_allowed_shapes() {
    let fixed = "[(name: \"post\", shape: Round(radius: 3), height: 70, places: Ring(count: 3, radius: 40)), \
                 (shape: Rectangle(width: 8, depth: 6), places: At([(0, 0)]), depth: (front: 2)), \
                 (name: \"post\", shape: Round(radius: 3), height: 70, places: At([(50.12345, 0)]))]";
    let scene = good(&format!("pillars: Auto(depth: (front: 4), fixed: {fixed})"));
    let brief = scene.brief.as_ref().expect("a brief");
    let names: Vec<&str> = scene.supports.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(
        names,
        ["post-1", "post-2", "post-3", "p1", "post-4", "base"]
    );
    assert_eq!((brief.allowed, brief.shapes.len()), (1, 3));
    let shapes: Vec<usize> = brief.given.iter().map(|p| p.shape).collect();
    assert_eq!(shapes, [1, 1, 1, 2, 1]);
    let fronts: Vec<f64> = brief.shapes.iter().map(|s| s.layer.front).collect();
    assert_eq!(
        fronts,
        [4.0, 4.0, 2.0],
        "fixed ones fall back on Auto's depth"
    );
    assert_eq!(brief.shapes[1].heights, [70.0, 70.0]);
    for (support, given) in scene.supports.iter().zip(&brief.given) {
        let SupportKind::Pillar { axis, .. } = support.kind else {
            panic!("a pillar")
        };
        assert_eq!(axis, given.at);
        assert!(given.fixed && given.owner.is_none());
    }
    assert_eq!(brief.given[4].at, DVec2::new(50.123, 0.0));
}

#[test]
fn a_layout_file_is_as_good_as_a_list() {
    let entries = "(name: \"a\", shape: Round(radius: 4), places: At([(0, 0), (20, 5)])), \
                   (shape: Rectangle(width: 8, depth: 8), height: 50, places: Ring(count: 3, radius: 40), depth: (back: 1))";
    let listed = good(&format!("pillars: [{entries}], depth: (front: 3)"));
    for layout in [
        format!("[{entries}]"),
        format!("// a remark\n#![enable(implicit_some)]\n[{entries}] // the end"),
        format!("(pillars: [{entries}])"),
        format!("\u{feff}(units: mm, adjust: [], pillars: [{entries}],)"),
    ] {
        let included = included(&layout, "depth: (front: 3)");
        assert_eq!(included.supports, listed.supports, "{layout}");
        assert!(included.brief.is_none());
    }
    // Whatever the scene's units.
    let text = text("units: cm, pillars: File(\"layout.ron\"), depth: (front: 0.3)");
    let text = text.replace("300", "30").replace("height: 40", "height: 4");
    let layout = format!("[{entries}]");
    let scene = scene::resolve(&text, &read(layout.as_bytes())).expect("a scene");
    assert_eq!(scene.value.supports, listed.supports);
    let inches =
        "(units: inch, pillars: [(shape: Round(radius: 0.2), height: 3, places: At([(1, 0)]))])";
    let SupportKind::Pillar { axis, top, .. } = included(inches, "").supports[0].kind else {
        panic!("a pillar")
    };
    assert!((axis.x - 25.4).abs() < 1e-12 && (top - 76.2).abs() < 1e-12);
}

#[test]
fn adjustments_turn_scale_and_shift_the_models_of_their_view_only() {
    let pillars = "pillars: [(shape: Round(radius: 4), places: At([(0, 0)]))]";
    let layout =
        format!("({pillars}, adjust: [(view: \"side\", turn: 30, scale: 0.9, shift: (3, -4))])");
    let (plain, scene) = (good(pillars), included(&layout, ""));
    let same = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).all(|(a, b)| a.distance(*b) < 1e-9);
    let mesh = |s: &Scene, view: usize| s.views[view].models[0].mesh.clone();
    assert_eq!(mesh(&plain, 0).vertices, mesh(&scene, 0).vertices);
    // The middle of the cube's underside is at (1, 2, 5).
    let foot = DVec3::new(1.0, 2.0, 5.0);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let wanted = |v: &DVec3| {
        let d = (*v - foot) * 0.9;
        let turned = DVec3::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y, d.z);
        foot + turned + DVec3::new(3.0, -4.0, 0.0)
    };
    let before = mesh(&plain, 1);
    let wanted: Vec<DVec3> = before.vertices.iter().map(wanted).collect();
    assert!(same(&wanted, &mesh(&scene, 1).vertices));
    // Reports carry the matrix from the file's coordinates.
    let (was, is) = (&plain.views[1].models[0], &scene.views[1].models[0]);
    let file: Vec<DVec3> = was
        .mesh
        .vertices
        .iter()
        .map(|v| was.matrix.inverse().transform_point3(*v))
        .collect();
    let by_matrix: Vec<DVec3> = file
        .iter()
        .map(|v| is.matrix.transform_point3(*v))
        .collect();
    assert!(same(&by_matrix, &is.mesh.vertices));
    assert_eq!(plain.views[1].look_at, scene.views[1].look_at);
    assert_eq!(scene.adjusted[0], Adjustment::NONE);
    assert_eq!(scene.adjusted[1].shift, DVec2::new(3.0, -4.0));
}

/// `(line, message, excerpt)` of problems that all lie in the layout file.
fn in_layout(layout: &str, rest: &str) -> Vec<(usize, String, String)> {
    let problems = match including(layout, rest) {
        Ok(done) => done.warnings,
        Err(problems) => problems,
    };
    let place = |p: &Diagnostic| match &p.place {
        Some(Place::Line {
            file,
            line,
            excerpt,
        }) => {
            assert_eq!(file, "layout.ron");
            (*line, p.message.clone(), excerpt.clone())
        }
        place => panic!("{place:?} of {p:?} in\n{layout}"),
    };
    problems.iter().map(place).collect()
}

#[test]
fn what_is_wrong_with_a_layout_file_is_told_of_the_file() {
    let pillar = "(shape: Round(radius: 4), places: At([(0, 0)]))";
    let one = |text: &str| text.replace("PILLAR", pillar);
    let cases: [(&str, &str, usize, &str); 16] = [
        (
            "[\nPILLAR,\n  (shape: Round(radius: 4), places: At([(3, 0)]))]",
            "",
            3,
            "pillars overlap: radius 4 mm but centres 3 mm apart",
        ),
        (
            "[PILLAR,\n(shape: Round(radius: 4), places: At([(80, 0)]))]",
            "base: Disc(radius: 60, centre: (0, 0))",
            2,
            "p2 at (80, 0) stands beside the base",
        ),
        (
            "[\n\nPILLAR]",
            "depth: (back: 3.5)",
            3,
            "reliefs would cut the pillar through: back 3.5 mm + core 1 mm is more than the radius, 4 mm",
        ),
        (
            "[(\n  shap: Round(radius: 4),\n  places: At([(0, 0)]))]",
            "",
            2,
            "unknown field `shap`, did you mean `shape`?",
        ),
        (
            "(pillars: [PILLAR],\n  pilars: 3)",
            "",
            2,
            "unknown field `pilars`, did you mean `pillars`?",
        ),
        (
            "[\n(shape: Round(radius: -4), places: At([(0, 0)]))]",
            "",
            2,
            "`radius` is -4 mm; it must be more than 0",
        ),
        ("(adjust: [])", "", 1, "the layout has no `pillars`"),
        ("[]", "", 1, "a forest needs at least one pillar"),
        (
            "(pillars: [PILLAR], adjust: [\n(view: \"sid\", turn: 3)])",
            "",
            2,
            "there is no view \"sid\", did you mean \"side\"?",
        ),
        (
            "(pillars: [PILLAR], adjust: [(view: \"side\"),\n(view: \"side\")])",
            "",
            2,
            "view \"side\" is adjusted twice",
        ),
        (
            "(pillars: [PILLAR], adjust: [(view: \"side\",\nscale: 0)])",
            "",
            2,
            "`scale` is 0; it must be from 0.1 to 10",
        ),
        (
            "(pillars: [PILLAR], adjust: [\n(turn: 3)])",
            "",
            2,
            "this adjustment has no `view`",
        ),
        ("[PILLAR\nPILLAR]", "", 1, "a comma is missing after this"),
        (
            "[PILLAR]\n[]",
            "",
            2,
            "the layout ends before this: nothing may follow its closing bracket",
        ),
        (
            "\n{ \"pillars\": [] }",
            "",
            2,
            "this looks like JSON; layouts are RON",
        ),
        (
            "\n  (pillars: [PILLAR]",
            "",
            2,
            "`(` is opened here and never closed",
        ),
    ];
    for (layout, rest, line, message) in cases {
        let layout = one(layout);
        let told = in_layout(&layout, rest);
        assert_eq!(told.len(), 1, "{layout}: {told:?}");
        assert_eq!((told[0].0, told[0].1.as_str()), (line, message), "{layout}");
        let shown = layout.lines().nth(line - 1).expect("the line");
        assert!(shown.contains(told[0].2.trim_end_matches('.')), "{told:?}");
    }
    let two = in_layout("[\n(shape: Star(),\nplaces: At([]))]", "");
    let lines: Vec<usize> = two.iter().map(|t| t.0).collect();
    assert_eq!(lines, [2, 3], "{two:?}");
}

#[test]
fn layout_files_that_are_no_text_or_too_much_of_it_are_named() {
    let text = text("pillars: File(\"layout.ron\")");
    let told = |bytes: &[u8]| scene::resolve(&text, &read(bytes)).expect_err("no layout");
    let byte = told(b"[\xff]");
    assert!(
        matches!(&byte[0].place, Some(Place::Byte { file, offset: 1 }) if file == "layout.ron")
    );
    for bytes in [&b""[..], b"// nothing\n", &vec![b' '; 9 << 20]] {
        let problems = told(bytes);
        assert_eq!(problems.len(), 1, "{problems:?}");
        assert!(
            problems[0].message.starts_with("the layout"),
            "{problems:?}"
        );
        let named = match &problems[0].place {
            Some(Place::File(file) | Place::Line { file, .. }) => file == "layout.ron",
            _ => false,
        };
        assert!(named, "{problems:?}");
    }
    // No prefix crashes.
    let layout = "(pillars: [(name: \"a\", shape: Round(radius: 4), places: At([(0, 0)]))], adjust: [(view: \"side\")])";
    for end in 0..layout.len() {
        in_layout_or_file(&layout[..end]);
    }
}

fn in_layout_or_file(layout: &str) {
    for problem in including(layout, "").expect_err("a part of a layout") {
        assert!(
            !matches!(problem.place, Some(Place::Scene(_))),
            "{layout}: {problem:?}"
        );
    }
}

/// Numbers that no decimal ends, the same in every run.
fn crooked(k: usize) -> f64 {
    (k as f64 * 0.754_877_666 + 0.1).fract() * 2.0 - 1.0
}

/// A plan with pillars of all views and shapes, somewhere.
fn crooked_plan(scene: &Scene) -> Planned {
    let brief = scene.brief.as_ref().expect("a brief");
    let mut pillars: Vec<Pillar> = brief.given.iter().filter(|p| p.fixed).copied().collect();
    for k in 0..24 {
        pillars.push(Pillar {
            at: DVec2::new(-90.0 + 12.0 * (k % 6) as f64, -60.0 + 12.0 * (k / 6) as f64)
                + DVec2::new(crooked(2 * k), crooked(2 * k + 1)),
            shape: k % brief.allowed,
            owner: [Some(1), Some(0), None][k % 3],
            fixed: false,
            given: None,
        });
    }
    let height = |(k, p): (usize, &Pillar)| {
        let [low, high] = brief.shapes[p.shape].heights;
        low + (high - low) * (0.5 + 0.5 * crooked(k % 4))
    };
    let turned = Adjustment {
        turn: crooked(5),
        scale: 1.0 + 0.1 * crooked(6),
        shift: DVec2::new(crooked(7), crooked(8)),
    };
    Planned {
        heights: pillars.iter().enumerate().map(height).collect(),
        adjustments: vec![Adjustment::NONE, turned],
        worth: Vec::new(),
        regions: Vec::new(),
        frames: Vec::new(),
        trade: Vec::new(),
        tries: 3,
        ended: Ended::Tries,
        changes: Vec::new(),
        pillars,
    }
}

fn pillars(scene: &Scene) -> Vec<&Support> {
    scene
        .supports
        .iter()
        .filter(|s| s.layer.is_some())
        .collect()
}

#[test]
fn a_plan_written_down_reads_back_as_itself() {
    let fixed = "[(name: \"side\", shape: Polygon(sides: 5, radius: 0.21, turn: 7.7), height: 3.3, places: Ring(count: 3, radius: 1.1, centre: (2, 2))), \
                 (shape: Round(radius: 0.1), places: At([(3.3, 0.7)]))]";
    let shapes = "[Round(radius: 0.17), Rectangle(width: 0.33, depth: 0.21, turn: 33.3), \
                  Profile(points: [(-0.1, -0.1), (0.13, -0.1), (0.03, 0.17)])]";
    let text = text(&format!(
        "title: \"two\\nlines\", units: inch, pillars: Auto(shapes: {shapes}, sizes: (0.9, 1.1), height: (2, 3), fixed: {fixed})"
    ));
    let text = text
        .replace("300", "20")
        .replace("height: 40", "height: 1.5");
    let scene = scene::resolve(&text, &read(b"")).unwrap_or_else(|p| panic!("{p:?}"));
    let scene = scene.value;
    let plan = crooked_plan(&scene);
    let laid = scene::laid_out(&scene, &plan);
    let layout = scene::layout_text(&scene, &plan);
    // As the scene with the file in the pillars' place.
    let (before, after) = text.split_once("pillars: Auto(").expect("an Auto");
    let end = after.rfind("))").expect("its end");
    let kept = format!("{before}pillars: File(\"layout.ron\"){}", &after[end + 1..]);
    let back = scene::resolve(&kept, &read(layout.as_bytes()));
    let back = back.unwrap_or_else(|p| panic!("{p:?}\n{layout}")).value;
    assert_eq!(pillars(&laid), pillars(&back), "{layout}");
    assert_eq!(pillars(&back).len(), 28);
    let names: Vec<&str> = pillars(&back).iter().map(|s| s.name.as_str()).collect();
    // Fixed ones keep their names; a view of the same name goes on counting.
    assert_eq!(
        names[..6],
        ["side-1", "side-2", "side-3", "p1", "front-1", "front-2"]
    );
    assert!(
        names.contains(&"side-11") && !names.contains(&"side-12"),
        "{names:?}"
    );
    assert_eq!(laid.adjusted, back.adjusted);
    for (a, b) in laid.views.iter().zip(&back.views) {
        assert_eq!((a.eye, a.look_at), (b.eye, b.look_at));
        assert_eq!(a.models[0].matrix, b.models[0].matrix);
        assert_eq!(a.models[0].mesh.vertices, b.models[0].mesh.vertices);
    }
    assert!(laid.brief.is_none() && layout.is_ascii());
    assert!(layout.contains("adjust") && !layout.contains("(view: \"front\""));
    let decimals = layout.split(|c: char| !c.is_ascii_digit() && c != '.');
    let places = decimals.filter(|n| n.parse::<f64>().is_ok());
    assert!(
        places
            .filter_map(|n| n.split_once('.'))
            .all(|(_, d)| d.len() <= 9)
    );
    // Written once more it is the same text: nothing drifts.
    assert_eq!(scene::layout_text(&scene, &plan), layout);
}

#[test]
fn no_prefix_of_an_auto_crashes() {
    let whole = text(
        "pillars: Auto(region: Disc(radius: 60), shapes: [Round(radius: 4)], sizes: (1, 1.2), height: (60, 90), \
         count: (3, 9), fixed: [(shape: Round(radius: 3), places: At([(0, 0)]))], eye_tolerance: [1, 2])",
    );
    assert!(scene::resolve(&whole, &read(b"")).is_ok());
    for end in 0..whole.len() {
        assert!(scene::resolve(&whole[..end], &read(b"")).is_err(), "{end}");
    }
}

#[cfg(unix)]
#[test]
fn layouts_outside_of_the_scenes_folder_are_refused() {
    let top = tempfile::tempdir().unwrap();
    let inside = top.path().join("scene");
    fs::create_dir(&inside).unwrap();
    fs::write(inside.join("cube.obj"), CUBE).unwrap();
    fs::write(top.path().join("secret.ron"), "[(shape: Secret())]").unwrap();
    std::os::unix::fs::symlink("../secret.ron", inside.join("link.ron")).unwrap();
    for file in ["../secret.ron", "link.ron"] {
        fs::write(inside.join("scene.ron"), keeping(file)).unwrap();
        let (code, _, err) = run(&inside, &["check"]);
        assert_eq!(code, 1, "{err}");
        assert!(err.contains("outside the scene's folder"), "{err}");
        assert!(
            !err.contains("Secret") && err.contains("scene.ron:4:"),
            "{err}"
        );
        let (_, _, err) = run(&inside, &["check", "--allow-outside"]);
        assert!(err.contains("unknown choice `Secret`"), "{err}");
    }
    // A link that the scene uses is not replaced either.
    fs::write(
        top.path().join("secret.ron"),
        "[(shape: Round(radius: 4), places: At([(0, 0)]))]",
    )
    .unwrap();
    let args = ["repair", "--allow-outside", "-o", "link.ron"];
    let (code, _, err) = run(&inside, &args);
    assert_eq!(code, 2, "{err}");
    assert!(inside.join("link.ron").is_symlink());
}

#[test]
fn lists_read_to_be_mended_are_given_and_free() {
    let list = "pillars: [(shape: Round(radius: 4), places: At([(0, 0), (3, 0)])), \
                (shape: Round(radius: 4), places: At([(90, 0)])), (shape: Round(radius: 5), height: 80, places: At([(-30, 0)]))], \
                base: Disc(radius: 60, centre: (0, 0))";
    assert!(resolve(list).is_err(), "overlapping, and beside the base");
    let done = scene::resolve_to_mend(&text(list), &read(b"")).unwrap_or_else(|p| panic!("{p:?}"));
    let scene = done.value;
    let brief = scene.brief.as_ref().expect("a brief");
    assert_eq!((brief.shapes.len(), brief.allowed), (2, 2));
    assert_eq!(brief.given.len(), 4);
    assert!(brief.given.iter().all(|p| !p.fixed));
    assert_eq!((brief.gap, brief.count), (0.2, [1, 200]));
    assert_eq!(brief.shapes[1].heights, [80.0, 80.0]);
    let rim = brief
        .region
        .outline()
        .iter()
        .map(|p| depth_inside(base(&scene), *p));
    assert!(rim.fold(f64::INFINITY, f64::min) > 1.0 - 1e-9);
    let names: Vec<&str> = scene.supports.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["p1", "p2", "p3", "p4", "base"]);
    // Everything else is still looked at.
    let wrong = list.replace("radius: 5", "radius: -5");
    assert!(scene::resolve_to_mend(&text(&wrong), &read(b"")).is_err());
    let auto = scene::resolve_to_mend(&text("pillars: Auto()"), &read(b"")).expect("a scene");
    let watch = Watch {
        progress: &|_, _| {},
        stop: &|| false,
    };
    let told = compile::repaired(&auto.value, watch).expect_err("nothing is listed");
    assert!(told[0].message.contains("no list to mend"), "{told:?}");
}

/// One eye and a cube before it.
const ONE: &str = r#"(
    models: [(name: "cube", file: "cube.obj", place: Fit(height: 30, facing: (0, -1), at: (0, 0, 12)))],
    views: [(name: "front", eye: (0, -300, 30), models: ["cube"])],
    pillars: Auto(height: 60, tries: 200),
    output: (plan_width: 400),
)"#;

/// `ONE` with the pillars of the file.
fn keeping(layout: &str) -> String {
    let file = format!("File(\"{layout}\")");
    ONE.replace("Auto(height: 60, tries: 200)", &file)
}

#[test]
fn set_reaches_into_auto() {
    let set = |text: &str, assignment: &str| {
        let text = scene::set(text, assignment).unwrap_or_else(|e| panic!("{assignment}: {e:?}"));
        let scene = scene::resolve(&text, &read(b"")).unwrap_or_else(|p| panic!("{p:?}"));
        scene.value.brief.expect("a brief")
    };
    assert_eq!(set(ONE, "pillars.seed=3").seed, 3);
    assert_eq!(set(ONE, "pillars.tries=7").tries, 7);
    assert_eq!(
        set(ONE, "pillars.matters.camouflage=2").matters.camouflage,
        2.0
    );
    let bare = text("pillars: Auto()");
    assert_eq!(set(&bare, "pillars.hidden_from=20").hidden_from_deg, 20.0);
    let listed = text("pillars: [(shape: Round(radius: 4), places: At([(0, 0)]))]");
    assert_eq!(set(&listed, "pillars=Auto(seed: 9)").seed, 9);
}

#[test]
fn a_scene_with_pillars_to_be_found_is_planned_first() {
    let scene = scene::resolve(ONE, &read(b"")).expect("a scene").value;
    let watch = Watch {
        progress: &|_, _| {},
        stop: &|| false,
    };
    let (laid, plan) = compile::planned(&scene, watch).expect("a plan");
    assert_eq!(pillars(&laid).len(), plan.pillars.len());
    assert!(pillars(&laid).iter().all(|p| p.name.starts_with("front-")));
    let build = compile::plan(&scene, &|_, _| {}, &|| false).expect("a plan");
    let paths: Vec<&str> = build.files.iter().map(|f| f.path.as_str()).collect();
    assert_eq!(paths, ["plan.svg", "plan.png", "layout.ron"]);
    let layout = scene::layout_text(&scene, &plan);
    assert_eq!(build.files[2].bytes, layout.as_bytes());
    let back = scene::resolve(&keeping("layout.ron"), &read(layout.as_bytes()));
    assert_eq!(pillars(&back.expect("a scene").value), pillars(&laid));
    let outputs = compile::plan_outputs(&scene, &plan);
    assert_eq!(outputs[0].path, "layout.ron");
    let told = compile::check(&scene, &|_, _| {}, &|| false).expect("a check");
    assert!(told.iter().all(|d| !d.is_error()), "{told:?}");
    // What is listed needs no plan.
    let told = compile::planned(&laid, watch).expect_err("nothing to plan");
    assert!(told[0].message.contains("nothing to plan"), "{told:?}");
}

#[test]
fn plan_writes_a_layout_that_the_scene_takes_up() {
    let folder = folder(ONE);
    let (code, out, err) = run(folder.path(), &["plan"]);
    assert_eq!(code, 0, "{out}{err}");
    for part in [
        "coverage",
        "conflicts",
        "at 10 deg off",
        "half likeness",
        "eye tolerance",
        "wrote out/scene/layout.ron",
        "pillars: File(\"out/scene/layout.ron\")",
    ] {
        assert!(out.contains(part), "{part}\n{out}");
    }
    assert!(!out.contains("another machine"), "{out}");
    let made = folder.path().join("out/scene");
    for file in ["layout.ron", "plan.svg", "plan.png"] {
        assert!(made.join(file).exists(), "{file}");
    }
    assert_eq!(
        fs::read_to_string(folder.path().join("scene.ron")).unwrap(),
        ONE
    );
    fs::write(
        folder.path().join("kept.ron"),
        keeping("out/scene/layout.ron"),
    )
    .unwrap();
    let (code, out, err) = run(folder.path(), &["check", "kept.ron", "--deny", "warnings"]);
    assert_eq!(code, 0, "{out}{err}");
    // The layout alone, elsewhere; the same seed gives the same.
    let (code, out, err) = run(folder.path(), &["plan", "-q", "-o", "kept/again.ron"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.starts_with("wrote kept/again.ron  ") && out.lines().count() == 1,
        "{out}"
    );
    let text = |path: &str| fs::read_to_string(folder.path().join(path)).unwrap();
    assert_eq!(text("kept/again.ron"), text("out/scene/layout.ron"));
    assert_eq!(fs::read_dir(folder.path().join("kept")).unwrap().count(), 1);
    let (code, out, _) = run(
        folder.path(),
        &["plan", "--seconds", "0.000001", "--seed", "4"],
    );
    assert_eq!(code, 0);
    assert!(
        out.contains("on another machine it may end elsewhere"),
        "{out}"
    );
    assert!(
        text("out/scene/layout.ron").contains("seed 4"),
        "{}",
        text("out/scene/layout.ron")
    );
}

#[test]
fn plan_overwrites_neither_the_scene_nor_what_it_includes() {
    let folder = folder(ONE);
    assert_eq!(run(folder.path(), &["plan", "-o", "layout.ron"]).0, 0);
    fs::write(folder.path().join("kept.ron"), keeping("layout.ron")).unwrap();
    fs::rename(
        folder.path().join("scene.ron"),
        folder.path().join("auto.ron"),
    )
    .unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/layout.ron"), ONE).unwrap();
    let before = listing(folder.path());
    for (args, said) in [
        (
            &["plan", "auto.ron", "-o", "auto.ron"][..],
            "the scene itself",
        ),
        (
            &["plan", "auto.ron", "-o", "./sub/../auto.ron"],
            "the scene itself",
        ),
        (&["plan", "sub/layout.ron", "-o", "sub"], "the scene itself"),
        (
            &["repair", "kept.ron", "-o", "layout.ron"],
            "a file that the scene uses",
        ),
        (
            &["repair", "kept.ron", "-o", "."],
            "a file that the scene uses",
        ),
        (
            &["plan", "auto.ron", "-o", "plan.svg"],
            "makes no .svg file",
        ),
        (
            &["plan", "auto.ron", "-o", "cube.obj"],
            "it is a file, not a directory",
        ),
    ] {
        let (code, out, err) = run(folder.path(), args);
        assert_eq!((code, out.as_str()), (2, ""), "{args:?}: {err}");
        assert!(
            err.contains(said) && err.contains("Nothing was written"),
            "{args:?}: {err}"
        );
        assert_eq!(listing(folder.path()), before, "{args:?}");
    }
    for (args, said) in [
        (["plan", "kept.ron"], "nothing to plan"),
        (["repair", "auto.ron"], "no list to mend"),
    ] {
        let (code, _, err) = run(folder.path(), &args);
        assert_eq!(code, 1, "{err}");
        assert!(err.contains(said), "{err}");
    }
    assert_eq!(listing(folder.path()), before);
}

/// Files of a folder with what they hold.
fn listing(folder: &std::path::Path) -> Vec<(String, Vec<u8>)> {
    let mut list = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            list.push((path.display().to_string(), fs::read(&path).unwrap()));
        } else {
            list.extend(listing(&path));
        }
    }
    list.sort();
    list
}

#[test]
fn repair_lists_its_changes_and_leaves_sound_layouts_alone() {
    let folder = folder(ONE);
    let path = |name: &str| folder.path().join(name);
    assert_eq!(run(folder.path(), &["plan", "-o", "sound.ron"]).0, 0);
    fs::write(path("kept.ron"), keeping("sound.ron")).unwrap();
    let (code, out, err) = run(folder.path(), &["repair", "kept.ron"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("nothing to mend. Nothing was written."),
        "{out}"
    );
    assert!(!path("out").exists());
    // One pillar is pushed into its neighbour.
    let sound = fs::read_to_string(path("sound.ron")).unwrap();
    let places = sound.find("At([").expect("places") + 4;
    let (first, rest) = sound[places..].split_once("), ").expect("two places");
    let second = rest.split(')').next().expect("a place");
    let numbers = |place: &str| -> Vec<f64> {
        let list = place.trim().trim_start_matches('(').split(", ");
        list.map(|n| n.parse().expect("a number")).collect()
    };
    let (a, b) = (numbers(first), numbers(second));
    let pushed = format!("({}, {})", b[0] + 0.75 * (a[0] - b[0]) / 8.0, b[1] + 4.0);
    let broken = format!("{}\n{pushed}, {rest}", &sound[..places]);
    fs::write(path("broken.ron"), broken).unwrap();
    fs::write(path("hurt.ron"), keeping("broken.ron")).unwrap();
    let (code, _, err) = run(folder.path(), &["check", "hurt.ron"]);
    assert!(
        code == 1 && err.contains("overlap") && err.contains("broken.ron"),
        "{err}"
    );
    let (code, out, err) = run(folder.path(), &["repair", "hurt.ron"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(
        out.contains("moved front-") && out.contains(" mm to ("),
        "{out}"
    );
    fs::write(path("mended.ron"), keeping("out/hurt/layout.ron")).unwrap();
    let (code, out, err) = run(folder.path(), &["check", "mended.ron"]);
    assert_eq!(code, 0, "{out}{err}");
}
