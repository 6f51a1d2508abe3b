//! Which of several ways held, in words.

use crate::ladder::Ladder;

/// A note on work that was not done in the first way; none if it was.
pub fn note(found: &Ladder) -> Option<String> {
    if found.held_at_once() {
        return None;
    }
    let place = found.place.as_deref();
    let place = place.map_or_else(String::new, |p| format!(", {p}"));
    Some(format!(
        "{}{place}: way {} of {} held, those before it did not",
        found.name,
        found.rung + 1,
        found.rungs
    ))
}
