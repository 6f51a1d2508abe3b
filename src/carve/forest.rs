//! What carving gives: checked solids, what was changed on the way, or why there are none.

use super::boolean::BooleanError;
use crate::index::CellId;
use crate::mesh::{Defect, Resolving, Solid, Tangled, TriMesh};

/// The forest as checked solids.
#[derive(Clone, Debug)]
pub struct Forest {
    /// Everything as one.
    pub whole: Solid,
    /// Base and pillars without reliefs.
    pub bare: Solid,
    /// The reliefs of each view, in the order of the views; `None` for a view without any.
    pub reliefs: Vec<Option<Solid>>,
    /// Cells of each view's map that had to be given up, rising.
    pub given_up: Vec<Vec<CellId>>,
    /// Every support with its reliefs, in the order of the supports: closed, not rounded and not resolved.
    pub standing: Vec<TriMesh>,
    /// What had to be changed on the way.
    pub repairs: Repairs,
}

/// What had to be changed to make the solids sound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repairs {
    /// Corners of reliefs whose depth was filled in.
    pub filled: usize,
    /// Cells of view maps given up.
    pub dropped_cells: usize,
    /// Reliefs that touched their support nowhere and were tied to it by a brace behind it.
    pub braces: usize,
    /// Volume of loose crumbs dropped, cubic millimetres.
    pub crumbs_mm3: f64,
    /// What rounding to f32 took.
    pub resolving: Resolving,
}

impl Repairs {
    pub(super) fn add(&mut self, other: &Repairs) {
        self.filled += other.filled;
        self.dropped_cells += other.dropped_cells;
        self.braces += other.braces;
        self.crumbs_mm3 += other.crumbs_mm3;
        self.resolving.add(&other.resolving);
    }
}

/// Why there is no sound forest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CarveError {
    #[error("{place}: {source}")]
    Boolean { place: String, source: BooleanError },
    #[error("{place} came out with defects: {}", list(.defects))]
    Unsound { place: String, defects: Vec<Defect> },
    #[error("{place}: {source}")]
    Tangled { place: String, source: Tangled },
}

fn list(defects: &[Defect]) -> String {
    defects
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("; ")
}
