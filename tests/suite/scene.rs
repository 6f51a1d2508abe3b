//! The scene language: every case under tests/cases, texts too large or too odd for files, placing, `--set`, the bundled scenes.

use pillarforest::diag::{Diagnostic, Place, Warned};
use pillarforest::index::VertexId;
use pillarforest::kinds::ReliefKind;
use pillarforest::scene::{self, Scene};
use pillarforest::steps::{Prefer, StepLimits, StepOptions};
use pillarforest::support::{Datum, SupportKind};
use std::fs;
use std::path::Path;

/// A cube of side 20 around the origin.
pub(crate) const CUBE: &str = "v -10 -10 -10\nv 10 -10 -10\nv 10 10 -10\nv -10 10 -10\nv -10 -10 10\nv 10 -10 10\nv 10 10 10\nv -10 10 10\n\
f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

/// The same cube with paint on it.
const PAINTED: &str = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
property float weight\nproperty float signed\nproperty float faint\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
element face 12\nproperty list uchar int vertex_indices\nend_header\n\
-10 -10 -10 0 -2 0 0 0 0\n10 -10 -10 1 1 0 255 0 0\n10 10 -10 2 0 0 0 0 0\n-10 10 -10 0.5 0 0 0 0 0\n\
-10 -10 10 1 0 0.25 0 0 0\n10 -10 10 1 0 0 0 0 0\n10 10 10 1 0 0 0 0 0\n-10 10 10 4 0 0 0 0 0\n\
3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";

/// Two eyes, 64 pillars.
const PLAIN: &str = include_str!("../cases/ok.ron");

fn resolve(text: &str) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    scene::resolve(text, &|name| match name {
        "cube.obj" => Ok(CUBE.as_bytes().to_vec()),
        "painted.ply" => Ok(PAINTED.as_bytes().to_vec()),
        _ => Err(Diagnostic::error(format!("no file {name}"))),
    })
}

fn good(text: &str) -> Scene {
    resolve(text)
        .unwrap_or_else(|problems| panic!("{problems:?}\n{text}"))
        .value
}

fn errors(text: &str) -> Vec<Diagnostic> {
    let problems = resolve(text)
        .err()
        .unwrap_or_else(|| panic!("no error in:\n{}", &text[..text.len().min(500)]));
    assert!(problems.iter().any(Diagnostic::is_error));
    problems
}

fn line_of(text: &str, problem: &Diagnostic) -> usize {
    match &problem.place {
        Some(Place::Scene(span)) => text[..span.start].matches('\n').count() + 1,
        other => panic!("no place in the scene: {other:?} of {problem:?}"),
    }
}

/// `(line, "error: ...")` as written in the comments of a case.
fn expected(text: &str) -> Vec<(usize, String)> {
    let mut list = Vec::new();
    for (i, line) in text.lines().enumerate() {
        for part in line.split("  // ").skip(1) {
            if part.starts_with("error: ") || part.starts_with("warning: ") {
                list.push((i + 1, part.trim_end().to_string()));
            }
        }
    }
    list
}

#[test]
fn every_case_says_what_its_comments_say() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    paths.sort();
    assert!(paths.len() > 70);
    let mut wrong = Vec::new();
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let problems = match resolve(&text) {
            Ok(done) => done.warnings,
            Err(problems) => problems,
        };
        let word = |p: &Diagnostic| if p.is_error() { "error" } else { "warning" };
        let found: Vec<(usize, String)> = problems
            .iter()
            .map(|p| (line_of(&text, p), format!("{}: {}", word(p), p.message)))
            .collect();
        if found != expected(&text) {
            wrong.push(format!(
                "{}:\n  found    {found:?}\n  expected {:?}",
                path.display(),
                expected(&text)
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn odd_texts_are_errors_not_crashes() {
    let deep = |open: &str, close: &str, n: usize| format!("{}{}", open.repeat(n), close.repeat(n));
    let texts = [
        String::new(),
        "  \n".into(),
        "// nothing\n".into(),
        deep("(", ")", 200_000),
        deep("[", "]", 200_000),
        "[".repeat(200_000),
        format!("(title: {})", deep("Some(", ")", 100_000)),
        format!("r{}", "#".repeat(100_000)),
        format!("(title: \"{}\")", "A".repeat(2 << 20)),
        format!("(views: [{}])", "(),".repeat(400_000)),
        "A".repeat(9 << 20),
        "\u{feff}".into(),
        "[1, 2, 3]".into(),
        "{ \"views\": [] }".into(),
        "(title: \"\u{202e}\", \u{0})".into(),
        "'".into(),
        "/*/".into(),
        "(title: \"\\".into(),
        "#![enable(".into(),
        "#![".into(),
    ];
    for text in texts {
        let problems = errors(&text);
        assert!(
            problems.len() <= 100,
            "{} problems for {} bytes",
            problems.len(),
            text.len()
        );
    }
}

#[test]
fn pillars_too_detailed_together_are_refused_before_they_are_made() {
    for (sides, rows, columns) in [(512, 100, 100), (150, 140, 140)] {
        let text = PLAIN
            .replace(
                "Rectangle(width: 3, depth: 3)",
                &format!("Polygon(sides: {sides}, radius: 2)"),
            )
            .replace("rows: 8", &format!("rows: {rows}"))
            .replace("columns: 8", &format!("columns: {columns}"));
        let told = errors(&text);
        assert!(
            told.iter()
                .any(|p| p.message.starts_with("outlines too detailed")),
            "{sides}: {told:?}"
        );
    }
}

#[test]
fn no_prefix_of_a_scene_crashes() {
    for end in 0..PLAIN.len() - 2 {
        assert!(resolve(&PLAIN[..end]).is_err(), "cut at {end}");
    }
}

#[test]
fn marks_tabs_and_line_ends_of_windows_are_fine() {
    let text = format!(
        "\u{feff}{}",
        PLAIN.replace("    ", "\t").replace('\n', "\r\n")
    );
    assert_eq!(good(&text).supports.len(), 65);
    let commented = format!("{}{}{PLAIN}", "/*".repeat(100_000), "*/".repeat(100_000));
    assert_eq!(good(&commented).supports.len(), 65);
}

#[test]
fn spans_are_exact() {
    let text = PLAIN.replace("pitch: 5", "pitch: /* how far */ -5.5 /* apart */");
    let problems = errors(&text);
    let Some(Place::Scene(span)) = &problems[0].place else {
        panic!("no place")
    };
    assert_eq!(&text[span.clone()], "-5.5");
}

#[test]
fn lengths_follow_the_units() {
    let metres = PLAIN
        .replace("units: mm", "units: cm")
        .replace("-1500", "-150")
        .replace("1500", "150")
        .replace("300)", "30)");
    let metres = metres
        .replace("width: 3, depth: 3", "width: 0.3, depth: 0.3")
        .replace("pitch: 5", "pitch: 0.5");
    let metres = metres
        .replace("height: 60", "height: 6")
        .replace("height: 40", "height: 4");
    let metres = metres.replace("thickness: 3, margin: 4", "thickness: 0.3, margin: 0.4");
    let (a, b) = (good(PLAIN), good(&metres));
    assert!(a.views[0].eye.distance(b.views[0].eye) < 1e-9);
    for (x, y) in a.supports.iter().zip(&b.supports) {
        for (v, w) in x.mesh.vertices.iter().zip(&y.mesh.vertices) {
            assert!(v.distance(*w) < 1e-9);
        }
    }
}

#[test]
fn a_fitted_model_has_its_size_stands_on_its_place_and_faces_the_eye() {
    // A wedge: its front (file -y) is the side with the nose at y = -30.
    let wedge = "v -10 10 0\nv 10 10 0\nv 0 -30 0\nv 0 10 25\nf 1 2 3\nf 1 3 4\nf 2 4 3\nf 1 4 2\n";
    let text = PLAIN
        .replace("Fit(height: 40)", "Fit(height: 50, at: (3, 4, 5))")
        .replace("\"cube.obj\"", "\"w.obj\"");
    let scene = scene::resolve(&text, &|_| Ok(wedge.as_bytes().to_vec()))
        .expect("resolves")
        .value;
    for view in &scene.views {
        let model = &view.models[0];
        let (lo, hi) = model.mesh.bounds().expect("vertices");
        assert!((hi.z - lo.z - 50.0).abs() < 1e-9 && (lo.z - 5.0).abs() < 1e-9);
        // Vertices are sorted on reading. Three lie at the bottom; the nose is the nearest to its middle.
        let bottom = model.mesh.vertices.iter().filter(|v| v.z < lo.z + 1e-6);
        let middle = glam::DVec3::new(3.0, 4.0, 5.0);
        let nose = *bottom
            .min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)))
            .expect("a bottom");
        let to_eye = (view.eye - glam::DVec3::new(3.0, 4.0, 5.0))
            .truncate()
            .normalize();
        let out = (nose - glam::DVec3::new(3.0, 4.0, 5.0)).truncate();
        // The box of the wedge runs from -30 to 10: its middle is at y = -10, its nose 20 * scale before that.
        assert!(
            out.distance(40.0 * to_eye) < 1e-6,
            "nose at {out}, eye towards {to_eye}"
        );
        assert!(model.mesh.volume() > 0.0);
    }
}

#[test]
fn supports_are_closed_prisms_and_pillars_sink_into_the_base() {
    let shapes: [(&str, f64, f64); 4] = [
        ("Round(radius: 2)", std::f64::consts::PI * 4.0, 0.02),
        ("Polygon(sides: 6, radius: 2)", 6.0 * 3f64.sqrt(), 1e-9),
        ("Rectangle(width: 3, depth: 2, turn: 30)", 6.0, 1e-9),
        (
            "Profile(points: [(0, 0), (0, 3), (3, 3), (3, 2), (1, 2), (1, 0)])",
            5.0,
            1e-9,
        ),
    ];
    for (shape, area, tolerance) in shapes {
        let scene = good(&PLAIN.replace("Rectangle(width: 3, depth: 3)", shape));
        let (base, pillars) = scene.supports.split_last().expect("a base");
        assert!(
            matches!(
                base.kind,
                SupportKind::Base {
                    top: 0.0,
                    bottom: -3.0,
                    ..
                }
            ) && base.layer.is_none()
        );
        for pillar in pillars {
            let SupportKind::Pillar { bottom, top, .. } = pillar.kind else {
                panic!("a pillar")
            };
            assert_eq!((bottom, top), (-1.0, 60.0));
            assert!(
                (pillar.mesh.volume() / 61.0 / area - 1.0).abs() < tolerance.max(1e-9),
                "{shape}"
            );
            assert!(closed(&pillar.mesh.faces), "{shape}");
        }
        assert!(closed(&base.mesh.faces));
    }
}

/// Whether every directed edge has its opposite exactly once.
fn closed(faces: &[[VertexId; 3]]) -> bool {
    let mut edges: Vec<(VertexId, VertexId)> = faces
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .collect();
    edges.sort_unstable();
    let distinct = edges.windows(2).all(|w| w[0] != w[1]);
    distinct
        && edges
            .iter()
            .all(|&(a, b)| edges.binary_search(&(b, a)).is_ok())
}

#[test]
fn layouts_stand_where_they_should() {
    let grid =
        "Grid(\n            rows: 8,\n            columns: 8,\n            pitch: 5,\n        )";
    assert!(PLAIN.contains(grid));
    for (places, count, reach) in [
        ("Ring(count: 12, radius: 40, turn: 15)", 12, 40.0),
        ("Hex(rings: 2, pitch: 10)", 19, 20.0),
        (
            "Grid(columns: 3, rows: 2, pitch: 10, pitch_y: 6)",
            6,
            109f64.sqrt(),
        ),
        ("At([(1, 2), (30, 40)])", 2, 50.0),
    ] {
        let scene = good(&PLAIN.replace(grid, places));
        let axes: Vec<f64> = scene
            .supports
            .iter()
            .filter_map(|s| match &s.kind {
                SupportKind::Pillar { axis, .. } => Some(axis.length()),
                SupportKind::Base { .. } | SupportKind::Body { .. } => None,
            })
            .collect();
        assert_eq!(axes.len(), count, "{places}");
        let farthest = axes.iter().copied().fold(0.0, f64::max);
        assert!((farthest - reach).abs() < 1e-9, "{places}: {farthest}");
    }
}

#[test]
fn a_layer_of_an_entry_replaces_the_scenes_field_by_field() {
    let text = PLAIN
        .replace("height: 60,", "height: 60, depth: (front: 2),")
        .replace(
            "    base",
            "    depth: (from: Surface, front: 4, back: 0.7),\n    base",
        );
    let layer = good(&text).supports[0].layer.expect("pillars carry");
    assert_eq!(
        (layer.datum(), layer.front, layer.back()),
        (Datum::Surface, 2.0, 0.7)
    );
}

#[test]
fn set_replaces_and_adds_values() {
    let set = |assignment: &str| {
        scene::set(PLAIN, assignment).unwrap_or_else(|e| panic!("{assignment}: {e:?}"))
    };
    assert_eq!(
        good(&set("pillars[0].height=80")).supports[0]
            .mesh
            .bounds()
            .unwrap()
            .1
            .z,
        80.0
    );
    assert_eq!(
        good(&set("views[side].eye=(900, 0, 100)")).views[1].eye.x,
        900.0
    );
    assert_eq!(
        good(&set("output.picture_size=128")).output.picture_size,
        128
    );
    assert_eq!(
        good(&set("pillars[0].places=At([(0, 0)])")).supports.len(),
        2
    );
    assert_eq!(good(&set("printer.nozzle=0.25")).printer.nozzle, 0.25);
    let twice = scene::set(&set("output.plan=false"), "output.views=false")
        .expect("an existing struct takes more");
    let output = good(&twice).output;
    assert!(!output.plan && !output.views && output.forest_stl);
    for wrong in [
        "pillars",
        "pillars[7].height=3",
        "views[nobody].eye=(1, 2, 3)",
        "=3",
        "a b=3",
        "pillars[0=3",
        "units=",
        "[0]=1",
    ] {
        assert!(scene::set(PLAIN, wrong).is_err(), "{wrong}");
    }
    let guess = scene::set(PLAIN, "views[sid].eye=3").unwrap_err();
    assert!(guess.help.iter().any(|h| h.contains("[side]")), "{guess:?}");
}

/// How its surfaces may be torn, if they may.
fn steps_of(scene: &Scene) -> Option<StepOptions> {
    match scene.relief {
        ReliefKind::Torn(_, steps) => Some(steps),
        ReliefKind::HeightField(_) | ReliefKind::Whole(..) => None,
    }
}

#[test]
fn steps_are_allowed_from_two_pillars_on_unless_the_scene_says_otherwise() {
    let set = |assignments: &[&str]| {
        let set =
            |text: String, a: &&str| scene::set(&text, a).unwrap_or_else(|e| panic!("{a}: {e:?}"));
        steps_of(&good(&assignments.iter().fold(PLAIN.to_string(), set)))
    };
    let by_default = set(&[]).expect("64 pillars");
    assert_eq!(by_default.limits.highest_mm, None);
    assert_eq!((by_default.limits.least_mm, by_default.most), (0.1, None));
    assert_eq!(by_default.prefer, Prefer::Tolerance);
    assert_eq!(set(&["energy=Normal(steps: Allowed())"]), Some(by_default));
    assert_eq!(set(&["energy=Normal()"]), Some(by_default));
    assert_eq!(set(&["energy=Normal(steps: Never)"]), None);
    assert_eq!(set(&["energy=Curvature()"]), None);
    let two = "pillars[0].places=At([(0, 0), (8, 0)])";
    let one = "pillars[0].places=At([(0, 0)])";
    assert_eq!(set(&[two]), Some(by_default));
    assert_eq!(set(&[one]), None);
    assert_eq!(
        set(&[one, "energy=Normal(steps: Allowed())"]),
        Some(by_default)
    );
    let milled = set(&["make=Milled(tool: 2)"]).expect("steps");
    assert_eq!(milled.narrowest_mm, 2.0);
    let finer = set(&["printer.nozzle=0.25"]).expect("steps");
    assert_eq!((by_default.narrowest_mm, finer.narrowest_mm), (0.4, 0.25));
}

/// A row of pillars that all overlap is one mistake: it is told where it is worst, and how often it is made.
#[test]
fn many_overlaps_are_told_in_few_words() {
    let places: Vec<String> = (0..20).map(|i| format!("({}, 0)", 2 * i)).collect();
    let row = format!("pillars[0].places=At([{}])", places.join(", "));
    let text = scene::set(PLAIN, &row).expect("a row");
    let told: Vec<_> = errors(&text)
        .into_iter()
        .filter(|e| e.message.contains("overlap"))
        .collect();
    assert_eq!(told.len(), 3, "{told:?}");
    assert!(told[2].message.contains("more pairs"), "{told:?}");
}

#[test]
fn limits_of_steps_follow_the_units() {
    let options = "Allowed(least: 0.02, highest: 0.3, tolerance: 4, most: 7, price: 5, narrowest: 0.06, prefer: Camouflage)";
    let text = PLAIN
        .replace("units: mm", "units: cm")
        .replace("00,", "0,")
        .replace("300)", "30)")
        .replace(
            "    base:",
            &format!("    energy: Normal(steps: {options}),\n    base:"),
        );
    let wanted = StepOptions {
        limits: StepLimits {
            least_mm: 0.2,
            highest_mm: Some(3.0),
            tolerance_mm: Some(40.0),
        },
        most: Some(7),
        price: 5.0,
        narrowest_mm: 0.6,
        prefer: Prefer::Camouflage,
    };
    assert_eq!(steps_of(&good(&text)), Some(wanted));
}

#[test]
fn the_schema_names_every_default_of_a_bare_scene() {
    let schema = scene::schema();
    for line in [
        "height: length",
        "front: length",
        "[5 mm]",
        "[90 mm]",
        "hidden_weight",
        "picture_size",
        "[required]",
    ] {
        assert!(schema.contains(line), "{line}");
    }
}

/// Resolves a scene of the repository with its own models.
fn bundled(name: &str, models: &Path) -> Scene {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join(name)).expect("scene");
    let read = |file: &str| {
        let path = models.join(Path::new(file).file_name().expect("file name"));
        fs::read(&path).map_err(|e| Diagnostic::error(format!("{}: {e}", path.display())))
    };
    let done =
        scene::resolve(&text, &read).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
    assert!(done.warnings.is_empty(), "{name}: {:?}", done.warnings);
    done.value
}

#[test]
fn bundled_scenes_resolve_without_a_word() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/models");
    assert_eq!(bundled("scenes/minimal.ron", &models).views.len(), 1);
    assert_eq!(
        bundled("src/scene/language/template.ron", &models)
            .views
            .len(),
        1
    );
    let four = bundled("scenes/four-creatures.ron", &models);
    assert_eq!(four.views.len(), 4);
    assert!(four.supports.len() > 25);
    for (name, supports) in [
        ("fig03-stairs", 1),
        ("fig04-groove", 1),
        ("fig12-free", 1),
        ("fig13-wave", 1),
        ("fig16-strips", 5),
        ("fig17-herd", 1),
        ("orthographic", 1),
        ("vase", 1),
    ] {
        let scene = bundled(&format!("scenes/paper/{name}.ron"), &models);
        assert_eq!(scene.supports.len(), supports, "{name}");
    }
}

#[test]
fn the_reference_forest_is_what_it_should_be() {
    let text = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/reference-forest.ron"),
    )
    .unwrap();
    let scene = scene::resolve(&text, &|_| Ok(CUBE.replace("10", "0.5").into_bytes()));
    // A small cube stands in for the models; its size may be suspicious, which only warns.
    let scene = scene.map(|d| d.value).unwrap_or_else(|p| panic!("{p:?}"));
    assert_eq!(scene.supports.len(), 28);
    let layer = scene.supports[0].layer.expect("pillars carry");
    assert_eq!(
        (layer.datum(), layer.front, layer.back()),
        (Datum::Plane, 5.0, 2.0)
    );
    let SupportKind::Pillar {
        axis, bottom, top, ..
    } = &scene.supports[26].kind
    else {
        panic!("a pillar")
    };
    assert_eq!(
        (axis.x, axis.y, *bottom, *top),
        (-27.6396, -35.8922, -1.0, 90.0)
    );
    assert_eq!(scene.views[3].eye, glam::DVec3::new(0.0, -250.0, 48.0));
    assert_eq!(scene.views[1].models[0].matrix.z_axis.y, 5.03500008);
}

#[test]
fn arbitrary_edits_never_crash() {
    use proptest::prelude::*;
    let mut runner = proptest::test_runner::TestRunner::new(proptest::test_runner::Config {
        cases: 400,
        failure_persistence: None,
        ..Default::default()
    });
    let junk = prop_oneof![
        Just("("),
        Just(")"),
        Just("["),
        Just("\""),
        Just(","),
        Just(":"),
        Just("-"),
        Just("1e400"),
        Just("/*"),
        Just("//"),
        Just("NaN"),
        Just("Some("),
        Just("\u{202e}"),
        Just("r#\""),
        Just("'"),
        Just("\\"),
        Just("99999999999"),
        Just("None")
    ];
    let edit = (0..PLAIN.len(), 0usize..12, junk);
    let edits = proptest::collection::vec(edit, 1..4);
    let done = runner.run(&edits, |edits| {
        let mut text = PLAIN.to_string();
        for (at, cut, junk) in edits {
            let at = at.min(text.len());
            let at = (0..=at)
                .rev()
                .find(|&i| text.is_char_boundary(i))
                .unwrap_or(0);
            let end = (at + cut).min(text.len());
            let end = (end..=text.len())
                .find(|&i| text.is_char_boundary(i))
                .unwrap_or(text.len());
            text.replace_range(at..end, junk);
        }
        let problems = match resolve(&text) {
            Ok(done) => done.warnings,
            Err(problems) => problems,
        };
        for problem in problems {
            if let Some(Place::Scene(span)) = problem.place {
                prop_assert!(text.get(span.clone()).is_some(), "span {span:?} of {text}");
            }
        }
        Ok(())
    });
    done.unwrap();
}

#[test]
fn regions_mark_the_vertices_they_hold_in_the_files_coordinates() {
    let scene = good(include_str!("../cases/regions_ok.ron"));
    let [cube, painted] = [0, 1].map(|v| &scene.views[v].models[0]);
    let by_file = |k: usize| scene.views[k].models[0].original.as_ref().unwrap();
    // Weights and freedom of the file's vertices, in its order.
    let of = |k: usize, model: &pillarforest::view::PlacedModel| -> (Vec<f64>, Vec<bool>) {
        let vertices = by_file(k).vertex_of.iter().map(|v| v.unwrap());
        vertices
            .map(|v| (model.marks.weights[v], model.marks.free[v]))
            .unzip()
    };
    let (weights, free) = of(0, cube);
    assert_eq!(weights, [0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 3.0, 1.0]);
    assert_eq!(free, [0, 1, 2, 3, 4, 5, 6, 7].map(|v| v == 0));
    // As painted, but never 0; free only above a half.
    let (weights, free) = of(1, painted);
    assert_eq!(weights, [1e-3, 1.0, 2.0, 0.5, 1.0, 1.0, 1.0, 4.0]);
    assert_eq!(free, [0, 1, 2, 3, 4, 5, 6, 7].map(|v| v != 0 && v != 3));
    let plain = good(PLAIN);
    let marks = plain.views[0].marks();
    assert!(marks.weights.is_empty() && marks.free.is_empty());
}
