//! Files read as OBJ.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pillarforest_fuzz::model("fuzz.obj", bytes));
