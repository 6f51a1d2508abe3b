//! Files read as 3MF: archives as they are, and any other bytes as the model part of a sound archive, whose checksums would
//! keep almost every change of an archive from the XML inside.
#![no_main]

use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if bytes.starts_with(b"PK") {
        pillarforest_fuzz::model("fuzz.3mf", bytes);
        return;
    }
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    archive
        .start_file("3D/3dmodel.model", options)
        .expect("an entry in memory");
    archive.write_all(bytes).expect("bytes in memory");
    let whole = archive.finish().expect("an archive in memory").into_inner();
    pillarforest_fuzz::model("fuzz.3mf", &whole);
});
