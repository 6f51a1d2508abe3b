//! Places and numbers in text files: lines of any ending, excerpts that are safe to print, coordinates that are finite.

use crate::diag::{Diagnostic, Place, escaped};

/// Longest excerpt of a user's line in a message, characters.
const MAX_EXCERPT: usize = 80;

/// Coordinates beyond this many millimetres (a thousand million kilometres) are nobody's model.
pub(super) const LARGEST_COORDINATE: f64 = 1e15;

const NOT_FINITE: &str = "not a finite number";

/// Lines of a text file with their numbers, 1-based. Ends a line at `\n`, `\r\n` or a lone `\r`.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let mut rest = bytes;
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let line = &rest[..end.unwrap_or(rest.len())];
        rest = match end {
            Some(e) if rest[e..].starts_with(b"\r\n") => &rest[e + 2..],
            Some(e) => &rest[e + 1..],
            None => &[],
        };
        Some((number, line))
    })
}

/// The text without a byte order mark.
pub(super) fn without_bom(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

/// Shortened, one line, printable characters only.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * MAX_EXCERPT)]);
    let mut shown = escaped(&text.trim().chars().take(MAX_EXCERPT).collect::<String>());
    if text.trim().chars().count() > MAX_EXCERPT || bytes.len() > 4 * MAX_EXCERPT {
        shown.push_str("...");
    }
    shown
}

/// An error at a line of a text file.
pub(super) fn at_line(
    file: &str,
    line: usize,
    text: &[u8],
    message: impl Into<String>,
) -> Diagnostic {
    Diagnostic::error(message).at(Place::Line {
        file: file.to_owned(),
        line,
        excerpt: excerpt(text),
    })
}

/// An error at a byte of a binary file.
pub(super) fn at_byte(file: &str, offset: usize, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(message).at(Place::Byte {
        file: file.to_owned(),
        offset: offset as u64,
    })
}

/// A finite coordinate.
///
/// # Errors
/// What is wrong with it, in the words of a message that goes on after "a coordinate that is".
pub(super) fn coordinate(word: &[u8]) -> Result<f64, String> {
    finite(word).and_then(check_coordinate)
}

/// A finite number of any size.
///
/// # Errors
/// As [`coordinate`].
pub(super) fn finite(word: &[u8]) -> Result<f64, String> {
    let text = std::str::from_utf8(word).ok().filter(|t| t.is_ascii());
    match text.and_then(|t| t.parse::<f64>().ok()) {
        Some(v) if v.is_finite() => Ok(v),
        Some(_) => Err(NOT_FINITE.to_owned()),
        None if word.contains(&b',') => Err(format!(
            "not a number: `{}` (decimals are written with a point)",
            excerpt(word)
        )),
        None => Err(format!("not a number: `{}`", excerpt(word))),
    }
}

/// Any number, as programs spell them; NaN for all that are not finite, `1.#IND` and `-nan(ind)` of old C libraries among them.
///
/// # Errors
/// As [`coordinate`].
pub(super) fn number_or_nan(word: &[u8]) -> Result<f64, String> {
    finite(word).or_else(|why| {
        let bare = word.strip_prefix(b"-").unwrap_or(word).to_ascii_lowercase();
        let spelled = [b"nan".as_slice(), b"inf", b"1.#"];
        let spelled = spelled.iter().any(|s| bare.starts_with(s));
        if spelled || why == NOT_FINITE {
            Ok(f64::NAN)
        } else {
            Err(why)
        }
    })
}

/// A coordinate that is finite and not absurdly large.
///
/// # Errors
/// As [`coordinate`].
pub(super) fn check_coordinate(value: f64) -> Result<f64, String> {
    if !value.is_finite() {
        Err(NOT_FINITE.to_owned())
    } else if value.abs() > LARGEST_COORDINATE {
        Err(format!("too large: {value:.0e}, more than 1e15"))
    } else {
        Ok(value)
    }
}
