//! Why there is no sound forest.

use crate::carve::CarveError;
use crate::diag::Diagnostic;

/// `crossing`: so many pairs of faces cross in meshes that are built as they are.
pub fn unsound(error: &CarveError, crossing: usize) -> Diagnostic {
    let told = Diagnostic::error(error.to_string()).fault();
    if crossing > 0 {
        told.help(format!(
            "whole meshes cross themselves at {crossing} pairs of faces: `ordering: true` in `energy` prevents it"
        ))
    } else {
        told
    }
}
