//! The lines along which a surface was torn, over a picture of what its eye sees of it, and what the caption says of them.

use crate::diagram::drawing::{Drawing, Ink, Mark, Pen, Verb};
use crate::geom::ImagePlane;
use crate::render::shading::mixed;
use crate::steps::{StepLine, StepSummary};
use glam::DVec2;

/// Colours of the lowest and the highest step: violets, which the error scale lacks; both stand out from its blues.
const LOW: [u8; 3] = [0xA9, 0x8B, 0xD6];
const HIGH: [u8; 3] = [0x2A, 0x0E, 0x66];

/// Shades between them. The lines of one shade are one shape, so that ends of short pieces do not darken each other.
const SHADES: usize = 8;

/// Width of the lines in hundredths of the panel's side: thin, so that errors between nearby lines stay in sight.
const WIDTH: f64 = 0.28;

/// Narrower ones would be painted piece by piece, pixels.
const LEAST_WIDTH_PX: f64 = 1.1;

/// A square panel of a picture, and the camera whose image fills it.
#[derive(Clone, Copy)]
pub(super) struct Panel {
    pub plane: ImagePlane,
    /// Tangent of half the field of view.
    pub half: f64,
    /// Top left corner and side in pixels.
    pub corner: DVec2,
    pub side: f64,
}

impl Panel {
    /// Where a line runs in the panel; `None` if it leaves it.
    fn place(&self, line: &StepLine) -> Option<[DVec2; 2]> {
        let [a, b] = line.ends.map(|end| {
            let q = self.plane.project(self.plane.eye + end)?;
            let inside = q.abs().max_element() <= self.half;
            let share = DVec2::new(q.x, -q.y) / self.half / 2.0 + 0.5;
            inside.then(|| self.corner + self.side * share)
        });
        a.zip(b).map(|(a, b)| [a, b])
    }
}

/// Draws the lines, the darker the higher they are beside the highest one.
pub(super) fn step_lines(drawing: &mut Drawing, lines: &[StepLine], panel: Panel) {
    let highest = lines.iter().map(height).fold(0.0, f64::max);
    let mut shades: [Vec<Verb>; SHADES] = Default::default();
    for line in lines {
        let Some([a, b]) = panel.place(line) else {
            continue;
        };
        // A height that is no number is drawn like none.
        let shade = (SHADES as f64 * height(line) / highest) as usize;
        shades[shade.min(SHADES - 1)].extend([Verb::Move(a), Verb::Line(b)]);
    }
    let width = (WIDTH * panel.side / 100.0).max(LEAST_WIDTH_PX);
    for (k, steps) in shades.into_iter().enumerate() {
        let colour = mixed(LOW, HIGH, k as f64 / (SHADES - 1) as f64);
        drawing.shapes.push(Mark {
            steps,
            fill: None,
            pen: Some(Pen::new(Ink::new(colour), width)),
            text: None,
        });
    }
}

/// Mean height of a piece of a line, millimetres.
fn height(line: &StepLine) -> f64 {
    (line.height_mm[0] + line.height_mm[1]) / 2.0
}

/// What the caption says of the lines.
pub(super) fn caption(lines: &[StepLine], summary: &StepSummary) -> String {
    let highest = summary.highest_mm;
    match summary.lines {
        _ if lines.is_empty() => "no steps".into(),
        // Slits: both of their sides belong to one piece.
        0 => format!("lines: steps up to {highest:.1} mm"),
        1 => format!("line: a step up to {highest:.1} mm"),
        n => format!("lines: {n} steps up to {highest:.1} mm"),
    }
}
