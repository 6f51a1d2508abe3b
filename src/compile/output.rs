//! What goals of the pipeline give.

use crate::diag::Diagnostic;

/// A file to be written, relative to the output directory.
#[derive(Clone, Debug)]
pub struct OutputFile {
    pub path: String,
    pub bytes: Vec<u8>,
}

impl OutputFile {
    pub fn new(path: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self {
            path: path.into(),
            bytes,
        }
    }
}

/// Everything that a scene's output section names, and whether it is what a build promises.
#[derive(Clone, Debug, Default)]
pub struct Build {
    pub files: Vec<OutputFile>,
    /// The last line for the terminal without paths and times:
    /// `27 pillars, 144 x 144 x 95 mm, 158 cm3, watertight; bunny 7.7 deg / skull 9.1 deg` (mean normal errors).
    pub summary: String,
    /// What of all that a build promises does not hold.
    pub failures: Vec<Diagnostic>,
    pub warnings: Vec<Diagnostic>,
}

/// Plan or pictures, which promise nothing.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    pub files: Vec<OutputFile>,
    /// As of a [`Build`]; of a plan only what is counted in it.
    pub summary: String,
    pub warnings: Vec<Diagnostic>,
}
