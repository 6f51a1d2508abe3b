//! Where the relief on a pillar may lie, along the sight of its owner.

use crate::horizon::Shadow;
use crate::planner::brief::Shape;
use crate::support::Datum;

/// Thickness behind a layer's back that is relief too, at most; see [`Slab::backing`](crate::support::Slab::backing).
const BACKING_MM: f64 = 0.8;

/// Where a pillar's relief may lie, seen from its owner: offsets of planes behind the axis plane, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Offsets {
    pub near: f64,
    /// Of the layer, and with the backing.
    pub back: f64,
    pub far: f64,
    /// Middle of the layer.
    pub middle: f64,
}

impl Offsets {
    pub(crate) fn new(shape: &Shape) -> Self {
        let layer = shape.layer;
        let near = match layer.datum() {
            Datum::Plane => -layer.front,
            Datum::Surface => -layer.front - shape.reach,
        };
        Self {
            near,
            back: layer.back(),
            far: layer.back() + BACKING_MM,
            middle: (near + layer.back()) / 2.0,
        }
    }
}

/// Horizontal distances between which rays meet a pillar or its relief.
pub(crate) fn reach_of(shadow: &Shadow, shape: &Shape) -> [f64; 2] {
    let offsets = Offsets::new(shape);
    let near = shadow.distance + offsets.near.min(-shape.reach);
    let far = (shadow.distance + offsets.far) / (shadow.to - shadow.middle).min(1.0).cos();
    [near, far]
}
