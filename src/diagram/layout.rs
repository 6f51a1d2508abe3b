//! `layout.svg`: where the pieces of a split forest go, at 1:1 for drilling and assembling.
//!
//! The page is as large as the forest with a margin; one unit is one millimetre. Base, cuts between plates with their pins, every
//! pillar's footprint with its number and a cross at its axis, where the eyes are, and a bar to check the print's scale by.

use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::finished::Plan;
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::page::{BASE, HAIR, PAPER, QUIET, TEXT, deep, length};
use crate::split::Split;
use crate::support::{Support, SupportKind};
use crate::view::View;
use glam::DVec2;

/// Around the forest, and below it for bar and notes, millimetres.
const MARGIN: f64 = 24.0;
const FOOT: f64 = 16.0;
/// The bar's length, millimetres.
const BAR: f64 = 50.0;
/// Narrowest page: bar and words fit, millimetres.
const NARROWEST: f64 = 120.0;
/// Lines, millimetres.
const FINE: f64 = 0.15;
/// Sizes of letters, millimetres.
const TITLE: f64 = 5.0;
const SMALL: f64 = 2.8;
/// Half a cross, millimetres.
const CROSS: f64 = 1.5;

/// From the scene to the page.
struct Template {
    lo: DVec2,
    hi: DVec2,
    size: DVec2,
}

impl Template {
    fn new(supports: &[Support]) -> Self {
        let points = || supports.iter().flat_map(|s| s.outline().iter().copied());
        let lo = points().reduce(DVec2::min).unwrap_or_default();
        let hi = points().reduce(DVec2::max).unwrap_or_default();
        let short = (NARROWEST - 2.0 * MARGIN - (hi.x - lo.x)).max(0.0) / 2.0;
        let (lo, hi) = (lo - DVec2::new(short, 0.0), hi + DVec2::new(short, 0.0));
        let size = hi - lo + 2.0 * MARGIN + DVec2::new(0.0, FOOT + TITLE);
        Self { lo, hi, size }
    }

    fn at(&self, p: DVec2) -> DVec2 {
        DVec2::new(p.x - self.lo.x + MARGIN, self.hi.y - p.y + MARGIN + TITLE)
    }
}

/// Draws the sheet.
pub fn layout(title: &str, views: &[View], supports: &[Support], split: &Split) -> Plan {
    let sheet = Template::new(supports);
    let mut drawing = Drawing::new(sheet.size);
    drawing.rect(DVec2::ZERO, sheet.size, Some(PAPER), None);
    let heading = style(TITLE, TEXT, Align::Start).fitting(title, sheet.size.x - MARGIN);
    drawing.text(DVec2::new(MARGIN / 2.0, MARGIN / 2.0), title, heading);
    base(&mut drawing, &sheet, supports);
    cuts(&mut drawing, &sheet, split);
    pillars(&mut drawing, &sheet, supports, split);
    eyes(&mut drawing, &sheet, views);
    bar(&mut drawing, &sheet);
    Plan {
        title: format!("{title}: layout"),
        drawing,
    }
}

fn style(size: f64, ink: Ink, anchor: Align) -> TextStyle {
    TextStyle::new(size, Typeface::Regular, ink, anchor)
}

fn base(drawing: &mut Drawing, sheet: &Template, supports: &[Support]) {
    let bases = supports
        .iter()
        .filter(|s| matches!(s.kind, SupportKind::Base { .. }));
    for support in bases {
        let points: Vec<DVec2> = support.outline().iter().map(|p| sheet.at(*p)).collect();
        drawing.polygon(&points, Some(BASE), Some(Pen::new(TEXT, 2.0 * FINE)));
    }
}

fn cuts(drawing: &mut Drawing, sheet: &Template, split: &Split) {
    let pen = Pen::new(TEXT, 2.0 * FINE).dashed(2.0, 1.2);
    // A little beyond the base, so that they can be told from what is engraved on it.
    let (lo, hi) = (sheet.lo - 3.0, sheet.hi + 3.0);
    for x in &split.cuts.x {
        let ends = [DVec2::new(*x, lo.y), DVec2::new(*x, hi.y)];
        drawing.polyline(&ends.map(|p| sheet.at(p)), pen);
    }
    for y in &split.cuts.y {
        let ends = [DVec2::new(lo.x, *y), DVec2::new(hi.x, *y)];
        drawing.polyline(&ends.map(|p| sheet.at(p)), pen);
    }
    for pin in &split.pins {
        let (a, b) = pin.outline();
        let (a, b) = (sheet.at(a), sheet.at(b));
        drawing.rect(a.min(b), a.max(b), Some(HAIR), Some(Pen::new(QUIET, FINE)));
    }
}

fn pillars(drawing: &mut Drawing, sheet: &Template, supports: &[Support], split: &Split) {
    let pen = Pen::new(TEXT, FINE);
    for socket in &split.sockets {
        let SupportKind::Pillar { axis, profile, .. } = &supports[socket.support].kind else {
            continue;
        };
        let points: Vec<DVec2> = profile.iter().map(|p| sheet.at(*p)).collect();
        drawing.polygon(&points, Some(PAPER), Some(Pen::new(TEXT, 2.0 * FINE)));
        if let Some(key) = socket.key {
            drawing.polyline(&key.map(|p| sheet.at(p)), pen);
        }
        let middle = sheet.at(*axis);
        for way in [DVec2::X, DVec2::Y] {
            drawing.polyline(&[middle - CROSS * way, middle + CROSS * way], pen);
        }
        let text = socket.number.to_string();
        let reach = profile
            .iter()
            .map(|p| p.distance(*axis))
            .fold(0.0, f64::max);
        match socket.label {
            // Where it is engraved, as high as it is there.
            Some(label) => {
                let size = (5.0 * label.stroke / 0.7).min(1.1 * reach + 2.0);
                let at = sheet.at(label.middle) + DVec2::new(0.0, 0.35 * size);
                drawing.text(at, &text, style(size, TEXT, Align::Middle));
            }
            None => {
                let size = reach.clamp(1.2, 4.0);
                let at = middle + DVec2::new(0.35 * reach, -0.2 * reach);
                drawing.text(at, &text, style(size, TEXT, Align::Start));
            }
        }
    }
}

/// An arrow for each eye, at the rim, towards what it looks at.
fn eyes(drawing: &mut Drawing, sheet: &Template, views: &[View]) {
    let (centre, half) = ((sheet.lo + sheet.hi) / 2.0, (sheet.hi - sheet.lo) / 2.0);
    for view in views {
        let away = (view.eye - view.look_at).truncate();
        let Some(way) = away.try_normalize() else {
            continue;
        };
        // Where the ray from the middle leaves the forest's box.
        let reach = (half / way.abs()).min_element();
        let tip = sheet.at(centre + (reach + 2.5) * way);
        let back = DVec2::new(way.x, -way.y);
        let ink = deep(view.colour, 0.2);
        drawing.polyline(&[tip + back, tip + 7.0 * back], Pen::new(ink, 0.6));
        let side = 1.3 * back.perp();
        let head = [tip, tip + 2.6 * back + side, tip + 2.6 * back - side];
        drawing.polygon(&head, Some(ink), None);
        let distance = match view.orthographic {
            true => "parallel rays".to_owned(),
            false => length(view.eye.truncate().distance(centre)),
        };
        let text = format!("{} {distance}", view.name);
        let half = width(&text, SMALL, Typeface::Regular) / 2.0;
        // Beside an upright arrow, beyond one that lies.
        let at = if way.x.abs() < 0.7 {
            tip + 5.0 * back + DVec2::new(half + 2.0, 1.0)
        } else {
            tip + 5.0 * back + DVec2::new(0.0, -2.0)
        };
        let room = half + 1.0;
        let at = DVec2::new(at.x.clamp(room, (sheet.size.x - room).max(room)), at.y);
        let words = style(SMALL, ink, Align::Middle).lifted(PAPER);
        drawing.text(at, &text, words);
    }
}

fn bar(drawing: &mut Drawing, sheet: &Template) {
    let start = DVec2::new(MARGIN / 2.0, sheet.size.y - 7.0);
    let pen = Pen::new(TEXT, 2.0 * FINE);
    drawing.polyline(&[start, start + BAR * DVec2::X], pen);
    for k in 0..=5 {
        let at = start + f64::from(k) * BAR / 5.0 * DVec2::X;
        drawing.polyline(&[at, at - 1.5 * DVec2::Y], pen);
    }
    let words = start + DVec2::new(BAR + 3.0, 0.0);
    drawing.text(
        words,
        &format!("{BAR} mm; print at 100 %, from above, y up"),
        style(SMALL, QUIET, Align::Start),
    );
}
