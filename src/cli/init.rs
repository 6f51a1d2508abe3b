//! `init`: a scene to start from, with the program's own model or with those of the user.

use super::ending::{FAILED, WRONG_INPUT, WRONG_USAGE, fail, say};
use super::files::{self, SceneFiles};
use super::messages::{Messages, tell};
use super::{threads, write};
use pillarforest::compile;
use pillarforest::diag::{Diagnostic, Warned, escaped};
use pillarforest::intake;
use pillarforest::scene::{self, StarterModel};
use std::path::{Path, PathBuf};

/// Shares of the usual size of models that are tried in turn, until a search for pillars has where to start.
const SHARES: [f64; 4] = [1.0, 0.85, 0.7, 0.5];

/// A file to be written: where, and its bytes.
type Fresh = (PathBuf, Vec<u8>);

/// Writes the scene, to the one `.ron` file among `paths` or to scene.ron; the others are the models it shows. Gives the exit code.
pub(super) fn run(messages: &Messages, paths: &[PathBuf], force: bool) -> u8 {
    let is_scene = |p: &&PathBuf| p.extension().is_some_and(|e| e.eq_ignore_ascii_case("ron"));
    let (scenes, models): (Vec<&PathBuf>, Vec<&PathBuf>) = paths.iter().partition(is_scene);
    if scenes.len() > 1 {
        let problem = Diagnostic::error(
            "`init` writes one scene, and several .ron files are named",
        )
        .help("name one of them and the models it is to show: `pillarforest init my.ron fox.obj`");
        return fail(messages, &[problem], None, WRONG_USAGE);
    }
    let scene = scenes
        .first()
        .map_or(Path::new("scene.ron"), |p| p.as_path());
    let files = match models.is_empty() {
        true => Ok(template(scene)),
        false => own(messages, scene, &models),
    };
    let files = match files {
        Ok(files) => files,
        Err(problems) => return fail(messages, &problems, None, WRONG_INPUT),
    };
    let in_way: Vec<Diagnostic> = files
        .iter()
        .filter(|(path, bytes)| {
            path.exists() && !force && std::fs::read(path).ok().as_ref() != Some(bytes)
        })
        .map(|(path, _)| {
            Diagnostic::error(format!("\"{}\" exists already", path.display()))
                .help("`--force` overwrites it; or give another name: `pillarforest init my.ron`")
        })
        .collect();
    if !in_way.is_empty() {
        return fail(messages, &in_way, None, WRONG_INPUT);
    }
    for (path, bytes) in &files {
        if let Err(problem) = write::into_file(path, bytes) {
            return fail(messages, &[problem], None, FAILED);
        }
    }
    let written: Vec<String> = files.iter().map(|(p, _)| p.display().to_string()).collect();
    let argument = match scene == Path::new("scene.ron") {
        true => String::new(),
        false => format!(" {}", scene.display()),
    };
    say(&format!(
        "wrote {}\nnext: pillarforest build{argument}\n",
        written.join(" and ")
    ))
}

fn template(scene: &Path) -> Vec<Fresh> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    vec![
        (scene.to_path_buf(), scene::TEMPLATE.into()),
        (
            folder.join(scene::TEMPLATE_MODEL_FILE),
            scene::TEMPLATE_MODEL.to_vec(),
        ),
    ]
}

/// The scene with the user's models, and copies of those that lie outside of its folder.
fn own(
    messages: &Messages,
    scene: &Path,
    models: &[&PathBuf],
) -> Result<Vec<Fresh>, Vec<Diagnostic>> {
    let remarks: Vec<Diagnostic> = threads::start(None).into_iter().collect();
    messages.print(&remarks, None);
    let (mut problems, mut known, mut copies) = (Vec::new(), Vec::new(), Vec::new());
    for path in models {
        match starter_model(messages, scene, path) {
            Err(problem) => problems.push(problem),
            Ok((model, copy)) => {
                tell(&format!(
                    "{}: up: \"{}\", front: \"{}\" ({}; `pillarforest inspect --views {}` draws all sides)",
                    escaped(&path.display().to_string()),
                    model.up,
                    model.front,
                    model.reason,
                    escaped(&path.display().to_string()),
                ));
                known.push(model);
                copies.extend(copy);
            }
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let typed: Vec<String> = models.iter().map(|p| p.display().to_string()).collect();
    let command = escaped(&format!("pillarforest init {}", typed.join(" ")));
    let text = fitting(scene, &known, &copies, &command)?;
    let mut files = vec![(scene.to_path_buf(), text.into_bytes())];
    files.extend(copies);
    Ok(files)
}

/// A model as the scene will name it, and its copy if it lies where the scene may not read.
fn starter_model(
    messages: &Messages,
    scene: &Path,
    path: &Path,
) -> Result<(StarterModel, Option<Fresh>), Diagnostic> {
    let bytes = files::regular(path)?;
    let shown = path.display().to_string();
    let Warned { value, warnings } = intake::load_model(&shown, &bytes, false)?;
    messages.print(&warnings, None);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = scene.parent().unwrap_or(Path::new(""));
    let (name, copy) = match below(folder, path) {
        Some(name) => (name, None),
        None => {
            let file = path.file_name().unwrap_or_default();
            let name = format!("models/{}", file.to_string_lossy());
            let copy = folder.join("models").join(file);
            (name, Some((copy, bytes)))
        }
    };
    Ok((StarterModel::new(&stem, &name, &value), copy))
}

/// The name of a file from a folder that it lies in or below, with `/`.
fn below(folder: &Path, path: &Path) -> Option<String> {
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let [folder, path] = [folder, path].map(|p| std::fs::canonicalize(p).ok());
    let inside = path?.strip_prefix(folder?).ok()?.to_path_buf();
    let parts: Vec<&str> = inside.iter().filter_map(|p| p.to_str()).collect();
    (parts.len() == inside.iter().count()).then(|| parts.join("/"))
}

/// The scene's text with models of the largest size at which `check` finds no error.
fn fitting(
    scene: &Path,
    models: &[StarterModel],
    copies: &[Fresh],
    command: &str,
) -> Result<String, Vec<Diagnostic>> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let files = SceneFiles::of(scene, Vec::new(), false);
    let read = |name: &str| match copies.iter().find(|(p, _)| *p == folder.join(name)) {
        Some((_, bytes)) => Ok(bytes.clone()),
        None => files.read(name),
    };
    let mut problems = Vec::new();
    for share in SHARES {
        let text = scene::starter(models, share, command);
        let checked = scene::resolve(&text, &read)
            .and_then(|scene| compile::check(&scene.value, &|_, _| (), &|| false));
        match checked {
            Ok(_) => return Ok(text),
            Err(found) => problems = found,
        }
    }
    // Places in a text that is not written help nobody.
    problems.iter_mut().for_each(|p| p.place = None);
    Err(problems)
}
