//! Text as outlines, so that every machine shows the same letters, whatever fonts it has.

use super::mark::Verb;
use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve, Point};
use glam::DVec2;
use std::sync::LazyLock;

/// A typeface. The heavier ones are the light one with its outline stroked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Typeface {
    Light,
    Regular,
    Bold,
}

impl Typeface {
    /// Width of the stroke that thickens the letters, in ems.
    pub fn stroke(self) -> f64 {
        match self {
            Self::Light => 0.0,
            Self::Regular => 0.022,
            Self::Bold => 0.055,
        }
    }
}

/// Ubuntu Light, and Hack for the characters that it lacks. Both are compiled in: parsing cannot fail.
static FONTS: LazyLock<Vec<FontRef<'static>>> = LazyLock::new(|| {
    [
        epaint_default_fonts::UBUNTU_LIGHT,
        epaint_default_fonts::HACK_REGULAR,
    ]
    .iter()
    .filter_map(|d| FontRef::try_from_slice(d).ok())
    .collect()
});

/// One letter: the font that has it, its glyph there, and the scale from font units to ems.
fn glyph(c: char) -> Option<(&'static FontRef<'static>, GlyphId, f64)> {
    let has = |font: &&FontRef| font.glyph_id(c) != GlyphId(0);
    let font = FONTS.iter().find(has).or_else(|| FONTS.first())?;
    let units = f64::from(font.units_per_em().unwrap_or(1000.0));
    Some((font, font.glyph_id(c), 1.0 / units))
}

/// Walks along a text; calls `visit` with every letter and its start, gives the width. In ems.
fn set(text: &str, face: Typeface, mut visit: impl FnMut(&FontRef, GlyphId, f64, f64)) -> f64 {
    let mut x = 0.0;
    for c in text.chars().filter(|c| !c.is_control()) {
        let Some((font, id, scale)) = glyph(c) else {
            continue;
        };
        visit(font, id, scale, x);
        x += f64::from(font.h_advance_unscaled(id)) * scale + 0.6 * face.stroke();
    }
    x
}

/// Width of a line of text.
pub fn width(text: &str, size: f64, face: Typeface) -> f64 {
    size * set(text, face, |_, _, _, _| {})
}

/// A text cut to a width, with an ellipsis.
pub fn shortened(text: &str, most: f64, size: f64, face: Typeface) -> String {
    if width(text, size, face) <= most {
        return text.to_owned();
    }
    let mut short = String::new();
    for c in text.chars() {
        if width(&format!("{short}{c}…"), size, face) > most {
            break;
        }
        short.push(c);
    }
    short + "…"
}

/// The outlines of a line of text whose baseline starts at `start`.
pub fn outlines(text: &str, start: DVec2, size: f64, face: Typeface) -> Vec<Verb> {
    let mut steps = Vec::new();
    set(text, face, |font, id, scale, x| {
        let Some(outline) = font.outline(id) else {
            return;
        };
        let place = |p: Point| {
            start + size * DVec2::new(x + f64::from(p.x) * scale, -f64::from(p.y) * scale)
        };
        let mut pen: Option<Point> = None;
        for curve in outline.curves {
            let (from, to) = ends(&curve);
            if pen != Some(from) {
                if pen.is_some() {
                    steps.push(Verb::Close);
                }
                steps.push(Verb::Move(place(from)));
            }
            steps.push(match curve {
                OutlineCurve::Line(_, b) => Verb::Line(place(b)),
                OutlineCurve::Quad(_, b, c) => Verb::Quad(place(b), place(c)),
                OutlineCurve::Cubic(_, b, c, d) => Verb::Cubic(place(b), place(c), place(d)),
            });
            pen = Some(to);
        }
        if pen.is_some() {
            steps.push(Verb::Close);
        }
    });
    steps
}

fn ends(curve: &OutlineCurve) -> (Point, Point) {
    match *curve {
        OutlineCurve::Line(a, b) => (a, b),
        OutlineCurve::Quad(a, _, c) => (a, c),
        OutlineCurve::Cubic(a, _, _, d) => (a, d),
    }
}
