//! The pipeline on one screen: the only module that runs stages on a scene, one function for each goal.
//!
//! Takes a resolved [`Scene`], gives the bytes of every output file; touches no file, clock or terminal.
//! Views are independent until the solids are united and run in parallel; nothing depends on the thread count.

mod built;
mod certificates;
mod effort;
mod elsewhere;
mod files;
mod headline;
mod laid;
mod names;
mod output;
mod page;
mod pictures;
mod planning;
mod print;
mod progress;
mod sight;
mod split;
mod stages;
mod summary;
mod verdict;

pub use effort::slow;
pub use names::{build_names, picture_names, plan_names};
pub use output::{Build, Drawn, OutputFile};
pub use planning::{LAYOUT, SEARCH_FILES, cut_short, plan_outputs, planned, repaired, shortfalls};
pub use progress::{Progress, Stop};

use crate::diag::Diagnostic;
use crate::scene::Scene;
use crate::viewmap::SupportField;
use certificates::certificates;
use files::{forest_files, plan_files, section_files};
use headline::{counts, headline};
use laid::{laid, laid_at_first};
use page::page;
use pictures::{drawn, picture_files, turntable_file};
use sight::{unheld, unsettled};
use split::divided;
use stages::{built, missing, seen};
use summary::report;
use verdict::{failures, remarks};

/// Everything the scene's output section names, judged. Pillars are found first if the scene wants it, as for every goal.
///
/// # Errors
/// All errors of the stage that failed, at least one of them.
pub fn build(scene: &Scene, progress: Progress, stop: Stop) -> Result<Build, Vec<Diagnostic>> {
    let laid = laid(scene, progress, stop)?;
    let (scene, progress) = (laid.scene(), &laid.rest(progress));
    let field = SupportField::new(&scene.supports);
    let (sights, settled) = seen(scene, &field, progress)?;
    let built = built(scene, &field, &sights, progress)?;
    progress("pictures", 0.7);
    let pictures = drawn(&built);
    let divided = divided(scene, &built.forest, progress)?;
    progress("certificates", 0.8);
    let certificates = certificates(&built, &settled, &divided.bodies);
    progress("files", 0.9);
    let failures = failures(&built, &certificates);
    let mut warnings = unheld(&sights, scene);
    warnings.extend(unsettled(built.sights, &built.shapes));
    warnings.extend(divided.warnings);
    warnings.extend(remarks(&built, &pictures, &certificates));
    let mut files = forest_files(&built, divided.files, &certificates);
    let mut report = report(&built, &pictures, certificates, divided.ladders);
    report.judge(&failures, &warnings);
    files.push(OutputFile::new("report.json", report.json().into_bytes()));
    files.extend(picture_files(scene, &pictures, scene.output.views));
    files.extend(page(scene, &report, &pictures, &files));
    files.extend(laid.layout());
    warnings.extend(laid.warning());
    Ok(Build {
        files,
        summary: headline(scene, &built.forest, &pictures),
        failures,
        warnings,
    })
}

/// Only plan.svg and plan.png.
///
/// # Errors
/// Which limits bind a search for pillars.
pub fn plan(scene: &Scene, progress: Progress, stop: Stop) -> Result<Drawn, Vec<Diagnostic>> {
    let laid = laid(scene, progress, stop)?;
    laid.rest(progress)("plan", 0.1);
    let scene = laid.scene();
    let mut files = plan_files(scene, &[]);
    files.extend(laid.layout());
    Ok(Drawn {
        files,
        summary: counts(scene),
        warnings: laid.warning().into_iter().collect(),
    })
}

/// Only the pictures (the forest is built for them).
///
/// # Errors
/// All errors of the stage that failed, at least one of them.
pub fn pictures(scene: &Scene, progress: Progress, stop: Stop) -> Result<Drawn, Vec<Diagnostic>> {
    let laid = laid(scene, progress, stop)?;
    let (scene, progress) = (laid.scene(), &laid.rest(progress));
    let field = SupportField::new(&scene.supports);
    let (sights, _) = seen(scene, &field, progress)?;
    let mut warnings = missing(scene, &sights);
    warnings.extend(unheld(&sights, scene));
    let built = built(scene, &field, &sights, progress)?;
    warnings.extend(unsettled(built.sights, &built.shapes));
    warnings.extend(laid.warning());
    progress("pictures", 0.7);
    let pictures = drawn(&built);
    let mut files = picture_files(scene, &pictures, true);
    files.extend(section_files(scene, &built.shapes));
    files.extend(turntable_file(&built));
    Ok(Drawn {
        files,
        summary: headline(scene, &built.forest, &pictures),
        warnings,
    })
}

/// Everything that can be looked at before solving: what is worth a warning. A scene that wants its pillars found is looked at with
/// those that a search would start from.
///
/// # Errors
/// All errors of the stage that failed, at least one of them.
pub fn check(
    scene: &Scene,
    progress: Progress,
    stop: Stop,
) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let laid = laid_at_first(scene, progress, stop)?;
    let (scene, progress) = (laid.scene(), &laid.rest(progress));
    let field = SupportField::new(&scene.supports);
    let (sights, _) = seen(scene, &field, progress)?;
    let mut warnings = missing(scene, &sights);
    warnings.extend(unheld(&sights, scene));
    warnings.extend(laid.warning());
    Ok(warnings)
}
