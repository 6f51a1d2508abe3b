//! What stands under the three panels of a view's picture.

use crate::diagram::drawing::{Align, Drawing, TextStyle};
use crate::diagram::lettering::{Typeface, width};
use crate::render::heat::scale;
use crate::render::inks::{QUIET, TEXT};
use crate::render::likeness::Likeness;
use crate::view::{PlacedModel, View};
use glam::{DVec2, DVec3};

/// Where captions go, in pixels of the picture; `unit` is a hundredth of a panel's side.
pub(super) struct CaptionPlace {
    /// Left edges of the panels.
    pub columns: [f64; 3],
    /// Base line of the titles.
    pub top: f64,
    pub unit: f64,
}

/// Writes a title and a line under each panel, and the scale of errors beside the last title.
pub(super) fn captions(
    drawing: &mut Drawing,
    place: &CaptionPlace,
    view: &View,
    likeness: &Likeness,
    torn: Option<&str>,
) {
    let CaptionPlace { columns, top, unit } = *place;
    let head = TextStyle {
        size: 4.6 * unit,
        ink: TEXT,
        face: Typeface::Regular,
        anchor: Align::Start,
        halo: None,
    };
    let body = TextStyle {
        size: 3.4 * unit,
        ink: QUIET,
        face: Typeface::Light,
        ..head
    };
    // Below the scale's figures, which the last column's second line passes under.
    let below = top + 6.6 * unit;
    let mut put = |x: f64, y: f64, text: &str, style: TextStyle| {
        // The third column's first line ends where the scale starts.
        let most = if x < columns[2] || y > top {
            98.0
        } else {
            62.0
        };
        let fit = (most * unit / width(text, style.size, style.face).max(1e-9)).min(1.0);
        let size = style.size * fit;
        drawing.text(DVec2::new(x, y), text, TextStyle { size, ..style });
    };
    let texts = [
        of_target(view),
        of_forest(view, likeness),
        of_errors(likeness, torn),
    ];
    for (x, [title, line]) in columns.into_iter().zip(&texts) {
        put(x, top, title, head);
        put(x, below, line, body);
    }
    let corner = DVec2::new(columns[2] + 66.0 * unit, top - 3.3 * unit);
    scale(drawing, corner, unit);
}

fn of_target(view: &View) -> [String; 2] {
    let files: Vec<String> = view.models.iter().map(PlacedModel::source).collect();
    [format!("{}: the target", view.name), files.join(", ")]
}

fn of_forest(view: &View, likeness: &Likeness) -> [String; 2] {
    let (title, eye) = if view.orthographic {
        let DVec3 { x, y, z } = (100.0 * view.from()).round() / 100.0 + 0.0;
        let from = format!("parallel rays from {x}, {y}, {z}");
        ("the forest by parallel rays", from)
    } else {
        let DVec3 { x, y, z } = view.eye.round() + 0.0;
        let eye = format!("eye at {x:.0}, {y:.0}, {z:.0} mm");
        ("the forest from its eye", eye)
    };
    let eye = eye.replace('-', "\u{2212}");
    let met = floor2(100.0 * likeness.hit);
    [
        title.to_owned(),
        format!("{eye}; {met:.2} % of the target's rays meet it"),
    ]
}

fn of_errors(likeness: &Likeness, torn: Option<&str>) -> [String; 2] {
    let Likeness {
        mean_deg,
        median_deg,
        p90_deg,
        ..
    } = *likeness;
    let torn = torn.map_or_else(String::new, |text| format!("; {text}"));
    [
        "error of the normals".to_owned(),
        format!("mean {mean_deg:.1}°, median {median_deg:.1}°, 90 % below {p90_deg:.1}°{torn}"),
    ]
}

/// Rounded down, so that only a perfect share reads as 100 %.
fn floor2(x: f64) -> f64 {
    (100.0 * x).floor() / 100.0
}
