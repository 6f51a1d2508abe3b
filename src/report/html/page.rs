//! The page from its head to its foot, with all that is not about one view alone.

use super::exhibits::Exhibits;
use super::text::{
    DASH, count, facts, list, mark, measure, measure_or, percent, place, table, table_if_any,
};
use super::views::view;
use crate::certify::camouflage::Camouflage;
use crate::certify::tolerance::Tolerance;
use crate::formats::markup::escaped;
use crate::ladder::Ladder;
use crate::report::document::Report;
use crate::report::print::PrintReport;
use crate::report::solid::SolidCheck;
use crate::report::view::ViewReport;
use crate::words;
use std::fmt::Write as _;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// What browsers may load for the page: what stands in it.
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

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
        for (k, found) in self.views.iter().enumerate() {
            html.push_str(&view(k + 1, found, shown.views.get(k)));
        }
        html.push_str(&camouflage(&self.camouflage, shown.camouflage));
        html.push_str(&print_sheet(&self.print));
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
        let row = |(k, v): (usize, &ViewReport)| {
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
        let measures = facts(&[
            ("size", format!("{x} × {y} × {z}\u{202F}mm")),
            ("volume", measure(s.volume_mm3 / 1000.0, 1, "cm³")),
            ("surface", measure(s.area_mm2 / 100.0, 1, "cm²")),
            ("triangles", count(s.triangles)),
            ("vertices", count(s.vertices)),
            ("parts", count(s.parts)),
            ("closed hollows", count(s.cavities)),
            ("relief corners filled in", count(s.repairs.filled_corners)),
            ("reliefs tied by a brace", count(s.repairs.braces)),
            (
                "loose crumbs dropped",
                measure(s.repairs.crumbs_mm3, 3, "mm³"),
            ),
            (
                "crossings resolved after rounding",
                count(s.repairs.crossings),
            ),
            (
                "moved for them by at most",
                measure(s.repairs.moved_mm, 4, "mm"),
            ),
        ]);
        let row = |c: &SolidCheck| {
            [
                escaped(&c.name),
                count(c.found),
                count(c.limit),
                mark(c.passed).into(),
            ]
        };
        let checks: Vec<_> = s.checks.iter().map(row).collect();
        let heads = ["what", "found", "at most", "holds"];
        let checks = table_if_any("Checks of the solid", heads, &checks);
        let ladders = ladders(&self.ladders);
        format!("<section id=\"solid\">\n<h2>Solid</h2>\n{measures}{checks}{ladders}</section>\n")
    }
}

/// What did not go as it was meant to at once.
fn ladders(all: &[Ladder]) -> String {
    let row = |l: &Ladder| {
        Some([
            escaped(&l.name),
            l.place.as_deref().map_or_else(|| DASH.into(), escaped),
            format!("{} of {}", count(l.rung + 1), count(l.rungs)),
            escaped(&words::ladders::note(l)?),
        ])
    };
    let rows: Vec<_> = all.iter().filter_map(row).collect();
    let heads = ["what was tried in turn", "for", "way that held", "note"];
    table_if_any("Ways that were not the first", heads, &rows)
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

/// What a printer needs to know; nothing if nothing was checked.
pub fn print_sheet(checks: &[PrintReport]) -> String {
    let length = |mm: f64| measure(mm, 2, "mm");
    let row = |c: &PrintReport| {
        [
            escaped(&c.check),
            length(c.value_mm),
            length(c.wanted_mm),
            length(c.limit_mm),
            mark(c.ok).into(),
            place(c.place),
            escaped(&c.note),
        ]
    };
    let rows: Vec<_> = checks.iter().map(row).collect();
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
