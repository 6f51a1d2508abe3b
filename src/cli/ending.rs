//! How a run ends: exit codes, and the last words.

use super::messages::{Messages, Source};
use pillarforest::diag::Diagnostic;
use std::io::Write;

pub(super) const WELL: u8 = 0;
pub(super) const WRONG_INPUT: u8 = 1;
pub(super) const WRONG_USAGE: u8 = 2;
pub(super) const NOT_PRINTABLE: u8 = 3;

pub(super) const NOTHING: &str = "Nothing was written.";
/// Prints to standard output; a closed pipe is no error.
pub(super) fn say(text: &str) -> u8 {
    let _ = std::io::stdout().write_all(text.as_bytes());
    WELL
}

/// Prints the problems of a failed command.
pub(super) fn fail(
    messages: &Messages,
    list: &[Diagnostic],
    source: Option<&Source>,
    code: u8,
) -> u8 {
    messages.print(list, source);
    messages.closing(list, NOTHING);
    code
}

/// `1 view`, `2 views`.
pub(super) fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}
