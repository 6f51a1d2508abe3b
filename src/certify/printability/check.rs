//! What is asked of a print: questions, their answers, and what they are asked about.

use crate::bvh::Bvh;
use crate::mesh::{Solid, TriMesh};
use crate::support::Support;
use glam::DVec3;

/// A question about printing and its answer; lengths in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintCheck {
    pub finding: PrintFinding,
    /// Where the value was measured.
    pub place: [f64; 3],
    pub value_mm: f64,
    /// What prints without loss.
    pub wanted_mm: f64,
    /// What fails.
    pub limit_mm: f64,
    /// Whether the value is on the right side of the limit.
    pub ok: bool,
}

/// Which question, and what was found besides the value.
#[derive(Clone, Debug, PartialEq)]
pub enum PrintFinding {
    /// Walls below the limit, which are not printed at all.
    Wall(Option<LostWalls>),
    /// What is narrower than the limit, square millimetres of one side: between two supports, and within one.
    Gap { joined_mm2: f64, closed_mm2: f64 },
    /// How many ledges reach farther than wanted.
    Overhang { ledges: usize },
    /// The slimmest pillar, its height over its width, and the most allowed.
    Slenderness {
        support: String,
        ratio: f64,
        most: f64,
    },
    /// The body that fits worst; none if that is the whole forest, which can still be divided.
    Bed { body: Option<String> },
    /// Parts that would come off.
    Part { count: usize },
    /// Closed hollows.
    Cavity { count: usize },
    /// The pillar with the weakest section, and that section's area.
    Core { support: String, area_mm2: f64 },
}

impl PrintFinding {
    /// As the report has it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Wall(_) => "wall",
            Self::Gap { .. } => "gap",
            Self::Overhang { .. } => "overhang",
            Self::Slenderness { .. } => "slenderness",
            Self::Bed { .. } => "bed",
            Self::Part { .. } => "part",
            Self::Cavity { .. } => "cavity",
            Self::Core { .. } => "core",
        }
    }
}

/// Walls too thin to be printed, square millimetres of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostWalls {
    pub area_mm2: f64,
    pub pieces: usize,
    pub largest_mm2: f64,
}

/// What the printer can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintLimits {
    /// Width of a printed line, millimetres.
    pub nozzle: f64,
    /// Width, depth and height of the build volume, millimetres.
    pub bed: [f64; 3],
    /// Thinnest wall wanted, in nozzles.
    pub wall_nozzles: f64,
    /// Narrowest gap wanted, in nozzles.
    pub gap_nozzles: f64,
    /// Height of a pillar over its least width that still stands.
    pub slimmest: f64,
}

/// What is printed: the forest as one, and as it goes on the bed.
pub struct Printed<'a> {
    pub supports: &'a [Support],
    pub whole: &'a Solid,
    pub bvh: &'a Bvh,
    /// Every support with its reliefs, closed.
    pub standing: &'a [TriMesh],
    /// Bodies that go on the bed one by one, as name and size; empty: the forest as one.
    pub bodies: &'a [(String, DVec3)],
}
