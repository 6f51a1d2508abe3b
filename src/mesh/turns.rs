//! Exact signs of turns: on which side of a line or a plane a point lies.
//!
//! Adaptive-precision determinants (Shewchuk 1997). Only their signs mean anything.

use glam::DVec3;
use robust::{Coord, Coord3D};

/// An axis to drop so that the face keeps a non-zero area, preferring its largest projection; `None` for a face of
/// exactly zero area.
pub(crate) fn projection_axis(corners: &[DVec3; 3]) -> Option<usize> {
    let [a, b, c] = *corners;
    let best = (b - a).cross(c - a).abs().max_position();
    [best, (best + 1) % 3, (best + 2) % 3]
        .into_iter()
        .find(|&axis| turn2(axis, a, b, c) != 0.0)
}

/// Sign of the turn `a, b, c` seen along `axis`.
pub(crate) fn turn2(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let drop = |p: DVec3| Coord { x: p[x], y: p[y] };
    robust::orient2d(drop(a), drop(b), drop(c))
}

/// Positive if `d` lies behind the plane of `a, b, c` (which turn counter-clockwise as seen from the front).
pub(crate) fn turn3(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    // Level and upright planes are common in printed bodies, and exact zeros are what the adaptive test is slowest at.
    if ((a.cmpeq(b) & a.cmpeq(c)) & a.cmpeq(d)).any() {
        return 0.0;
    }
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}
