//! What is wanted of a layout: region, pillars allowed, what matters.

use crate::geom::{contains, to_segment};
use crate::support::Layer;
use glam::{DMat4, DQuat, DVec2, DVec3};

/// A cross-section that pillars of the layout may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Around the origin, counter-clockwise, millimetres.
    pub profile: Vec<DVec2>,
    /// It stands for a circle.
    pub round: bool,
    /// Largest distance of the profile from the origin, millimetres.
    pub reach: f64,
    /// Lowest and highest top, millimetres above the base.
    pub heights: [f64; 2],
    pub layer: Layer,
    /// As scenes write it, at this size: `Round(radius: 4)`. For writing layouts down; the planner does not look at it.
    pub written: String,
}

/// A pillar of a layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pillar {
    pub at: DVec2,
    /// Index of its shape.
    pub shape: usize,
    /// Index of the view that it is for; none if no view sees it yet.
    pub owner: Option<usize>,
    /// Stays where it is.
    pub fixed: bool,
}

/// What matters, as weights; see [`Score`](super::Score).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matters {
    pub camouflage: f64,
    pub tolerance: f64,
    pub pillars: f64,
    pub spread: f64,
}

/// How far the models of a view may be changed, to either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Turned about the vertical through their middle, radians.
    pub turn: f64,
    /// Largest factor on their size, at least 1; the smallest is its inverse.
    pub scale: f64,
    /// Shifted level, millimetres.
    pub shift: f64,
}

impl Freedom {
    /// Models stay as they are placed.
    pub const NONE: Self = Self {
        turn: 0.0,
        scale: 1.0,
        shift: 0.0,
    };
}

/// How the models of one view are changed: turned and scaled about the middle of their underside, then shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjustment {
    /// Radians, counter-clockwise from above.
    pub turn: f64,
    pub scale: f64,
    /// Millimetres.
    pub shift: DVec2,
}

impl Adjustment {
    pub const NONE: Self = Self {
        turn: 0.0,
        scale: 1.0,
        shift: DVec2::ZERO,
    };

    /// The change as a matrix, for models whose underside has its middle at `foot`.
    pub fn matrix(&self, foot: DVec3) -> DMat4 {
        DMat4::from_translation(foot + self.shift.extend(0.0))
            * DMat4::from_scale_rotation_translation(
                DVec3::splat(self.scale),
                DQuat::from_rotation_z(self.turn),
                DVec3::ZERO,
            )
            * DMat4::from_translation(-foot)
    }
}

/// What a layout is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Brief {
    /// Simple polygon, counter-clockwise: bodies of pillars stay inside.
    pub region: Vec<DVec2>,
    /// Allowed shapes first, then those of fixed pillars only.
    pub shapes: Vec<Shape>,
    /// How many of `shapes` new pillars may have.
    pub allowed: usize,
    /// Room between any two solids, millimetres.
    pub gap: f64,
    /// Fewest and most pillars, fixed ones included.
    pub count: [usize; 2],
    /// Pillars to keep (`fixed`), or to begin with when a layout is mended.
    pub given: Vec<Pillar>,
    pub seed: u64,
    /// Candidate layouts to try, over all chains.
    pub tries: u64,
    /// Wall-clock seconds that the user grants; the planner itself has no clock and only looks at [`Watch::stop`](super::Watch).
    pub seconds: f64,
    /// How far off, in degrees, the models are to be hidden.
    pub hidden_from_deg: f64,
    pub matters: Matters,
    /// Least eye tolerance of every view, millimetres.
    pub tolerance_mm: Vec<f64>,
    pub freedom: Freedom,
}

impl Brief {
    /// How far the circle of radius `reach` around `at` sticks out of the region, millimetres; 0 if it does not.
    pub fn outside(&self, at: DVec2, reach: f64) -> f64 {
        let n = self.region.len();
        let edges = (0..n).map(|i| to_segment(at, self.region[i], self.region[(i + 1) % n]));
        let distance = edges.fold(f64::INFINITY, f64::min);
        let inside = if contains(&self.region, at) {
            distance
        } else {
            -distance
        };
        (reach - inside).max(0.0)
    }
}
