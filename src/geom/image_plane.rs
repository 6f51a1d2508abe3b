//! The central projection of one eye, or the parallel one of an eye at infinity.

use super::angles::solid_angle;
use super::planar::orient;
use glam::{DVec2, DVec3};

/// How far away eyes at infinity stand, millimetres: a central projection from there is a parallel one for all that prints. Rays 50 mm
/// beside the line of sight lean by 0.0095 degrees, 1.2 micrometres over a layer of 7 mm. Ten times nearer a printer could show
/// that; ten times farther rounding (6e-11 mm here) comes near what bounds promise (1e-6 mm) after some thousand operations.
pub const FAR_MM: f64 = 3e5;
/// From where angles are told of what is seen from infinity, millimetres: where one reads. Images of either projection so have
/// coordinates of one size.
pub const READING_MM: f64 = 300.0;
/// Lengths below this are none up to the reading distance, and in proportion beyond it, millimetres: depths are found in log depth, and
/// this is a thousandth of what f32 files resolve there.
const NOTHING_MM: f64 = 1e-6;

/// Lengths below this are none for an eye so far away, millimetres.
pub fn nothing_mm(distance: f64) -> f64 {
    NOTHING_MM * (distance / READING_MM).max(1.0)
}

/// The plane `focal` units in front of an eye `o`; a point `q` of it stands for the ray `o + z * direction(q)`, `z > 0`.
///
/// `z` is the depth along the forward axis, not the distance `lambda`; on one ray both differ by a constant factor,
/// so relative depths `s = lambda / lambda0 = z / z0` are the same in either. `1/z` is affine in `q` on any plane of space.
#[derive(Clone, Copy, Debug)]
pub struct ImagePlane {
    pub eye: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    /// 1 for an eye in its place; for one at infinity how many times [`READING_MM`] away it stands.
    pub focal: f64,
}

impl ImagePlane {
    /// The plane of an eye that looks at `target`, upright (its `right` is horizontal) unless it looks straight up or down.
    pub fn looking_at(eye: DVec3, target: DVec3) -> Self {
        let forward = (target - eye).normalize();
        let right = forward.cross(DVec3::Z);
        let right = if right.length() > 1e-9 {
            right.normalize()
        } else {
            DVec3::X
        };
        Self {
            eye,
            forward,
            right,
            up: right.cross(forward),
            focal: 1.0,
        }
    }

    /// The same of an eye that stands for one at infinity: its image is as large as from [`READING_MM`].
    pub fn from_afar(eye: DVec3, target: DVec3) -> Self {
        Self {
            focal: eye.distance(target) / READING_MM,
            ..Self::looking_at(eye, target)
        }
    }

    /// Whether its rays count as parallel.
    pub fn is_parallel(&self) -> bool {
        self.focal > 1.0
    }

    /// The un-normalised direction of the ray `q`: its component along `forward` is 1.
    pub fn direction(&self, q: DVec2) -> DVec3 {
        let q = q / self.focal;
        self.forward + q.x * self.right + q.y * self.up
    }

    /// The point of space at depth `z` on the ray `q`.
    pub fn point(&self, q: DVec2, z: f64) -> DVec3 {
        self.eye + z * self.direction(q)
    }

    /// Depth of `p` along the forward axis; not positive behind the eye.
    pub fn depth(&self, p: DVec3) -> f64 {
        (p - self.eye).dot(self.forward)
    }

    /// Image of `p`; `None` if it does not lie in front of the eye.
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        (self.depth(p) > 1e-9).then(|| self.image(p))
    }

    /// Image of a point in front of the eye.
    fn image(&self, p: DVec3) -> DVec2 {
        let d = p - self.eye;
        DVec2::new(d.dot(self.right), d.dot(self.up)) / d.dot(self.forward) * self.focal
    }

    /// Millimetres that a unit of the image measures at depth `z`.
    pub fn scale(&self, z: f64) -> f64 {
        z / self.focal
    }

    /// Solid angle in steradians of a triangle of the image, positive if it turns counter-clockwise; of an eye at infinity
    /// as seen from [`READING_MM`] straight before it.
    pub fn solid_angle(&self, [a, b, c]: [DVec2; 3]) -> f64 {
        if self.is_parallel() {
            return orient(a, b, c) / 2.0;
        }
        let [a, b, c] = [a, b, c].map(|q| self.direction(q));
        solid_angle(a, b, c)
    }

    /// The same of a triangle in space, in front of the eye.
    pub fn solid_angle_of(&self, corners: [DVec3; 3]) -> f64 {
        if self.is_parallel() {
            let [a, b, c] = corners.map(|p| self.image(p));
            return orient(a, b, c) / 2.0;
        }
        let [a, b, c] = corners.map(|p| p - self.eye);
        solid_angle(a, b, c)
    }
}
