//! Cases of figures and benches, built by this program, each in a process of its own: so that its time and memory are those that anybody
//! would measure.

use super::load::libraries;
use super::messages::tell;
use pillarforest::figures::{Job, Made};
use pillarforest::report::Report;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// How cases are built.
#[derive(Clone, Copy)]
pub(super) struct CaseBuilder<'a> {
    /// Where the scenes lie.
    pub scenes: &'a Path,
    pub models: &'a [PathBuf],
    /// Where the folders of the cases go.
    pub output: &'a Path,
    pub jobs: Option<u16>,
    /// Whether the names of cases are left out.
    pub quiet: bool,
}

impl CaseBuilder<'_> {
    /// Builds one case with its files.
    ///
    /// # Errors
    /// Why it was not built.
    pub(super) fn build(&self, job: &Job) -> Result<Made, String> {
        if !self.quiet {
            tell(&format!("       {}", job.folder));
        }
        let scene = scene_path(self.scenes, &job.scene);
        let folder = self.output.join(&job.folder);
        let program =
            std::env::current_exe().map_err(|e| format!("cannot find this program: {e}"))?;
        let mut command = Command::new(program);
        command.arg("build").arg(&scene).arg("-o").arg(&folder);
        command.args(["--force", "--quiet", "--timings", "--diagnostics", "json"]);
        for library in libraries(self.models)
            .iter()
            .chain([&self.scenes.join("../models")])
        {
            command.arg("--models").arg(library);
        }
        job.sets
            .iter()
            .for_each(|set| _ = command.arg("--set").arg(set));
        if let Some(jobs) = self.jobs {
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
