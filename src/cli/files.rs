//! Reading: the scene's text and the files it names, models and layouts.
//!
//! A scene may come from anywhere, so what it names is read only if it is a regular file in or below the scene's folder, links
//! followed, or if it lies, by its bare file name, in the folder the user gave with `--models`. Only `--allow-outside` lets a
//! scene name other files. What lies outside is not even looked at: no message tells whether it is there.

use pillarforest::diag::{Diagnostic, Place, escaped};
use pillarforest::scene::nearest;
use std::cell::RefCell;
use std::fs;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Larger files are refused.
const LARGEST_FILE: u64 = 2 << 30;

/// The text of a scene without byte order mark.
///
/// # Errors
/// No such file, not a regular file, or not UTF-8 (with the offset of the first bad byte).
pub(super) fn scene_text(path: &Path) -> Result<String, Diagnostic> {
    let shown = path.display().to_string();
    let bytes = regular(path).map_err(|problem| match path.exists() {
        true => problem,
        false => Diagnostic::error(format!("there is no scene \"{shown}\""))
            .help("`pillarforest init` writes one to start from; or give its name: `pillarforest build scenes/my.ron`"),
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let offset = error.utf8_error().valid_up_to() as u64;
        Diagnostic::error(format!(
            "the scene is not UTF-8 text: byte {offset} fits no character"
        ))
        .at(Place::Byte {
            file: shown,
            offset,
        })
        .help("save it as UTF-8 in the editor")
    })?;
    Ok(text
        .strip_prefix('\u{feff}')
        .map(str::to_string)
        .unwrap_or(text))
}

/// The bytes of a regular file of reasonable size.
pub(super) fn regular(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let shown = path.display().to_string();
    let fail = |why: String| Diagnostic::error(format!("cannot read \"{shown}\": {why}"));
    let meta = fs::metadata(path).map_err(|e| fail(e.to_string()))?;
    if meta.is_dir() {
        return Err(fail("it is a directory".into()));
    }
    if !meta.is_file() {
        return Err(fail("it is not a regular file".into()));
    }
    if meta.len() > LARGEST_FILE {
        return Err(fail(format!(
            "it is {} MB large; the limit is {} MB",
            meta.len() >> 20,
            LARGEST_FILE >> 20
        )));
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(|e| fail(e.to_string()))?;
    file.take(LARGEST_FILE)
        .read_to_end(&mut bytes)
        .map_err(|e| fail(e.to_string()))?;
    Ok(bytes)
}

/// Where the files that a scene names are looked for.
pub(super) struct SceneFiles {
    folder: PathBuf,
    libraries: Vec<PathBuf>,
    /// Whether the user lets the scene name files anywhere.
    anywhere: bool,
    /// Those read so far.
    read: RefCell<Vec<PathBuf>>,
}

impl SceneFiles {
    /// The files of a scene; `anywhere` lets it name files outside of its folder.
    pub(super) fn of(scene: &Path, libraries: Vec<PathBuf>, anywhere: bool) -> Self {
        let folder = scene
            .parent()
            .filter(|p| !p.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        Self {
            folder: folder.to_path_buf(),
            libraries,
            anywhere,
            read: RefCell::default(),
        }
    }

    /// The files that were read.
    pub(super) fn into_read(self) -> Vec<PathBuf> {
        self.read.into_inner()
    }

    /// Reads the file a scene calls `name`.
    ///
    /// # Errors
    /// The name is no plain path, leads out of the scene's folder, or there is no such regular file.
    pub(super) fn read(&self, name: &str) -> Result<Vec<u8>, Diagnostic> {
        let (path, found) = self.find(name)?;
        let bytes = regular(&found)?;
        self.read.borrow_mut().push(path);
        Ok(bytes)
    }

    /// The path that the name means, and the file to read: links on the way to it are followed only once.
    fn find(&self, name: &str) -> Result<(PathBuf, PathBuf), Diagnostic> {
        well_named(name)?;
        let named = Path::new(name);
        let file = named.file_name();
        let places = self.libraries.iter().filter_map(|l| Some(l.join(file?)));
        if let Some(found) = places.into_iter().find(|p| p.exists()) {
            return Ok((found.clone(), found));
        }
        if !self.anywhere && climbs(named) {
            return Err(outside("the file lies outside the scene's folder"));
        }
        let path = self.folder.join(named);
        match fs::canonicalize(&path) {
            Ok(found) if self.may_read(&found) => Ok((path, found)),
            Ok(_) => Err(outside(
                "the file is a link that leads outside the scene's folder",
            )),
            Err(_) => Err(self.missing(&path)),
        }
    }

    /// Whether a path without links lies where scenes may read.
    fn may_read(&self, found: &Path) -> bool {
        self.anywhere || fs::canonicalize(&self.folder).is_ok_and(|f| found.starts_with(f))
    }

    /// No such file: where it was looked for, and what is there instead.
    fn missing(&self, path: &Path) -> Diagnostic {
        let absolute = std::path::absolute(path).unwrap_or(path.to_path_buf());
        let mut problem = Diagnostic::error(format!(
            "there is no file \"{}\"",
            escaped(&absolute.display().to_string())
        ));
        let wanted = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_string();
        let folder = path.parent().unwrap_or(Path::new("."));
        let may_list = fs::canonicalize(folder).is_ok_and(|f| self.may_read(&f));
        let list = may_list.then(|| fs::read_dir(folder).ok()).flatten();
        let mut there: Vec<String> = list
            .into_iter()
            .flatten()
            .take(1000)
            .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().to_string()))
            .collect();
        there.sort();
        if let Some(guess) = nearest(&wanted, there.iter().map(String::as_str)) {
            problem = problem.help(format!("did you mean \"{}\"?", escaped(guess)));
        }
        if self.libraries.is_empty() {
            return problem.help("models kept elsewhere are found with `--models DIR` or the variable PILLARFOREST_MODELS");
        }
        let shown = |l: &PathBuf| format!("\"{}\"", escaped(&l.display().to_string()));
        let shown: Vec<String> = self.libraries.iter().map(shown).collect();
        problem.help(format!(
            "it is not in {} (--models) either",
            shown.join(" or ")
        ))
    }
}

/// Whether a path, read as text, leaves the folder it starts in.
fn climbs(path: &Path) -> bool {
    let mut depth = 0i32;
    path.components().any(|c| {
        depth += match c {
            Component::Normal(_) => 1,
            Component::CurDir => 0,
            Component::ParentDir => -1,
            Component::Prefix(_) | Component::RootDir => return true,
        };
        depth < 0
    })
}

fn outside(why: &str) -> Diagnostic {
    Diagnostic::error(why)
        .help("copy it beside the scene, or give its folder: `--models DIR` finds it by its file name")
        .help("`--allow-outside` lets a scene that you trust name any file")
}

/// Refuses names that mean something else on another system, or no file at all.
fn well_named(name: &str) -> Result<(), Diagnostic> {
    let fail =
        |why: &str, help: &str| Err(Diagnostic::error(why.to_string()).help(help.to_string()));
    if name.trim().is_empty() {
        return fail(
            "the name of the file is empty",
            "give a file beside the scene: file: \"models/owl.ply\"",
        );
    }
    if name.contains("://") {
        return fail(
            "a file cannot be read from the network",
            "download the file first and name the copy",
        );
    }
    if name.starts_with("\\\\") || name.starts_with("//") {
        return fail(
            "a model cannot be read from a network share",
            "copy the file beside the scene",
        );
    }
    if name.contains('\\') {
        return fail(
            "the file name has backslashes",
            "write folders with `/`, which works on every system",
        );
    }
    if name.contains('\0') {
        return fail(
            "the file name holds a NUL character",
            "give a file beside the scene",
        );
    }
    Ok(())
}
