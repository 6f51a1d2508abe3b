//! A line chart: one axis of positive numbers across, logarithmic, and values from zero upwards.

use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::lettering::Typeface;
use crate::diagram::page::{HAIR, PAPER, QUIET, TEXT};
use glam::DVec2;

/// What a chart shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What the values are, with their unit.
    pub title: String,
    /// What goes across, with its unit.
    pub across: String,
    pub lines: Vec<Line>,
}

/// One line of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub name: String,
    /// sRGB.
    pub colour: [u8; 3],
    /// Positive numbers and values.
    pub points: Vec<(f64, f64)>,
}

/// Page, millimetres, and corners of the axes.
const PAGE: DVec2 = DVec2::new(160.0, 100.0);
const AXES: [DVec2; 2] = [DVec2::new(16.0, 20.0), DVec2::new(118.0, 84.0)];
const LETTERS: f64 = 3.6;
/// Least distance of the baselines of two names.
const LEADING: f64 = 4.6;
/// Lines across, at most.
const TICKS: f64 = 6.0;

/// Draws it, one unit a millimetre.
pub fn chart(chart: &Chart) -> Drawing {
    let mut drawing = Drawing::new(PAGE);
    drawing.rect(DVec2::ZERO, PAGE, Some(PAPER), None);
    let head = TextStyle::new(4.6, Typeface::Regular, TEXT, Align::Start);
    drawing.text(DVec2::new(8.0, 10.0), &chart.title, head);
    let scale = Grid::of(chart);
    scale.draw(&mut drawing, &chart.across);
    for line in &chart.lines {
        let ink = Ink::new(line.colour);
        let points: Vec<DVec2> = line.points.iter().map(|p| scale.at(*p)).collect();
        drawing.polyline(&points, Pen::new(ink, 0.6));
        let rim = Some(Pen::new(PAPER, 0.35));
        points
            .iter()
            .for_each(|p| drawing.circle(*p, 1.1, Some(ink), rim));
    }
    names(&mut drawing, &scale, &chart.lines);
    drawing
}

struct Grid {
    /// Numbers across that occur, rising.
    numbers: Vec<f64>,
    /// Distance of the lines across, and how many there are.
    tick: f64,
    ticks: usize,
}

impl Grid {
    fn of(chart: &Chart) -> Self {
        let points = || chart.lines.iter().flat_map(|l| &l.points);
        let mut numbers: Vec<f64> = points().map(|p| p.0).collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup();
        let most = points().map(|p| p.1).fold(0.0, f64::max).max(1e-9);
        let power = 10f64.powf((most / TICKS).log10().floor());
        let wide_enough = |m: &f64| most / (m * power) <= TICKS;
        let tick = power
            * [1.0, 2.0, 5.0, 10.0]
                .into_iter()
                .find(wide_enough)
                .unwrap_or(10.0);
        Self {
            numbers,
            tick,
            ticks: (most / tick).ceil() as usize,
        }
    }

    fn x(&self, number: f64) -> f64 {
        let [first, last] =
            [self.numbers.first(), self.numbers.last()].map(|n| n.copied().unwrap_or(1.0));
        let share = match last > first {
            true => (number / first).ln() / (last / first).ln(),
            false => 0.5,
        };
        AXES[0].x + share * (AXES[1].x - AXES[0].x)
    }

    fn y(&self, value: f64) -> f64 {
        let share = value / (self.tick * self.ticks as f64);
        AXES[1].y - share * (AXES[1].y - AXES[0].y)
    }

    fn at(&self, point: (f64, f64)) -> DVec2 {
        DVec2::new(self.x(point.0), self.y(point.1))
    }

    fn draw(&self, drawing: &mut Drawing, across: &str) {
        let style = |anchor| TextStyle::new(LETTERS, Typeface::Regular, QUIET, anchor);
        for k in 0..=self.ticks {
            // Rounded: sums of a tenth are not tenths.
            let value = (self.tick * k as f64 * 1e6).round() / 1e6;
            let y = self.y(value);
            let ends = [
                DVec2::new(AXES[0].x - 2.0, y),
                DVec2::new(AXES[1].x + 2.0, y),
            ];
            drawing.polyline(&ends, Pen::new(HAIR, 0.2));
            let at = DVec2::new(AXES[0].x - 3.5, y + 0.33 * LETTERS);
            drawing.text(at, &value.to_string(), style(Align::End));
        }
        for number in &self.numbers {
            let at = DVec2::new(self.x(*number), AXES[1].y + 6.0);
            drawing.text(at, &number.to_string(), style(Align::Middle));
        }
        let at = DVec2::new((AXES[0].x + AXES[1].x) / 2.0, AXES[1].y + 12.0);
        drawing.text(at, across, style(Align::Middle));
    }
}

/// Names of the lines beside their right ends, moved apart where they would touch.
fn names(drawing: &mut Drawing, scale: &Grid, lines: &[Line]) {
    let right = |line: &Line| {
        let ends = line.points.iter().copied();
        ends.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let ends = lines.iter().filter_map(|l| Some((scale.y(right(l)?.1), l)));
    let mut ends: Vec<(f64, &Line)> = ends.collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Upwards from the lowest, which the axis below keeps in place.
    for k in (1..ends.len()).rev() {
        ends[k - 1].0 = ends[k - 1].0.min(ends[k].0 - LEADING);
    }
    for (y, line) in ends {
        let style = TextStyle::new(LETTERS, Typeface::Bold, Ink::new(line.colour), Align::Start);
        let style = style.fitting(&line.name, PAGE.x - AXES[1].x - 8.0);
        let at = DVec2::new(AXES[1].x + 5.0, y + 0.33 * LETTERS);
        drawing.text(at, &line.name, style);
    }
}
