//! Pillars and base as they stand in plan, with their places in the text: what checks look at and solids are made of.

use crate::scene::text::Span;
use glam::DVec2;

/// A pillar on its place.
pub(crate) struct Standing {
    pub name: String,
    pub axis: DVec2,
    pub profile: Vec<DVec2>,
    /// Top, millimetres above the base's top.
    pub height: f64,
    /// Largest distance of the profile from the axis.
    pub reach: f64,
    pub round: bool,
    pub span: Span,
}

/// The base; its top is z = 0.
pub(crate) struct BasePlate {
    pub outline: Vec<DVec2>,
    pub thickness: f64,
    pub span: Option<Span>,
}
