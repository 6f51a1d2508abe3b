//! The pipeline on one screen: the only module that runs stages on a scene.
//!
//! Takes a resolved [`Scene`], gives the bytes of every output file; touches no file, clock or terminal.
//! Views are independent until the solids are united and run in parallel; nothing depends on the thread count.

mod files;
mod pictures;
mod print;
mod sight;
mod split;
mod summary;

use crate::carve::{Forest, ViewRelief, carve};
use crate::diag::Diagnostic;
use crate::scene::Scene;
use crate::viewmap::SupportField;
use files::{counts, file, plan_files, printable_files, summary};
use pictures::{picture_files, pictures};
use print::print_checks;
use rayon::prelude::*;
use sight::see;
use split::{bodies, pieces, remarks, split_files};
use summary::report;

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
    /// The last line for the terminal without paths and times:
    /// `27 pillars, 144 x 144 x 95 mm, 158 cm3, watertight; bunny 7.7 deg / skull 9.1 deg` (mean normal errors).
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
pub fn run(scene: &Scene, goal: Goal, progress: Progress) -> Result<Build, Vec<Diagnostic>> {
    if goal == Goal::Plan {
        progress("plan", 0.1);
        return Ok(Build {
            files: plan_files(scene),
            printable: true,
            summary: counts(scene),
            ..Build::default()
        });
    }
    progress("view maps", 0.02);
    let field = SupportField::new(&scene.supports);
    let sights = all(scene.views.par_iter().map(|v| see(v, &field)))?;
    let mut warnings: Vec<Diagnostic> = sights.iter().flat_map(|s| s.warning(&field)).collect();
    if goal == Goal::Check {
        return Ok(Build {
            summary: counts(scene),
            printable: true,
            warnings,
            ..Build::default()
        });
    }
    progress("quadratic programs", 0.15);
    let shapes = all(sights.par_iter().map(|s| s.shape(scene, &field)))?;
    progress("solids", 0.45);
    let reliefs: Vec<ViewRelief> = sights
        .iter()
        .zip(&shapes)
        .map(|(s, r)| s.relief(&r.relief))
        .collect();
    let forest =
        carve(&scene.supports, &reliefs).map_err(|e| vec![Diagnostic::error(e.to_string())])?;
    warnings.extend(loose(&forest));
    progress("pictures", 0.75);
    let pictures = pictures(scene, &shapes, &forest);
    if wanted(scene, goal) {
        progress("pieces", 0.8);
    }
    let split = wanted(scene, goal)
        .then(|| pieces(scene, &forest).map_err(|e| vec![e]))
        .transpose()?;
    warnings.extend(split.iter().flat_map(remarks));
    progress("print checks", 0.87);
    let print = print_checks(
        scene,
        &forest,
        &split.as_ref().map_or_else(Vec::new, bodies),
    );
    let mut report = report(scene, &sights, &shapes, &forest, &pictures, &warnings);
    report.print = print;
    progress("files", 0.9);
    let summary = summary(scene, &forest, &pictures);
    let mut files = Vec::new();
    if goal == Goal::All {
        files.extend(printable_files(scene, &forest));
        if scene.output.plan {
            files.extend(plan_files(scene));
        }
        files.push(file("report.json", report.json().into_bytes()));
        if let Some(split) = &split {
            let (pieces, warning) = split_files(scene, split);
            files.extend(pieces);
            warnings.extend(warning);
        }
    }
    let views = goal == Goal::Pictures || scene.output.views;
    files.extend(picture_files(scene, pictures, views));
    Ok(Build {
        files,
        summary,
        printable: forest.whole.parts() == 1,
        warnings,
    })
}

/// Whether the forest is to be written in pieces too.
fn wanted(scene: &Scene, goal: Goal) -> bool {
    goal == Goal::All && scene.output.split
}

/// A forest must be one piece.
fn loose(forest: &Forest) -> Option<Diagnostic> {
    let parts = forest.whole.parts();
    (parts > 1).then(|| {
        Diagnostic::warning(format!("the forest comes apart into {parts} pieces"))
            .help("a pillar that stands outside the base, or no base at all, leaves pieces loose")
    })
}

/// All results, or all errors of all views.
fn all<T: Send>(
    results: impl ParallelIterator<Item = Result<T, Vec<Diagnostic>>>,
) -> Result<Vec<T>, Vec<Diagnostic>> {
    let results: Vec<_> = results.collect();
    let (good, bad): (Vec<_>, Vec<_>) = results.into_iter().partition(Result::is_ok);
    if bad.is_empty() {
        Ok(good.into_iter().flatten().collect())
    } else {
        Err(bad.into_iter().filter_map(Result::err).flatten().collect())
    }
}
