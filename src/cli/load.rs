//! Scenes as commands read them.

use super::args::{Effort, SceneArgs};
use super::ending::{FAILED, NOTHING, WRONG_INPUT, fail};
use super::files::{self, SceneFiles};
use super::messages::{Messages, Source};
use super::progress::Reporter;
use super::threads;
use pillarforest::diag::{Diagnostic, Warned};
use pillarforest::scene::{self, Purpose, Quality, Scene};
use std::path::PathBuf;
use std::time::Instant;

/// A scene read for a command, with its text for messages.
pub(super) struct Loaded {
    pub scene: Scene,
    pub warnings: Vec<Diagnostic>,
    pub source: Source,
    /// The files it names that were read.
    pub read: Vec<PathBuf>,
}

/// Reads a scene with its models and prints what is wrong with it; `None` if that ends the run.
pub(super) fn load(
    messages: &Messages,
    args: &SceneArgs,
    purpose: Purpose,
    reporter: &Reporter,
) -> Option<Loaded> {
    let mut remarks: Vec<Diagnostic> = threads::start(args.jobs).into_iter().collect();
    remarks.extend(libraries_missing(&args.models));
    if messages.print(&remarks, None) {
        messages.closing(&remarks, NOTHING);
        return None;
    }
    let stop = |list: &[Diagnostic], source: Option<&Source>| {
        fail(messages, list, source, WRONG_INPUT);
        None
    };
    let mut text = match files::scene_text(&args.scene) {
        Ok(text) => text,
        Err(problem) => return stop(&[problem], None),
    };
    text = scene::at_quality(&text, quality(args.quality));
    for assignment in &args.sets {
        text = match scene::set(&text, assignment) {
            Ok(text) => text,
            Err(problem) => return stop(&[problem], None),
        };
    }
    let changed = match (args.sets.is_empty(), args.quality) {
        (false, _) => " (with --set)",
        (true, Effort::Normal) => "",
        (true, _) => " (with --quality)",
    };
    let source = Source {
        path: format!("{}{changed}", args.scene.display()),
        text,
    };
    let files = SceneFiles::of(&args.scene, libraries(&args.models), args.allow_outside);
    let told = |stage: &str| reporter.report(stage, 0.0);
    let resolved = scene::resolve_for(&source.text, &|name| files.read(name), purpose, &told);
    reporter.pause();
    match resolved {
        Err(problems) => stop(&problems, Some(&source)),
        Ok(Warned { value, warnings }) => {
            if messages.print(&warnings, Some(&source)) {
                messages.closing(&warnings, NOTHING);
                return None;
            }
            Some(Loaded {
                scene: value,
                warnings,
                source,
                read: files.into_read(),
            })
        }
    }
}

/// The folders that the user named, or else the one that the surroundings name.
pub(super) fn libraries(named: &[PathBuf]) -> Vec<PathBuf> {
    if !named.is_empty() {
        return named.to_vec();
    }
    let variable = std::env::var_os("PILLARFOREST_MODELS").filter(|v| !v.is_empty());
    variable.map(PathBuf::from).into_iter().collect()
}

/// Folders to look for models in that are not there. Scenes may do without them, so that this is no error.
fn libraries_missing(named: &[PathBuf]) -> Vec<Diagnostic> {
    let whose = match named {
        [] => "the variable PILLARFOREST_MODELS",
        _ => "`--models`",
    };
    let libraries = libraries(named);
    let missing = libraries.iter().filter(|l| !l.is_dir());
    let warning = |l: &PathBuf| {
        let what = if l.exists() {
            "is no folder"
        } else {
            "does not exist"
        };
        let text = format!(
            "\"{}\", where {whose} looks for models, {what}",
            l.display()
        );
        Diagnostic::warning(text).help("give a folder that holds the models' files: `--models DIR`")
    };
    missing.map(warning).collect()
}

fn quality(effort: Effort) -> Quality {
    match effort {
        Effort::Draft => Quality::Draft,
        Effort::Normal => Quality::Normal,
        Effort::Final => Quality::Final,
    }
}

impl Loaded {
    /// Tells, from now on, whether a search for pillars has had its time. The library has no clock.
    pub(super) fn time_is_up(&self) -> impl Fn() -> bool + Sync + use<> {
        let brief = self.scene.brief.as_ref();
        let seconds = brief.map_or(f64::INFINITY, |b| b.seconds);
        let start = Instant::now();
        move || start.elapsed().as_secs_f64() > seconds
    }

    /// Prints what ended the run; gives the exit code.
    pub(super) fn failed(&self, messages: &Messages, problems: &[Diagnostic]) -> u8 {
        let all: Vec<Diagnostic> = problems.iter().chain(&self.warnings).cloned().collect();
        messages.print(problems, Some(&self.source));
        messages.closing(&all, NOTHING);
        let errors = problems.iter().filter(|d| d.is_error());
        match errors.into_iter().all(|d| d.fault) {
            true => FAILED,
            false => WRONG_INPUT,
        }
    }
}
