//! Names that become file names and object names.

use super::place::{Span, error_at, warning_at};
use super::reader::Reader;
use super::wording::printable;
use crate::scene::defaults;

/// Names no Windows file may have.
const RESERVED: [&str; 10] = [
    "con", "prn", "aux", "nul", "com1", "com2", "com3", "lpt1", "lpt2", "lpt3",
];

/// A name fit for a file on any system, or `None` after an error.
///
/// What can be repaired is repaired with a warning; what looks like a path, is empty or too long is an error.
/// `owner` says whose name it is: "view".
pub(crate) fn checked(reader: &mut Reader, name: &str, span: &Span, owner: &str) -> Option<String> {
    let shown = printable(name);
    let fail = |why: &str| error_at(span, format!("the name of a {owner} {why}: \"{shown}\""));
    let problem = if name.trim().is_empty() {
        Some(fail("is empty"))
    } else if name.chars().count() > defaults::LONGEST_NAME {
        Some(fail(&format!(
            "is longer than {} characters",
            defaults::LONGEST_NAME
        )))
    } else if name.contains('\0') {
        Some(fail("holds a NUL character"))
    } else if name.contains(['/', '\\']) || name.starts_with('.') {
        Some(fail("looks like a path; it becomes a file name"))
    } else {
        None
    };
    if let Some(problem) = problem {
        reader
            .problems
            .push(problem.help("use letters, digits, `-` and `_`"));
        return None;
    }
    let fit = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | ' ' | '.');
    let mut safe: String = name
        .trim()
        .chars()
        .map(|c| if fit(c) { c } else { '_' })
        .collect();
    if RESERVED.contains(&safe.split('.').next().unwrap_or("").to_lowercase().as_str())
        || safe.ends_with('.')
    {
        safe.push('_');
    }
    if safe != name {
        reader.problems.push(
            warning_at(span, format!("the name \"{shown}\" of a {owner} is not fit for a file name; \"{safe}\" is used"))
                .help("use letters, digits, `-` and `_`"),
        );
    }
    Some(safe)
}
