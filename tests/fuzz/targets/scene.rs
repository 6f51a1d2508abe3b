//! Scene texts whose model files do not exist: the reader of the language and all checks of values.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(text) = std::str::from_utf8(bytes) {
        pillarforest_fuzz::resolve(text, None);
    }
});
