//! The numbers of a section.

use super::plane::SectionPlane;
use super::slice::SlicedOutline;
use crate::index::GroupId;

/// What the section cuts of one cell that shows the model: values at both its ends, depths along the image's forward axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Rising.
    pub x: [f64; 2],
    /// Of the model, and of the optimised surface before it is cut (it need not lie near any support where none carries it).
    pub model: [f64; 2],
    pub surface: [f64; 2],
    pub laid: Option<Laid>,
}

/// Where a group carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laid {
    /// Into [`Section::groups`].
    pub group: usize,
    /// Bounds of the layer: `mu near <= surface <= mu far`, to within what the relief was clamped by.
    pub near: [f64; 2],
    pub far: [f64; 2],
    /// Of the finished relief: `surface / mu`, clamped.
    pub relief: [f64; 2],
}

/// A group that is cut.
#[derive(Clone, Debug, PartialEq)]
pub struct CutGroup {
    /// Of the view's groups.
    pub group: GroupId,
    pub mu: f64,
    /// Name of its support.
    pub support: String,
    /// Length of its cut in the image.
    pub width: f64,
}

/// See the folder's head.
#[derive(Clone, Debug)]
pub struct Section {
    pub cut: SectionPlane,
    /// By rising `x`.
    pub stretches: Vec<Stretch>,
    /// In order of appearance.
    pub groups: Vec<CutGroup>,
    /// How many groups the view has.
    pub of: usize,
    /// Whether the surface was torn: then every `mu` is 1.
    pub torn: bool,
    /// Outlines of supports (bases are left out), and whether one carries a group that is cut.
    pub supports: Vec<(SlicedOutline, bool)>,
    pub model: Vec<SlicedOutline>,
}
