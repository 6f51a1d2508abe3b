//! What a layout is worth to every view, as figures.

use super::measures::{COLUMNS, MARGIN};
use super::story::Story;
use super::words;
use crate::diagram::drawing::{Align, Drawing, Pen, TextStyle};
use crate::diagram::eyes::eye_symbol;
use crate::diagram::lettering::Typeface;
use crate::diagram::page::{HAIR, QUIET, TEXT, deep};
use crate::planner::{Adjustment, Worth};
use glam::DVec2;

/// Room of the head, of the last row with what is below it, of a row, and of a note below a name, millimetres.
const HEAD: f64 = 13.0;
const BELOW: f64 = 9.0;
const ROW: f64 = 5.2;
const NOTE: f64 = 3.0;
/// Columns of the table: the names' left edge, then the right edges of figures.
const NAME: f64 = 24.0;
const NAME_WIDTH: f64 = 27.0;
const FIGURES: [f64; 7] = [62.0, 76.0, 88.0, 101.0, 115.0, 130.0, 146.0];

/// All of it: adjusted models have a note below their view's name.
pub(crate) fn height(story: &Story) -> f64 {
    let notes = story
        .planned
        .adjustments
        .iter()
        .filter_map(adjusted)
        .count();
    HEAD + ROW * story.views.len() as f64 + NOTE * notes as f64 + BELOW
}

fn adjusted(a: &Adjustment) -> Option<String> {
    let mut list = Vec::new();
    if a.turn != 0.0 {
        list.push(format!("turned {:.1}°", a.turn.to_degrees()));
    }
    if a.scale != 1.0 {
        list.push(format!("scaled by {:.3}", a.scale));
    }
    if a.shift != DVec2::ZERO {
        list.push(format!("shifted by {:.1}, {:.1} mm", a.shift.x, a.shift.y));
    }
    (!list.is_empty()).then(|| format!("model {}", list.join(", ")).replace('-', "\u{2212}"))
}

/// Draws it from `top` down.
pub(crate) fn draw(drawing: &mut Drawing, story: &Story, top: f64) {
    let head = TextStyle::new(2.6, Typeface::Light, QUIET, Align::End);
    let off = format!("at {}", words::angle(story.brief));
    let titles = [
        ["", "covered"],
        ["", "conflicts"],
        ["", "pillars"],
        ["error", off.as_str()],
        ["likeness", "halved at"],
        ["", "middle"],
        ["tolerance of the eye", "guaranteed"],
    ];
    for (x, [upper, lower]) in FIGURES.iter().zip(titles) {
        drawing.text(DVec2::new(*x, top + 4.5), upper, head);
        drawing.text(DVec2::new(*x, top + 8.0), lower, head);
    }
    let mut y = top + HEAD;
    for (k, view) in story.views.iter().enumerate() {
        eye_symbol(drawing, DVec2::new(MARGIN + 2.3, y - 1.1), 2.2, view.colour);
        let style = TextStyle::new(3.3, Typeface::Regular, TEXT, Align::Start);
        let key = TextStyle {
            face: Typeface::Bold,
            ink: deep(view.colour, 0.35),
            ..style
        };
        drawing.text(
            DVec2::new(MARGIN + 6.6, y),
            &story.keys[k],
            key.fitting(&story.keys[k], 5.5),
        );
        drawing.text_within(DVec2::new(NAME, y), &view.name, NAME_WIDTH, style);
        if let Some(worth) = story.planned.worth.get(k) {
            row(drawing, y, &cells(worth), Typeface::Light);
        }
        if let Some(note) = story.planned.adjustments.get(k).and_then(adjusted) {
            y += NOTE;
            let style = TextStyle::new(2.4, Typeface::Light, QUIET, Align::Start);
            drawing.text(DVec2::new(NAME, y + 0.3), &note, style);
        }
        y += ROW;
    }
    totals(drawing, story, y);
}

/// The last row, and how the search ended.
fn totals(drawing: &mut Drawing, story: &Story, y: f64) {
    let rule = [MARGIN, COLUMNS[0][1]].map(|x| DVec2::new(x, y - 3.9));
    drawing.polyline(&rule, Pen::new(HAIR, 0.2));
    let style = TextStyle::new(3.3, Typeface::Regular, TEXT, Align::Start);
    drawing.text(DVec2::new(MARGIN, y), "worst, and all pillars", style);
    row(drawing, y, &worst(story), Typeface::Regular);
    let planned = story.planned;
    let fixed = match planned.pillars.iter().filter(|p| p.fixed).count() {
        0 => String::new(),
        n => format!(" ({n} fixed)"),
    };
    let line = format!(
        "{}{fixed}   ·   {}   ·   {}",
        words::plural(planned.pillars.len() as u64, "pillar"),
        words::plural(planned.tries, "try"),
        words::ended(planned.ended),
    );
    let style = TextStyle::new(2.9, Typeface::Light, QUIET, Align::Start);
    drawing.text(DVec2::new(MARGIN, y + 5.4), &line, style);
}

fn row(drawing: &mut Drawing, y: f64, cells: &[String; 7], face: Typeface) {
    let style = TextStyle::new(3.2, face, TEXT, Align::End);
    for (x, text) in FIGURES.iter().zip(cells) {
        drawing.text(DVec2::new(*x, y), text, style);
    }
}

fn cells(worth: &Worth) -> [String; 7] {
    [
        covered(worth.coverage),
        worth.conflicts.to_string(),
        worth.pillars.to_string(),
        words::degrees(worth.hidden_deg),
        worth
            .half_likeness_deg
            .map_or("never".into(), words::degrees),
        words::millimetres(worth.tolerance_mm[0]),
        words::millimetres(worth.tolerance_mm[1]),
    ]
}

/// Rounded down: a gap, however thin, never reads as 100 %.
fn covered(share: f64) -> String {
    format!("{} %", (1000.0 * share + 1e-6).floor() / 10.0)
}

/// The worst of all views; conflicts have a part in two views, so that the most of one view are shown.
fn worst(story: &Story) -> [String; 7] {
    let worth = &story.planned.worth;
    let least = |of: fn(&Worth) -> f64| worth.iter().map(of).fold(f64::INFINITY, f64::min);
    let half = worth
        .iter()
        .map(|w| w.half_likeness_deg.unwrap_or(f64::INFINITY));
    let half = half.fold(0.0, f64::max);
    let conflicts = worth.iter().map(|w| w.conflicts).max().unwrap_or(0);
    if worth.is_empty() {
        return Default::default();
    }
    [
        covered(least(|w| w.coverage)),
        conflicts.to_string(),
        story.planned.pillars.len().to_string(),
        words::degrees(least(|w| w.hidden_deg)),
        if half.is_finite() {
            words::degrees(half)
        } else {
            "never".into()
        },
        words::millimetres(least(|w| w.tolerance_mm[0])),
        words::millimetres(least(|w| w.tolerance_mm[1])),
    ]
}
