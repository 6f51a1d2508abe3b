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

/// Whether a point lies in a simple polygon (its edge counts as in, up to rounding).
pub fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    let n = polygon.len();
    let crossings = (0..n).filter(|&i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
    });
    crossings.count() % 2 == 1
}

/// Distance of `p` from the segment `ab`.
pub fn to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let ab = b - a;
    let t = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    p.distance(a + t * ab)
}

/// Smallest width of a polygon over the directions square to its sides.
pub fn narrowest(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % n]);
            let across = (b - a).perp().normalize_or_zero();
            polygon
                .iter()
                .map(|p| (*p - a).dot(across))
                .fold(0.0, f64::max)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Distance between two outlines: 0 if they touch or one holds the other.
pub fn gap(a: &[DVec2], b: &[DVec2]) -> f64 {
    if contains(a, b[0]) || contains(b, a[0]) {
        return 0.0;
    }
    let mut best = f64::INFINITY;
    for i in 0..a.len() {
        let (p, q) = (a[i], a[(i + 1) % a.len()]);
        for j in 0..b.len() {
            let (r, s) = (b[j], b[(j + 1) % b.len()]);
            if segment_crossing(p, q, r, s).is_some() {
                return 0.0;
            }
            best = best.min(to_segment(p, r, s)).min(to_segment(r, p, q));
        }
    }
    best
}

/// The convex hull, counter-clockwise, without points on its sides (Andrew's monotone chain).
pub fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while chain.len() > 1
                && orient(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}
