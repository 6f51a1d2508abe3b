//! Ties for reliefs that would float: pieces at a pillar's very edge may lie where the pillar has no material.
//!
//! A brace joins the backing of such a piece to the support's axis, inside the backing's own depth range: behind the layer and
//! within the support's shadow, so its eye never sees it.

use super::boolean::{Boolean, BooleanError};
use crate::support::Slab;
use glam::DVec3;

/// One brace for every loose part larger than `crumb` cubic millimetres (the largest part is the support itself).
pub fn braces(joined: &Boolean, slab: &Slab, crumb: f64) -> Result<Vec<Boolean>, BooleanError> {
    let parts = joined.parts();
    parts.iter().skip(1).filter(|p| p.volume() >= crumb).filter_map(|p| brace(p, slab).transpose()).collect()
}

fn brace(part: &Boolean, slab: &Slab) -> Result<Option<Boolean>, BooleanError> {
    let mesh = part.simplified(0.0);
    let behind = |p: &DVec3| slab.offset(*p) > slab.deepest();
    // The back face of the piece, moved to the axis and to the front of the backing, spans the brace.
    let back: Vec<DVec3> = mesh.vertices.into_iter().filter(behind).collect();
    if back.is_empty() {
        return Ok(None);
    }
    let thickness = slab.backing() - slab.deepest();
    let corners = back.iter().flat_map(|p| {
        let front = slab.moved(*p, -0.9 * thickness);
        [*p, front, slab.onto_axis(*p), slab.onto_axis(front)]
    });
    Boolean::hull(&corners.collect::<Vec<_>>()).map(Some)
}
