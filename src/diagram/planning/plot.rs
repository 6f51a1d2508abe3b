//! Camouflage against eye tolerance: what one costs the other.

use super::words;
use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::page::{HAIR, PAPER, QUIET, TEXT};
use crate::planner::{Brief, Planned, Trade};
use glam::DVec2;

/// The plot's own page, millimetres.
const PAGE: DVec2 = DVec2::new(200.0, 140.0);
const AXES: [DVec2; 2] = [DVec2::new(24.0, 32.0), DVec2::new(190.0, 120.0)];
/// Tolerances whose largest is this many times the smallest are drawn on a logarithmic axis.
const WIDE: f64 = 6.0;
/// An axis shows at least this share of its largest value: differences of rounding are none.
pub(crate) const LEAST_SPAN: f64 = 0.25;
/// The line, and what is chosen: Okabe and Ito's blue and vermilion.
const LINE: Ink = Ink::new([0x00, 0x72, 0xB2]);
const CHOSEN: Ink = Ink::new([0xD5, 0x5E, 0x00]);

pub(crate) fn page(title: &str, brief: &Brief, planned: &Planned) -> Drawing {
    let mut drawing = Drawing::new(PAGE);
    drawing.rect(DVec2::ZERO, PAGE, Some(PAPER), None);
    let head =
        TextStyle::new(6.4, Typeface::Regular, TEXT, Align::Start).fitting(title, PAGE.x - 20.0);
    drawing.text(DVec2::new(10.0, 12.0), title, head);
    let line = format!(
        "What camouflage costs: the best forecast found at every tolerance of the eye, {} layouts tried",
        words::count(planned.tries)
    );
    let style = TextStyle::new(3.4, Typeface::Light, QUIET, Align::Start);
    drawing.text(
        DVec2::new(10.0, 18.5),
        &line,
        style.fitting(&line, PAGE.x - 20.0),
    );
    draw(&mut drawing, AXES, 3.2, brief, planned);
    drawing
}

/// An axis: what it shows, and where it is marked.
struct Axis {
    from: f64,
    to: f64,
    log: bool,
    ticks: Vec<f64>,
}

impl Axis {
    /// Some room beyond the values, rounded to ticks.
    fn new(values: &[f64], may_be_log: bool) -> Self {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if may_be_log && least > 0.0 && most > WIDE * least {
            let (from, to) = (least / 1.25, most * 1.4);
            let powers = from.log10().floor() as i32..=to.log10().ceil() as i32;
            let ticks = powers.flat_map(|p| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(p)));
            let ticks = ticks.filter(|t| from <= *t && *t <= to).collect();
            return Self {
                from,
                to,
                log: true,
                ticks,
            };
        }
        let span = (most - least).max(LEAST_SPAN * most.abs()).max(1e-3);
        let rough = span / 4.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|m| m * power)
            .into_iter()
            .find(|s| *s >= rough);
        let step = step.unwrap_or(rough);
        let first = ((least - 0.1 * span) / step).floor().max(0.0) as i64;
        let last = ((most + 0.1 * span) / step).ceil() as i64;
        let ticks: Vec<f64> = (first..=last).map(|k| k as f64 * step).collect();
        Self {
            from: first as f64 * step,
            to: last.max(first + 1) as f64 * step,
            log: false,
            ticks,
        }
    }

    /// 0 to 1.
    fn share(&self, x: f64) -> f64 {
        if self.log {
            (x / self.from).ln() / (self.to / self.from).ln()
        } else {
            (x - self.from) / (self.to - self.from)
        }
    }
}

/// Both axes on the page.
struct Axes {
    x: Axis,
    y: Axis,
    area: [DVec2; 2],
}

impl Axes {
    fn place(&self, tolerance: f64, hidden: f64) -> DVec2 {
        let [lo, hi] = self.area;
        DVec2::new(
            lo.x + self.x.share(tolerance).clamp(0.0, 1.0) * (hi.x - lo.x),
            hi.y - self.y.share(hidden).clamp(0.0, 1.0) * (hi.y - lo.y),
        )
    }
}

/// The plot, its axes at the edges of `area`; letters as large as `size` stand left of it and below.
pub(crate) fn draw(
    drawing: &mut Drawing,
    area: [DVec2; 2],
    size: f64,
    brief: &Brief,
    planned: &Planned,
) {
    let finite = |t: &&Trade| t.tolerance_mm.is_finite() && t.hidden_deg.is_finite();
    let trade: Vec<Trade> = planned.trade.iter().filter(finite).copied().collect();
    let label = TextStyle::new(size, Typeface::Light, QUIET, Align::Middle);
    if trade.is_empty() {
        let pen = Pen::new(HAIR, 0.2);
        drawing.rect(area[0], area[1], None, Some(pen));
        drawing.text((area[0] + area[1]) / 2.0, "no layouts to compare", label);
        return;
    }
    let start = start(planned);
    let of =
        |value: fn(&Trade) -> f64| -> Vec<f64> { trade.iter().chain(&start).map(value).collect() };
    let frame = Axes {
        x: Axis::new(&of(|t| t.tolerance_mm), true),
        y: Axis::new(&of(|t| t.hidden_deg), false),
        area,
    };
    axes(drawing, &frame, label, brief);
    wanted(drawing, &frame, label, brief);
    stairs(drawing, &frame, &trade, size);
    if let Some(start) = start {
        mark(drawing, &frame, &start, "start", size, false);
    }
    for (k, chosen) in trade.iter().filter(|t| t.chosen).enumerate() {
        let text = format!(
            "chosen: {} at {}",
            words::degrees(chosen.hidden_deg),
            words::millimetres(chosen.tolerance_mm)
        );
        mark(
            drawing,
            &frame,
            chosen,
            if k == 0 { &text } else { "" },
            size,
            true,
        );
    }
}

/// The layout before the search, if it was one without faults and another than the one chosen.
fn start(planned: &Planned) -> Option<Trade> {
    let first = planned
        .frames
        .first()
        .filter(|_| planned.frames.len() > 1)?;
    let good =
        first.faults.is_empty() && first.tolerance_mm.is_finite() && first.hidden_deg.is_finite();
    good.then_some(Trade {
        tolerance_mm: first.tolerance_mm,
        hidden_deg: first.hidden_deg,
        chosen: false,
    })
}

fn axes(drawing: &mut Drawing, frame: &Axes, label: TextStyle, brief: &Brief) {
    let [lo, hi] = frame.area;
    let hair = Pen::new(HAIR, 0.15);
    for tick in &frame.x.ticks {
        let x = frame.place(*tick, frame.y.from).x;
        drawing.polyline(&[DVec2::new(x, lo.y), DVec2::new(x, hi.y)], hair);
        drawing.text(
            DVec2::new(x, hi.y + 1.45 * label.size),
            &plain(*tick),
            label,
        );
    }
    for tick in &frame.y.ticks {
        let y = frame.place(frame.x.from, *tick).y;
        drawing.polyline(&[DVec2::new(lo.x, y), DVec2::new(hi.x, y)], hair);
        let at = DVec2::new(lo.x - 0.6 * label.size, y + 0.35 * label.size);
        drawing.text(
            at,
            &format!("{}°", plain(*tick)),
            label.anchored(Align::End),
        );
    }
    let below = DVec2::new((lo.x + hi.x) / 2.0, hi.y + 3.1 * label.size);
    let scale = if frame.x.log { ", logarithmic" } else { "" };
    drawing.text(below, &format!("tolerance of the eye in mm{scale}"), label);
    let above = DVec2::new(lo.x - 3.6 * label.size, lo.y - 1.1 * label.size);
    let text = format!("forecast error {} off, worst view", words::angle(brief));
    drawing.text(above, &text, label.anchored(Align::Start));
}

/// A number without zeros that say nothing.
fn plain(x: f64) -> String {
    let rounded = (1000.0 * x).round() / 1000.0;
    format!("{rounded}")
}

/// The least tolerance that was asked for, where all views have the same.
fn wanted(drawing: &mut Drawing, frame: &Axes, label: TextStyle, brief: &Brief) {
    let least = brief
        .tolerance_mm
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    if !(frame.x.from < least && least < frame.x.to) {
        return;
    }
    let (head, foot) = (
        frame.place(least, frame.y.to),
        frame.place(least, frame.y.from),
    );
    let pen = Pen::new(QUIET, 0.25).dashed(1.2, 1.2);
    drawing.polyline(&[head, foot], pen);
    let at = foot + label.size * DVec2::new(0.4, -0.5);
    drawing.text(
        at,
        "wanted at least",
        label.anchored(Align::Start).lifted(PAPER),
    );
}

/// Tolerances up to a point's have its forecast or a better one.
fn stairs(drawing: &mut Drawing, frame: &Axes, trade: &[Trade], size: f64) {
    let mut line = vec![frame.place(frame.x.from, trade[0].hidden_deg)];
    for (k, t) in trade.iter().enumerate() {
        line.push(frame.place(t.tolerance_mm, t.hidden_deg));
        let next = trade.get(k + 1).map_or(frame.y.from, |n| n.hidden_deg);
        line.push(frame.place(t.tolerance_mm, next));
    }
    let mut below = line.clone();
    below.push(frame.place(frame.x.from, frame.y.from));
    drawing.polygon(&below, Some(LINE.fade(0.1)), None);
    drawing.polyline(&line, Pen::new(LINE, 0.14 * size));
    for t in trade {
        drawing.circle(
            frame.place(t.tolerance_mm, t.hidden_deg),
            0.24 * size,
            Some(LINE),
            None,
        );
    }
}

/// A diamond for what is chosen, a ring for the start, and words beside it, up to the right where nothing is.
fn mark(drawing: &mut Drawing, frame: &Axes, trade: &Trade, text: &str, size: f64, chosen: bool) {
    let at = frame.place(trade.tolerance_mm, trade.hidden_deg);
    let r = 0.62 * size;
    let style = TextStyle::new(1.05 * size, Typeface::Regular, TEXT, Align::Start).lifted(PAPER);
    if chosen {
        let corners = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(|d| at + 1.2 * r * d);
        drawing.polygon(&corners, Some(PAPER), Some(Pen::new(CHOSEN, 0.18 * size)));
        drawing.circle(at, 0.28 * size, Some(CHOSEN), None);
    } else {
        drawing.circle(at, 0.8 * r, Some(PAPER), Some(Pen::new(QUIET, 0.16 * size)));
    }
    let wide = width(text, style.size, style.face);
    let up = if chosen { -1.3 } else { 1.7 };
    let beside = at + DVec2::new(1.4 * r, up * r + 0.2 * size);
    let room = frame.area[1].x - wide;
    drawing.text(
        DVec2::new(
            beside.x.min(room).max(frame.area[0].x),
            beside.y.max(frame.area[0].y + size),
        ),
        text,
        style,
    );
}
