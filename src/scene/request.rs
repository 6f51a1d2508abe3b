//! What is asked of the reader of scenes.

use crate::diag::Diagnostic;

/// Reads a file, a model or a layout, by the name the scene gives.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, Diagnostic>;

/// Called with the name of what is done as it begins, if it may take a while.
pub type Begun<'a> = &'a dyn Fn(&str);

/// What a scene is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Its pillars stand where they are, or are to be found.
    Build,
    /// Its pillars are a first draft: where they stand in each other's way is no mistake.
    Mend,
}
