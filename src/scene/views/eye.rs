//! Eyes: where they are, and which way they look.

use crate::diag::Diagnostic;
use crate::scene::language::raw::RawView;
use crate::scene::text::{Field, Reader, Span, error_at};
use glam::DVec3;

/// The eye of a view, for checks.
pub(crate) struct Eye {
    pub view: String,
    pub stand: Stand,
    pub span: Span,
}

/// Where an eye is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stand {
    At(DVec3),
    /// At infinity, in this direction (unit).
    Towards(DVec3),
}

impl Stand {
    /// Whether two eyes are one.
    pub(crate) fn is_like(self, other: Self) -> bool {
        match (self, other) {
            (Self::At(a), Self::At(b)) => a.distance(b) < 1.0,
            (Self::Towards(a), Self::Towards(b)) => a.distance(b) < SAME_WAY,
            _ => false,
        }
    }
}

/// Directions that differ by less (radians) are one: a millimetre seen from a metre.
const SAME_WAY: f64 = 1e-3;

/// Where a view's eye is: exactly one of two fields says so.
pub(crate) fn stand(
    reader: &mut Reader,
    raw: &RawView,
    owner: &str,
    span: &Span,
) -> Option<(Stand, Span)> {
    let Field::Given(from) = &raw.from else {
        reader.need(&raw.eye, "eye", owner, span);
        let (eye, at) = reader.point_field(&raw.eye, "eye")?;
        return Some((Stand::At(eye.into()), at));
    };
    let from_span = reader.span(from);
    if !matches!(raw.eye, Field::Missing) {
        reader.problems.push(
            error_at(&from_span, format!("{owner} has both `eye` and `from`"))
                .label("an eye has a place or is at infinity")
                .help("keep `eye: (x, y, z)` for a place, or `from: (x, y, z)` for parallel rays from a direction"),
        );
        return None;
    }
    let from = DVec3::from(*reader.value(from)?);
    // A direction of any length, without unit; what is not finite has none.
    let Some(way) = (from / from.abs().max_element()).try_normalize() else {
        let text = format!(
            "`from` is ({}, {}, {}); it must point somewhere",
            from.x, from.y, from.z
        );
        reader.problems.push(
            error_at(&from_span, text)
                .help("it points from what is seen towards the eye: `from: (0, -1, 0.2)` is from the front and a little above"),
        );
        return None;
    };
    Some((Stand::Towards(way), from_span))
}

/// An eye must look somewhere, and not straight down.
pub(crate) fn direction(view: &str, eye: DVec3, look_at: DVec3, span: &Span) -> Option<Diagnostic> {
    let gaze = look_at - eye;
    if gaze.length() < 1e-3 {
        let problem = error_at(
            span,
            format!("view \"{view}\" looks at its own eye: it has no direction"),
        );
        return Some(problem.help("`look_at` is a point in the middle of what is seen"));
    }
    if gaze.truncate().length() < 0.05 * gaze.z.abs() {
        let way = if gaze.z < 0.0 { "down" } else { "up" };
        let problem = error_at(
            span,
            format!("view \"{view}\" looks straight {way}: pillars show nothing but their ends"),
        );
        return Some(problem.help("put the eye to the side of the forest"));
    }
    None
}
