//! Drawings as SVG text: one unit is one millimetre on paper.

use crate::diagram::drawing::{Drawing, Ink, Mark, Verb};
use crate::formats::markup::escaped;
use glam::DVec2;
use std::fmt::Write as _;

impl Drawing {
    /// The page as an SVG document. Letters are paths, each line of text labelled with what it says.
    pub fn svg(&self, title: &str) -> String {
        let mut svg = opening(self.size, title);
        self.shapes
            .iter()
            .for_each(|shape| push_shape(&mut svg, shape));
        svg.push_str(CLOSING);
        svg
    }
}

/// A document up to its first shape; [`CLOSING`] ends it.
pub(crate) fn opening(size: DVec2, title: &str) -> String {
    let (w, h) = (number(size.x), number(size.y));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\">\n"
    );
    _ = writeln!(svg, "<title>{}</title>", escaped(title));
    svg.push_str("<g stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
    svg
}

pub(crate) const CLOSING: &str = "</g>\n</svg>\n";

pub(crate) fn push_shape(svg: &mut String, shape: &Mark) {
    svg.push_str("<path");
    push_ink(svg, "fill", shape.fill);
    if let Some(pen) = shape.pen {
        push_ink(svg, "stroke", Some(pen.ink));
        _ = write!(svg, " stroke-width=\"{}\"", number(pen.width));
        if let Some([dash, gap]) = pen.dash {
            _ = write!(
                svg,
                " stroke-dasharray=\"{} {}\"",
                number(dash),
                number(gap)
            );
        }
    }
    if let Some(text) = &shape.text {
        _ = write!(svg, " aria-label=\"{}\"", escaped(text));
    }
    svg.push_str(" d=\"");
    shape.steps.iter().for_each(|step| push_step(svg, *step));
    svg.push_str("\"/>\n");
}

fn push_ink(svg: &mut String, attribute: &str, ink: Option<Ink>) {
    let Some(Ink {
        rgb: [r, g, b],
        alpha,
    }) = ink
    else {
        _ = write!(svg, " {attribute}=\"none\"");
        return;
    };
    _ = write!(svg, " {attribute}=\"#{r:02x}{g:02x}{b:02x}\"");
    if alpha < 1.0 {
        _ = write!(svg, " {attribute}-opacity=\"{}\"", number(alpha));
    }
}

fn push_step(svg: &mut String, step: Verb) {
    let mut put = |letter: char, points: &[DVec2]| {
        svg.push(letter);
        for (k, p) in points.iter().enumerate() {
            let gap = if k > 0 { " " } else { "" };
            _ = write!(svg, "{gap}{} {}", number(p.x), number(p.y));
        }
    };
    match step {
        Verb::Move(p) => put('M', &[p]),
        Verb::Line(p) => put('L', &[p]),
        Verb::Quad(a, p) => put('Q', &[a, p]),
        Verb::Cubic(a, b, p) => put('C', &[a, b, p]),
        Verb::Close => put('Z', &[]),
    }
}

/// A thousandth of a unit is enough for any printer; trailing zeros and -0 are left out.
pub(crate) fn number(x: f64) -> String {
    let text = format!("{:.3}", if x.is_finite() { x } else { 0.0 });
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
