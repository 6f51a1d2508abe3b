//! The shadow of an obstacle: the bearings at which a viewpoint looks at it, with nothing else in the way.

use super::obstacle::{Footprint, Obstacle};
use super::viewpoint::{Viewpoint, turn};
use glam::DVec2;
use std::f64::consts::PI;

/// Bearings and distance of one obstacle.
///
/// `middle` lies between -pi and pi, the tangents on both sides of it: no shadow is torn at the back of the viewpoint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shadow {
    /// Bearing of the point inside the footprint, and of both tangents.
    pub middle: f64,
    pub from: f64,
    pub to: f64,
    /// Distance of the point inside.
    pub distance: f64,
}

impl Shadow {
    /// All around, from minus to plus infinity, if the viewpoint stands inside the obstacle (or within the hull of a polygon).
    pub fn new(viewpoint: &Viewpoint, obstacle: &Obstacle) -> Self {
        match *viewpoint {
            Viewpoint::At { place, ahead } => Self::of_place(place, ahead, obstacle),
            Viewpoint::Infinity { ahead } => Self::of_infinity(ahead, obstacle),
        }
    }

    /// Whether the viewpoint stands inside the obstacle: it looks through it then.
    pub fn is_around(&self) -> bool {
        self.from == f64::NEG_INFINITY
    }

    fn of_place(place: DVec2, ahead: DVec2, obstacle: &Obstacle) -> Self {
        let offset = obstacle.at - place;
        let hub = offset + obstacle.footprint.inside();
        let (middle, distance) = (turn(ahead, hub), hub.length());
        let sides = match obstacle.footprint {
            Footprint::Disc { radius } => (distance > radius).then(|| {
                let half = (radius / distance).asin();
                [-half, half]
            }),
            Footprint::Polygon { corners, .. } => {
                let turns = corners.iter().map(|p| turn(hub, offset + *p));
                let sides = extremes(turns);
                (distance > 0.0 && sides[1] - sides[0] < PI).then_some(sides)
            }
        };
        let [left, right] = sides.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        Self {
            middle,
            from: middle + left,
            to: middle + right,
            distance,
        }
    }

    fn of_infinity(ahead: DVec2, obstacle: &Obstacle) -> Self {
        let inside = obstacle.footprint.inside();
        let hub = obstacle.at + inside;
        let [left, right] = match obstacle.footprint {
            Footprint::Disc { radius } => [-radius, radius],
            Footprint::Polygon { corners, .. } => {
                extremes(corners.iter().map(|p| ahead.perp_dot(*p - inside)))
            }
        };
        let middle = ahead.perp_dot(hub);
        Self {
            middle,
            from: middle + left,
            to: middle + right,
            distance: ahead.dot(hub),
        }
    }
}

/// Least and greatest, both sides of 0: a point inside has corners on either.
fn extremes(list: impl Iterator<Item = f64>) -> [f64; 2] {
    list.fold([0.0, 0.0], |[l, h], x| [l.min(x), h.max(x)])
}
