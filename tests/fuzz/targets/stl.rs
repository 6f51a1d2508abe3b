//! Files read as STL.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pillarforest_fuzz::model("fuzz.stl", bytes));
