//! Sets of files that are written together: all of them or none, whatever ends the run.
//!
//! A set is first written to a hidden folder inside of the output folder, to `.pillarforest-XXXXXX/making`. When all of it lies there,
//! one rename makes `making` to `ready`: from then on the new set counts. Its files are then renamed into place one by one, and those
//! they replace kept beside `ready` until the last is there.
//!
//! - An error before that moment removes the hidden folder, and one after it puts the old files back.
//! - A signal waits ([`Held`]): before that moment it removes the hidden folder, after it the set is put into place first.
//! - A run that is killed outright, or has its power cut, leaves its hidden folder. While it lives it holds a lock on it, so that the next
//!   run to the same place knows what is left of the dead ([`tidy`]): a set that is `ready` is put into place, any other removed.
//!
//! The folder is not exchanged as a whole: it may hold other files, be a link, a mount, or the place where a shell or a viewer stands.

use super::signals::Held;
use pillarforest::diag::Diagnostic;
use std::error::Error;
use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

const PREFIX: &str = ".pillarforest-";

/// What could not be written, and what the system said.
#[derive(Debug)]
pub(super) struct Unwritten {
    path: PathBuf,
    why: io::Error,
}

impl Unwritten {
    pub(super) fn diagnostic(&self) -> Diagnostic {
        let Self { path, why } = self;
        let why = said(why);
        Diagnostic::error(format!("cannot write \"{}\": {why}", path.display()))
            .help("what was there before is as it was")
    }
}

/// A file of a set: its path from the set's folder with `/`, and its bytes.
pub(super) type Entry<'a> = (&'a str, &'a [u8]);

/// Writes a set of files into a folder, which is made if there is none. Other files there stay.
///
/// # Errors
/// The file that cannot be written. The folder is then as it was.
pub(super) fn write(folder: &Path, set: &[Entry]) -> Result<(), Unwritten> {
    let held = Held::new();
    let mut made = Vec::new();
    let written = make_folders(folder, &mut made)
        .map_err(|why| unwritten(folder, why))
        .and_then(|()| staged(folder, set, &held));
    if written.is_err() {
        remove_folders(&made);
    }
    written
}

fn unwritten(path: &Path, why: io::Error) -> Unwritten {
    let path = path.to_path_buf();
    Unwritten { path, why }
}

fn staged(folder: &Path, set: &[Entry], held: &Held) -> Result<(), Unwritten> {
    let hidden = tempfile::Builder::new()
        .prefix(PREFIX)
        .tempdir_in(folder)
        .map_err(|why| unwritten(folder, why))?;
    let _alive = lock(hidden.path());
    let making = hidden.path().join("making");
    for (name, bytes) in set {
        let path = making.join(name);
        let written = fs::create_dir_all(parent(&path)).and_then(|()| fs::write(&path, bytes));
        written.map_err(|why| unwritten(&folder.join(name), why))?;
        if held.came() {
            return Err(unwritten(folder, io::ErrorKind::Interrupted.into()));
        }
    }
    fs::rename(&making, hidden.path().join("ready")).map_err(|why| unwritten(folder, why))?;
    let names: Vec<&str> = set.iter().map(|(name, _)| *name).collect();
    into_place(hidden.path(), folder, &names)
    // What cannot be removed of the hidden folder is for the next run to tidy.
}

/// Renames files that are ready in a hidden folder into place; all of them or none.
fn into_place(hidden: &Path, folder: &Path, names: &[&str]) -> Result<(), Unwritten> {
    let (mut done, mut made) = (Vec::<&str>::new(), Vec::new());
    for name in names {
        if let Err(why) = replace(hidden, folder, name, &mut made) {
            done.iter().rev().for_each(|n| put_back(hidden, folder, n));
            remove_folders(&made);
            return Err(unwritten(&folder.join(name), why));
        }
        done.push(*name);
    }
    Ok(())
}

fn replace(hidden: &Path, folder: &Path, name: &str, made: &mut Vec<PathBuf>) -> io::Result<()> {
    let (ready, place) = (hidden.join("ready").join(name), folder.join(name));
    let replaced = hidden.join("replaced").join(name);
    make_folders(parent(&place), made)?;
    if let Ok(there) = place.symlink_metadata() {
        if there.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        fs::create_dir_all(parent(&replaced))?;
        // A second name keeps the old file in its place until the new one takes it; not all file systems have them.
        fs::hard_link(&place, &replaced).or_else(|_| fs::rename(&place, &replaced))?;
    }
    fs::rename(ready, &place).inspect_err(|_| put_back(hidden, folder, name))
}

/// The old file in its place, or none if there was none. What fails here cannot be helped.
fn put_back(hidden: &Path, folder: &Path, name: &str) {
    let (place, replaced) = (folder.join(name), hidden.join("replaced").join(name));
    let _ = match replaced.symlink_metadata() {
        Ok(_) => fs::rename(replaced, place),
        Err(_) => fs::remove_file(place),
    };
}

/// Finishes what runs left in a folder that were killed while they wrote.
pub(super) fn tidy(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries {
        let is_ours = entry.file_name().to_string_lossy().starts_with(PREFIX);
        if !is_ours || !entry.file_type().is_ok_and(|t| t.is_dir()) {
            continue;
        }
        let hidden = entry.path();
        // Whoever holds the lock is still at it.
        let Some(_dead) = lock(&hidden) else { continue };
        let mut names = Vec::new();
        list(&hidden.join("ready"), "", &mut names);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if into_place(&hidden, folder, &names).is_ok() {
            let _ = fs::remove_dir_all(hidden);
        }
    }
}

/// A lock on a folder as long as the value lives; `None` if another process holds it or the system has none for folders.
fn lock(folder: &Path) -> Option<File> {
    let file = File::open(folder).ok()?;
    file.try_lock().ok().map(|()| file)
}

/// All files below a folder by their paths from it with `/`.
fn list(folder: &Path, before: &str, names: &mut Vec<String>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        match entry.file_type() {
            Ok(kind) if kind.is_dir() => list(&entry.path(), &format!("{name}/"), names),
            _ => names.push(name),
        }
    }
}

/// What keeps a set of these names from being written into a folder, all of it. A name that ends in `/` stands for files in that
/// folder. Nothing is changed there.
pub(super) fn obstacles<'n>(
    folder: &Path,
    names: impl IntoIterator<Item = &'n str>,
) -> Vec<Diagnostic> {
    let there = folder.ancestors().map(or_here).find(|a| a.exists());
    let mut found: Vec<String> = there.and_then(unwritable).into_iter().collect();
    for name in names {
        let path = Path::new(name);
        let inside = path.ancestors().filter(|a| !a.as_os_str().is_empty());
        // The outermost first; the path itself is a folder only if it says so.
        for part in inside.collect::<Vec<_>>().into_iter().rev() {
            let wants_folder = part != path || name.ends_with('/');
            found.extend(obstacle(&folder.join(part), wants_folder));
        }
    }
    let mut told: Vec<String> = Vec::new();
    for text in found {
        if !told.contains(&text) {
            told.push(text);
        }
    }
    let diagnostic = |text| {
        Diagnostic::error(text).help("move it away, or give another folder or name: `-o DIR`")
    };
    told.into_iter().map(diagnostic).collect()
}

/// What is wrong with a place where a folder, or else a file, is wanted.
fn obstacle(place: &Path, wants_folder: bool) -> Option<String> {
    let there = place.symlink_metadata().ok()?;
    let shown = place.display();
    match (wants_folder, there.is_dir()) {
        (true, true) => unwritable(place),
        (true, false) if there.is_symlink() => Some(format!(
            "cannot write into \"{shown}\": \"{shown}\" is a link, and a folder of its own is wanted there"
        )),
        (true, false) => Some(format!(
            "cannot write into \"{shown}\": it is a file, and a folder is wanted there"
        )),
        (false, true) => Some(format!(
            "cannot write \"{shown}\": it is a folder, and a file is wanted there"
        )),
        (false, false) => None,
    }
}

/// Why nothing can be written into a folder: only trying tells.
fn unwritable(folder: &Path) -> Option<String> {
    let tried = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder);
    let why = tried.and_then(tempfile::TempDir::close).err()?;
    Some(format!(
        "cannot write to \"{}\": {}",
        folder.display(),
        said(&why)
    ))
}

/// What the system said, without the hidden folder's name.
fn said(why: &io::Error) -> String {
    why.source().map_or(why.to_string(), ToString::to_string)
}

/// Makes a folder and those above it, and adds those that were missing to `made`.
fn make_folders(folder: &Path, made: &mut Vec<PathBuf>) -> io::Result<()> {
    let missing = folder.ancestors().take_while(|a| !or_here(a).exists());
    for folder in missing.collect::<Vec<_>>().into_iter().rev() {
        match fs::create_dir(folder) {
            // Somebody else was faster.
            Err(_) if folder.is_dir() => {}
            Err(why) => return Err(why),
            Ok(()) => made.push(folder.to_path_buf()),
        }
    }
    Ok(())
}

/// Removes folders that are still empty, the last made first.
fn remove_folders(made: &[PathBuf]) {
    for folder in made.iter().rev() {
        let _ = fs::remove_dir(folder);
    }
}

fn or_here(path: &Path) -> &Path {
    match path.as_os_str().is_empty() {
        true => Path::new("."),
        false => path,
    }
}

pub(super) fn parent(path: &Path) -> &Path {
    path.parent().map_or(Path::new("."), or_here)
}

/// Whether a part of a path is a name: no root, no `..`.
pub(super) fn is_plain(part: Component) -> bool {
    matches!(part, Component::Normal(_))
}
