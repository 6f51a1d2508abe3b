//! What stands in the way: footprints at places, and where rays enter them.

use super::viewpoint::Ray;
use glam::DVec2;

/// The outline of a body in plan, around its own origin, millimetres.
///
/// Both forms exist as callers mean different things by a round pillar: one that looks for a layout means the circle, which is the
/// same from all sides, and one that shows what is printed means the polygon with which the print is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Footprint<'a> {
    /// A circle around the origin.
    Disc { radius: f64 },
    /// A simple polygon, counter-clockwise, no corner of which is hidden from the point `inside` (any point of a convex one).
    Polygon { corners: &'a [DVec2], inside: DVec2 },
}

impl Footprint<'_> {
    /// The point inside from which corners are judged.
    pub fn inside(&self) -> DVec2 {
        match *self {
            Footprint::Disc { .. } => DVec2::ZERO,
            Footprint::Polygon { inside, .. } => inside,
        }
    }
}

/// A footprint with its origin at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle<'a> {
    pub at: DVec2,
    pub footprint: Footprint<'a>,
}

/// Where a ray enters an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Along the ray.
    pub distance: f64,
    /// Of the obstacle, outward, unit.
    pub normal: DVec2,
}

impl Obstacle<'_> {
    /// Where the ray enters first; `None` if it misses, or begins behind a disc's entry.
    pub fn entry(&self, ray: &Ray) -> Option<Impact> {
        let (offset, way) = (self.at - ray.from, ray.way);
        match self.footprint {
            Footprint::Disc { radius } => {
                let off = way.perp_dot(offset);
                let under = radius * radius - off * off;
                let distance = way.dot(offset) - under.max(0.0).sqrt();
                (under >= 0.0 && distance > ray.start).then(|| Impact {
                    distance,
                    normal: (distance * way - offset) / radius,
                })
            }
            Footprint::Polygon { corners, .. } => {
                let mut best: Option<(f64, DVec2)> = None;
                for (i, corner) in corners.iter().enumerate() {
                    let (p, q) = (offset + *corner, offset + corners[(i + 1) % corners.len()]);
                    let (sp, sq) = (way.perp_dot(p), way.perp_dot(q));
                    // Half open: of two sides that meet on the ray, one is crossed.
                    if (sp < 0.0) == (sq < 0.0) {
                        continue;
                    }
                    let t = way.dot(p + (q - p) * (sp / (sp - sq)));
                    if t > ray.start && best.is_none_or(|b| t < b.0) {
                        best = Some((t, -(q - p).perp()));
                    }
                }
                best.map(|(distance, side)| Impact {
                    distance,
                    normal: side.normalize_or_zero(),
                })
            }
        }
    }
}
