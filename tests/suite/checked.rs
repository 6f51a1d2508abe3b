//! What `check` says before anything is solved: what could be known is not told after minutes.

use super::shapes::{ball, obj};
use glam::DVec3;
use pillarforest::compile;
use pillarforest::diag::Diagnostic;
use pillarforest::mimic::{RowKind, SolveError};
use pillarforest::scene;
use pillarforest::sight::Sight;
use pillarforest::viewmap::SupportField;
use pillarforest::words;
use serde_json::Value;

/// A wall of 8 m, as thin as a plate.
const WALL: &str = "v -4000 -1 0\nv 4000 -1 0\nv 4000 1 0\nv -4000 1 0\nv -4000 -1 40\nv 4000 -1 40\nv 4000 1 40\nv -4000 1 40\n\
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn read(name: &str) -> Result<Vec<u8>, Diagnostic> {
    match name {
        "ball.obj" => Ok(obj(&ball(DVec3::ZERO, 20.0, 12))),
        "owl.ply" => {
            let models = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/models/");
            std::fs::read(format!("{models}{name}")).map_err(|e| Diagnostic::error(e.to_string()))
        }
        "wall.obj" => Ok(WALL.as_bytes().to_vec()),
        _ => Err(Diagnostic::error(format!("no file {name}"))),
    }
}

/// A model of 40 mm before five pillars at different depths.
fn text(model: &str, depth: &str) -> String {
    format!(
        "(models: [(name: \"m\", {model})], views: [(name: \"front\", eye: (0, -300, 45), models: [\"m\"])],\n\
         pillars: [(shape: Round(radius: 5, facets: 24), height: 60,\n\
         places: At([(-40, 0), (-16, -8), (-8, 8), (0, -8), (8, 8), (16, -8)]))], depth: ({depth}),\n\
         output: (forest_glb: false, views: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    )
}

fn checked(text: &str) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let scene = scene::resolve(text, &read)?.value;
    compile::check(&scene, &|_, _| {}, &|| false)
}

fn assert_told(told: &[Diagnostic], words: &str, help: &str) {
    let fits =
        |d: &Diagnostic| d.message.contains(words) && d.help.iter().any(|h| h.contains(help));
    assert!(
        told.iter().any(fits),
        "`{words}` and `{help}` wanted in: {told:#?}"
    );
}

#[test]
fn models_that_nothing_holds_are_refused() {
    let free = |x: f64| {
        format!(
            "file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 8)), \
             regions: [(shape: Box(from: (-99, -99, -99), to: ({x}, 99, 99)), free: true)]"
        )
    };
    let refused = checked(&text(&free(99.0), "front: 3")).expect_err("nothing holds it");
    assert_told(
        &refused,
        "all that is seen of its models is free, so nothing holds it",
        "free: true",
    );
    // The left half is free, and before two pillars there is nothing else.
    let warned = checked(&text(&free(0.0), "front: 3")).expect("a scene that can be tried");
    assert_told(
        &warned,
        "before p2, p3 are wholly free",
        "free less of the model",
    );
    let held = checked(&text(&free(-19.0), "front: 3")).expect("a sound scene");
    assert!(
        held.iter().all(|d| !d.message.contains("free")),
        "{held:#?}"
    );
}

#[test]
fn supports_that_carry_nothing_say_why() {
    let told = |support: &str| {
        let text = format!(
            "(models: [(name: \"m\", file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 8)))],\n\
             views: [(name: \"front\", eye: (0, -300, 45), models: [\"m\"])], supports: [{support}])"
        );
        checked(&text).expect_err("nothing carries it")
    };
    let words = "no support stands behind or in its models";
    let away = told("Plate(width: 90, height: 90, facing: (0, 1))");
    assert_told(
        &away,
        words,
        "plate turns its back to the eye: `facing: (0.00, -1.00)`",
    );
    let behind = told("Plate(width: 90, height: 90, at: (0, -400, 0))");
    assert_told(&behind, words, "plate stands behind the eye");
    let beside = told("Plate(width: 90, height: 90, at: (200, 0, 0))");
    assert_told(&beside, words, "move the models before a support");
}

#[test]
fn faces_that_no_ray_brings_to_their_support_are_refused() {
    let wall = "file: \"wall.obj\", place: Matrix([(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 8), (0, 0, 0, 1)])";
    let refused =
        checked(&text(wall, "front: 3")).expect_err("p1 meets no ray to the wall's right end");
    assert_told(
        &refused,
        "that p1 carries reaches 93 degrees beside it",
        "subdivide",
    );
}

#[test]
fn a_layer_as_deep_as_the_forest_is_built() {
    let text = text(
        "file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 8))",
        "front: 60, back: 2",
    );
    assert_eq!(checked(&text).expect("a sound scene"), []);
    let scene = scene::resolve(&text, &read).expect("a scene").value;
    let build = compile::build(&scene, &|_, _| {}, &|| false).expect("a build");
    assert_eq!(build.failures, []);
}

/// A model of 1.2 m seen from 9 m: what is rounded there is thirty times as much as on a desk, and no printer is asked.
/// Twenty views of one model all want the same five pillars. What one cell after another is in the way of is not listed: it would be
/// hundreds of millions of pairs.
#[test]
fn twenty_views_of_one_place_are_checked_like_two() {
    let eye = |k: i32| {
        let (y, x) = (f64::from(k) * std::f64::consts::TAU / 20.0).sin_cos();
        format!(
            "(name: \"v{k}\", eye: ({}, {}, 45), models: [\"m\"]),",
            300.0 * x,
            300.0 * y
        )
    };
    let views: String = (0..20).map(eye).collect();
    let text = format!(
        "(models: [(name: \"m\", file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 8)))], views: [{views}],\n\
         pillars: [(shape: Round(radius: 7), height: 60, places: At([(-16, 0), (16, 0), (0, 16), (0, -16), (0, 0)]))])"
    );
    let told = checked(&text).expect("warnings only");
    let most = |d: &&Diagnostic| {
        let words = d.message.split("misses ").nth(1);
        let share = words.and_then(|t| t.split(' ').next()?.parse().ok());
        share.is_some_and(|s: f64| s > 75.0)
    };
    assert_eq!(told.iter().filter(most).count(), 19, "{told:#?}");
    assert_told(&told, "view \"v0\" needs p", "`contested` says who");
}

#[test]
fn an_exhibit_is_in_order() {
    let pillars: String = (-3..=3)
        .map(|k| format!("({}, {}), ", 240 * k, if k % 2 == 0 { -240 } else { 240 }))
        .collect();
    let text = format!(
        "(detail: 2000, models: [(name: \"m\", file: \"owl.ply\", place: Fit(height: 1200, at: (0, 0, 240)))],\n\
         views: [(name: \"front\", eye: (0, -9000, 1350), models: [\"m\"])],\n\
         pillars: [(shape: Round(radius: 150, facets: 24), height: 1800, places: At([{pillars}]))],\n\
         depth: (front: 90, back: 30), make: Built(),\n\
         output: (forest_glb: false, views: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    );
    let larger = scene::resolve(&text.replace("1200", "1700"), &read).expect("a scene");
    assert_eq!(larger.warnings, []);
    let resolved = scene::resolve(&text, &read).expect("a scene");
    let build = compile::build(&resolved.value, &|_, _| {}, &|| false).expect("a build");
    let report = build.files.iter().find(|f| f.path == "report.json");
    let report: Value = serde_json::from_slice(&report.expect("a report").bytes).expect("JSON");
    let certificate = &report["views"][0]["certificate"];
    assert_eq!(certificate["order_inversions"], 0);
    assert_eq!(certificate["bound_violation_mm"], 0.0);
}

#[test]
fn a_solver_that_gives_up_says_where() {
    let text = text(
        "file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 8))",
        "front: 3",
    );
    let scene = scene::resolve(&text, &read).expect("a scene").value;
    let field = SupportField::new(&scene.supports);
    let sight = Sight::new(&scene.views[0], &field).expect("a sight");
    let gave_up = |worst| SolveError::Unsolved {
        reason: "after 200 steps the solver was not there yet".into(),
        worst,
    };
    let told = words::sight::unsolved(&sight, &gave_up(Some(RowKind::Far(0))));
    assert_told(
        std::slice::from_ref(&told),
        "after 200 steps the solver was not there yet; farthest off is the farthest depth on p",
        "thicker layer",
    );
    assert!(told.message.contains("its line of sight"), "{told:?}");
    let told = words::sight::unsolved(&sight, &gave_up(None));
    assert_told(
        &[told],
        "view \"front\": no depths were found: after 200",
        "`front`",
    );
}

#[test]
fn long_builds_say_so_and_what_makes_them_short() {
    let read = |_: &str| Ok(obj(&ball(DVec3::ZERO, 20.0, 100)));
    let views: String = (0..32)
        .map(|k| {
            format!(
                "(name: \"v{k}\", eye: (0, -300, {}), models: [\"m\"]), ",
                10 + 10 * k
            )
        })
        .collect();
    let text = format!(
        "(models: [(name: \"m\", file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 8)))], views: [{views}],\n\
         pillars: [(shape: Round(radius: 30), height: 60, places: At([(0, 0)]))])"
    );
    let scene = scene::resolve(&text, &read).expect("a scene").value;
    let told = compile::slow(&scene, 1).expect("630,000 vertices take more than a minute");
    assert!(!told.is_error() && !told.is_warning());
    assert_told(
        &[told],
        "this build will take about 70 s; the largest model, \"m\", has 19802 vertices",
        "`--set detail=5000` simplifies the models: about 20 s",
    );
    assert_eq!(compile::slow(&scene, 12), None, "not with twelve threads");
    let small = scene::set(&text, "detail=5000").expect("a text");
    let small = scene::resolve(&small, &read).expect("a scene").value;
    assert_eq!(compile::slow(&small, 1), None, "not when simplified");
}
