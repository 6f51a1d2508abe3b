//! The search as an animated SVG (SMIL, no scripts).
//!
//! Every attribute that moves has one value for each frame and the last once more, for the rest at the end. Pillars
//! glide; what belongs to one frame alone, ranges and figures, fades in and out. Attributes as written are those of the last frame: so
//! viewers that know no animation show the layout chosen.

use super::plot::LEAST_SPAN;
use super::scenery::Map;
use super::story::Story;
use super::tracks::{Track, tracks};
use super::words;
use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::page::{HAIR, PAPER, QUIET, TEXT};
use crate::diagram::svg::{CLOSING, number, opening, push_shape};
use crate::formats::markup::escaped;
use crate::planner::Frame;
use glam::DVec2;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::ops::Range;

/// At most so many frames are shown, spread over this long, and rested on the last, seconds.
const FRAMES: usize = 24;
const MOVES_S: f64 = 6.0;
const RESTS_S: f64 = 2.0;
/// Page, map and figures, millimetres.
const PAGE: DVec2 = DVec2::new(180.0, 216.0);
const ROOM: [DVec2; 2] = [DVec2::new(5.0, 24.0), DVec2::new(175.0, 172.0)];
const UNIT: f64 = 0.9;
const MARGIN: f64 = 10.0;
const LABELS: f64 = 181.0;
/// Chords of an outline at a range's end: there are many ranges.
const ARC: usize = 5;
/// Edges of the small curves, and the pace of one figure to the next.
const CURVE: [f64; 2] = [194.0, 207.0];
const PACE: f64 = 41.0;
const BREADTH: f64 = 35.0;
/// Starts and stops gently at every frame.
const EASE: &str = ".6 0 .4 1";

pub(crate) fn svg(story: &Story) -> String {
    let frames: Vec<&Frame> = story
        .picked(FRAMES)
        .iter()
        .map(|k| &story.frames[*k])
        .collect();
    let mut film = Film::new(story.title, frames.len());
    let mut map = Map::new(story, ROOM, UNIT);
    map.arc = ARC;
    film.still(|d| {
        d.rect(DVec2::ZERO, PAGE, Some(PAPER), None);
        let head = TextStyle::new(6.4, Typeface::Regular, TEXT, Align::Start)
            .fitting(story.title, PAGE.x - 2.0 * MARGIN);
        d.text(DVec2::new(MARGIN, 12.0), story.title, head);
        let line = format!(
            "The search for a layout   ·   {}   ·   {}",
            words::plural(story.planned.tries, "try"),
            words::ended(story.planned.ended)
        );
        d.text(
            DVec2::new(MARGIN, 18.5),
            &line,
            TextStyle::new(3.4, Typeface::Light, QUIET, Align::Start),
        );
        map.ground(d);
    });
    for (k, frame) in frames.iter().enumerate() {
        film.only(k, |d| map.ranges(d, frame));
    }
    for track in tracks(&frames) {
        film.pillar(&map, &track);
    }
    film.still(|d| map.eyes(d));
    for (k, frame) in frames.iter().enumerate() {
        let marks = story.marks(frame);
        if !marks.is_empty() {
            film.only(k, |d| map.marks(d, &marks, 0));
        }
    }
    figures(&mut film, story, &frames);
    film.svg + CLOSING
}

/// Of the figures.
const FIGURE: TextStyle = TextStyle::new(5.2, Typeface::Regular, TEXT, Align::Start);

/// The document as it grows.
struct Film {
    svg: String,
    frames: usize,
    /// Attributes that all animations share: times and length.
    timing: String,
}

impl Film {
    fn new(title: &str, frames: usize) -> Self {
        let share = MOVES_S / (MOVES_S + RESTS_S);
        let steps = (frames - 1).max(1) as f64;
        let mut times: Vec<String> = (0..frames)
            .map(|k| fine(share * k as f64 / steps))
            .collect();
        times.push("1".into());
        let timing = format!(
            "keyTimes=\"{}\" dur=\"{}s\" repeatCount=\"indefinite\"",
            times.join(";"),
            number(MOVES_S + RESTS_S)
        );
        Self {
            svg: opening(PAGE, &format!("{title}: search")),
            frames,
            timing,
        }
    }

    /// Shapes that do not change.
    fn still(&mut self, draw: impl FnOnce(&mut Drawing)) {
        let mut drawing = Drawing::new(PAGE);
        draw(&mut drawing);
        drawing
            .shapes
            .iter()
            .for_each(|s| push_shape(&mut self.svg, s));
    }

    /// Shapes of one frame.
    fn only(&mut self, frame: usize, draw: impl FnOnce(&mut Drawing)) {
        let shown: Vec<bool> = (0..self.frames).map(|k| k == frame).collect();
        self.open(None, &shown);
        self.still(draw);
        self.svg.push_str("</g>\n");
    }

    fn pillar(&mut self, map: &Map, track: &Track) {
        let places: Vec<DVec2> = (0..self.frames)
            .map(|k| map.page.place(track.place(k)))
            .collect();
        let shown: Vec<bool> = track.at.iter().map(Option::is_some).collect();
        self.open(Some(&places), &shown);
        self.still(|d| map.pillar(d, &track.pillar, DVec2::ZERO));
        self.svg.push_str("</g>\n");
    }

    /// A group that moves along `places` and is seen in some frames only.
    fn open(&mut self, places: Option<&[DVec2]>, shown: &[bool]) {
        let opacity = |seen: &bool| if *seen { "1" } else { "0" }.to_owned();
        self.svg.push_str("<g");
        let shift = |p: &DVec2| format!("{} {}", number(p.x), number(p.y));
        if let Some(last) = places.and_then(|p| p.last()) {
            _ = write!(self.svg, " transform=\"translate({})\"", shift(last));
        }
        if shown.last() == Some(&false) {
            self.svg.push_str(" opacity=\"0\"");
        }
        self.svg.push_str(">\n");
        if let Some(places) = places {
            let head = "animateTransform attributeName=\"transform\" type=\"translate\"";
            self.animate(head, places.iter().map(shift).collect());
        }
        self.animate(
            "animate attributeName=\"opacity\"",
            shown.iter().map(opacity).collect(),
        );
    }

    /// Every letter of a text once, for [`figure`](Self::figure).
    fn define_letters(&mut self, text: &str) {
        let letters: BTreeSet<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
        self.svg.push_str("<defs>\n");
        for letter in letters {
            _ = writeln!(self.svg, "<g id=\"u{:x}\">", u32::from(letter));
            self.still(|d| d.text(DVec2::ZERO, &letter.to_string(), FIGURE));
            self.svg.push_str("</g>\n");
        }
        self.svg.push_str("</defs>\n");
    }

    /// A text in defined letters, seen in some frames.
    fn figure(&mut self, at: DVec2, text: &str, frames: Range<usize>) {
        let shown = (0..self.frames).map(|k| frames.contains(&k));
        let values: Vec<String> = shown.map(|s| u8::from(s).to_string()).collect();
        let hidden = values.last().is_some_and(|v| v == "0");
        let opacity = if hidden { " opacity=\"0\"" } else { "" };
        _ = writeln!(self.svg, "<g aria-label=\"{}\"{opacity}>", escaped(text));
        self.switch(values);
        let mut before = String::new();
        for letter in text.chars() {
            let x = at.x + width(&before, FIGURE.size, FIGURE.face);
            before.push(letter);
            if !letter.is_whitespace() {
                let (x, y, code) = (number(x), number(at.y), u32::from(letter));
                _ = writeln!(self.svg, "<use href=\"#u{code:x}\" x=\"{x}\" y=\"{y}\"/>");
            }
        }
        self.svg.push_str("</g>\n");
    }

    /// Opacity that changes at once.
    fn switch(&mut self, mut values: Vec<String>) {
        values.extend(values.last().cloned());
        if values.windows(2).any(|v| v[0] != v[1]) {
            let values = values.join(";");
            let head = "<animate attributeName=\"opacity\" calcMode=\"discrete\"";
            _ = writeln!(self.svg, "{head} values=\"{values}\" {}/>", self.timing);
        }
    }

    /// One attribute through all frames; nothing where it does not change.
    fn animate(&mut self, head: &str, mut values: Vec<String>) {
        let Some(last) = values
            .last()
            .cloned()
            .filter(|l| values.iter().any(|v| v != l))
        else {
            return;
        };
        let splines = vec![EASE; values.len()].join(";");
        values.push(last);
        _ = writeln!(
            self.svg,
            "<{head} values=\"{}\" calcMode=\"spline\" keySplines=\"{splines}\" {}/>",
            values.join(";"),
            self.timing
        );
    }
}

fn fine(x: f64) -> String {
    let text = format!("{x:.5}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What is told below the map: name, figure of every frame, and a curve with a dot on it.
fn figures(film: &mut Film, story: &Story, frames: &[&Frame]) {
    let error = format!("forecast error {} off", words::angle(story.brief));
    let list: [(&str, Gauge, Told); 4] = [
        ("tries", |f| f.tries as f64, |f| words::count(f.tries)),
        ("faults", |f| words::wrong(&f.faults), fault_figure),
        (&error, |f| f.hidden_deg, |f| words::degrees(f.hidden_deg)),
        (
            "tolerance of the eye",
            |f| f.tolerance_mm,
            |f| words::millimetres(f.tolerance_mm),
        ),
    ];
    let told = list
        .iter()
        .flat_map(|(_, _, told)| frames.iter().map(|f| told(f)));
    film.define_letters(&told.collect::<String>());
    for (k, (name, value, told)) in list.into_iter().enumerate() {
        let x = MARGIN + PACE * k as f64;
        let style = TextStyle::new(3.0, Typeface::Light, QUIET, Align::Start);
        film.still(|d| d.text(DVec2::new(x, LABELS), name, style));
        // Equal figures in a row are one.
        let texts: Vec<String> = frames.iter().map(|f| told(f)).collect();
        let mut from = 0;
        for chunk in texts.chunk_by(|a, b| a == b) {
            let to = from + chunk.len();
            film.figure(DVec2::new(x, LABELS + 6.6), &chunk[0], from..to);
            from = to;
        }
        let values: Vec<f64> = frames.iter().map(|f| value(f)).collect();
        curve(film, x, &values);
    }
}

type Gauge = fn(&Frame) -> f64;
type Told = fn(&Frame) -> String;

fn fault_figure(frame: &Frame) -> String {
    let sum = words::wrong(&frame.faults);
    if sum > 0.0 {
        words::millimetres(sum)
    } else {
        "none".into()
    }
}

/// A curve through all frames, with a dot at the frame shown.
fn curve(film: &mut Film, x: f64, values: &[f64]) {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    let ends = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| {
        [e[0].min(v), e[1].max(v)]
    });
    let steps = (values.len() - 1).max(1) as f64;
    let span = (ends[1] - ends[0]).max(LEAST_SPAN * ends[1].abs());
    let place = |k: usize| {
        // Half up where all are the same; what is endless stays at the edge.
        let share = (values[k] - (ends[0] + ends[1]) / 2.0) / span + 0.5;
        let share = if share.is_nan() {
            0.5
        } else {
            share.clamp(0.0, 1.0)
        };
        let along = if values.len() > 1 {
            k as f64 / steps
        } else {
            1.0
        };
        DVec2::new(
            x + BREADTH * along,
            CURVE[1] - share * (CURVE[1] - CURVE[0]),
        )
    };
    let line: Vec<DVec2> = (0..values.len()).map(place).collect();
    film.still(|d| {
        d.polyline(
            &[
                DVec2::new(x, CURVE[1] + 1.5),
                DVec2::new(x + BREADTH, CURVE[1] + 1.5),
            ],
            Pen::new(HAIR, 0.2),
        );
        d.polyline(&line, Pen::new(QUIET, 0.4));
    });
    film.open(Some(&line), &vec![true; values.len()]);
    film.still(|d| {
        d.circle(
            DVec2::ZERO,
            1.1,
            Some(Ink::new([0xD5, 0x5E, 0x00])),
            Some(Pen::new(PAPER, 0.3)),
        );
    });
    film.svg.push_str("</g>\n");
}
