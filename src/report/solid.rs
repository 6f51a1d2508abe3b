//! What the report tells of the finished solid: counts and measures, what was asked of it, and what had to be mended on the way.

use crate::carve::{Forest, Repairs};
use crate::certify::without_minus_zero;
use crate::mesh::{Solid, check};
use serde::{Deserialize, Serialize};

/// The finished forest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolidReport {
    pub triangles: usize,
    pub vertices: usize,
    pub volume_mm3: f64,
    pub area_mm2: f64,
    /// Pieces that would come apart.
    pub parts: usize,
    /// Hollows without a way out.
    pub cavities: usize,
    pub size_mm: [f64; 3],
    pub checks: Vec<SolidCheck>,
    pub repairs: RepairReport,
}

/// A question about the solid: what was counted, and the most that is right.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolidCheck {
    pub name: String,
    pub found: usize,
    pub limit: usize,
    pub passed: bool,
}

/// What had to be changed to make the solids sound: figures, not checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RepairReport {
    /// Corners of reliefs whose depth was filled in.
    pub filled_corners: usize,
    /// Cells of view maps left without relief.
    pub dropped_cells: usize,
    /// Reliefs that touched their support nowhere and were tied to it.
    pub braces: usize,
    /// Loose crumbs taken away.
    pub crumbs_mm3: f64,
    /// Pairs of faces that rounding to f32 brought into each other's way.
    #[serde(default)]
    pub crossings: usize,
    /// Rounds until there was none.
    #[serde(default)]
    pub crossing_rounds: usize,
    /// The farthest that a point of the surface was moved for it.
    #[serde(default)]
    pub moved_mm: f64,
}

impl SolidReport {
    /// Counts and measures of one solid.
    pub fn new(solid: &Solid) -> Self {
        let (lo, hi) = solid.bounds();
        Self {
            triangles: solid.mesh().faces.len(),
            vertices: solid.mesh().vertices.len(),
            volume_mm3: solid.volume_mm3(),
            area_mm2: solid.area_mm2(),
            parts: solid.parts(),
            cavities: solid.cavities(),
            size_mm: without_minus_zero(hi - lo),
            ..Self::default()
        }
    }

    /// Those of a forest, with what was asked of it and what was mended.
    pub fn of_forest(forest: &Forest) -> Self {
        Self {
            checks: checks(forest),
            repairs: RepairReport::from(&forest.repairs),
            ..Self::new(&forest.whole)
        }
    }
}

/// What can be wrong with a forest that was made. Defects are counted anew, on what files will hold.
fn checks(forest: &Forest) -> Vec<SolidCheck> {
    let defects = check(forest.whole.mesh());
    vec![
        SolidCheck::at_most(
            "defects: open, crowded or wrongly wound edges, faces through each other",
            defects.iter().map(|d| d.count).sum(),
            0,
        ),
        SolidCheck::at_most("parts", forest.whole.parts(), 1),
        SolidCheck::at_most(
            "cells whose relief was given up",
            forest.repairs.dropped_cells,
            0,
        ),
    ]
}

impl SolidCheck {
    /// Passed if no more than `limit` were found.
    pub fn at_most(name: &str, found: usize, limit: usize) -> Self {
        Self {
            name: name.to_owned(),
            found,
            limit,
            passed: found <= limit,
        }
    }
}

impl From<&Repairs> for RepairReport {
    fn from(repairs: &Repairs) -> Self {
        Self {
            filled_corners: repairs.filled,
            dropped_cells: repairs.dropped_cells,
            braces: repairs.braces,
            crumbs_mm3: repairs.crumbs_mm3,
            crossings: repairs.resolving.pairs,
            crossing_rounds: repairs.resolving.rounds,
            moved_mm: repairs.resolving.moved_mm,
        }
    }
}
