//! What can be wrong with a layout, where, and by how much.

use glam::DVec2;

/// What can be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// A part of the models meets no pillar.
    Uncovered,
    /// A part of the models meets another view's pillar.
    Foreign,
    /// Overlap is missing behind a cut or an outline.
    Loose,
    /// A strip is too narrow.
    Narrow,
    /// What stays of a pillar behind another is too thin.
    Fin,
    /// Rays pass above a pillar's top or below its foot.
    Ends,
    /// A relief stands in sight lines of another view.
    Sight,
    /// Room is missing between solids.
    Tight,
    /// A pillar sticks out of the region.
    Outside,
    /// A cut opens faster than the tolerance allows.
    Open,
    /// Too many pillars, or too few.
    Count,
}

/// A fault; see [`FaultKind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    pub kind: FaultKind,
    /// The view that suffers.
    pub view: Option<usize>,
    /// The pillars that have a part in it.
    pub pillars: [Option<usize>; 2],
    /// How much is wrong: widths, depths and gaps as such, the rest as far as it would have to move.
    pub mm: f64,
    pub at: DVec2,
}
