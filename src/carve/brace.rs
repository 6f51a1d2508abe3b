//! Ties for parts that would float: pieces of relief or pillar at a pillar's very edge, where nothing stands behind them.
//!
//! A brace is a stub in the piece's own shadow, back to the depth of the reliefs' backing, and a bar from there to the support's
//! axis, behind the layer and within the support's shadow: the eye sees neither.

use super::boolean::{Boolean, BooleanError};
use crate::support::Slab;
use glam::DVec3;

/// What of a loose part counts as its rear, millimetres of depth.
const REAR_MM: f64 = 0.6;

/// A brace is this much slimmer than the piece it holds, so that no face of one lies in a face of the other.
const SLIM: f64 = 0.83;

/// One brace for every loose part larger than `crumb` cubic millimetres (the largest part is the support itself).
pub(crate) fn braces(
    joined: &Boolean,
    slab: &Slab,
    crumb: f64,
) -> Result<Vec<Boolean>, BooleanError> {
    let parts = joined.parts();
    parts
        .iter()
        .skip(1)
        .filter(|p| p.volume() >= crumb)
        .filter_map(|p| brace(p, slab).transpose())
        .collect()
}

fn brace(part: &Boolean, slab: &Slab) -> Result<Option<Boolean>, BooleanError> {
    let vertices = part.mesh().vertices;
    let rear = vertices
        .iter()
        .map(|p| slab.offset(*p))
        .fold(f64::NEG_INFINITY, f64::max);
    let rear: Vec<DVec3> = vertices
        .into_iter()
        .filter(|p| slab.offset(*p) > rear - REAR_MM)
        .collect();
    let middle = rear.iter().sum::<DVec3>() / rear.len().max(1) as f64;
    let rear: Vec<DVec3> = rear.iter().map(|p| middle.lerp(*p, SLIM)).collect();
    let thickness = slab.backing() - slab.deepest();
    let at = |p: &DVec3, offset: f64| slab.moved(*p, offset - slab.offset(*p));
    let (front, back) = (
        slab.deepest() + 0.1 * thickness,
        slab.backing() - 0.1 * thickness,
    );
    let stub: Vec<DVec3> = rear.iter().flat_map(|p| [*p, at(p, back)]).collect();
    let bar = rear
        .iter()
        .flat_map(|p| [at(p, front), at(p, back)])
        .flat_map(|p| [p, slab.onto_axis(p)]);
    let bar = Boolean::hull(&bar.collect::<Vec<_>>())?;
    Boolean::hull(&stub)?
        .plus(&bar)
        .map(|b| (!b.is_empty()).then_some(b))
}
