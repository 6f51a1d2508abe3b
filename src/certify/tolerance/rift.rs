//! Two pieces that meet along a side of the view map, and by how much they part if the eye moves.

use glam::DVec3;

/// A place where two pieces meet along a side of the view map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rift {
    /// Unit direction from the eye to the side's middle.
    pub direction: DVec3,
    /// Unit normal of the plane through eye and side.
    pub normal: DVec3,
    /// Of both pieces there from the eye, millimetres; the nearer one first.
    pub distances: [f64; 2],
}

impl Rift {
    /// The angle by which the cut opens, or its pieces overlap, if the eye moves by `e`: radians, exactly.
    pub fn opening(&self, e: DVec3) -> f64 {
        parting(self.direction, self.normal, self.distances, e).abs()
    }
}

/// By how much two points in the unit direction `u` part across the plane with the unit normal `n`, if the eye moves by `e`; see
/// the module. Radians, positive if the first is the nearer one and `n . e > 0`.
pub(crate) fn parting(u: DVec3, n: DVec3, distances: [f64; 2], e: DVec3) -> f64 {
    let [a, b] = distances.map(|a| (n.dot(e) / (a * u - e).length()).clamp(-1.0, 1.0).asin());
    a - b
}
