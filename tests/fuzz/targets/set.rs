//! `--set`: the first line is the assignment, the rest the scene.
#![no_main]

use pillarforest::scene;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(input) = std::str::from_utf8(bytes) else {
        return;
    };
    let (assignment, text) = input.split_once('\n').unwrap_or((input, ""));
    match scene::set(text, assignment) {
        Err(problem) => assert!(!problem.message.is_empty()),
        Ok(changed) => {
            let value = assignment.split_once('=').map_or("", |(_, value)| value);
            assert!(changed.contains(value.trim()), "{changed}");
            pillarforest_fuzz::resolve(&changed, None);
        }
    }
});
