//! Which of several ways held: a stage that tries the next way where one fails tells here how far it had to go.
//!
//! Takes nothing, prints nothing. Promises: rungs are counted from 0, the way that is meant to hold.

use serde::{Deserialize, Serialize};

/// One piece of work with the way of doing it that held.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ladder {
    /// What is tried in turn, in a few words: `position on the bed`.
    pub name: String,
    /// Whose work it was (a view, a support, a piece); none if of everything, or of all that held at the first rung.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
    /// The way that held, from 0, and how many ways there are.
    pub rung: usize,
    pub rungs: usize,
}

impl Ladder {
    pub fn new(name: &str, place: Option<&str>, rung: usize, rungs: usize) -> Self {
        Self {
            name: name.to_owned(),
            place: place.map(str::to_owned),
            rung,
            rungs,
        }
    }

    /// Whether it went as it was meant to.
    pub fn held_at_once(&self) -> bool {
        self.rung == 0
    }
}

/// Those that did not hold at once, and one for each name that did everywhere else, in the order in which they come.
pub fn short(ladders: Vec<Ladder>) -> Vec<Ladder> {
    let mut kept: Vec<Ladder> = Vec::new();
    for ladder in ladders {
        let place = ladder.place.filter(|_| ladder.rung > 0);
        let ladder = Ladder { place, ..ladder };
        if !kept.contains(&ladder) {
            kept.push(ladder);
        }
    }
    kept
}
