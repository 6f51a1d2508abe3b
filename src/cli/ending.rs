//! How a run ends: exit codes, and the last words.

use super::messages::{Messages, Source, tell};
use pillarforest::diag::Diagnostic;
use std::io::{ErrorKind, Write};

pub(super) const WELL: u8 = 0;
pub(super) const WRONG_INPUT: u8 = 1;
pub(super) const WRONG_USAGE: u8 = 2;
pub(super) const NOT_PRINTABLE: u8 = 3;
/// Nothing is wrong with what the user gave: the program failed, or the system did under it (a full disk).
pub(super) const FAILED: u8 = 4;

pub(super) const NOTHING: &str = "Nothing was written.";

/// Prints to standard output. A pipe whose reader has gone is no error: it has had what it wanted.
pub(super) fn say(text: &str) -> u8 {
    let mut out = std::io::stdout();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            tell(&format!("error: cannot write to standard output: {error}"));
            FAILED
        }
        _ => WELL,
    }
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
