//! A scene with nothing left to decide: what [`resolve`](super::resolve) gives and every later stage takes.

use crate::certify::printability::PrintLimits;
use crate::contest::Contested;
use crate::kinds::ReliefKind;
use crate::planner::{Adjustment, Brief};
use crate::support::Support;
use crate::view::View;

/// A resolved scene: millimetres, every mesh loaded and placed, every default filled in.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Title for people.
    pub title: String,
    pub views: Vec<View>,
    /// Pillars first, then the base (if any), then other bodies.
    pub supports: Vec<Support>,
    /// What is to be found besides these pillars, or mended among them: they are the ones it gives, in their order. `None`: the
    /// forest is complete.
    pub brief: Option<Brief>,
    /// How a layout file changed the models of every view; done in `views` already.
    pub adjusted: Vec<Adjustment>,
    /// How surfaces become reliefs, and the energy they minimise.
    pub relief: ReliefKind,
    /// Who gets surface that two views want.
    pub contested: Contested,
    pub printer: Printer,
    pub making: Making,
    /// What is narrower is not seen, arc-minutes.
    pub seen_arcmin: f64,
    pub output: Output,
}

/// How the forest is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Making {
    pub way: MakingWay,
    /// The finest that can be made, millimetres: the width of a printed line, of a cutter.
    pub line: f64,
    pub limits: PrintLimits,
}

/// Which machine or hand makes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MakingWay {
    Printed,
    Milled,
    Built,
}

impl Making {
    /// Narrower gaps do not stay open, millimetres.
    pub(crate) fn narrowest_gap(&self) -> f64 {
        self.limits.gap.map_or(0.0, |g| g.wanted)
    }
}

impl MakingWay {
    /// What becomes of gaps and walls that are too small.
    pub(crate) fn closes(self) -> &'static str {
        match self {
            Self::Printed => "fuse when printed",
            Self::Milled => "are too narrow for the cutter",
            Self::Built => "close",
        }
    }

    /// What to write for a finer one.
    pub(crate) fn finest(self) -> &'static str {
        match self {
            Self::Printed => "`printer: (nozzle: ...)`",
            Self::Milled => "`make: Milled(tool: ...)`",
            Self::Built => "`make: Built(finest: ...)`",
        }
    }

    /// What its finest line is made with.
    pub(crate) fn tool(self) -> &'static str {
        match self {
            Self::Printed => "nozzle",
            Self::Milled => "cutter",
            Self::Built => "line",
        }
    }

    /// What a check is called.
    pub(crate) fn check(self) -> &'static str {
        match self {
            Self::Printed => "print check",
            Self::Milled | Self::Built => "check",
        }
    }
}

/// The printer the checks have in mind, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printer {
    pub nozzle: f64,
    /// Width, depth, height of the build volume.
    pub bed: [f64; 3],
    /// Room between what is to be put together.
    pub clearance: f64,
}

/// Which files a build writes, and how large its pictures are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    pub forest_3mf: bool,
    pub forest_stl: bool,
    pub forest_glb: bool,
    pub plan: bool,
    pub views: bool,
    /// Figures and pictures of the views in real light.
    pub lights: bool,
    /// Likeness from rings of eyes: figures and a plot.
    pub camouflage: bool,
    /// The forest in pieces too.
    pub split: bool,
    /// The report as a page for people.
    pub report_html: bool,
    /// The optimised surfaces, before they are cut and scaled back.
    pub surface: bool,
    /// A section of every view with its groups' bounds, before and after they are scaled.
    pub groups: bool,
    /// The solid from several sides.
    pub turntable: bool,
    /// Side of one panel of a view picture and height of the turntable's, pixels.
    pub picture_size: u32,
    /// Width of plan.png and of sections, pixels.
    pub plan_width: u32,
}
