//! Supports that are no pillars: what their layers promise, found by rays at the finished solid and the bare one.

use super::shapes::{Outcome, Setting, ball, balls, obj};
use glam::DVec3;
use pillarforest::bvh::Bvh;
use pillarforest::compile::{self, Build};
use pillarforest::diag::{Diagnostic, Place};
use pillarforest::intake::load_model;
use pillarforest::mesh::{Solid, TriMesh};
use pillarforest::scene::{self, Scene};
use pillarforest::support::{HULL_MM, Slab};

/// A ball of 20 mm before the support, seen from in front and a little above.
fn text(supports: &str) -> String {
    // In one piece a facet that spans several steps finds no depths in a layer that follows them.
    let steps = if supports.starts_with("Stairs") {
        "Allowed()"
    } else {
        "Never"
    };
    format!(
        "(models: [(name: \"ball\", file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 10)))],\n\
         views: [(name: \"front\", eye: (0, -300, 90), look_at: (0, 0, 30), models: [\"ball\"])],\n\
         supports: [{supports}],\n\
         energy: Normal(steps: {steps}),\n\
         output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    )
}

fn read(name: &str) -> Result<Vec<u8>, Diagnostic> {
    match name {
        "ball.obj" => Ok(obj(&ball(DVec3::ZERO, 20.0, 40))),
        "sheet.obj" => Ok(obj(&sheet())),
        "grey.png" => Ok(ramp()),
        "deep.png" => Ok(deep()),
        "huge.png" => Ok(png(
            [60_000, 60_000],
            png::ColorType::Grayscale,
            png::BitDepth::One,
            &[],
        )),
        "cut.png" => Ok(ramp()[..60].to_vec()),
        "photo.jpg" => Ok(b"\xFF\xD8\xFF\xE0\0\x10JFIF".to_vec()),
        _ => Err(Diagnostic::error(format!("no file {name}"))),
    }
}

/// An upright square of 80 mm that looks along -y, with a border.
fn sheet() -> TriMesh {
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    TriMesh::new(
        vec![
            corner(-40.0, 0.0),
            corner(40.0, 0.0),
            corner(40.0, 80.0),
            corner(-40.0, 80.0),
        ],
        [[0, 1, 2], [0, 2, 3]],
    )
}

/// A PNG with these pixels, or only its head.
fn png(size: [u32; 2], colour: png::ColorType, depth: png::BitDepth, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("a header");
    if !pixels.is_empty() {
        writer.write_image_data(pixels).expect("pixels");
    }
    drop(writer);
    bytes
}

/// Three greys of 16 bits, of which 8 bits would keep none: the first two would be one.
const GREYS: [u16; 3] = [1000, 1027, 60_001];

fn deep() -> Vec<u8> {
    let pixels = GREYS.map(u16::to_be_bytes).concat();
    png(
        [3, 1],
        png::ColorType::Grayscale,
        png::BitDepth::Sixteen,
        &pixels,
    )
}

/// A PNG that is black on the left and white on the right.
fn ramp() -> Vec<u8> {
    let mut pixmap = tiny_skia::Pixmap::new(2, 1).expect("two pixels");
    pixmap.pixels_mut()[1] =
        tiny_skia::PremultipliedColorU8::from_rgba(255, 255, 255, 255).expect("white");
    pixmap.pixels_mut()[0] =
        tiny_skia::PremultipliedColorU8::from_rgba(0, 0, 0, 255).expect("black");
    pixmap.encode_png().expect("a PNG")
}

fn good(supports: &str) -> Scene {
    let done = scene::resolve(&text(supports), &read);
    let done = done.unwrap_or_else(|problems| panic!("{supports}: {problems:?}"));
    assert!(done.warnings.is_empty(), "{supports}: {:?}", done.warnings);
    done.value
}

fn built(scene: &Scene) -> Build {
    compile::build(scene, &|_, _| {}, &|| false).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn forest(build: &Build) -> TriMesh {
    let file = build.files.iter().find(|f| f.path == "forest.stl");
    load_model("forest.stl", &file.expect("a forest").bytes, false)
        .expect("a sound file")
        .value
}

fn report(build: &Build) -> serde_json::Value {
    let file = build.files.iter().find(|f| f.path == "report.json");
    serde_json::from_slice(&file.expect("a report").bytes).expect("JSON")
}

/// Ridges seen from the left hide a slope each: the image is connected there, the layer is not. No face has to fit into both of its sides.
#[test]
fn a_layer_that_jumps_behind_ridges_ends_a_group_there() {
    let text = "(models: [(name: \"ball\", file: \"ball.obj\", place: Fit(height: 50, at: (0, 0, 15)))],
        views: [(name: \"left\", eye: (-320, -320, 45), models: [\"ball\"])],
        supports: [Wave(width: 90, height: 90, thickness: 5, heights: Formula(\"22 * acos(cos(x / 4)) / 3.14159\"), depth: (front: 3))],
        energy: Normal(steps: Allowed()),
        output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))";
    let scene = scene::resolve(text, &read).unwrap_or_else(|problems| panic!("{problems:?}"));
    let report = report(&built(&scene.value));
    let view = &report["views"][0];
    let groups = view["groups"].as_u64();
    assert!(groups.is_some_and(|n| n >= 2), "{groups:?} groups");
    assert_eq!(view["certificate"]["coverage"], 1.0);
    let error = view["normal_error_deg"]["mean"].as_f64();
    assert!(error.is_some_and(|deg| deg < 6.0), "{error:?} degrees");
}

/// A ball that hides part of another on ridges between which the layer jumps against the model's order: parts on two ridges cannot cross,
/// so nothing orders them, and one piece fits.
#[test]
fn parts_on_two_ridges_have_no_order() {
    let text = "(models: [(name: \"m\", file: \"balls.obj\", place: Fit(height: 50, at: (0, 0, 15)))],
        views: [(name: \"left\", eye: (-320, -320, 45), models: [\"m\"])],
        supports: [Wave(width: 90, height: 90, thickness: 5, heights: Formula(\"22 * acos(cos(x / 4)) / 3.14159\"), depth: (front: 4))],
        energy: Curvature(),
        output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))";
    let scene = scene::resolve(text, &read_balls(DVec3::new(-14.0, -30.0, 4.0)));
    let scene = scene.unwrap_or_else(|problems| panic!("{problems:?}"));
    let report = report(&built(&scene.value));
    let certificate = &report["views"][0]["certificate"];
    assert_eq!(certificate["order_inversions"], 0, "{certificate}");
    assert_eq!(certificate["coverage"], 1.0, "{certificate}");
}

/// The file of two balls.
fn read_balls(second: DVec3) -> impl Fn(&str) -> Result<Vec<u8>, Diagnostic> {
    move |name| match name {
        "balls.obj" => Ok(obj(&balls(second))),
        _ => Err(Diagnostic::error(format!("no file {name}"))),
    }
}

/// Two balls before a plate whose outlines lie on it, built with these steps.
fn two_balls(second: DVec3, steps: &str) -> serde_json::Value {
    let text = format!(
        "(models: [(name: \"m\", file: \"balls.obj\", place: Fit(largest: 70, at: (0, 0, 10)))],\n\
         views: [(name: \"m\", eye: (0, -350, 50), models: [\"m\"])],\n\
         supports: [Plate(width: 100, height: 100, depth: (front: 6, outline: OnSupport))],\n\
         energy: Normal(steps: {steps}),\n\
         output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    );
    let scene = scene::resolve(&text, &read_balls(second))
        .unwrap_or_else(|problems| panic!("{problems:?}"));
    let report = report(&built(&scene.value));
    report["views"][0].clone()
}

/// Where the nearer ball passes before the other, tears end at an outline that leaves them no room. The surface is torn all the same,
/// but for there.
#[test]
fn tears_that_end_at_outlines_without_room_close_there() {
    let view = two_balls(DVec3::new(22.0, -40.0, 6.0), "Allowed()");
    let lines = view["steps"]["lines"].as_u64();
    assert!(lines.is_some_and(|n| n > 20), "{lines:?} tears");
    let error = view["normal_error_deg"]["mean"].as_f64();
    assert!(error.is_some_and(|deg| deg < 4.0), "{error:?} degrees");
}

/// Parts that overlap are one object with one outline: the seam between them lies where it must, in front of the plate.
#[test]
fn parts_that_overlap_have_one_outline() {
    let view = two_balls(DVec3::new(22.0, -8.0, 6.0), "Never");
    let certificate = &view["certificate"];
    assert_eq!(certificate["order_inversions"], 0);
    let front = certificate["relief_front_mm"].as_f64();
    assert!(front.is_some_and(|mm| mm > 5.0), "{front:?} mm");
}

/// How far the forest stands before the bare support (negative: behind it) on rays at the ball, millimetres along the rays.
fn offsets(scene: &Scene, mesh: &TriMesh) -> Vec<f64> {
    let view = &scene.views[0];
    let mut bare = TriMesh::default();
    scene.supports.iter().for_each(|s| bare.append(&s.mesh));
    let target = Bvh::new(&view.target());
    let (bare, forest) = (Bvh::new(&bare), Bvh::new(mesh));
    let plane = view.plane();
    let mut found = Vec::new();
    for i in 0..80 {
        for j in 0..80 {
            let place = |k: i32| (f64::from(k) + 0.37) / 40.0 - 1.0;
            let q = 0.08 * glam::DVec2::new(place(i), place(j));
            let way = plane.direction(q).normalize();
            if target.first_hit(view.eye, way).is_none() {
                continue;
            }
            let [a, b] =
                [&bare, &forest].map(|bvh| bvh.first_hit(view.eye, way).expect("a support").t);
            found.push(a - b);
        }
    }
    assert!(found.len() > 1500, "{} rays", found.len());
    found
}

#[test]
fn reliefs_stay_in_their_layers_on_supports_of_any_form() {
    // Of plates millimetres are square to the face; on rays they are up to 8 % more here.
    let kinds = [
        (
            "Plate(width: 80, height: 70, at: (0, 20, 0), depth: (front: 4))",
            4.0 * 1.08,
            0.1,
            1,
        ),
        (
            "Plate(width: 80, height: 70, thickness: 8, at: (0, 20, 0), depth: (front: 1, back: 3))",
            1.08,
            3.0 * 1.08,
            1,
        ),
        (
            "Stairs(steps: 5, width: 80, rise: 14, going: 12, depth: (front: 5))",
            5.0,
            0.1,
            7,
        ),
        (
            "Groove(width: 80, height: 80, opening: 70, deep: 30, thickness: 45, at: (0, 20, -20), depth: (front: 1, back: 5))",
            1.0,
            5.0,
            1,
        ),
        (
            "Wave(width: 80, height: 80, heights: Formula(\"2 * sin(x / 6) * cos(y / 9)\"), pitch: 4, at: (0, 20, 0), depth: (front: 2, back: 2))",
            2.0,
            2.0,
            1,
        ),
        (
            "Mesh(file: \"ball.obj\", place: Fit(height: 140, at: (0, 80, -40)), depth: (front: 1.5, back: 1.5))",
            1.5,
            1.5,
            1,
        ),
    ];
    for (kind, front, back, groups) in kinds {
        let scene = good(kind);
        let build = built(&scene);
        // A ball that hangs in the air is no mistake here.
        let hangs = |d: &&Diagnostic| kind.starts_with("Mesh") && d.message.contains("overhang");
        let failures: Vec<_> = build.failures.iter().filter(|d| !hangs(d)).collect();
        assert!(failures.is_empty(), "{kind}: {failures:?}");
        let mesh = forest(&build);
        let solid = Solid::new(mesh.clone()).unwrap_or_else(|d| panic!("{kind}: {d:?}"));
        assert_eq!(solid.parts(), 1, "{kind}");
        let report = report(&build);
        let view = &report["views"][0];
        assert_eq!(view["groups"], groups, "{kind}");
        assert_eq!(view["certificate"]["coverage"], 1.0, "{kind}");
        let offsets = offsets(&scene, &mesh);
        let most = offsets.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = offsets.iter().copied().fold(f64::INFINITY, f64::min);
        // A hair for what f32 and mended solids round, and nearly all of the room is used.
        assert!(
            most <= front + 1e-3 && most > 0.8 * front.min(1.0),
            "{kind}: {most}"
        );
        assert!(least >= -back - 1e-3, "{kind}: {least}");
        if back > 1.0 {
            assert!(least < -0.5 * back, "{kind}: {least}");
        }
    }
}

#[test]
fn outlines_lie_on_the_support_where_they_are_to() {
    for (outline, held) in [("OnSupport", true), ("Free", false)] {
        let scene = good(&format!(
            "Plate(width: 80, height: 70, thickness: 8, at: (0, 20, 0), depth: (front: 4, back: 3, outline: {outline}))"
        ));
        let Outcome { sight, relief, .. } = Setting::of(&scene).solved(scene.relief.energy());
        let map = &sight.image.map;
        let slab = Slab::new(&scene.supports[0], scene.views[0].eye).expect("a layer");
        let (mut ends, mut off) = (0, 0.0f64);
        for (c, cell) in map.all() {
            let Some(depth) = relief.depth[c] else {
                continue;
            };
            for (k, z) in depth.into_iter().enumerate() {
                let q = map.points[cell.corners[k]];
                let (near, far) = sight.image.layer_in(&slab, c, k);
                assert!(z >= near - 1e-9 && z <= far + 1e-9);
                if cell.outline[k] {
                    ends += 1;
                    off = off.max(slab.offset(map.plane.point(q, z)).abs());
                }
            }
        }
        assert!(ends > 50, "{ends} corners on the outline");
        assert_eq!(off < HULL_MM + 1e-9, held, "{outline}: {off} mm");
    }
}

#[test]
fn waves_have_the_heights_that_are_asked_for() {
    let at = |kind: &str| good(kind).supports[0].mesh.clone();
    let formula = at(
        "Wave(width: 60, height: 40, pitch: 3, at: (5, 7, 2), heights: Formula(\"x / 10 + 0.05 * y\"))",
    );
    let face = formula.vertices.iter().filter(|v| v.y < 16.5);
    let mut count = 0;
    for v in face {
        let (x, y) = (v.x - 5.0, v.z - 2.0);
        assert!((7.0 - v.y - (x / 10.0 + 0.05 * y)).abs() < 1e-9, "{v}");
        count += 1;
    }
    assert_eq!(count, 21 * 15);
    // Two pixels: level beyond their middles, straight between them.
    let image = at(
        "Wave(width: 60, height: 40, pitch: 3, heights: Image(file: \"grey.png\", from: 1, to: 4))",
    );
    for v in image.vertices.iter().filter(|v| v.y < 9.5) {
        let wanted = 1.0 + 3.0 * ((v.x + 15.0) / 30.0).clamp(0.0, 1.0);
        assert!((-v.y - wanted).abs() < 1e-9, "{v}");
    }
}

#[test]
fn strips_stand_side_by_side_and_turn() {
    let scene = good("Strips(count: 5, width: 20, height: 60, gap: 0.5, turn: 22.5)");
    let names: Vec<&str> = scene.supports.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(
        names,
        ["strip-1", "strip-2", "strip-3", "strip-4", "strip-5"]
    );
    let normal = |k: usize| scene.supports[k].mesh.clone();
    let volume = 20.0 * 60.0 * 5.0;
    for k in 0..5 {
        assert!((normal(k).volume() - volume).abs() < 1e-6);
        let Some(slab) = Slab::new(&scene.supports[k], DVec3::new(0.0, -300.0, 0.0)) else {
            panic!("strip {k} turns its back");
        };
        let away = slab.moved(DVec3::ZERO, 1.0);
        let angle = (22.5 * (k as f64 - 2.0)).to_radians();
        assert!(away.distance(DVec3::new(-angle.sin(), angle.cos(), 0.0)) < 1e-12);
    }
    // The middle one stands where the row does.
    let (lo, hi) = normal(2).bounds().expect("a box");
    assert!((lo + hi).x.abs() < 1e-9 && lo.y.abs() < 1e-9 && (hi.y - 5.0).abs() < 1e-9);
}

#[test]
fn open_meshes_become_solid_by_a_thickness() {
    let scene = good(
        "Mesh(file: \"sheet.obj\", thickness: 6, place: Matrix([(1, 0, 0, 0), (0, 1, 0, 30), (0, 0, 1, 0), (0, 0, 0, 1)]))",
    );
    let mesh = &scene.supports[0].mesh;
    assert!((mesh.volume() - 80.0 * 80.0 * 6.0).abs() < 1e-6);
    let (lo, hi) = mesh.bounds().expect("a box");
    assert!(
        (lo.y - 30.0).abs() < 1e-9 && (hi.y - 36.0).abs() < 1e-9,
        "behind its face"
    );
    let problems = scene::resolve(&text("Mesh(file: \"sheet.obj\")"), &read).expect_err("open");
    assert!(
        problems[0].message.contains("open: 4 edges"),
        "{problems:?}"
    );
    let closed = "Mesh(file: \"ball.obj\", thickness: 6)";
    let problems = scene::resolve(&text(closed), &read).expect_err("closed");
    assert!(problems[0].message.contains("closed"), "{problems:?}");
}

#[test]
fn layers_that_cut_a_body_through_are_refused_with_the_room_there_is() {
    let scene = good(
        "Groove(width: 80, height: 80, opening: 70, deep: 30, thickness: 33, at: (0, 20, 0), depth: (front: 1, back: 5))",
    );
    let problems = compile::check(&scene, &|_, _| {}, &|| false).expect_err("too deep");
    assert!(
        problems[0].message.starts_with("groove leaves -"),
        "{problems:?}"
    );
}

#[test]
fn images_keep_sixteen_bits() {
    let scene =
        good("Wave(width: 60, height: 40, pitch: 2, heights: Image(file: \"deep.png\", to: 4))");
    let heights = GREYS.map(|g| 4.0 * f64::from(g) / 65535.0);
    let mut seen = [0; 3];
    // The middles of the pixels lie 20 mm apart.
    for v in scene.supports[0].mesh.vertices.iter().filter(|v| v.y < 9.5) {
        for ((middle, height), seen) in [-20.0, 0.0, 20.0].into_iter().zip(heights).zip(&mut seen) {
            if (v.x - middle).abs() < 1e-9 {
                assert!((-v.y - height).abs() < 1e-6, "{v}: {height} wanted");
                *seen += 1;
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 10), "{seen:?}");
}

#[test]
fn images_that_cannot_be_read_say_what_is_wanted() {
    for (file, words, help) in [
        (
            "huge.png",
            "the image has 60000 x 60000 pixels; at most 25 million are read",
            "make it smaller",
        ),
        (
            "photo.jpg",
            "the image is a JPEG picture; a PNG is wanted",
            "save it as PNG",
        ),
        (
            "ball.obj",
            "the image is no PNG; a PNG is wanted",
            "save it as PNG",
        ),
        ("cut.png", "the PNG is damaged or cut short", "save it anew"),
    ] {
        let body = format!("Wave(width: 60, height: 40, heights: Image(file: \"{file}\", to: 4))");
        let problems = scene::resolve(&text(&body), &read).expect_err(file);
        let error = problems.iter().find(|p| p.is_error()).expect("an error");
        assert!(error.message.contains(words), "{file}: {}", error.message);
        assert!(error.help[0].contains(help), "{file}: {:?}", error.help);
    }
}

#[test]
fn formulas_say_where_they_are_wrong() {
    let wave = |formula: &str| {
        text(&format!(
            "Wave(width: 60, height: 40, heights: Formula(\"{formula}\"))"
        ))
    };
    for (formula, mark, words, help) in [
        (
            "2,5",
            ",",
            "at its character 2: `,` found, an operator (+ - * / ^) or the end wanted",
            "2.5",
        ),
        (
            "sinus(x)",
            "sinus",
            "unknown name: sinus",
            "did you mean `sin`?",
        ),
        ("x + z", "z", "unknown name: z", "a formula of x and y"),
        (
            "2 x",
            "x",
            "at its character 3: `x` found, an operator",
            "a formula",
        ),
        (
            "x * ) + 1",
            ")",
            "at its character 5: `)` found, a number, x, y, a function or `(` wanted",
            "a formula",
        ),
        (
            "max(x; y)",
            ";",
            "`;` found, `,` and a second value wanted",
            "a formula",
        ),
        (
            "1.2.3 + x",
            "1.2.3",
            "`1.2.3` found, a number, as 2.5 or 1e-3, wanted",
            "a formula",
        ),
        ("x $ y", "$", "`$` found", "a formula"),
        (
            "sin(x",
            "",
            "the formula ends where `)` is wanted",
            "a formula",
        ),
        (
            "x +",
            "",
            "the formula ends where a number, x, y, a function or `(` is wanted",
            "a formula",
        ),
        ("", "", "the formula ends where", "a formula"),
    ] {
        let text = wave(formula);
        let problems = scene::resolve(&text, &read).expect_err(formula);
        let error = problems.iter().find(|p| p.is_error()).expect("an error");
        assert!(
            error.message.contains(words),
            "{formula}: {}",
            error.message
        );
        assert!(error.help[0].contains(help), "{formula}: {:?}", error.help);
        let Some(Place::Scene(span)) = &error.place else {
            panic!("{formula}: {:?}", error.place);
        };
        let whole = format!("Formula(\"{formula}\")");
        let wanted = if mark.is_empty() { &whole } else { mark };
        assert_eq!(&text[span.clone()], wanted, "{formula}");
    }
    for deep in [
        format!("{}x{}", "(".repeat(480), ")".repeat(480)),
        "-".repeat(900) + "x",
    ] {
        let _ = scene::resolve(&wave(&deep), &read);
    }
    // What reads alike is alike.
    let heights = |formula: &str| {
        good(&format!(
            "Wave(width: 60, height: 40, heights: Formula(\"{formula}\"))"
        ))
        .supports[0]
            .mesh
            .clone()
    };
    for (formula, same) in [
        ("2e0*sin(x/8)", "2 * sin(x / 8)"),
        ("max(min(x, 3), -1e-1 * 20)", "min(max(x, -2), 3)"),
        ("pi - PI + cos(y)", "cos(y)"),
        ("-(-x / 30)^2", "-(x / 30)^2"),
    ] {
        let [a, b] = [formula, same].map(heights);
        let worst = a
            .vertices
            .iter()
            .zip(&b.vertices)
            .map(|(p, q)| p.distance(*q))
            .fold(0.0, f64::max);
        assert!(worst < 1e-9, "{formula}: {worst}");
    }
}

#[test]
fn flat_models_are_said_to_be_flat() {
    let lying = "v 0 0 5\nv 10 0 5\nv 10 20 5\nv 0 20 5\nf 1 2 3 4\n";
    let place = |fit: &str| text("Plate(width: 80, height: 70)").replace("height: 40", fit);
    let read = |_: &str| Ok(lying.as_bytes().to_vec());
    let problems = scene::resolve(&place("height: 40"), &read).expect_err("flat");
    let told: Vec<&str> = problems
        .iter()
        .filter(|p| p.is_error())
        .map(|p| p.message.as_str())
        .collect();
    let wanted = "model \"ball\" has no height that could be fitted: as it stands it is 10 wide, 20 deep and 0 high, in units of its file";
    assert_eq!(told, [wanted]);
    assert!(
        problems
            .iter()
            .all(|p| !p.message.contains("larger than any printer")),
        "{problems:?}"
    );
    // Stood up it has one.
    scene::resolve(&place("height: 40, up: \"y\", front: \"z\""), &read).expect("a model");
}
