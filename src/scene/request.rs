//! What is asked of the reader of scenes.

use crate::diag::Diagnostic;

/// Reads a file, a model or a layout, by the name the scene gives.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, Diagnostic>;

/// What a scene is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Its pillars stand where they are, or are to be found.
    Build,
    /// Its pillars are a first draft: where they stand in each other's way is no mistake.
    Mend,
}
