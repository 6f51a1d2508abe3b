//! Everything the program reads, under inputs that nobody would write: see `tests/corpus/README.md`.
//!
//! Each target has kept inputs in `tests/corpus/<target>/`. All of them are read in every run of the tests. `FUZZ_SECONDS=10` makes
//! new ones of them for ten seconds a target, in a process of its own that may crash or hang; what makes it fail is kept.

mod engine;
mod mutate;
mod targets;

use engine::{Failure, fuzzed, replayed};
pub(crate) use engine::{asked, files, hash};
use targets::TARGETS;

/// Of all kept inputs.
#[test]
fn kept_inputs_keep_the_promises() {
    let failures: Vec<Failure> = TARGETS.iter().flat_map(replayed).collect();
    assert!(failures.is_empty(), "{}", engine::told(&failures));
}

#[test]
fn mutated_inputs_keep_the_promises() {
    let Some(seconds) = asked("FUZZ_SECONDS") else {
        return;
    };
    let seed = asked("FUZZ_SEED").unwrap_or_else(engine::random_seed);
    let found = TARGETS.iter().filter_map(|t| fuzzed(t, seed, seconds));
    let failures: Vec<Failure> = found.collect();
    assert!(failures.is_empty(), "{}", engine::told(&failures));
}

/// What `fuzzed` starts: one target in this process, until the time is up.
#[test]
fn one_target_alone() {
    engine::run_if_asked(&TARGETS);
}
