//! Places in a text, and problems that point at them.

use crate::diag::{Diagnostic, Place};
use std::ops::Range;

/// Byte range of a text: the scene's, or a layout file's.
pub type Span = Range<usize>;

/// An error at a place of the scene.
pub fn error_at(span: &Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(message).at(Place::Scene(span.clone()))
}

/// A warning at a place of the scene.
pub fn warning_at(span: &Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::warning(message).at(Place::Scene(span.clone()))
}

/// A problem that points at `span` unless it knows a better place.
pub fn placed(mut problem: Diagnostic, span: &Span) -> Diagnostic {
    problem.place.get_or_insert(Place::Scene(span.clone()));
    problem
}
