//! The search as small maps, for paper and for viewers without animation.

use super::scenery::Map;
use super::story::Story;
use super::words;
use crate::diagram::drawing::{Align, Drawing, TextStyle};
use crate::diagram::lettering::Typeface;
use crate::diagram::page::{PAPER, QUIET, RED, TEXT};
use glam::DVec2;

/// At most so many maps, so many in a row.
const MAPS: usize = 6;
const ACROSS: usize = 3;
/// Page and one map with its caption, millimetres.
const MARGIN: f64 = 8.0;
const TOP: f64 = 20.0;
const CELL: DVec2 = DVec2::new(88.0, 92.0);
const MAP: f64 = 78.0;
/// Layout unit of the maps.
const UNIT: f64 = 0.5;

pub(crate) fn draw(story: &Story) -> Drawing {
    let picked = story.picked(MAPS);
    let rows = picked.len().div_ceil(ACROSS);
    let size = DVec2::new(
        2.0 * MARGIN + CELL.x * ACROSS as f64,
        TOP + CELL.y * rows as f64 + MARGIN / 2.0,
    );
    let mut drawing = Drawing::new(size);
    drawing.rect(DVec2::ZERO, size, Some(PAPER), None);
    let head = TextStyle::new(6.0, Typeface::Regular, TEXT, Align::Start)
        .fitting(story.title, 0.7 * size.x);
    drawing.text(DVec2::new(MARGIN, 12.0), story.title, head);
    let note = TextStyle::new(3.2, Typeface::Light, QUIET, Align::End);
    drawing.text(
        DVec2::new(size.x - MARGIN, 12.0),
        "the search for a layout",
        note,
    );
    for (k, frame) in picked.iter().enumerate() {
        let corner = DVec2::new(
            MARGIN + CELL.x * (k % ACROSS) as f64,
            TOP + CELL.y * (k / ACROSS) as f64,
        );
        cell(&mut drawing, story, *frame, corner);
    }
    drawing
}

fn cell(drawing: &mut Drawing, story: &Story, index: usize, corner: DVec2) {
    let frame = &story.frames[index];
    let room = [
        corner + DVec2::new(2.0, 0.0),
        corner + DVec2::new(CELL.x - 2.0, MAP),
    ];
    let map = Map::new(story, room, UNIT);
    map.ground(drawing);
    map.ranges(drawing, frame);
    map.pillars(drawing, &frame.pillars);
    map.small_eyes(drawing);
    map.marks(drawing, &story.marks(frame), 0);
    let middle = corner.x + CELL.x / 2.0;
    let line = format!(
        "{}   ·   error {}   ·   tolerance {}",
        words::plural(frame.tries, "try"),
        words::degrees(frame.hidden_deg),
        words::millimetres(frame.tolerance_mm),
    );
    let style = TextStyle::new(3.0, Typeface::Regular, TEXT, Align::Middle);
    drawing.text(DVec2::new(middle, corner.y + MAP + 4.0), &line, style);
    let small = TextStyle::new(2.6, Typeface::Light, QUIET, Align::Middle);
    let below = DVec2::new(middle, corner.y + MAP + 8.0);
    match words::faults(&frame.faults) {
        Some(faults) => drawing.text_within(
            below,
            &format!("faults: {faults}"),
            CELL.x - 4.0,
            TextStyle { ink: RED, ..small },
        ),
        None => {
            let pillars = words::plural(frame.pillars.len() as u64, "pillar");
            drawing.text(below, &format!("{pillars}, no faults"), small);
        }
    }
}
