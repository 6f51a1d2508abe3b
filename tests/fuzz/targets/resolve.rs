//! Scenes with models: the text up to the first zero byte, then the bytes of every model file.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let split = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    let (text, model) = bytes.split_at(split);
    if let Ok(text) = std::str::from_utf8(text) {
        pillarforest_fuzz::resolve(text, Some(model.get(1..).unwrap_or(&[])));
    }
});
