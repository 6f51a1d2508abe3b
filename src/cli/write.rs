//! Writing: whole sets of files, complete or not at all.
//!
//! Everything is written to a temporary directory inside the output directory first and then renamed into place, so that an
//! interrupted or failed run never leaves a torn file. Nothing is written outside: a link in a file's place is replaced, not
//! followed, and one in the place of a folder is refused.

use pillarforest::compile::OutputFile;
use pillarforest::diag::Diagnostic;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Where a run writes to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// All files into a directory.
    Directory(PathBuf),
    /// The one file of a run with this path's ending, to this path.
    File(PathBuf),
}

/// File endings that ask for one file rather than a directory.
const ENDINGS: [&str; 7] = ["3mf", "stl", "glb", "svg", "png", "json", "ron"];

impl Destination {
    /// What `-o` means, by default `out/<scene>`; checked as far as it can be before any work.
    ///
    /// # Errors
    /// The destination cannot be written: a file in the way, an unknown ending, no such place.
    pub(super) fn new(
        output: Option<&Path>,
        scene: &Path,
        allowed: &[&str],
    ) -> Result<Self, Diagnostic> {
        let stem = scene.file_stem().unwrap_or("scene".as_ref());
        // A scene called `...ron` has the stem `..`.
        let plain = Path::new(stem).components().all(is_plain);
        let stem = if plain { stem } else { "scene".as_ref() };
        let path = output.map_or_else(|| Path::new("out").join(stem), Path::to_path_buf);
        let fail = |why: String| {
            Diagnostic::error(format!("cannot write to \"{}\": {why}", path.display()))
        };
        let ending = path
            .extension()
            .map(|e| e.to_string_lossy().to_lowercase())
            .unwrap_or_default();
        let destination = if ENDINGS.contains(&ending.as_str()) && !path.is_dir() {
            if !allowed.contains(&ending.as_str()) {
                return Err(fail(format!(
                    "this command makes no .{ending} file; it makes {}",
                    allowed.join(", ")
                )));
            }
            Self::File(path.clone())
        } else {
            if path.exists() && !path.is_dir() {
                return Err(fail("it is a file, not a directory".into()));
            }
            Self::Directory(path.clone())
        };
        let ancestor = path
            .ancestors()
            .skip(1)
            .find(|a| a.as_os_str().is_empty() || a.exists());
        match ancestor {
            Some(a) if !a.as_os_str().is_empty() && !a.is_dir() => {
                Err(fail(format!("\"{}\" is a file", a.display())))
            }
            _ => Ok(destination),
        }
    }

    /// Refuses to overwrite the scene or a file that it names, `read`. `names` are those of the files to be written.
    ///
    /// # Errors
    /// Which of them is in the way.
    pub(super) fn spares<'n>(
        &self,
        names: impl IntoIterator<Item = &'n str>,
        scene: &Path,
        read: &[PathBuf],
    ) -> Result<(), Diagnostic> {
        let outputs: Vec<PathBuf> = match self {
            Self::Directory(directory) => names.into_iter().map(|n| directory.join(n)).collect(),
            Self::File(path) => vec![path.clone()],
        };
        for output in outputs {
            let what = if same(&output, scene) {
                "the scene itself"
            } else if read.iter().any(|file| same(&output, file)) {
                "a file that the scene uses"
            } else {
                continue;
            };
            return Err(Diagnostic::error(format!(
                "cannot write to \"{}\": it is {what}",
                output.display()
            ))
            .help("give another folder or name: `-o DIR`"));
        }
        Ok(())
    }

    /// Writes the files; gives the path to name in the last line.
    ///
    /// # Errors
    /// What the system said. No file is torn even then.
    pub(super) fn write(&self, files: &[OutputFile]) -> Result<PathBuf, Diagnostic> {
        match self {
            Self::Directory(directory) => {
                let fail = |e: std::io::Error| {
                    Diagnostic::error(format!("cannot write to \"{}\": {e}", directory.display()))
                };
                check_names(files)?;
                into_directory(directory, files).map_err(fail)?;
                Ok(files
                    .first()
                    .map_or(directory.clone(), |f| directory.join(&f.path)))
            }
            Self::File(path) => {
                let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
                let matches = |f: &&OutputFile| Path::new(&f.path).extension() == Some(&ending);
                let file = files.iter().find(matches).ok_or_else(|| {
                    Diagnostic::error(format!(
                        "the run made no .{} file",
                        ending.to_string_lossy()
                    ))
                    .help("the scene's `output` section may have switched it off")
                })?;
                into_file(path, &file.bytes).map_err(|e| {
                    Diagnostic::error(format!("cannot write \"{}\": {e}", path.display()))
                })?;
                Ok(path.clone())
            }
        }
    }
}

/// Whether writing `output` would replace `file`, or the link that it is: outputs replace links and do not follow them.
fn same(output: &Path, file: &Path) -> bool {
    let folder = |path: &Path| fs::canonicalize(parent(path)).ok();
    let entry = |path: &Path| Some(folder(path)?.join(path.file_name()?));
    let target = |path: &Path| fs::canonicalize(path).ok();
    let ours = match output.is_symlink() {
        true => [entry(output), None],
        false => [entry(output), target(output)],
    };
    let theirs = [entry(file), target(file)];
    ours.iter()
        .flatten()
        .any(|o| theirs.iter().flatten().any(|t| o == t))
}

/// Output names come from the program; a slip there must not write elsewhere.
fn check_names(files: &[OutputFile]) -> Result<(), Diagnostic> {
    let stays = |f: &&OutputFile| Path::new(&f.path).components().all(is_plain);
    match files.iter().find(|f| !stays(f)) {
        Some(file) => Err(Diagnostic::error(format!(
            "output name \"{}\" leaves the output directory",
            file.path
        ))),
        None => Ok(()),
    }
}

fn is_plain(part: Component) -> bool {
    matches!(part, Component::Normal(_))
}

fn into_directory(directory: &Path, files: &[OutputFile]) -> std::io::Result<()> {
    let fresh = !directory.exists();
    fs::create_dir_all(directory)?;
    let written = staged(directory, files);
    if fresh && written.is_err() {
        // Only if it is still empty.
        let _ = fs::remove_dir(directory);
    }
    written
}

fn staged(directory: &Path, files: &[OutputFile]) -> std::io::Result<()> {
    for file in files {
        no_links(directory, parent(Path::new(&file.path)))?;
    }
    let staging = tempfile::Builder::new()
        .prefix(".pillarforest-")
        .tempdir_in(directory)?;
    for file in files {
        let path = staging.path().join(&file.path);
        fs::create_dir_all(parent(&path))?;
        fs::write(&path, &file.bytes)?;
    }
    // Only now are other files in the target touched, by renames on one file system; those not of this run stay.
    for file in files {
        let path = directory.join(&file.path);
        fs::create_dir_all(parent(&path))?;
        fs::rename(staging.path().join(&file.path), &path)?;
    }
    staging.close()
}

/// Folders inside of the output directory must not lead out of it.
fn no_links(directory: &Path, folder: &Path) -> std::io::Result<()> {
    let mut path = directory.to_path_buf();
    for part in folder.components().filter(|c| is_plain(*c)) {
        path.push(part);
        if path.is_symlink() {
            let why = format!("\"{}\" is a link", path.display());
            return Err(std::io::Error::other(why));
        }
    }
    Ok(())
}

/// Writes one file by way of a temporary one beside it.
pub(super) fn into_file(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    fs::create_dir_all(parent(path))?;
    let staging = tempfile::Builder::new()
        .prefix(".pillarforest-")
        .tempdir_in(parent(path))?;
    let staged = staging.path().join("file");
    fs::write(&staged, bytes)?;
    fs::rename(&staged, path)?;
    staging.close()
}

fn parent(path: &Path) -> &Path {
    path.parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}
