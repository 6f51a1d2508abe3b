//! The marks of a drawing: outlines with ink and pen.

use glam::DVec2;

/// A step of an outline, with its points: what path verbs are elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verb {
    Move(DVec2),
    Line(DVec2),
    Quad(DVec2, DVec2),
    Cubic(DVec2, DVec2, DVec2),
    Close,
}

/// A colour with its opacity, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    pub rgb: [u8; 3],
    pub alpha: f64,
}

impl Ink {
    pub const fn new(rgb: [u8; 3]) -> Self {
        Self { rgb, alpha: 1.0 }
    }

    pub const fn fade(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }
}

/// A line of round joins and ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    pub ink: Ink,
    pub width: f64,
    /// Lengths of dash and gap.
    pub dash: Option<[f64; 2]>,
}

impl Pen {
    pub const fn new(ink: Ink, width: f64) -> Self {
        Self {
            ink,
            width,
            dash: None,
        }
    }

    pub const fn dashed(self, dash: f64, gap: f64) -> Self {
        Self {
            dash: Some([dash, gap]),
            ..self
        }
    }
}

/// An outline, filled (even-odd is never needed: non-zero) and then stroked.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub steps: Vec<Verb>,
    pub fill: Option<Ink>,
    pub pen: Option<Pen>,
    /// What the shape says, for screen readers and for searching in the SVG.
    pub text: Option<String>,
}
