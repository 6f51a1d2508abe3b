//! The largest circle inside an outline.
//!
//! Takes an outline as loose segments, in any order and direction (even-odd: an outer ring with holes is fine); gives the circle of
//! the largest radius that fits inside, to within a precision. Best first over squares, as in Mapbox's polylabel: a square of half
//! side `h` whose middle is `d` from the outline holds no centre with a radius above `d + h sqrt 2`.

use glam::DVec2;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Squares looked at before giving up on the precision: outlines of degenerate shape only.
const MOST_SQUARES: usize = 20_000;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    pub centre: DVec2,
    pub radius: f64,
}

/// A square not yet divided.
struct Square {
    middle: DVec2,
    half: f64,
    /// Largest radius that a circle with its centre in here may have.
    bound: f64,
}

impl Square {
    fn new(outline: &[[DVec2; 2]], middle: DVec2, half: f64) -> (Self, f64) {
        let d = depth(outline, middle);
        let bound = d + half * std::f64::consts::SQRT_2;
        let square = Self {
            middle,
            half,
            bound,
        };
        (square, d)
    }
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |s: &Self| (s.middle.x, s.middle.y);
        let ((ax, ay), (bx, by)) = (place(self), place(other));
        // Ties by place, so that the result never depends on the heap's inner order.
        self.bound
            .total_cmp(&other.bound)
            .then(bx.total_cmp(&ax))
            .then(by.total_cmp(&ay))
    }
}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Square {}

/// The largest circle inside, its radius at most `precision` below the true one; or the first one found of a radius of at least
/// `enough`. `None` for an outline without an inside.
pub fn inscribed(outline: &[[DVec2; 2]], precision: f64, enough: f64) -> Option<Circle> {
    let points = || outline.iter().flatten();
    let lo = points().copied().reduce(DVec2::min)?;
    let hi = points().copied().reduce(DVec2::max)?;
    let side = (hi - lo).min_element();
    if side.is_nan() || side <= 0.0 {
        return None;
    }
    let mut best: Option<Circle> = None;
    let mut heap = BinaryHeap::new();
    let look = |heap: &mut BinaryHeap<Square>, best: &mut Option<Circle>, middle, half| {
        let (square, radius) = Square::new(outline, middle, half);
        if radius > best.map_or(0.0, |b| b.radius) {
            *best = Some(Circle {
                centre: middle,
                radius,
            });
        }
        heap.push(square);
    };
    // At most 64 along the longer side: a needle's squares are larger than its width.
    let side = side.max((hi - lo).max_element() / 64.0);
    let across = ((hi - lo) / side).ceil();
    for i in 0..across.x as usize {
        for j in 0..across.y as usize {
            let middle = lo + side * DVec2::new(i as f64 + 0.5, j as f64 + 0.5);
            look(&mut heap, &mut best, middle, side / 2.0);
        }
    }
    for _ in 0..MOST_SQUARES {
        let radius = best.map_or(0.0, |b| b.radius);
        let square = heap.pop().filter(|s| s.bound > radius + precision);
        let Some(square) = square.filter(|_| radius < enough) else {
            break;
        };
        let half = square.half / 2.0;
        for corner in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let middle = square.middle + half * DVec2::from(corner);
            look(&mut heap, &mut best, middle, half);
        }
    }
    best
}

/// Distance from the outline, negative outside.
fn depth(outline: &[[DVec2; 2]], p: DVec2) -> f64 {
    let (mut inside, mut nearest) = (false, f64::INFINITY);
    for &[a, b] in outline {
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
        let ab = b - a;
        let t = (p - a).dot(ab) / ab.length_squared();
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        nearest = nearest.min((a + t * ab - p).length_squared());
    }
    let distance = nearest.sqrt();
    if inside { distance } else { -distance }
}
