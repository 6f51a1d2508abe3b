//! `inspect`: what is in mesh files and whether they can be printed; or what they look like from all sides.

use super::ending::{FAILED, NOT_PRINTABLE, WELL, WRONG_INPUT, WRONG_USAGE, fail, say};
use super::messages::Messages;
use super::write::Destination;
use super::{files, threads};
use pillarforest::compile::OutputFile;
use pillarforest::diag::{Diagnostic, Warned};
use pillarforest::intake;
use pillarforest::render::six_sides;
use pillarforest::scene::StarterModel;
use std::path::{Path, PathBuf};

/// Judges files one by one; gives the exit code.
pub(super) fn run(messages: &Messages, paths: &[PathBuf], json: bool) -> u8 {
    let mut codes = Vec::new();
    for path in paths {
        let code = one(messages, path, json);
        if code == FAILED {
            return FAILED;
        }
        codes.push(code);
    }
    // A file that cannot be read weighs more than one that cannot be printed.
    let worst = [WRONG_INPUT, NOT_PRINTABLE];
    let worst = worst.into_iter().find(|c| codes.contains(c));
    worst.unwrap_or(WELL)
}

fn one(messages: &Messages, path: &Path, json: bool) -> u8 {
    let name = path.display().to_string();
    let found = files::regular(path).and_then(|bytes| intake::inspect(&name, &bytes));
    let Warned { value, warnings } = match found {
        Ok(found) => found,
        Err(problem) => {
            messages.print(&[problem], None);
            return WRONG_INPUT;
        }
    };
    let denied = messages.print(&warnings, None);
    let said = say(&if json {
        format!("{}\n", serde_json::json!(value))
    } else {
        format!("{value}")
    });
    match said {
        WELL if denied => WRONG_INPUT,
        WELL if !value.printable() => NOT_PRINTABLE,
        said => said,
    }
}

/// Draws the sides of every file to out/<file>-sides.png; gives the exit code.
pub(super) fn draw(messages: &Messages, paths: &[PathBuf]) -> u8 {
    let remarks: Vec<Diagnostic> = threads::start(None).into_iter().collect();
    messages.print(&remarks, None);
    let pictures: Vec<String> = paths.iter().map(|p| picture(p)).collect();
    let destination = match Destination::new(Some(Path::new("out")), Path::new("sides"), &[]) {
        Ok(destination) => destination,
        Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
    };
    let names = pictures.iter().map(String::as_str);
    if let Err(problems) = destination.clear(names, Path::new("sides"), paths) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    let mut code = WELL;
    for (path, picture) in paths.iter().zip(pictures) {
        let drawn = match drawn(messages, path) {
            Ok(drawn) => drawn,
            Err(problem) => {
                messages.print(&[problem], None);
                code = WRONG_INPUT;
                continue;
            }
        };
        match destination.write(&[OutputFile::new(picture, drawn)]) {
            Err(problem) => return fail(messages, &[problem], None, FAILED),
            Ok(written) => {
                if say(&format!("wrote {}\n", written.display())) == FAILED {
                    return FAILED;
                }
            }
        }
    }
    code
}

/// The name of a model's picture. Its ending stays in it: a fox.obj may lie beside a fox.stl.
fn picture(model: &Path) -> String {
    let name = model.file_name().unwrap_or_default().to_string_lossy();
    format!("{}-sides.png", name.replace('.', "-"))
}

fn drawn(messages: &Messages, path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let bytes = files::regular(path)?;
    let shown = path.display().to_string();
    let Warned { value, warnings } = intake::load_model(&shown, &bytes, false)?;
    messages.print(&warnings, None);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let likely = StarterModel::new(&name, &name, &value);
    Ok(six_sides(&name, &value, likely.up))
}
