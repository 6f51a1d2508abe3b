//! Layers on facets that the eye looks along.

use super::shapes::{ball, obj};
use glam::DVec3;
use pillarforest::compile::{Build, build};
use pillarforest::diag::Diagnostic;
use pillarforest::scene;
use serde_json::Value;

/// A ball of 40 mm before square pillars of 7 mm whose faces look at the eye: it sees along their sides, by a few degrees.
fn built(energy: &str) -> Result<Build, Vec<Diagnostic>> {
    let text = format!(
        "(models: [(name: \"ball\", file: \"ball.obj\", place: Fit(height: 40, at: (0, 0, 15)))],\n\
         views: [(name: \"front\", eye: (250, -250, 50), models: [\"ball\"])],\n\
         pillars: [(shape: Rectangle(width: 6.9, depth: 6.9, turn: 45), places: Grid(columns: 6, rows: 1, pitch: 10))],\n\
         depth: (from: Surface, front: 1, back: 0.6), {energy}\n\
         output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    );
    let read = |_: &str| Ok::<_, Diagnostic>(obj(&ball(DVec3::ZERO, 20.0, 40)));
    let done = scene::resolve(&text, &read).unwrap_or_else(|p| panic!("{p:?}"));
    build(&done.value, &|_, _| {}, &|| false)
}

#[test]
fn a_layer_goes_on_before_a_facet_that_the_eye_looks_along() {
    for energy in [
        "energy: Normal(steps: Never),",
        "energy: Normal(steps: Allowed()),",
    ] {
        let build = built(energy).unwrap_or_else(|problems| panic!("{energy} {problems:?}"));
        let report = build.files.iter().find(|f| f.path == "report.json");
        let report: Value = serde_json::from_slice(&report.expect("a report").bytes).expect("JSON");
        let certificate = &report["views"][0]["certificate"];
        let violation = certificate["bound_violation_mm"]
            .as_f64()
            .expect("a number");
        assert!(violation < 1e-6, "{energy} {certificate}");
        // The pillars leave gaps of a tenth of a millimetre; all else is there.
        let coverage = certificate["coverage"].as_f64().expect("a number");
        assert!(coverage > 0.97, "{energy} {certificate}");
    }
}
