//! `report.html`: the report with its pictures.

use super::output::OutputFile;
use super::pictures::Pictures;
use crate::report::Report;
use crate::report::html::{Exhibits, ViewExhibit};
use crate::scene::Scene;

/// The page, if the scene wants it; it shows what it can of the files made so far, and lists them.
pub(crate) fn page(
    scene: &Scene,
    report: &Report,
    pictures: &[Pictures],
    files: &[OutputFile],
) -> Option<OutputFile> {
    let svg = |path: &str| {
        let found = files.iter().find(|f| f.path == path)?;
        std::str::from_utf8(&found.bytes).ok()
    };
    let views = scene.views.iter().zip(pictures);
    let exhibits = || Exhibits {
        plan: svg("plan.svg"),
        camouflage: svg("camouflage.svg"),
        views: views
            .map(|(view, drawn)| ViewExhibit {
                colour: view.colour,
                pictures: Some(&drawn.view),
                lights: drawn.lights.as_ref().map(|(_, png)| &png[..]),
            })
            .collect(),
        files: files
            .iter()
            .map(|f| (f.path.as_str(), f.bytes.len()))
            .collect(),
    };
    let html = || report.html(&exhibits()).into_bytes();
    scene
        .output
        .report_html
        .then(|| OutputFile::new("report.html", html()))
}
