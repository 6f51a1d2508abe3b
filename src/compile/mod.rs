//! The pipeline on one screen: the only module that runs stages on a scene.
//!
//! Takes a resolved [`Scene`], gives the bytes of every output file; touches no file, clock or terminal.
//! Views are independent until the solids are united and run in parallel; nothing depends on the thread count.

mod certificates;
mod elsewhere;
mod files;
mod page;
mod pictures;
mod planning;
mod print;
mod sight;
mod split;
mod summary;
mod verdict;

use crate::bvh::Bvh;
use crate::carve::{Forest, ViewRelief, Whole, carve, joined};
use crate::diag::Diagnostic;
use crate::planner::{Brief, Watch};
use crate::scene::{Scene, laid_out};
use crate::viewmap::SupportField;
use certificates::{Settled, certificates, settled};
use elsewhere::{camouflage_files, rooms};
use files::{counts, file, plan_files, printable_files, section_files, summary, surface_files};
use page::page;
use pictures::{picture_files, pictures, turntable_file};
use rayon::prelude::*;
use sight::{Shape, Sight, see, unsettled};
use split::{bodies, pieces, remarks, split_files};
use summary::report;
use verdict::failures;

pub use planning::{LAYOUT, cut_short, plan_outputs, planned, repaired, shortfalls};

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
    /// What of all that a build promises does not hold; only [`Goal::All`] looks at it.
    pub failures: Vec<Diagnostic>,
    pub warnings: Vec<Diagnostic>,
}

/// All results of the stages that make a forest.
struct Built<'a> {
    scene: &'a Scene,
    field: &'a SupportField<'a>,
    sights: Vec<Sight<'a>>,
    settled: Settled,
    shapes: Vec<Shape>,
    forest: Forest,
    /// That of the whole forest.
    bvh: Bvh,
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

/// Asked now and then by a search for pillars whether it is to end with what it has. May come from any thread.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// Share of a run that finding its pillars takes.
const PLANNING: f64 = 0.3;

/// Runs the stages that `goal` needs, finding pillars first if the scene wants it.
///
/// # Errors
/// All errors of the stage that failed, at least one of them.
pub fn run(
    scene: &Scene,
    goal: Goal,
    progress: Progress,
    stop: Stop,
) -> Result<Build, Vec<Diagnostic>> {
    let Some(brief) = &scene.brief else {
        return forest(scene, goal, progress);
    };
    // A check looks at what a search would start from.
    let tries = if goal == Goal::Check { 0 } else { brief.tries };
    let brief = Brief {
        tries,
        ..brief.clone()
    };
    let watch = Watch {
        progress: &|stage, share| progress(stage, PLANNING * share),
        stop,
    };
    let plan = crate::planner::plan(&scene.views, &brief, watch)
        .map_err(|e| crate::words::planner::no_layout(&scene.views, &e))?;
    let rest = |stage: &str, share| progress(stage, PLANNING + (1.0 - PLANNING) * share);
    let mut build = forest(&laid_out(scene, &plan), goal, &rest)?;
    build.warnings.extend(cut_short(&brief, &plan));
    if matches!(goal, Goal::All | Goal::Plan) {
        build.files.push(planning::layout_file(scene, &plan));
    }
    Ok(build)
}

/// The stages of a scene whose pillars stand.
fn forest(scene: &Scene, goal: Goal, progress: Progress) -> Result<Build, Vec<Diagnostic>> {
    if goal == Goal::Plan {
        progress("plan", 0.1);
        return Ok(Build {
            files: plan_files(scene, &[]),
            summary: counts(scene),
            ..Build::default()
        });
    }
    progress("view maps", 0.02);
    let field = SupportField::new(&scene.supports);
    let mut sights = all(scene.views.par_iter().map(|v| see(v, &field, scene.whole)))?;
    let settled = settled(scene, &mut sights, &field)?;
    // A build tells of what is missing as failures.
    let told = sights.par_iter().filter(|_| goal != Goal::All);
    let warnings: Vec<Diagnostic> = told
        .flat_map_iter(|s| s.coverage(scene, &field, &[]).warnings(&s.view.name))
        .collect();
    if goal == Goal::Check {
        return Ok(Build {
            summary: counts(scene),
            warnings,
            ..Build::default()
        });
    }
    progress("quadratic programs", 0.15);
    let shapes = all(sights.par_iter().map(|s| s.shape(scene, &field)))?;
    let warnings: Vec<Diagnostic> = warnings
        .into_iter()
        .chain(unsettled(&sights, &shapes))
        .collect();
    progress("solids", 0.45);
    let forest = solids(&field, &sights, &shapes)?;
    progress("pictures", 0.7);
    let built = Built {
        bvh: Bvh::new(forest.whole.mesh()),
        scene,
        field: &field,
        sights,
        settled,
        shapes,
        forest,
    };
    let pictures = pictures(&built);
    let summary = summary(scene, &built.forest, &pictures);
    if goal == Goal::Pictures {
        return Ok(Build {
            files: picture_files(scene, &pictures, true)
                .into_iter()
                .chain(section_files(scene, &built.shapes))
                .chain(turntable_file(&built))
                .collect(),
            summary,
            warnings,
            ..Build::default()
        });
    }
    let mut warnings = warnings;
    let split = if scene.output.split {
        progress("pieces", 0.75);
        let split = pieces(scene, &built.forest).map_err(|e| vec![e])?;
        warnings.extend(remarks(&split));
        Some(split)
    } else {
        None
    };
    progress("certificates", 0.8);
    let bodies = split.as_ref().map_or_else(Vec::new, bodies);
    let certificates = certificates(&built, &bodies);
    progress("files", 0.9);
    let mut files = printable_files(scene, &built.forest);
    files.extend(surface_files(scene, &built.shapes));
    files.extend(section_files(scene, &built.shapes));
    files.extend(turntable_file(&built));
    if let Some(split) = &split {
        let (pieces, warning) = split_files(scene, split);
        files.extend(pieces);
        warnings.extend(warning);
    }
    if scene.output.plan {
        files.extend(plan_files(scene, &rooms(&certificates.views)));
    }
    files.extend(camouflage_files(scene, &certificates.camouflage));
    let (mut report, unseen) = report(&built, &pictures, certificates);
    let failures = failures(scene, &report, unseen);
    report.judge(&failures, &warnings);
    files.push(file("report.json", report.json().into_bytes()));
    files.extend(picture_files(scene, &pictures, scene.output.views));
    files.extend(page(scene, &report, &pictures, &files));
    Ok(Build {
        files,
        summary,
        failures,
        warnings,
    })
}

/// Reliefs or whole meshes as solids.
fn solids(
    field: &SupportField,
    sights: &[Sight],
    shapes: &[Shape],
) -> Result<Forest, Vec<Diagnostic>> {
    let both = || sights.iter().zip(shapes);
    let wholes: Option<Vec<Whole>> = both().map(|(s, r)| s.joined(r)).collect();
    let forest = match wholes {
        Some(wholes) => joined(field, &wholes),
        None => {
            let reliefs: Vec<ViewRelief> = both().map(|(s, r)| s.relief(&r.relief)).collect();
            carve(field, &reliefs)
        }
    };
    forest.map_err(|e| {
        let error = Diagnostic::error(e.to_string());
        let crossings = shapes.iter().filter_map(|s| s.crossings);
        let pairs: usize = crossings.map(|c| c.self_intersections).sum();
        let whole = shapes.iter().any(|s| s.whole.is_some());
        vec![if whole && pairs > 0 {
            error.help(format!(
                "whole meshes cross themselves at {pairs} pairs of faces: `ordering: true` in `energy` prevents it"
            ))
        } else {
            error
        }]
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
