//! The plot: one panel a scene, thickness and error on logarithmic axes, a line for every surface.

use crate::rows::Rows;
use crate::{Compared, SUBJECTS, SURFACES, THICKNESSES};
use glam::DVec2;
use pillarforest::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use pillarforest::diagram::lettering::Typeface;

/// Width of the picture in pixels, which are the drawing's unit.
pub(crate) const WIDTH: u32 = 1400;
const HEIGHT: f64 = 620.0;

/// Left ends of the panels' axes and their length, top and bottom of the axes.
const LEFT: [f64; 2] = [80.0, 770.0];
const LENGTH: f64 = 470.0;
const TOP: f64 = 120.0;
const BOTTOM: f64 = 520.0;

/// ErrorAxis that may have a line across, degrees.
const TICKS: [f64; 9] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 50.0];

const TEXT: Ink = Ink::new([0x22, 0x26, 0x2B]);
const QUIET: Ink = Ink::new([0x6F, 0x73, 0x78]);
const HAIR: Ink = Ink::new([0xDE, 0xDC, 0xD6]);
const PAPER: Ink = Ink::new([0xFF; 3]);
const LETTERS: f64 = 22.0;
/// Least distance of the baselines of two labels.
const LEADING: f64 = 27.0;

/// A text of the plot's size and regular face.
fn style(ink: Ink, anchor: Align) -> TextStyle {
    TextStyle {
        size: LETTERS,
        ink,
        face: Typeface::Regular,
        anchor,
        halo: None,
    }
}

/// The logarithmic axis of errors from one tick to another.
struct ErrorAxis {
    low: f64,
    high: f64,
}

impl ErrorAxis {
    /// The ticks around all figures.
    fn around(rows: &Rows) -> Self {
        let figures: Vec<f64> = SUBJECTS
            .iter()
            .flat_map(|s| lines(rows, s))
            .flatten()
            .map(|p| p.1)
            .collect();
        let below = |t: &&f64| figures.iter().all(|f| f >= t);
        let above = |t: &&f64| figures.iter().all(|f| f <= t);
        Self {
            low: TICKS.iter().rev().find(below).copied().unwrap_or(TICKS[0]),
            high: TICKS.iter().find(above).copied().unwrap_or(TICKS[8]),
        }
    }

    fn y(&self, error: f64) -> f64 {
        let share = (error / self.low).ln() / (self.high / self.low).ln();
        BOTTOM - share.clamp(0.0, 1.0) * (BOTTOM - TOP)
    }
}

/// Right of a panel's left end.
fn x(mm: f64) -> f64 {
    let [first, .., last] = THICKNESSES;
    LENGTH * (mm / first).ln() / (last / first).ln()
}

/// For every surface its thicknesses and errors.
fn lines(rows: &Rows, subject: &Compared) -> Vec<Vec<(f64, f64)>> {
    let point = |surface: &str, mm: f64| Some((mm, rows.average(subject.scene, surface, mm)?[0]));
    let line = |name| {
        THICKNESSES
            .iter()
            .filter_map(|mm| point(name, *mm))
            .collect()
    };
    SURFACES.iter().map(|s| line(s.name)).collect()
}

/// Draws all rows.
pub(crate) fn plot(rows: &Rows) -> Drawing {
    let mut drawing = Drawing::new(DVec2::new(f64::from(WIDTH), HEIGHT));
    let errors = ErrorAxis::around(rows);
    let heading = TextStyle {
        size: 26.0,
        ..style(TEXT, Align::Start)
    };
    drawing.text(
        DVec2::new(30.0, 40.0),
        "Mean error of the normals, degrees",
        heading,
    );
    for (subject, left) in SUBJECTS.iter().zip(LEFT) {
        axes(&mut drawing, &errors, left, subject.title);
        let lines = lines(rows, subject);
        for (surface, line) in SURFACES.iter().zip(&lines) {
            let at = |p: &(f64, f64)| DVec2::new(left + x(p.0), errors.y(p.1));
            let points: Vec<DVec2> = line.iter().map(at).collect();
            let ink = Ink::new(surface.colour);
            drawing.polyline(&points, Pen::new(ink, 3.5));
            let ring = Pen::new(PAPER, 2.0);
            points
                .iter()
                .for_each(|p| drawing.circle(*p, 6.5, Some(ink), Some(ring)));
        }
        labels(&mut drawing, &errors, left, &lines);
    }
    drawing
}

/// Lines across with their errors, thicknesses below.
fn axes(drawing: &mut Drawing, errors: &ErrorAxis, left: f64, title: &str) {
    let bold = TextStyle {
        face: Typeface::Bold,
        ..style(TEXT, Align::Start)
    };
    drawing.text(DVec2::new(left, TOP - 28.0), title, bold);
    for tick in TICKS
        .into_iter()
        .filter(|t| (errors.low..=errors.high).contains(t))
    {
        let y = errors.y(tick);
        let ends = [
            DVec2::new(left - 8.0, y),
            DVec2::new(left + LENGTH + 8.0, y),
        ];
        drawing.polyline(&ends, Pen::new(HAIR, 1.5));
        let at = DVec2::new(left - 18.0, y + 0.33 * LETTERS);
        drawing.text(at, &format!("{tick}°"), style(QUIET, Align::End));
    }
    for mm in THICKNESSES {
        let at = DVec2::new(left + x(mm), BOTTOM + 36.0);
        drawing.text(at, &mm.to_string(), style(QUIET, Align::Middle));
    }
    let at = DVec2::new(left + LENGTH / 2.0, BOTTOM + 74.0);
    drawing.text(
        at,
        "thickness of the layer, mm",
        style(QUIET, Align::Middle),
    );
}

/// Names of the surfaces beside the right ends of their lines, moved apart where they would touch.
fn labels(drawing: &mut Drawing, errors: &ErrorAxis, left: f64, lines: &[Vec<(f64, f64)>]) {
    let ends = SURFACES
        .iter()
        .zip(lines)
        .filter_map(|(s, l)| Some((errors.y(l.last()?.1), s)));
    let mut ends: Vec<_> = ends.collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Upwards from the lowest, which the axis below keeps in place.
    for k in (1..ends.len()).rev() {
        ends[k - 1].0 = ends[k - 1].0.min(ends[k].0 - LEADING);
    }
    for (y, surface) in ends {
        let at = DVec2::new(left + LENGTH + 20.0, y + 0.33 * LETTERS);
        let bold = TextStyle {
            face: Typeface::Bold,
            ..style(Ink::new(surface.colour), Align::Start)
        };
        drawing.text(at, surface.name, bold);
    }
}
