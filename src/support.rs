//! What carries reliefs: pillars now; plates, stairs, grooves, waves and meshes are to come as new `SupportKind`s.
//!
//! A support is a closed solid with a name and, if it may carry reliefs, a depth layer. Everything downstream
//! (visibility, groups, solids) asks only for its mesh and for its layer along a ray.

use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};

/// From where a layer is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datum {
    /// The vertical plane through the pillar's axis that faces the eye: a flat slab, the best layer for a pillar.
    AxisPlane,
    /// The first hit of each ray with the support: a shell.
    Surface,
}

/// The room a relief may fill, in millimetres measured along the horizontal direction from the eye to the axis
/// (`AxisPlane`) or along the ray (`Surface`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    pub datum: Datum,
    /// How far in front of the datum.
    pub front: f64,
    /// How far behind it.
    pub back: f64,
    /// Material that must be left behind the layer.
    pub core: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SupportKind {
    /// An upright prism. `profile` is a simple polygon in the ground plane, world coordinates, counter-clockwise.
    Pillar { axis: DVec2, profile: Vec<DVec2>, bottom: f64, top: f64, round: bool },
    /// The slab the pillars stand on. `outline` as a pillar's profile.
    Base { outline: Vec<DVec2>, bottom: f64, top: f64 },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    pub name: String,
    pub kind: SupportKind,
    /// `None`: carries nothing (the base).
    pub layer: Option<Layer>,
    /// Closed, outward oriented.
    pub mesh: TriMesh,
}
