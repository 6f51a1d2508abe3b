//! `report.html`: the report for people, as one page that needs nothing but itself.
//!
//! Takes a [`Report`] and what there is to show with it, gives the page's text. Pictures are part of it, style and script too;
//! the page forbids itself every other source, so that it looks the same from a disk, in a mail and in ten years. Without
//! scripts everything can still be seen, and it prints. The same report gives the same bytes. Figures carry their exact value
//! as `<data value>`; what people read is rounded.

mod certificate;
mod text;
mod views;

use super::Report;
use crate::certify::camouflage::Camouflage;
use crate::certify::tolerance::Tolerance;
use crate::formats::markup::escaped;
use crate::render::ViewPictures;
use serde_json::Value;
use std::fmt::Write as _;
use text::{count, mark, measure, measure_or, percent, table, table_if_any};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// What browsers may load for the page: what stands in it.
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";
const DASH: &str = "\u{2013}";

/// What is shown besides figures. SVG as whole documents without a prolog, trusted as they are.
#[derive(Clone, Debug, Default)]
pub struct Exhibits<'a> {
    pub plan: Option<&'a str>,
    pub camouflage: Option<&'a str>,
    /// In the order of the report's views; may be shorter.
    pub views: Vec<ViewExhibit<'a>>,
    /// Paths of the files made, and their sizes in bytes.
    pub files: Vec<(&'a str, usize)>,
}

/// One view's pictures.
#[derive(Clone, Copy, Debug)]
pub struct ViewExhibit<'a> {
    /// In which the plan and the curves draw it.
    pub colour: [u8; 3],
    pub pictures: Option<&'a ViewPictures>,
    /// PNG: the sheet in real light.
    pub lights: Option<&'a [u8]>,
}

impl Report {
    /// The page, with a line break at its end.
    pub fn html(&self, shown: &Exhibits) -> String {
        let title = escaped(&self.scene);
        let mut html = format!(
            "<!DOCTYPE html>\n<html lang=\"en-GB\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n\
             <title>{title}: report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n"
        );
        html.push_str(&self.head(&title));
        html.push_str("<main>\n");
        html.push_str(&self.overview());
        if let Some(svg) = shown.plan {
            _ = write!(
                html,
                "<section id=\"plan\">\n<h2>Plan</h2>\n<figure class=\"sheet\" role=\"img\" aria-label=\"The forest from above\">\
                 \n{svg}</figure>\n</section>\n"
            );
        }
        for (k, view) in self.views.iter().enumerate() {
            html.push_str(&views::view(k + 1, view, shown.views.get(k)));
        }
        html.push_str(&camouflage(&self.camouflage, shown.camouflage));
        html.push_str(&print_sheet(&self.values()["print"]));
        html.push_str(&self.solid_facts());
        html.push_str(&files(&shown.files));
        _ = write!(
            html,
            "</main>\n<footer>Made by {} {}. Every number stands in report.json too, in full.</footer>\n\
             <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
            escaped(&self.program.name),
            escaped(&self.program.version)
        );
        html
    }

    /// As the JSON file has it.
    fn values(&self) -> Value {
        serde_json::to_value(self).unwrap_or_default()
    }

    /// Title, ways to the sections, verdict.
    fn head(&self, title: &str) -> String {
        let mut html = format!("<header>\n<p class=\"kind\">Pillar forest</p>\n<h1>{title}</h1>\n");
        if self.ok {
            html.push_str(
                "<div class=\"verdict holds\"><p><b>✓ ok.</b> All holds that a build promises.</p></div>\n",
            );
        } else {
            _ = write!(
                html,
                "<div class=\"verdict off\"><p><b>✗ not ok.</b> What does not hold:</p>\n{}</div>\n",
                list(&self.failures)
            );
        }
        if !self.warnings.is_empty() {
            _ = write!(
                html,
                "<div class=\"verdict warn\"><p><b>! Warnings</b></p>\n{}</div>\n",
                list(&self.warnings)
            );
        }
        html.push_str("</header>\n");
        html
    }

    /// One line for each view: what most people want to know.
    fn overview(&self) -> String {
        let row = |(k, v): (usize, &super::ViewReport)| {
            let c = v.certificate.as_ref();
            let [unseen, one] = c.map_or([DASH; 2].map(str::to_owned), |c| room(&c.tolerance));
            let half = self.camouflage.get(k).and_then(|c| c.half_likeness_deg);
            [
                format!("<a href=\"#view-{}\">{}</a>", k + 1, escaped(&v.name)),
                measure_or(v.normal_error_deg.map(|e| e.mean), 2, "°", DASH),
                c.map_or_else(|| DASH.into(), |c| percent(c.reaching)),
                unseen,
                one,
                measure_or(
                    c.and_then(|c| c.tolerance.stereo_distance_mm),
                    0,
                    "mm",
                    DASH,
                ),
                measure_or(half, 1, "°", DASH),
            ]
        };
        let rows: Vec<_> = self.views.iter().enumerate().map(row).collect();
        let heads = [
            "view",
            "mean error of the normals",
            "of the model seen",
            "eye may move unseen",
            "still one picture",
            "two eyes from",
            "half as like at",
        ];
        let table = table_if_any("The views at a glance", heads, &rows);
        if table.is_empty() {
            table
        } else {
            format!("<section id=\"views\">\n<h2>Views</h2>\n{table}</section>\n")
        }
    }

    fn solid_facts(&self) -> String {
        let Some(s) = &self.solid else {
            return String::new();
        };
        let [x, y, z] = s.size_mm.map(|c| measure(c, 1, ""));
        let facts = facts(&[
            ("size", format!("{x} × {y} × {z}\u{202F}mm")),
            ("volume", measure(s.volume_mm3 / 1000.0, 1, "cm³")),
            ("surface", measure(s.area_mm2 / 100.0, 1, "cm²")),
            ("triangles", count(s.triangles)),
            ("vertices", count(s.vertices)),
            ("parts", count(s.parts)),
            ("closed hollows", count(s.cavities)),
        ]);
        let checks: Vec<_> = s
            .checks
            .iter()
            .map(|c| [escaped(&c.name), escaped(&c.found), mark(c.passed).into()])
            .collect();
        let checks = table_if_any("Checks of the solid", ["what", "found", "holds"], &checks);
        format!("<section id=\"solid\">\n<h2>Solid</h2>\n{facts}{checks}</section>\n")
    }
}

/// Figures under words, side by side. Both are HTML.
fn facts(facts: &[(&str, String)]) -> String {
    let mut html = String::from("<dl class=\"facts\">\n");
    for (what, found) in facts {
        _ = writeln!(html, "<div><dt>{what}</dt><dd>{found}</dd></div>");
    }
    html.push_str("</dl>\n");
    html
}

fn list(texts: &[String]) -> String {
    let mut html = String::from("<ul>\n");
    for text in texts {
        _ = writeln!(html, "<li>{}</li>", escaped(text));
    }
    html.push_str("</ul>\n");
    html
}

fn camouflage(found: &[Camouflage], curves: Option<&str>) -> String {
    if found.is_empty() {
        return String::new();
    }
    let figure = curves.map_or_else(String::new, |svg| {
        format!(
            "<figure class=\"sheet\" role=\"img\" aria-label=\"Likeness of every view by angle\">\n{svg}</figure>\n"
        )
    });
    let rows: Vec<_> = found
        .iter()
        .map(|c| {
            [
                escaped(&c.view),
                measure_or(c.curve.first().map(|p| p.likeness), 2, "", DASH),
                measure_or(c.half_likeness_deg, 1, "°", "never"),
                measure_or(c.worst_off_view_deg, 0, "°", DASH),
                measure_or(c.worst_likeness, 2, "", DASH),
            ]
        })
        .collect();
    let heads = [
        "view",
        "likeness at its eye",
        "half of it at",
        "beyond that most at",
        "likeness there",
    ];
    let table = table("How soon the models vanish", heads, &rows);
    format!(
        "<section id=\"camouflage\">\n<h2>Camouflage</h2>\n<p class=\"lead\">How like its model the forest is to eyes that stand \
         elsewhere: 1 is a perfect picture, 0 none.</p>\n{figure}{table}</section>\n"
    )
}

/// What a printer needs to know, from the report's `print`: a list of objects with `check`, `place`, `value_mm`, `wanted_mm`,
/// `ok`, and perhaps `limit_mm` and `note`. Nothing of anything else.
pub fn print_sheet(checks: &Value) -> String {
    let text = |v: &Value| v.as_str().map_or_else(|| DASH.into(), escaped);
    let length = |v: &Value| measure_or(v.as_f64(), 2, "mm", DASH);
    let place = |v: &Value| {
        let part = |k: usize| v.get(k).and_then(Value::as_f64);
        match (part(0), part(1), part(2)) {
            (Some(x), Some(y), Some(z)) => text::place([x, y, z]),
            _ => text(v),
        }
    };
    let rows: Vec<_> = checks
        .as_array()
        .into_iter()
        .flatten()
        .map(|c| {
            [
                text(&c["check"]),
                length(&c["value_mm"]),
                length(&c["wanted_mm"]),
                length(&c["limit_mm"]),
                mark(c["ok"] == true).into(),
                place(&c["place"]),
                text(&c["note"]),
            ]
        })
        .collect();
    let heads = [
        "check", "found", "wanted", "limit", "holds", "place", "note",
    ];
    let table = table_if_any("What a printer needs to know", heads, &rows);
    if table.is_empty() {
        table
    } else {
        format!("<section id=\"print\">\n<h2>Print sheet</h2>\n{table}</section>\n")
    }
}

fn files(files: &[(&str, usize)]) -> String {
    let rows: Vec<_> = files
        .iter()
        .map(|(path, bytes)| [escaped(path), measure(*bytes as f64 / 1000.0, 0, "kB")])
        .collect();
    let table = table_if_any(
        "Files of this build, beside this page",
        ["file", "size"],
        &rows,
    );
    if table.is_empty() {
        table
    } else {
        format!("<section id=\"files\">\n<h2>Files</h2>\n{table}</section>\n")
    }
}

/// How far an eye may move sideways, or turn if it is at infinity: unseen, and with one picture still.
fn room(found: &Tolerance) -> [String; 2] {
    match (&found.eye_tolerance_deg, &found.one_picture_deg) {
        (Some(unseen), Some(one)) => [unseen, one].map(|t| measure_or(t.side, 2, "°", DASH)),
        _ => [found.eye_tolerance_mm, found.one_picture_mm]
            .map(|m| measure_or(m.side, 1, "mm", DASH)),
    }
}
