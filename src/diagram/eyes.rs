//! Eyes on a map: symbols, arrows towards what they look at, names where there is room.

use crate::diagram::drawing::{Align, Drawing, Ink, Mark, Pen, Verb};
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::page::{PAPER, Page, QUIET, TEXT, deep, length};
use crate::view::View;
use glam::DVec2;

/// Half the width of the eye symbol, layout units.
const EYE: f64 = 4.0;

/// All eyes with their names. `rooms` are how far they may move, `numbers` stand before the names; both may be empty.
pub(crate) fn eyes(
    drawing: &mut Drawing,
    page: &Page,
    views: &[View],
    rooms: &[Option<f64>],
    numbers: &[String],
) {
    let stands: Vec<(DVec2, bool)> = views.iter().map(|v| page.stand(v.eye.truncate())).collect();
    let way = |(v, s): (&View, &(DVec2, bool))| {
        let from = if v.orthographic {
            v.eye.truncate()
        } else {
            s.0
        };
        page.place(v.look_at.truncate()) - page.place(from)
    };
    let ways: Vec<DVec2> = views.iter().zip(&stands).map(way).collect();
    let ways: Vec<DVec2> = ways.into_iter().map(DVec2::normalize_or_zero).collect();
    let mut taken: Vec<Rectangle> = Vec::new();
    let room = |k: usize| rooms.get(k).copied().flatten();
    for (k, ((stand, _), ahead)) in stands.iter().zip(&ways).enumerate() {
        let at = page.place(*stand);
        taken.push(Rectangle::around(at, DVec2::new(EYE, 0.7 * EYE) * page.u));
        taken.extend(room(k).map(|r| Rectangle::around(at, DVec2::splat(r))));
        taken.push(Rectangle::around(
            at + 10.0 * page.u * *ahead,
            DVec2::splat(1.2 * page.u) + 5.0 * page.u * ahead.abs(),
        ));
    }
    let views = views.iter().zip(&stands).zip(&ways);
    for (k, ((view, (stand, far)), &ahead)) in views.enumerate() {
        let at = page.place(*stand);
        if view.orthographic && *far {
            rays(drawing, page, at, ahead, view.colour);
        } else {
            arrow(drawing, page, at, ahead, *far, view.colour);
            eye_symbol(drawing, at, EYE * page.u, view.colour);
        }
        let mut clear = EYE;
        if let Some(room) = room(k) {
            room_of_eye(drawing, page, at, room, view.colour);
            clear = clear.max(room / page.u + 0.6);
        }
        let name = match numbers.get(k) {
            Some(number) => &format!("{number}  {}", view.name),
            None => &view.name,
        };
        let around = (at, clear);
        label(
            drawing,
            page,
            (view, name),
            around,
            -ahead,
            *far,
            &mut taken,
        );
    }
}

/// The places to which an eye may move with its picture still one, at true scale: over the eye's symbol, which is often larger.
pub(crate) fn room_of_eye(
    drawing: &mut Drawing,
    page: &Page,
    at: DVec2,
    room: f64,
    colour: [u8; 3],
) {
    let rim = |ink, width: f64| Some(Pen::new(ink, width * page.u));
    let ink = Ink::new(colour).fade(0.25);
    drawing.circle(at, room, None, rim(PAPER, 0.7));
    drawing.circle(at, room, Some(ink), rim(deep(colour, 0.5), 0.3));
}

/// From the eye towards what it looks at; with a break if the eye is further away than drawn.
pub(crate) fn arrow(
    drawing: &mut Drawing,
    page: &Page,
    at: DVec2,
    ahead: DVec2,
    far: bool,
    colour: [u8; 3],
) {
    let u = page.u;
    let side = ahead.perp();
    let pen = Pen::new(deep(colour, 0.25), 0.5 * u);
    let (start, tip) = (at + 5.2 * u * ahead, at + 15.0 * u * ahead);
    let head = tip - 2.4 * u * ahead;
    if far {
        let gap = at + 8.6 * u * ahead;
        drawing.polyline(&[start, gap - 0.7 * u * ahead], pen);
        drawing.polyline(&[gap + 0.7 * u * ahead, head], pen);
        for shift in [-0.7, 0.7] {
            let middle = gap + shift * u * ahead;
            drawing.polyline(
                &[
                    middle - 1.5 * u * side - 0.6 * u * ahead,
                    middle + 1.5 * u * side + 0.6 * u * ahead,
                ],
                pen,
            );
        }
    } else {
        drawing.polyline(&[start, head], pen);
    }
    drawing.polygon(
        &[tip, head + 1.2 * u * side, head - 1.2 * u * side],
        Some(pen.ink),
        None,
    );
}

/// Parallel arrows in the place of an eye at infinity.
fn rays(drawing: &mut Drawing, page: &Page, at: DVec2, ahead: DVec2, colour: [u8; 3]) {
    for shift in [-1.0, 0.0, 1.0] {
        let start = at + page.u * (shift * 0.8 * EYE * ahead.perp() - 8.0 * ahead);
        arrow(drawing, page, start, ahead, false, colour);
    }
}

/// An upright eye of half width `r`.
pub(crate) fn eye_symbol(drawing: &mut Drawing, at: DVec2, r: f64, colour: [u8; 3]) {
    let point = |x: f64, y: f64| at + r * DVec2::new(x, y);
    let steps = vec![
        Verb::Move(point(-1.0, 0.0)),
        Verb::Cubic(point(-0.5, -0.78), point(0.5, -0.78), point(1.0, 0.0)),
        Verb::Cubic(point(0.5, 0.78), point(-0.5, 0.78), point(-1.0, 0.0)),
        Verb::Close,
    ];
    let rim = Pen::new(deep(colour, 0.35), 0.14 * r);
    drawing.shapes.push(Mark {
        steps,
        fill: Some(Ink::new([255; 3])),
        pen: Some(rim),
        text: None,
    });
    drawing.circle(
        at,
        0.44 * r,
        Some(Ink::new(colour)),
        Some(Pen::new(deep(colour, 0.35), 0.08 * r)),
    );
    drawing.circle(at, 0.18 * r, Some(TEXT), None);
}

/// Name and distance beside the eye, on the first side where there is room, and at least `clear` layout units from it.
fn label(
    drawing: &mut Drawing,
    page: &Page,
    (view, text): (&View, &str),
    (at, clear): (DVec2, f64),
    outward: DVec2,
    far: bool,
    taken: &mut Vec<Rectangle>,
) {
    let u = page.u;
    let room = Rectangle {
        lo: page.room[0],
        hi: page.room[1],
    };
    let name = page.style(4.4, Typeface::Bold, deep(view.colour, 0.35), Align::Middle);
    let most = page.widest_label;
    let note = page.style(3.1, Typeface::Light, QUIET, Align::Middle);
    let distance = length(view.eye.distance(view.look_at));
    let line = match (view.orthographic, far) {
        (true, true) => "parallel rays from here".to_owned(),
        (true, false) => "parallel rays from above".to_owned(),
        (false, true) => format!("{distance} away"),
        (false, false) => distance,
    };
    let half = DVec2::new(
        width(text, name.size, name.face)
            .min(most)
            .max(width(&line, note.size, note.face))
            / 2.0,
        4.3 * u,
    );
    let offset = |d: DVec2| d * (half + DVec2::new(clear + 0.8, clear - 0.8) * u);
    // Above or below, whichever is further out, then the sides, then the corners.
    let vertical = DVec2::new(0.0, if outward.y < -0.35 { -1.0 } else { 1.0 });
    let horizontal = DVec2::new(if outward.x < 0.0 { -1.0 } else { 1.0 }, 0.0);
    let ways = [
        vertical,
        horizontal,
        -vertical,
        -horizontal,
        vertical + horizontal,
        vertical - horizontal,
        horizontal - vertical,
    ];
    let inside = |b: &Rectangle| b.lo.cmpge(room.lo).all() && b.hi.cmple(room.hi).all();
    let blocks = ways.map(|d| Rectangle::around(at + offset(d), half));
    let block = blocks
        .iter()
        .find(|b| inside(b) && !taken.iter().any(|t| t.overlaps(b)))
        .unwrap_or(&blocks[0])
        .clone();
    let middle = ((block.lo + block.hi) / 2.0).clamp(room.lo + half, room.hi - half);
    let halo = PAPER.fade(0.85);
    let at = middle + DVec2::new(0.0, -0.4 * u);
    drawing.text_within(at, text, most, name.lifted(halo));
    drawing.text(middle + DVec2::new(0.0, 3.6 * u), &line, note.lifted(halo));
    taken.push(block);
}

/// A rectangle of the page that is in use.
#[derive(Clone)]
struct Rectangle {
    lo: DVec2,
    hi: DVec2,
}

impl Rectangle {
    fn around(middle: DVec2, half: DVec2) -> Self {
        Self {
            lo: middle - half,
            hi: middle + half,
        }
    }

    fn overlaps(&self, other: &Rectangle) -> bool {
        self.lo.cmplt(other.hi).all() && other.lo.cmplt(self.hi).all()
    }
}
