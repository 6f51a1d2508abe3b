//! Files read as OFF.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pillarforest_fuzz::model("fuzz.off", bytes));
