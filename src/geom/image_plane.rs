//! The central projection of one eye.

use glam::{DVec2, DVec3};

/// The plane one unit in front of an eye `o`; a point `q` of it stands for the ray `o + z * direction(q)`, `z > 0`.
///
/// `z` is the depth along the forward axis, not the distance `lambda`; on one ray both differ by a constant factor,
/// so relative depths `s = lambda / lambda0 = z / z0` are the same in either. `1/z` is affine in `q` on any plane of space.
#[derive(Clone, Copy, Debug)]
pub struct ImagePlane {
    pub eye: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
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
        }
    }

    /// The un-normalised direction of the ray `q`: its component along `forward` is 1.
    pub fn direction(&self, q: DVec2) -> DVec3 {
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
        let d = p - self.eye;
        let z = d.dot(self.forward);
        (z > 1e-9).then(|| DVec2::new(d.dot(self.right), d.dot(self.up)) / z)
    }
}
