//! The pipeline on one screen: the only module that runs stages on a scene.
//!
//! Takes a resolved [`Scene`], gives the bytes of every output file; touches no file, clock or terminal.

use crate::diag::Diagnostic;
use crate::scene::Scene;

/// A file to be written, relative to the output directory.
#[derive(Clone, Debug)]
pub struct OutputFile {
    pub path: String,
    pub bytes: Vec<u8>,
}

/// What a finished run gives.
#[derive(Clone, Debug, Default)]
pub struct Build {
    pub files: Vec<OutputFile>,
    /// The last line for the terminal without paths and times: `27 pillars, 144 x 144 x 95 mm, 158 cm3, watertight; bunny 7.7 deg / skull 9.1 deg`.
    pub summary: String,
    /// Whether every solid passed our own checks.
    pub printable: bool,
    pub warnings: Vec<Diagnostic>,
}

/// What is wanted of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Everything the scene's output section names.
    All,
    /// Only plan.svg and plan.png.
    Plan,
    /// Only the view pictures (the forest is built for them).
    Pictures,
    /// Nothing is written; everything that can be checked before solving is.
    Check,
}

/// Called as work goes on with the stage's name and the share of the whole run done, 0 to 1. May come from any thread.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

/// Runs the stages that `goal` needs.
///
/// # Errors
/// All errors of the stage that failed, at least one of them.
pub fn run(_scene: &Scene, _goal: Goal, _progress: Progress) -> Result<Build, Vec<Diagnostic>> {
    Err(vec![Diagnostic::error("building is not wired up yet")])
}
