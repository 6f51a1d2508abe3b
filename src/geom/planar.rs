//! Predicates and small constructions in the image plane.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

fn coord(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// Twice the signed area of `abc`, exact in sign (Shewchuk's adaptive predicate): positive counter-clockwise.
pub fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    orient2d(coord(a), coord(b), coord(c))
}

/// Barycentric coordinates of `p` in `abc`; they sum to 1, negative outside. Not finite for a degenerate triangle.
pub fn barycentric(a: DVec2, b: DVec2, c: DVec2, p: DVec2) -> DVec3 {
    let area = (b - a).perp_dot(c - a);
    let wa = (b - p).perp_dot(c - p) / area;
    let wb = (c - p).perp_dot(a - p) / area;
    DVec3::new(wa, wb, 1.0 - wa - wb)
}

/// Signed area of a simple polygon, positive counter-clockwise.
pub fn polygon_area(points: &[DVec2]) -> f64 {
    let n = points.len();
    (0..n)
        .map(|i| points[i].perp_dot(points[(i + 1) % n]))
        .sum::<f64>()
        / 2.0
}

/// Parameter along `ab` at which it crosses `cd`, both taken as closed segments; `None` if they miss or are parallel.
pub fn segment_crossing(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<f64> {
    let (ab, cd, ac) = (b - a, d - c, c - a);
    let det = ab.perp_dot(cd);
    if det == 0.0 {
        return None;
    }
    let t = ac.perp_dot(cd) / det;
    let u = ac.perp_dot(ab) / det;
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some(t)
}
