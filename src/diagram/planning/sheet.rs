//! The plan's page: two maps at the same scale, what they are worth, and what camouflage costs.

use super::plot;
use super::scenery::{Map, plus, sign};
use super::story::Story;
use super::words;
use crate::diagram::drawing::{Anchor, Drawing, Ink, Pen, TextStyle};
use crate::diagram::eyes::eye_symbol;
use crate::diagram::lettering::{Face, width};
use crate::diagram::page::{HAIR, PAPER, QUIET, RED, TEXT, deep, pale};
use crate::planner::{Adjustment, Frame, Worth};
use glam::DVec2;

/// A4 on its side, millimetres.
const WIDTH: f64 = 297.0;
const LEAST_HEIGHT: f64 = 210.0;
const MARGIN: f64 = 11.0;
/// Edges of both columns.
const COLUMNS: [[f64; 2]; 2] = [[MARGIN, 146.0], [151.0, WIDTH - MARGIN]];
/// Baselines of the maps' captions; top and bottom of the maps.
const CAPTION: f64 = 30.0;
const MAPS: [f64; 2] = [36.0, 149.0];
/// Layout unit of the maps: letters of names are 4.4 of it.
const UNIT: f64 = 0.72;
/// Faults listed below a map, at most, and the height of a line.
const LISTED: usize = 6;
const LINE: f64 = 3.7;
/// Room of the key, and below it down to the first row of the table.
const KEY: f64 = 7.0;
const HEAD: f64 = 13.0;
/// Height of a row of the table, and of a note below a name.
const ROW: f64 = 5.2;
const NOTE: f64 = 3.0;
/// Height of the plot with its axes, at least.
const PLOT: f64 = 44.0;
/// Columns of the table: the names' left edge, then the right edges of figures.
const NAME: f64 = 24.0;
const NAME_WIDTH: f64 = 27.0;
const FIGURES: [f64; 7] = [62.0, 76.0, 88.0, 101.0, 115.0, 130.0, 146.0];

pub fn draw(story: &Story) -> Drawing {
    let lists = [story.first(), story.last()].map(|f| f.marks.len().min(LISTED + 1));
    let key = MAPS[1] + LINE * lists[0].max(lists[1]) as f64 + 5.5;
    let table = key + KEY;
    let rows = rows_height(story);
    let bottom = table + (HEAD + rows + 9.0).max(PLOT);
    let size = DVec2::new(WIDTH, LEAST_HEIGHT.max(bottom + 4.0));
    let mut drawing = Drawing::new(size);
    drawing.rect(DVec2::ZERO, size, Some(PAPER), None);
    heading(&mut drawing, story);
    for (column, frame) in COLUMNS.iter().zip([story.first(), story.last()]) {
        let room = [
            DVec2::new(column[0], MAPS[0]),
            DVec2::new(column[1], MAPS[1]),
        ];
        let map = Map::new(story, room, UNIT);
        let before = column == &COLUMNS[0];
        map.ground(&mut drawing);
        if before {
            map.regions(&mut drawing);
        }
        map.ranges(&mut drawing, frame);
        map.pillars(&mut drawing, &frame.pillars);
        if !before {
            map.changes(&mut drawing);
        }
        map.eyes(&mut drawing);
        map.marks(&mut drawing, frame, numbered(frame));
        caption(&mut drawing, story, column, frame, before);
        list(&mut drawing, column, frame);
    }
    keys(&mut drawing, story, key);
    figures(&mut drawing, story, table);
    let axes = [
        DVec2::new(COLUMNS[1][0] + 16.0, table + 3.0),
        DVec2::new(COLUMNS[1][1], size.y - 14.0),
    ];
    plot::draw(&mut drawing, axes, 2.8, story.brief, story.planned);
    drawing
}

/// How many faults have a line of their own below the map.
fn numbered(frame: &Frame) -> usize {
    if frame.marks.len() > LISTED + 1 {
        LISTED
    } else {
        frame.marks.len()
    }
}

fn heading(drawing: &mut Drawing, story: &Story) {
    let title = TextStyle::new(8.0, Face::Regular, TEXT, Anchor::Start)
        .fitting(story.title, WIDTH - 2.0 * MARGIN);
    drawing.text(DVec2::new(MARGIN, 14.5), story.title, title);
    let line = format!(
        "The layout {}, from above   ·   {}   ·   {}   ·   seed {}",
        if story.mended() {
            "as given and mended"
        } else {
            "before and after the search"
        },
        words::plural(story.views.len() as u64, "view"),
        words::plural(story.last().pillars.len() as u64, "pillar"),
        story.brief.seed,
    );
    let style = TextStyle::new(3.4, Face::Light, QUIET, Anchor::Start);
    drawing.text(DVec2::new(MARGIN, 20.5), &line, style);
}

fn caption(drawing: &mut Drawing, story: &Story, column: &[f64; 2], frame: &Frame, before: bool) {
    let at = DVec2::new(column[0], CAPTION);
    let name = match (story.mended(), before) {
        (false, true) => "Before",
        (false, false) => "After",
        (true, true) => "As given",
        (true, false) => "Mended",
    };
    let bold = TextStyle::new(4.6, Face::Bold, TEXT, Anchor::Start);
    drawing.text(at, name, bold);
    let beside = at + DVec2::new(width(name, bold.size, bold.face) + 3.0, 0.0);
    let line = format!(
        "{}   ·   {}   ·   error {} at {} off   ·   tolerance {}",
        words::plural(frame.tries, "try"),
        words::plural(frame.pillars.len() as u64, "pillar"),
        words::degrees(frame.hidden_deg),
        words::angle(story.brief),
        words::millimetres(frame.tolerance_mm),
    );
    let style = TextStyle::new(3.1, Face::Light, TEXT, Anchor::Start);
    drawing.text(beside, &line, style.fitting(&line, column[1] - beside.x));
    let (faults, ink) = match words::faults(&frame.faults) {
        Some(faults) => (format!("faults: {faults}"), RED),
        None => ("no faults".to_owned(), QUIET),
    };
    let style = TextStyle::new(2.9, Face::Light, ink, Anchor::Start);
    drawing.text_within(
        at + DVec2::new(0.0, 4.8),
        &faults,
        column[1] - column[0],
        style,
    );
}

/// What the numbers at faults mean.
fn list(drawing: &mut Drawing, column: &[f64; 2], frame: &Frame) {
    let style = TextStyle::new(2.8, Face::Light, TEXT, Anchor::Start);
    let shown = numbered(frame);
    let line = |k: usize| DVec2::new(column[0], MAPS[1] + LINE * (k as f64 + 1.0));
    for (k, (_, text)) in frame.marks.iter().take(shown).enumerate() {
        let number = TextStyle {
            face: Face::Bold,
            ink: RED,
            ..style
        };
        drawing.text(line(k), &(k + 1).to_string(), number);
        let beside = line(k) + DVec2::new(5.0, 0.0);
        drawing.text_within(beside, text, column[1] - beside.x, style);
    }
    if shown < frame.marks.len() {
        let more = format!("and {} more", frame.marks.len() - shown);
        drawing.text(
            line(shown) + DVec2::new(5.0, 0.0),
            &more,
            TextStyle {
                ink: QUIET,
                ..style
            },
        );
    }
}

/// What the maps' signs mean.
fn keys(drawing: &mut Drawing, story: &Story, y: f64) {
    let grey = [0x8A, 0x8F, 0x94];
    let style = TextStyle::new(2.8, Face::Light, TEXT, Anchor::Start);
    let fine = Pen::new(deep(grey, 0.35), 0.2);
    let mut x = MARGIN;
    let gap = if story.mended() { 5.0 } else { 7.0 };
    let mut entry = |drawing: &mut Drawing, text: &str, sign: &dyn Fn(&mut Drawing, DVec2)| {
        sign(drawing, DVec2::new(x + 2.5, y - 0.9));
        drawing.text(DVec2::new(x + 6.6, y), text, style);
        x += 6.6 + width(text, style.size, style.face) + gap;
    };
    let swatch = |drawing: &mut Drawing, at: DVec2, fill: Ink, pen: Option<Pen>| {
        let half = DVec2::new(2.5, 1.4);
        drawing.rect(at - half, at + half, Some(fill), pen);
    };
    entry(drawing, "visible range", &|d, at| {
        swatch(d, at, Ink::new(grey).fade(0.3), Some(fine))
    });
    if story.planned.regions.iter().any(|r| !r.is_empty()) {
        let pen = Pen::new(deep(grey, 0.1), 0.3).dashed(1.1, 1.0);
        entry(drawing, "sight region of the start", &|d, at| {
            swatch(d, at, Ink::new(grey).fade(0.1), Some(pen))
        });
    }
    entry(drawing, "pillar, with its view's letter", &|d, at| {
        d.circle(at, 1.7, Some(pale(grey, 0.3)), Some(fine));
    });
    entry(drawing, "fixed", &|d, at| {
        d.circle(at, 1.6, Some(pale(grey, 0.3)), Some(Pen::new(TEXT, 0.65)));
    });
    if story.mended() {
        entry(drawing, "where a given pillar stood", &|d, at| {
            d.circle(at, 1.6, None, Some(Pen::new(TEXT, 0.22).dashed(0.6, 0.7)));
        });
        entry(drawing, "new", &|d, at| plus(d, at, 0.9));
    }
    entry(drawing, "fault", &|d, at| sign(d, at, 0.95, RED, None));
    entry(drawing, "looks past all pillars", &|d, at| {
        swatch(d, at, RED.fade(0.18), None);
        let way = DVec2::new(2.5, 0.0);
        d.polyline(&[at - way, at + way], Pen::new(RED, 0.22).dashed(0.6, 0.9));
    });
    entry(drawing, "meets another view's pillar", &|d, at| {
        d.circle(at, 1.7, Some(pale(grey, 0.3)), Some(fine));
        let arc = [-1.5, -0.75, 0.0, 0.75, 1.5].map(|a: f64| at + 1.7 * DVec2::from_angle(a));
        d.polyline(&arc, Pen::new(RED, 0.65));
    });
}

/// Adjusted models have a note below their view's name.
fn rows_height(story: &Story) -> f64 {
    let notes = story
        .planned
        .adjustments
        .iter()
        .filter_map(adjusted)
        .count();
    ROW * story.views.len() as f64 + NOTE * notes as f64
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

fn figures(drawing: &mut Drawing, story: &Story, top: f64) {
    let head = TextStyle::new(2.6, Face::Light, QUIET, Anchor::End);
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
        let style = TextStyle::new(3.3, Face::Regular, TEXT, Anchor::Start);
        let key = TextStyle {
            face: Face::Bold,
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
            row(drawing, y, &cells(worth), Face::Light);
        }
        if let Some(note) = story.planned.adjustments.get(k).and_then(adjusted) {
            y += NOTE;
            let style = TextStyle::new(2.4, Face::Light, QUIET, Anchor::Start);
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
    let style = TextStyle::new(3.3, Face::Regular, TEXT, Anchor::Start);
    drawing.text(DVec2::new(MARGIN, y), "worst, and all pillars", style);
    row(drawing, y, &worst(story), Face::Regular);
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
    let style = TextStyle::new(2.9, Face::Light, QUIET, Anchor::Start);
    drawing.text(DVec2::new(MARGIN, y + 5.4), &line, style);
}

fn row(drawing: &mut Drawing, y: f64, cells: &[String; 7], face: Face) {
    let style = TextStyle::new(3.2, face, TEXT, Anchor::End);
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
