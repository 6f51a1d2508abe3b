//! `figures`: every case is a build of its own, by this program, so that its time and memory are those that anybody would measure.

use super::args::{FigureArgs, Global};
use super::ending::{FAILED, NOT_PRINTABLE, WELL, WRONG_INPUT, WRONG_USAGE, fail, say};
use super::load::libraries;
use super::messages::{Messages, tell};
use super::write::Destination;
use pillarforest::diag::Diagnostic;
use pillarforest::figures::{self, Done, FIGURES, FILES, Figure, Job, Made, Workshop};
use pillarforest::report::Report;
use pillarforest::scene::nearest;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Instant;

/// Makes the figures; gives the exit code.
pub(super) fn run(messages: &Messages, global: &Global, args: &FigureArgs) -> u8 {
    if args.list {
        let line = |f: &Figure| format!("{:<10}{}: {}\n", f.name, f.paper, f.title);
        return say(&FIGURES.iter().map(line).collect::<String>());
    }
    let wanted = match wanted(&args.names) {
        Ok(wanted) => wanted,
        Err(problems) => return fail(messages, &problems, None, WRONG_USAGE),
    };
    if let Err(problem) = has_scenes(&args.scenes) {
        return fail(messages, &[problem], None, WRONG_INPUT);
    }
    let destination = match Destination::new(Some(&args.output), Path::new("figures"), &[]) {
        Ok(destination @ Destination::Directory(_)) => destination,
        Ok(Destination::File(_)) => {
            let problem =
                Diagnostic::error("figures are many files").help("give a directory: `-o DIR`");
            return fail(messages, &[problem], None, WRONG_USAGE);
        }
        Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
    };
    if let Err(problems) = destination.clear(FILES, Path::new("figures"), &[]) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    let start = Instant::now();
    let done = made(&wanted, args, global);
    match destination.write(&figures::files(&done)) {
        Err(problem) => fail(messages, &[problem], None, FAILED),
        Ok(page) => {
            let mut text: String = done.iter().map(told_of).collect();
            let well = done.iter().filter(|d| d.ok()).count();
            text.push_str(&format!(
                "wrote {}  {well} of {} figures hold  ({:.1} s)\n",
                page.display(),
                done.len(),
                start.elapsed().as_secs_f64()
            ));
            match say(&text) {
                WELL if well < done.len() => NOT_PRINTABLE,
                said => said,
            }
        }
    }
}

/// That the scenes of the figures lie there.
pub(super) fn has_scenes(folder: &Path) -> Result<(), Diagnostic> {
    match folder.is_dir() {
        true => Ok(()),
        false => Err(Diagnostic::error(format!(
            "there is no folder \"{}\" with the scenes of the figures",
            folder.display()
        ))
        .help("run it where the program's sources lie, or say where: `--scenes DIR`")),
    }
}

/// The figures of these names, in the paper's order; all if there are no names.
fn wanted(names: &[String]) -> Result<Vec<Figure>, Vec<Diagnostic>> {
    let known = || FIGURES.iter().map(|f| f.name);
    let unknown = names.iter().filter(|n| known().all(|k| k != n.as_str()));
    let problems: Vec<Diagnostic> = unknown
        .map(|name| {
            let problem = Diagnostic::error(format!("there is no figure \"{name}\""));
            match nearest(name, known()) {
                Some(guess) => problem.help(format!("did you mean `{guess}`?")),
                None => problem.help("`pillarforest figures --list` says which there are"),
            }
        })
        .collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let is_wanted = |f: &&Figure| names.is_empty() || names.iter().any(|n| n == f.name);
    Ok(FIGURES.iter().filter(is_wanted).copied().collect())
}

fn made(wanted: &[Figure], args: &FigureArgs, global: &Global) -> Vec<Done> {
    let mut build = |job: &Job| {
        if !global.quiet {
            tell(&format!("       {}", job.folder));
        }
        built(job, args)
    };
    let mut workshop = Workshop::new(&mut build);
    let one = |figure: &Figure| {
        if !global.quiet {
            tell(&format!("{}: {}", figure.paper, figure.title));
        }
        figures::make(*figure, &mut workshop)
    };
    wanted.iter().map(one).collect()
}

/// What a figure claims, and what of it holds.
fn told_of(done: &Done) -> String {
    let Done {
        figure,
        findings,
        failure,
    } = done;
    let mut text = format!("{}: {}\n", figure.paper, figure.title);
    for claim in &findings.claims {
        let sign = if claim.holds {
            "holds"
        } else {
            "DOES NOT HOLD"
        };
        text.push_str(&format!("    {sign}: {}\n", claim.text));
    }
    for case in findings.cases.iter().filter(|c| !c.ok) {
        text.push_str(&format!(
            "    DOES NOT HOLD: what a build promises, in the case {}\n",
            case.name
        ));
    }
    if let Some(why) = failure {
        text.push_str(&format!("    NOT MADE: {why}\n"));
    }
    text
}

/// Builds one case with its files.
pub(super) fn built(job: &Job, args: &FigureArgs) -> Result<Made, String> {
    let scene = scene_path(&args.scenes, &job.scene);
    let folder = args.output.join(&job.folder);
    let program = std::env::current_exe().map_err(|e| format!("cannot find this program: {e}"))?;
    let mut command = Command::new(program);
    command.arg("build").arg(&scene).arg("-o").arg(&folder);
    command.args(["--force", "--quiet", "--timings", "--diagnostics", "json"]);
    for library in libraries(&args.models)
        .iter()
        .chain([&args.scenes.join("../models")])
    {
        command.arg("--models").arg(library);
    }
    job.sets
        .iter()
        .for_each(|set| _ = command.arg("--set").arg(set));
    if let Some(jobs) = args.jobs {
        command.arg("-j").arg(jobs.to_string());
    }
    let output = command.stdin(Stdio::null()).output();
    let output = output.map_err(|e| format!("cannot start a build: {e}"))?;
    let told = told(&output);
    if !matches!(output.status.code(), Some(0 | 3)) {
        return Err(failure(&told, &output));
    }
    read(job, &scene, &folder, &told)
}

/// The path without detours: `scenes/paper/../four-creatures` is `scenes/four-creatures`.
fn scene_path(scenes: &Path, scene: &str) -> PathBuf {
    let (folder, name) = match scene.strip_prefix("../") {
        Some(name) => (scenes.parent().unwrap_or(Path::new("..")), name),
        None => (scenes, scene),
    };
    folder.join(name).with_extension("ron")
}

/// The JSON objects that a build printed.
fn told(output: &Output) -> Vec<Value> {
    let text = String::from_utf8_lossy(&output.stderr);
    text.lines()
        .filter_map(|l| serde_json::from_str(l).ok())
        .collect()
}

fn failure(told: &[Value], output: &Output) -> String {
    let errors = told.iter().filter(|v| v["severity"] == "error");
    let errors: Vec<&str> = errors.filter_map(|v| v["message"].as_str()).collect();
    match errors[..] {
        [] => format!("the build ended with {}", output.status),
        _ => errors.join("; "),
    }
}

/// What a build wrote and told.
fn read(job: &Job, scene: &Path, folder: &Path, told: &[Value]) -> Result<Made, String> {
    let path = folder.join("report.json");
    let text = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let report = Report::read(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    let timings = told.iter().find(|v| v["timings"].is_array());
    let timings = timings.ok_or("the build told no times")?;
    let stages = timings["timings"].as_array().into_iter().flatten();
    let stage = |s: &Value| Some((s["stage"].as_str()?.to_owned(), s["seconds"].as_f64()?));
    let mut files = Vec::new();
    list(folder, "", &mut files);
    files.sort();
    Ok(Made {
        job: job.clone(),
        scene: scene.display().to_string(),
        report,
        seconds: timings["seconds"].as_f64().unwrap_or_default(),
        stages: stages.filter_map(stage).collect(),
        peak_mb: timings["peak_memory_mb"].as_f64(),
        files,
    })
}

/// All files below a folder, by their paths from it with `/`.
fn list(folder: &Path, before: &str, files: &mut Vec<String>) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        match entry.file_type() {
            Ok(kind) if kind.is_dir() => list(&entry.path(), &format!("{name}/"), files),
            _ => files.push(name),
        }
    }
}
