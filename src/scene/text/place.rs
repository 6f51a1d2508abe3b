//! Places in a text, and problems that point at them.

use crate::diag::{Diagnostic, Place};
use std::ops::Range;

/// Byte range of a text: the scene's, or a layout file's.
pub(crate) type Span = Range<usize>;

/// An error at a place of the scene.
pub(crate) fn error_at(span: &Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(message).at(Place::Scene(span.clone()))
}

/// A warning at a place of the scene.
pub(crate) fn warning_at(span: &Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::warning(message).at(Place::Scene(span.clone()))
}

/// A problem that points at `span` unless it knows a better place.
pub(crate) fn placed(mut problem: Diagnostic, span: &Span) -> Diagnostic {
    problem.place.get_or_insert(Place::Scene(span.clone()));
    problem
}
