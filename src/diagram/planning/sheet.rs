//! The plan's page: two maps at the same scale, what they are worth, and what camouflage costs.

use super::measures::{COLUMNS, MARGIN, WIDTH};
use super::plot;
use super::scenery::{Map, plus, sign};
use super::story::Story;
use super::table;
use super::words;
use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::page::{PAPER, QUIET, RED, TEXT, deep, pale};
use crate::planner::Frame;
use glam::DVec2;

/// At least A4 on its side, millimetres.
const LEAST_HEIGHT: f64 = 210.0;
/// Baselines of the maps' captions; top and bottom of the maps.
const CAPTION: f64 = 30.0;
const MAPS: [f64; 2] = [36.0, 149.0];
/// Layout unit of the maps: letters of names are 4.4 of it.
const UNIT: f64 = 0.72;
/// Faults listed below a map, at most, and the height of a line.
const LISTED: usize = 6;
const LINE: f64 = 3.7;
/// Room of the key.
const KEY: f64 = 7.0;
/// Height of the plot with its axes, at least.
const PLOT: f64 = 44.0;

pub(crate) fn draw(story: &Story) -> Drawing {
    let lists = [story.first(), story.last()].map(|f| story.marks(f).len().min(LISTED + 1));
    let key = MAPS[1] + LINE * lists[0].max(lists[1]) as f64 + 5.5;
    let top = key + KEY;
    let bottom = top + table::height(story).max(PLOT);
    let size = DVec2::new(WIDTH, LEAST_HEIGHT.max(bottom + 4.0));
    let mut drawing = Drawing::new(size);
    drawing.rect(DVec2::ZERO, size, Some(PAPER), None);
    heading(&mut drawing, story);
    half(&mut drawing, story, true);
    half(&mut drawing, story, false);
    keys(&mut drawing, story, key);
    table::draw(&mut drawing, story, top);
    let axes = [
        DVec2::new(COLUMNS[1][0] + 16.0, top + 3.0),
        DVec2::new(COLUMNS[1][1], size.y - 14.0),
    ];
    plot::draw(&mut drawing, axes, 2.8, story.brief, story.planned);
    drawing
}

/// One map with its caption and its faults.
fn half(drawing: &mut Drawing, story: &Story, before: bool) {
    let (column, frame) = if before {
        (&COLUMNS[0], story.first())
    } else {
        (&COLUMNS[1], story.last())
    };
    let room = [
        DVec2::new(column[0], MAPS[0]),
        DVec2::new(column[1], MAPS[1]),
    ];
    let map = Map::new(story, room, UNIT);
    map.ground(drawing);
    if before {
        map.regions(drawing);
    }
    map.ranges(drawing, frame);
    map.pillars(drawing, &frame.pillars);
    if !before {
        map.changes(drawing);
    }
    map.eyes(drawing);
    let marks = story.marks(frame);
    map.marks(drawing, &marks, numbered(&marks));
    caption(drawing, story, column, frame, before);
    list(drawing, column, &marks);
}

/// How many faults have a line of their own below the map.
fn numbered(marks: &[(DVec2, String)]) -> usize {
    if marks.len() > LISTED + 1 {
        LISTED
    } else {
        marks.len()
    }
}

fn heading(drawing: &mut Drawing, story: &Story) {
    let title = TextStyle::new(8.0, Typeface::Regular, TEXT, Align::Start)
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
    let style = TextStyle::new(3.4, Typeface::Light, QUIET, Align::Start);
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
    let bold = TextStyle::new(4.6, Typeface::Bold, TEXT, Align::Start);
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
    let style = TextStyle::new(3.1, Typeface::Light, TEXT, Align::Start);
    drawing.text(beside, &line, style.fitting(&line, column[1] - beside.x));
    let (faults, ink) = match words::faults(&frame.faults) {
        Some(faults) => (format!("faults: {faults}"), RED),
        None => ("no faults".to_owned(), QUIET),
    };
    let style = TextStyle::new(2.9, Typeface::Light, ink, Align::Start);
    drawing.text_within(
        at + DVec2::new(0.0, 4.8),
        &faults,
        column[1] - column[0],
        style,
    );
}

/// What the numbers at faults mean.
fn list(drawing: &mut Drawing, column: &[f64; 2], marks: &[(DVec2, String)]) {
    let style = TextStyle::new(2.8, Typeface::Light, TEXT, Align::Start);
    let shown = numbered(marks);
    let line = |k: usize| DVec2::new(column[0], MAPS[1] + LINE * (k as f64 + 1.0));
    for (k, (_, text)) in marks.iter().take(shown).enumerate() {
        let number = TextStyle {
            face: Typeface::Bold,
            ink: RED,
            ..style
        };
        drawing.text(line(k), &(k + 1).to_string(), number);
        let beside = line(k) + DVec2::new(5.0, 0.0);
        drawing.text_within(beside, text, column[1] - beside.x, style);
    }
    if shown < marks.len() {
        let more = format!("and {} more", marks.len() - shown);
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
    let style = TextStyle::new(2.8, Typeface::Light, TEXT, Align::Start);
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
        swatch(d, at, Ink::new(grey).fade(0.3), Some(fine));
    });
    if story.planned.regions.iter().any(|r| !r.is_empty()) {
        let pen = Pen::new(deep(grey, 0.1), 0.3).dashed(1.1, 1.0);
        entry(drawing, "sight region of the start", &|d, at| {
            swatch(d, at, Ink::new(grey).fade(0.1), Some(pen));
        });
    }
    entry(drawing, "pillar, with its view's letter", &|d, at| {
        d.circle(at, 1.7, Some(pale(grey, 0.3)), Some(fine));
    });
    let shown = [story.first(), story.last()];
    if shown.iter().any(|f| f.pillars.iter().any(|p| p.fixed)) {
        entry(drawing, "fixed", &|d, at| {
            d.circle(at, 1.6, Some(pale(grey, 0.3)), Some(Pen::new(TEXT, 0.65)));
        });
    }
    if story.mended() {
        entry(drawing, "where a given pillar stood", &|d, at| {
            d.circle(at, 1.6, None, Some(Pen::new(TEXT, 0.22).dashed(0.6, 0.7)));
        });
        entry(drawing, "new", &|d, at| plus(d, at, 0.9));
    }
    if shown
        .iter()
        .all(|f| f.faults.is_empty() && story.marks(f).is_empty())
    {
        return;
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
