//! A display list: what is drawn, without saying on what. PNG and SVG are made from the same list.
//!
//! Page coordinates: x right, y down, in the drawing's own unit (millimetres for the plan, pixels for pictures).

pub use super::mark::{Ink, Mark, Pen, Verb};

use super::lettering::{self, Typeface};
use glam::DVec2;

/// Where a text's anchor point lies on its baseline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextStyle {
    /// Height of the em square.
    pub size: f64,
    pub ink: Ink,
    pub face: Typeface,
    pub anchor: Align,
    /// Colour of a border that lifts the text off what lies beneath.
    pub halo: Option<Ink>,
}

impl TextStyle {
    /// Without a border.
    pub const fn new(size: f64, face: Typeface, ink: Ink, anchor: Align) -> Self {
        Self {
            size,
            ink,
            face,
            anchor,
            halo: None,
        }
    }

    pub const fn anchored(self, anchor: Align) -> Self {
        Self { anchor, ..self }
    }

    pub const fn lifted(self, halo: Ink) -> Self {
        Self {
            halo: Some(halo),
            ..self
        }
    }

    /// As large as it is, or as small as it must be for a text no wider than `most`.
    pub fn fitting(self, text: &str, most: f64) -> Self {
        let width = lettering::width(text, self.size, self.face);
        Self {
            size: self.size * (most / width.max(1e-9)).min(1.0),
            ..self
        }
    }
}

/// The display list of one page.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub size: DVec2,
    pub shapes: Vec<Mark>,
}

impl Drawing {
    pub fn new(size: DVec2) -> Self {
        Self {
            size,
            shapes: Vec::new(),
        }
    }

    pub fn polygon(&mut self, points: &[DVec2], fill: Option<Ink>, pen: Option<Pen>) {
        self.path(points, true, fill, pen);
    }

    pub fn polyline(&mut self, points: &[DVec2], pen: Pen) {
        self.path(points, false, None, Some(pen));
    }

    pub fn circle(&mut self, centre: DVec2, radius: f64, fill: Option<Ink>, pen: Option<Pen>) {
        // Four cubic arcs: 0.03 % off a true circle.
        let k = 0.552_284_75 * radius;
        let r = radius;
        let at = |x: f64, y: f64| centre + DVec2::new(x, y);
        let steps = vec![
            Verb::Move(at(r, 0.0)),
            Verb::Cubic(at(r, k), at(k, r), at(0.0, r)),
            Verb::Cubic(at(-k, r), at(-r, k), at(-r, 0.0)),
            Verb::Cubic(at(-r, -k), at(-k, -r), at(0.0, -r)),
            Verb::Cubic(at(k, -r), at(r, -k), at(r, 0.0)),
            Verb::Close,
        ];
        self.shapes.push(Mark {
            steps,
            fill,
            pen,
            text: None,
        });
    }

    pub fn rect(&mut self, lo: DVec2, hi: DVec2, fill: Option<Ink>, pen: Option<Pen>) {
        self.polygon(
            &[lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)],
            fill,
            pen,
        );
    }

    /// Sets one line of text on a baseline point.
    pub fn text(&mut self, at: DVec2, text: &str, style: TextStyle) {
        self.text_for(at, text, text, style);
    }

    /// The same no wider than `most`: cut with an ellipsis if it must be. The SVG still says all of it.
    pub fn text_within(&mut self, at: DVec2, text: &str, most: f64, style: TextStyle) {
        let short = lettering::shortened(text, most, style.size, style.face);
        self.text_for(at, &short, text, style);
    }

    fn text_for(&mut self, at: DVec2, text: &str, meaning: &str, style: TextStyle) {
        let width = lettering::width(text, style.size, style.face);
        let start = match style.anchor {
            Align::Start => at,
            Align::Middle => at - DVec2::new(width / 2.0, 0.0),
            Align::End => at - DVec2::new(width, 0.0),
        };
        let steps = lettering::outlines(text, start, style.size, style.face);
        if steps.is_empty() {
            return;
        }
        if let Some(ink) = style.halo {
            let pen = Pen::new(ink, 0.22 * style.size);
            self.shapes.push(Mark {
                steps: steps.clone(),
                fill: Some(ink),
                pen: Some(pen),
                text: None,
            });
        }
        let weight = style.face.stroke() * style.size;
        let pen = (weight > 0.0).then_some(Pen::new(style.ink, weight));
        self.shapes.push(Mark {
            steps,
            fill: Some(style.ink),
            pen,
            text: Some(meaning.to_owned()),
        });
    }

    fn path(&mut self, points: &[DVec2], close: bool, fill: Option<Ink>, pen: Option<Pen>) {
        let Some((first, rest)) = points.split_first() else {
            return;
        };
        let mut steps = vec![Verb::Move(*first)];
        steps.extend(rest.iter().map(|p| Verb::Line(*p)));
        if close {
            steps.push(Verb::Close);
        }
        self.shapes.push(Mark {
            steps,
            fill,
            pen,
            text: None,
        });
    }
}
