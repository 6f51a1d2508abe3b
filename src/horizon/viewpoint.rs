//! Viewpoints in plan, and their rays: eyes, and lamps, near or endlessly far.

use glam::DVec2;
use std::f64::consts::TAU;

/// The angle from one direction to another, radians, counter-clockwise, between -pi and pi.
pub fn turn(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}

/// From where is looked. Directions ahead are unit vectors: bearing 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    At {
        place: DVec2,
        ahead: DVec2,
    },
    /// So far away that all rays run straight ahead.
    Infinity {
        ahead: DVec2,
    },
}

/// The points `from + t * way` for all `t` beyond `start`; `way` is a unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub from: DVec2,
    pub way: DVec2,
    pub start: f64,
}

impl Ray {
    /// From a place on.
    pub fn new(from: DVec2, way: DVec2) -> Self {
        Self {
            from,
            way,
            start: 0.0,
        }
    }

    pub fn at(&self, distance: f64) -> DVec2 {
        self.from + distance * self.way
    }
}

impl Viewpoint {
    pub fn bearing(&self, p: DVec2) -> f64 {
        match *self {
            Self::At { place, ahead } => turn(ahead, p - place),
            Self::Infinity { ahead } => ahead.perp_dot(p),
        }
    }

    /// The bearing at or after `from` that means the same direction; as it is where no other one does.
    pub fn from_on(&self, from: f64, bearing: f64) -> f64 {
        match self {
            Self::At { .. } => from + (bearing - from).rem_euclid(TAU),
            Self::Infinity { .. } => bearing,
        }
    }

    pub fn ray(&self, bearing: f64) -> Ray {
        match *self {
            Self::At { place, ahead } => Ray::new(place, DVec2::from_angle(bearing).rotate(ahead)),
            Self::Infinity { ahead } => Ray {
                from: bearing * ahead.perp(),
                way: ahead,
                start: f64::NEG_INFINITY,
            },
        }
    }

    /// Disjoint spans of bearings in which some of the bodies stand, rising. Each body is given by its points, and reaches from the
    /// first of their bearings to the last: around the front, for one that lies across the direction behind the viewpoint.
    pub fn spans<P: Iterator<Item = DVec2>>(
        &self,
        bodies: impl Iterator<Item = P>,
    ) -> Vec<[f64; 2]> {
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for points in bodies {
            let bearings = points.map(|p| self.bearing(p)).filter(|b| b.is_finite());
            let nothing = [f64::INFINITY, f64::NEG_INFINITY];
            let [lo, hi] = bearings.fold(nothing, |[l, h], b| [l.min(b), h.max(b)]);
            if lo < hi {
                spans.push([lo, hi]);
            }
        }
        spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut merged: Vec<[f64; 2]> = Vec::new();
        for span in spans {
            match merged.last_mut() {
                Some(last) if span[0] <= last[1] => last[1] = last[1].max(span[1]),
                _ => merged.push(span),
            }
        }
        merged
    }
}
