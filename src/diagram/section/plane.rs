//! The plane of a section: one through the eye, as a line of its image.

use crate::geom::ImagePlane;
use glam::{DVec2, DVec3};

/// A plane through the eye.
#[derive(Clone, Copy, Debug)]
pub struct SectionPlane {
    pub plane: ImagePlane,
    pub upright: bool,
    /// Where its line crosses the image's other axis.
    pub offset: f64,
}

impl SectionPlane {
    /// Along the line, and across it.
    pub fn axes(&self) -> (DVec2, DVec2) {
        if self.upright {
            (DVec2::Y, DVec2::X)
        } else {
            (DVec2::X, DVec2::Y)
        }
    }

    /// The image point of the line at `x`.
    pub fn ray(&self, x: f64) -> DVec2 {
        let (along, across) = self.axes();
        x * along + self.offset * across
    }

    /// The place in the section of the point at depth `z` on the ray at `x`.
    pub fn place(&self, x: f64, z: f64) -> DVec2 {
        z * DVec2::new(x, (1.0 + self.offset * self.offset).sqrt())
    }

    /// Unit vectors of the section's axes in space.
    pub fn frame(&self) -> (DVec3, DVec3) {
        let (along, _) = self.axes();
        let sideways = along.x * self.plane.right + along.y * self.plane.up;
        (sideways, self.plane.direction(self.ray(0.0)).normalize())
    }
}
