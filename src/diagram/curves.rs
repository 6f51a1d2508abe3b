//! The plot of camouflage: how much of its likeness every view keeps at which angle from its eye.
//!
//! Takes a curve for each view, gives a display list, one unit a millimetre. Values are drawn relative to a curve's first point,
//! the view's own eye, so that one line is half of all of them. The axis of angles is linear near 0 and logarithmic
//! beyond [`KNEE_DEG`]: a likeness is mostly lost within few degrees, and what returns returns far from there.

use crate::diagram::drawing::{Align, Drawing, Pen, TextStyle};
use crate::diagram::lettering::Typeface;
use crate::diagram::page::{HAIR, PAPER, QUIET, TEXT, deep};
use glam::DVec2;

/// One view.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pub name: String,
    /// sRGB.
    pub colour: [u8; 3],
    /// Angle in degrees and value, by rising angle from 0.
    pub points: Vec<(f64, f64)>,
    /// Where the value has fallen to half the first.
    pub half_deg: Option<f64>,
    /// Angle and value of the largest beyond that.
    pub worst: Option<(f64, f64)>,
}

/// Page and frame of the plot, millimetres.
const PAGE: f64 = 200.0;
const LEFT: f64 = 20.0;
const RIGHT: f64 = 194.0;
const TOP: f64 = 25.0;
const BOTTOM: f64 = 113.0;
/// Top of the table below, height of a row, and room below the last one.
const TABLE: f64 = 138.0;
const ROW: f64 = 5.6;
const BELOW: f64 = 5.0;

const TICKS_DEG: [f64; 9] = [0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 90.0, 180.0];
/// Where the axis of angles turns from linear to logarithmic, degrees.
const KNEE_DEG: f64 = 2.0;
/// Columns of the table: name, then the right edges of likeness at the eye, half angle, worst angle, likeness there.
const COLUMNS: [f64; 5] = [28.0, 98.0, 124.0, 159.0, 194.0];

/// Draws all curves under a title.
pub fn curves(title: &str, list: &[Curve]) -> Drawing {
    let height = TABLE + ROW * list.len() as f64 + BELOW;
    let mut drawing = Drawing::new(DVec2::new(PAGE, height));
    drawing.rect(DVec2::ZERO, drawing.size, Some(PAPER), None);
    let head =
        TextStyle::new(6.4, Typeface::Regular, TEXT, Align::Start).fitting(title, PAGE - 18.0);
    drawing.text(DVec2::new(12.0, 12.0), title, head);
    drawing.text(
        DVec2::new(12.0, 18.5),
        "How like its model the forest is to eyes that stand elsewhere, relative to the view's own eye",
        TextStyle::new(3.4, Typeface::Light, QUIET, Align::Start),
    );
    let tallest = list.iter().flat_map(relative).map(|p| p.1);
    let scale = DegreeScale {
        top: tallest.fold(1.0, f64::max),
    };
    frame(&mut drawing, &scale);
    for curve in list {
        draw_curve(&mut drawing, &scale, curve);
    }
    table(&mut drawing, list);
    drawing
}

/// Where values lie on the page.
struct DegreeScale {
    /// The largest value shown.
    top: f64,
}

impl DegreeScale {
    fn place(&self, deg: f64, value: f64) -> DVec2 {
        let along = (deg / KNEE_DEG).ln_1p() / (180.0 / KNEE_DEG).ln_1p();
        DVec2::new(
            LEFT + along * (RIGHT - LEFT),
            BOTTOM - value / self.top * (BOTTOM - TOP),
        )
    }
}

/// Points with values relative to the first; none if that is nothing.
fn relative(curve: &Curve) -> Vec<(f64, f64)> {
    let own = curve.points.first().map_or(0.0, |p| p.1);
    if own <= 0.0 {
        return Vec::new();
    }
    curve.points.iter().map(|p| (p.0, p.1 / own)).collect()
}

fn frame(drawing: &mut Drawing, scale: &DegreeScale) {
    let label = TextStyle::new(3.2, Typeface::Light, QUIET, Align::Middle);
    for deg in TICKS_DEG {
        let (foot, head) = (scale.place(deg, 0.0), scale.place(deg, scale.top));
        drawing.polyline(&[foot, head], Pen::new(HAIR, 0.15));
        drawing.text(foot + DVec2::new(0.0, 5.0), &format!("{deg:.0}°"), label);
    }
    for tenth in (0..=10).step_by(2) {
        let value = f64::from(tenth) / 10.0;
        let (start, end) = (scale.place(0.0, value), scale.place(180.0, value));
        drawing.polyline(&[start, end], Pen::new(HAIR, 0.15));
        drawing.text(
            start + DVec2::new(-2.0, 1.1),
            &format!("{} %", 10 * tenth),
            TextStyle {
                anchor: Align::End,
                ..label
            },
        );
    }
    let half = [scale.place(0.0, 0.5), scale.place(180.0, 0.5)];
    drawing.polyline(&half, Pen::new(TEXT, 0.3).dashed(1.6, 1.4));
    drawing.text(
        half[0] + DVec2::new(1.2, -1.4),
        "half",
        TextStyle {
            ink: TEXT,
            anchor: Align::Start,
            ..label
        },
    );
    let below = DVec2::new((LEFT + RIGHT) / 2.0, BOTTOM + 10.5);
    drawing.text(
        below,
        "angle from the view's eye, about the model's middle",
        label,
    );
}

fn draw_curve(drawing: &mut Drawing, scale: &DegreeScale, curve: &Curve) {
    let points = relative(curve);
    let line: Vec<DVec2> = points.iter().map(|p| scale.place(p.0, p.1)).collect();
    let ink = deep(curve.colour, 0.05);
    drawing.polyline(&line, Pen::new(ink, 0.7));
    for at in &line {
        drawing.circle(*at, 0.75, Some(ink), None);
    }
    let paper = Some(PAPER);
    if let Some(half) = curve.half_deg {
        let rim = Some(Pen::new(ink, 0.6));
        drawing.circle(scale.place(half, 0.5), 1.5, paper, rim);
    }
    let worst = curve
        .worst
        .and_then(|(deg, _)| points.iter().find(|p| p.0 == deg));
    if let Some((deg, value)) = worst {
        let at = scale.place(*deg, *value);
        let corner = |x: f64, y: f64| at + DVec2::new(x, y);
        let diamond = [
            corner(0.0, -2.1),
            corner(2.1, 0.0),
            corner(0.0, 2.1),
            corner(-2.1, 0.0),
        ];
        drawing.polygon(&diamond, paper, Some(Pen::new(ink, 0.6)));
    }
}

fn table(drawing: &mut Drawing, list: &[Curve]) {
    let head = TextStyle::new(3.0, Typeface::Light, QUIET, Align::End);
    let y = TABLE - 4.5;
    let titles = [
        "likeness at the eye",
        "○ half of it at",
        "◇ most of it beyond at",
        "likeness there",
    ];
    for (x, text) in COLUMNS[1..].iter().zip(titles) {
        drawing.text(DVec2::new(*x, y), text, head);
    }
    let or_never = |x: Option<String>| x.unwrap_or_else(|| "never".into());
    for (k, curve) in list.iter().enumerate() {
        let y = TABLE + ROW * k as f64 + 1.0;
        let ink = deep(curve.colour, 0.05);
        let (start, end) = (DVec2::new(12.0, y - 1.2), DVec2::new(24.0, y - 1.2));
        drawing.polyline(&[start, end], Pen::new(ink, 0.9));
        drawing.circle((start + end) / 2.0, 0.9, Some(ink), None);
        let name =
            TextStyle::new(3.6, Typeface::Regular, TEXT, Align::Start).fitting(&curve.name, 42.0);
        drawing.text(DVec2::new(COLUMNS[0], y), &curve.name, name);
        let own = curve.points.first().map_or(0.0, |p| p.1);
        let cells = [
            format!("{own:.2}"),
            or_never(curve.half_deg.map(|a| format!("{a:.1}°"))),
            or_never(curve.worst.map(|w| format!("{:.0}°", w.0))),
            or_never(curve.worst.map(|w| format!("{:.2}", w.1))),
        ];
        for (x, text) in COLUMNS[1..].iter().zip(cells) {
            let body = TextStyle::new(3.4, Typeface::Light, TEXT, Align::End);
            drawing.text(DVec2::new(*x, y), &text, body);
        }
    }
}
