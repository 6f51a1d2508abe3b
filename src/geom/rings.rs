//! Regions of a plane as closed rings: cut, joined, widened. The only module that names `i_overlay`.
//!
//! Outer rings run counter-clockwise, holes clockwise. Lengths in whatever unit the rings have. Results are snapped to a grid of about a
//! billionth of their size, so an operation may move points by that.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::outline::offset::OutlineOffset;
use i_overlay::mesh::style::{LineJoin, OutlineStyle};

/// See the module.
pub type Rings = Vec<Vec<[f64; 2]>>;

fn flat(shapes: Vec<Vec<Vec<[f64; 2]>>>) -> Rings {
    shapes.into_iter().flatten().collect()
}

/// Resolves rings that touch, cross or overlap.
pub fn simple(rings: Rings) -> Rings {
    flat(rings.simplify_shape(FillRule::NonZero))
}

/// `from` without `what`.
pub fn taken(from: &Rings, what: &Rings) -> Rings {
    flat(from.overlay(what, OverlayRule::Difference, FillRule::NonZero))
}

/// What lies in either.
pub fn joined(a: &Rings, b: &Rings) -> Rings {
    flat(a.overlay(b, OverlayRule::Union, FillRule::NonZero))
}

/// What lies in both.
pub fn common(a: &Rings, b: &Rings) -> Rings {
    flat(a.overlay(b, OverlayRule::Intersect, FillRule::NonZero))
}

/// Rings moved outwards by `by` (inwards if negative), corners bevelled.
pub fn offset(rings: &Rings, by: f64) -> Rings {
    flat(rings.outline(&OutlineStyle::new(by).line_join(LineJoin::Bevel)))
}

/// Rings moved outwards by `by` everywhere, sharp corners kept.
pub fn widened(rings: &Rings, by: f64) -> Rings {
    /// Corners sharper than this are cut off: their tips would be very far out.
    const SHARPEST: f64 = 0.1 * std::f64::consts::PI;
    flat(rings.outline(&OutlineStyle::new(by).line_join(LineJoin::Miter(SHARPEST))))
}
