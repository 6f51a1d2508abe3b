//! Where a run writes to: checked before its work, so that nobody waits for minutes to be told of a file in the way.
//!
//! Nothing is written outside: a link in a file's place is replaced, not followed, and one in the place of a folder is refused.

use super::staging::{self, is_plain, parent};
use pillarforest::compile::OutputFile;
use pillarforest::diag::Diagnostic;
use std::fs;
use std::path::{Path, PathBuf};

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

/// Endings of files that no command writes alone, and what to type for what comes nearest.
const OTHER_ENDINGS: [(&str, &str); 20] = [
    ("obj", MESHES),
    ("ply", MESHES),
    ("off", MESHES),
    ("gltf", MESHES),
    ("amf", MESHES),
    ("step", MESHES),
    ("stp", MESHES),
    ("blend", MESHES),
    ("fbx", MESHES),
    (
        "gcode",
        "slice the forest: `-o forest.3mf` writes what slicers read",
    ),
    ("html", FOLDER),
    ("htm", FOLDER),
    ("zip", FOLDER),
    ("gif", FOLDER),
    ("webp", PICTURES),
    ("jpg", PICTURES),
    ("jpeg", PICTURES),
    ("bmp", PICTURES),
    ("pdf", PICTURES),
    ("dxf", PICTURES),
];
const MESHES: &str = "the forest as a mesh: `-o forest.3mf`, `-o forest.stl` or `-o forest.glb`; optimised surfaces as PLY and OBJ: \
    `output: (surface: true)` in the scene and a folder, `-o out/my`";
const FOLDER: &str = "it belongs to a whole set of files: give a folder, `-o out/my`";
const PICTURES: &str =
    "the plan alone: `-o plan.svg` or `-o plan.png`; all pictures: give a folder, `-o out/my`";

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
        if path.is_symlink() && !path.exists() {
            return Err(fail("it is a link that leads nowhere".into()));
        }
        let other = OTHER_ENDINGS.iter().find(|(other, _)| *other == ending);
        if let Some((_, help)) = other.filter(|_| !path.exists()) {
            return Err(fail(format!("no command makes a single .{ending} file")).help(*help));
        }
        let destination = if ENDINGS.contains(&ending.as_str()) && !path.is_dir() {
            if !allowed.contains(&ending.as_str()) {
                return Err(fail(match allowed {
                    [] => format!("this command makes no .{ending} file; it makes many files"),
                    _ => format!(
                        "this command makes no .{ending} file; it makes {}",
                        allowed.join(", ")
                    ),
                })
                .help("give a folder for all files: `-o out/my`"));
            }
            Self::File(path.clone())
        } else {
            if path.exists() && !path.is_dir() {
                return Err(fail("it is a file, not a directory".into()));
            }
            Self::Directory(path.clone())
        };
        let in_way = |a: &&Path| !a.as_os_str().is_empty() && a.symlink_metadata().is_ok();
        match path.ancestors().skip(1).find(in_way) {
            Some(a) if !a.exists() => Err(fail(format!(
                "\"{}\" is a link that leads nowhere",
                a.display()
            ))),
            Some(a) if !a.is_dir() => Err(fail(format!("\"{}\" is a file", a.display()))),
            _ => Ok(destination),
        }
    }

    /// The folder that files are written into, and their names there.
    fn places<'n>(
        &'n self,
        names: impl IntoIterator<Item = &'n str>,
    ) -> (&'n Path, Vec<std::borrow::Cow<'n, str>>) {
        match self {
            Self::Directory(folder) => (folder, names.into_iter().map(Into::into).collect()),
            Self::File(path) => {
                let name = path.file_name().unwrap_or_default();
                (parent(path), vec![name.to_string_lossy()])
            }
        }
    }

    /// Makes sure that files of these names can be written: nothing that the run reads is among them, nothing is in their way, and
    /// the system lets them be written. Finishes what killed runs left there.
    ///
    /// # Errors
    /// All that is in the way.
    pub(super) fn clear<'n>(
        &'n self,
        names: impl IntoIterator<Item = &'n str>,
        scene: &Path,
        read: &[PathBuf],
    ) -> Result<(), Vec<Diagnostic>> {
        let (folder, names) = self.places(names);
        let names = || names.iter().map(AsRef::as_ref);
        self.spares(names(), scene, read).map_err(|p| vec![p])?;
        let obstacles = staging::obstacles(folder, names());
        if !obstacles.is_empty() {
            return Err(obstacles);
        }
        staging::tidy(folder);
        Ok(())
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
    /// What could not be written, and what the system said. All is as it was even then.
    pub(super) fn write(&self, files: &[OutputFile]) -> Result<PathBuf, Diagnostic> {
        match self {
            Self::Directory(directory) => {
                check_names(files)?;
                let set: Vec<staging::Entry> = files
                    .iter()
                    .map(|f| (f.path.as_str(), f.bytes.as_slice()))
                    .collect();
                staging::write(directory, &set).map_err(|e| e.diagnostic())?;
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
                into_file(path, &file.bytes)?;
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

/// Writes one file, or leaves what was there.
///
/// # Errors
/// What the system said.
pub(super) fn into_file(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    staging::write(parent(path), &[(&name, bytes)]).map_err(|e| e.diagnostic())
}
