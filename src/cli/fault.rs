//! Faults of the program itself: told in words, with a code of their own, instead of a trace.

use super::ending::{FAILED, fail};
use super::messages::Messages;
use pillarforest::diag::{Diagnostic, Place};
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook, take_hook};
use std::sync::{Mutex, PoisonError};

/// The last panic: what it said and where. Those that the library catches itself, because it knows another way, are never told.
static LAST: Mutex<Option<(String, String)>> = Mutex::new(None);

fn note(info: &PanicHookInfo) {
    let text = info.payload_as_str().unwrap_or("no reason given");
    let place = info.location().map_or(String::new(), |l| {
        format!("{}:{}:{}", l.file(), l.line(), l.column())
    });
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    *last = Some((text.to_string(), place));
}

/// Runs a command; if it panics, says so and gives the code for it.
pub(super) fn caught(messages: &Messages, command: impl FnOnce() -> u8) -> u8 {
    let usual = take_hook();
    // Whoever asks for traces gets them.
    let traced = std::env::var_os("RUST_BACKTRACE").is_some_and(|v| v != "0");
    set_hook(Box::new(move |info| {
        note(info);
        if traced {
            usual(info);
        }
    }));
    catch_unwind(AssertUnwindSafe(command)).unwrap_or_else(|_| {
        let last = LAST.lock().unwrap_or_else(PoisonError::into_inner).take();
        let (text, place) = last.unwrap_or_default();
        let mut fault = Diagnostic::error(format!("pillarforest itself failed: {text}"))
            .help("this is a fault of the program, not of what you gave it: please report it with the scene and its models")
            .help("RUST_BACKTRACE=1 before the command shows where it happened");
        if !place.is_empty() {
            fault = fault.at(Place::File(place));
        }
        fail(messages, &[fault], None, FAILED)
    })
}

#[cfg(test)]
mod tests {
    use super::super::args::Cli;
    use super::*;
    use clap::Parser;

    #[test]
    fn a_panic_ends_with_a_code_of_its_own() {
        let cli = Cli::parse_from(["pillarforest", "schema"]);
        let messages = Messages::new(&cli.global);
        assert_eq!(caught(&messages, || panic!("on purpose")), FAILED);
        assert_eq!(caught(&messages, || 3), 3);
    }
}
