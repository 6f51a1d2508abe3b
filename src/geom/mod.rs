//! Pure geometry: image planes, planar predicates, solid angles.
//!
//! Millimetres, z up, f64 throughout. Nothing here knows meshes, scenes or files.

mod image_plane;
mod inscribed;
mod planar;

pub use image_plane::ImagePlane;
pub use inscribed::{Circle, inscribed};
pub use planar::{
    barycentric, contains, gap, narrowest, orient, polygon_area, segment_crossing, to_segment,
};

use glam::DVec3;

/// Solid angle in steradians of the triangle `abc` seen from the origin, positive if it turns counter-clockwise as seen from there.
/// Van Oosterom & Strackee 1983.
pub fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let numerator = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    -2.0 * numerator.atan2(denominator)
}
