//! Contests that nobody may win, and views that lose too much.

use crate::contest::{Contest, Dispute};
use crate::diag::Diagnostic;

/// A conflict where contests are errors.
pub fn refused(refusal: &Dispute) -> Diagnostic {
    let view = &refusal.view;
    let Contest {
        with_view,
        support,
        with_support,
        arcmin2,
        place_mm: [x, y, z],
        ..
    } = &refusal.found;
    let what = if support == with_support {
        format!("views \"{view}\" and \"{with_view}\" both want {support}")
    } else {
        format!(
            "the reliefs of view \"{view}\" on {support} and of view \"{with_view}\" on {with_support} stand in each other's way"
        )
    };
    Diagnostic::error(format!(
        "{what}: {arcmin2:.1} square arc-minutes of \"{view}\", mostly near ({x:.1}, {y:.1}, {z:.1}) mm"
    ))
    .help("move a pillar or a model, or let one of them have it: `contested: First` or `contested: Largest`")
}

/// A view whose mesh is not cut would lose part of it.
pub fn indivisible(view: &str) -> Diagnostic {
    Diagnostic::error(format!(
        "view \"{view}\" would have to give up surface to another view, but its meshes stay whole"
    ))
    .help("move supports or models of different views apart, or `relief: HeightField`")
}

/// A view loses all it has.
pub fn nothing_left(view: &str) -> Diagnostic {
    Diagnostic::error(format!(
        "view \"{view}\": other views own every place where its models could appear"
    ))
    .help("move pillars or models apart, or try `contested: Largest`")
}
