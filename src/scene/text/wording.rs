//! Numbers, names and guesses as messages show them.

use crate::diag::escaped;

/// A number for people: at most three decimals, none without need.
pub(crate) fn short(value: f64) -> String {
    let rounded = (value * 1e3).round() / 1e3;
    if value != 0.0 && rounded == 0.0 {
        format!("{value:e}")
    } else {
        format!("{rounded}")
    }
}

/// What of `known` was probably meant, if any is near.
pub fn nearest<'k>(found: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let lower = found.to_lowercase();
    let likeness = |k: &str| strsim::jaro_winkler(&lower, &k.to_lowercase());
    let best = known.into_iter().map(|k| (likeness(k), k)).fold(
        None,
        |best: Option<(f64, &str)>, next| match best {
            Some(b) if b.0 >= next.0 => Some(b),
            _ => Some(next),
        },
    )?;
    (best.0 > 0.78).then_some(best.1)
}

/// Makes text fit for one line of a terminal: control and direction characters escaped, cut at 60 characters or the first line end.
pub(crate) fn printable(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    let mut out = escaped(&line.chars().take(60).collect::<String>());
    if line.len() < text.len() || line.chars().count() > 60 {
        out.push_str("...");
    }
    out
}
