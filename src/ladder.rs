//! Ladders of retries: where the first way of doing a thing may fail, others are tried in turn, and which of them held is told.
//!
//! A rung above the first is luck that ran out once: results stay sound, but the next layout may find no rung that holds.

/// What is tried again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ladder {
    /// Coarser grids that the points of a view map are snapped to.
    SnappingGrid,
    /// Other widths at which a support's reliefs overlap it.
    CarvingWidths,
    /// Unions of all supports, each with other widths of one of them.
    Unions,
    /// Tolerances at which a boolean's result is simplified.
    Simplifying,
    /// Heights below which slivers are dissolved.
    Mending,
}

/// The rung of a ladder that held.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rung {
    pub ladder: Ladder,
    /// Of what: a support or view by its name, or the forest.
    pub place: String,
    /// From 0, the first.
    pub held: usize,
    /// How many there are.
    pub of: usize,
}
