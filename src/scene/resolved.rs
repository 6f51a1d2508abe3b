//! A scene with nothing left to decide: what [`resolve`](super::resolve) gives and every later stage takes.

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
    pub output: Output,
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
