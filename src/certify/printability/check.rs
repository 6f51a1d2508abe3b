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
    /// Whether it is a matter of the machine, which another machine, supports or care may solve, and not of what is seen.
    pub fn is_of_machine(&self) -> bool {
        matches!(
            self,
            Self::Overhang { .. } | Self::Slenderness { .. } | Self::Bed { .. }
        )
    }

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

/// A length as it is wanted, and where it fails, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    pub wanted: f64,
    pub limit: f64,
}

/// What can be made; what is `None` is not asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintLimits {
    /// Thickness of walls, from above.
    pub wall: Option<Margin>,
    /// Width of gaps, from above.
    pub gap: Option<Margin>,
    /// How far ledges reach, from below.
    pub overhang: Option<Margin>,
    /// Height of a pillar over its least width that still stands.
    pub slimmest: Option<f64>,
    /// Width, depth and height of what holds the work, millimetres.
    pub bed: Option<[f64; 3]>,
    /// Without a base: what stands for itself. `None`: all is one part.
    pub apart: Option<Apart>,
}

/// Parts that stand each for themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// The most of them.
    pub parts: usize,
    /// How high the highest of their feet lies, millimetres: what ends above floats.
    pub foot: f64,
}

/// Walls wanted by a printer, in nozzles: two printed lines that overlap; and what is not printed at all (0.65 mm at 0.4 mm, by trial).
pub const WALL_NOZZLES: [f64; 2] = [2.25, 1.625];
/// Gaps wanted, in nozzles, and those that fuse (0.1 mm at 0.4 mm, by trial).
pub const GAP_NOZZLES: [f64; 2] = [0.5, 0.25];
/// A printed line may stick out freely by this many nozzles.
const FREE_NOZZLES: f64 = 3.0;

impl PrintLimits {
    /// Of a printer with this `nozzle`, whose supports hold ledges of up to `overhang`, millimetres.
    pub fn printed(nozzle: f64, bed: [f64; 3], overhang: f64, slimmest: f64) -> Self {
        let in_nozzles = |[wanted, limit]: [f64; 2]| Margin {
            wanted: wanted * nozzle,
            limit: limit * nozzle,
        };
        Self {
            wall: Some(in_nozzles(WALL_NOZZLES)),
            gap: Some(in_nozzles(GAP_NOZZLES)),
            overhang: Some(Margin {
                wanted: FREE_NOZZLES * nozzle,
                limit: overhang,
            }),
            slimmest: Some(slimmest),
            bed: Some(bed),
            apart: None,
        }
    }

    /// Of a cutter of this width, `tool`, that leaves walls from `wall` on standing, millimetres.
    pub fn milled(tool: f64, wall: f64, slimmest: f64) -> Self {
        let sharp = |length: f64| Margin {
            wanted: length,
            limit: length,
        };
        Self {
            wall: Some(sharp(wall)),
            gap: Some(sharp(tool)),
            slimmest: Some(slimmest),
            ..Self::NONE
        }
    }

    /// What has no limits but that it must hang together.
    pub const NONE: Self = Self {
        wall: None,
        gap: None,
        overhang: None,
        slimmest: None,
        bed: None,
        apart: None,
    };
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
