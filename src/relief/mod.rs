//! Reliefs: the optimised surface cut at the view map's lines and scaled back onto its supports.
//!
//! Takes depths and groups. Gives, for every cell of the view map that carries a relief, the depth of its three corners:
//! the model's face there, scaled by `s`, divided by the group's `mu` (never multiplied), clamped to the layer. Because
//! `1/lambda` is affine over a cell, corners inside a flat layer keep the whole cell inside. The largest clamp is reported.
//! Corners that a free vertex has a share in have no layer and stay where the optimum put them, even outside of what a solid
//! over the support can hold.
//! A height field over the view map cannot overlap itself as the eye sees it; `block` makes it a closed solid.

mod block;

pub use block::{Block, block};

use crate::groups::{Groups, anchor, layer_in};
use crate::mimic::Depths;
use crate::viewmap::{Cell, SupportField, Target, ViewMap};

/// The cut and scaled-back surface of one view.
#[derive(Clone, Debug)]
pub struct Relief {
    /// Depth along the forward axis of each cell's corners; `None` where the cell carries nothing. Index: cell.
    pub depth: Vec<Option<[f64; 3]>>,
    /// Largest distance a corner was moved along its ray to stay in its layer, millimetres: what linearised bounds left over.
    pub clamp_mm: f64,
    /// Which corners have no layer; empty if no vertex of the target is free. Index: cell.
    pub free: Vec<[bool; 3]>,
}

/// Cuts and scales back; of a whole mesh gives what is seen of it.
pub fn relief(
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
    groups: &Groups,
    depths: &Depths,
) -> Relief {
    if groups.whole {
        return of_whole(map, target, groups, depths);
    }
    let mut clamp_mm = 0.0f64;
    let mut depth = vec![None; map.cells.len()];
    let marked = if target.free.is_empty() {
        0
    } else {
        map.cells.len()
    };
    let mut no_layer = vec![[false; 3]; marked];
    for (c, cell) in map.cells.iter().enumerate() {
        let (Some(group), Some(face), Some(support)) = (groups.of_cell[c], cell.face, cell.support)
        else {
            continue;
        };
        let Some(slab) = groups.slabs[support as usize] else {
            continue;
        };
        depth[c] = Some([0, 1, 2].map(|k| {
            let q = map.points[cell.corners[k] as usize];
            let (anchor, model_depth) = anchor(target, face as usize, q);
            let free = model_depth * anchor.relative_depth(&depths.s) / depths.mu[group as usize];
            if anchor.is_free(target) {
                no_layer[c][k] = true;
                return free;
            }
            let (near, far) = layer_in(map, field, &slab, c, k);
            let kept = free.clamp(near, far.max(near));
            clamp_mm = clamp_mm.max((kept - free).abs() * map.plane.direction(q).length());
            kept
        }));
    }
    Relief {
        depth,
        clamp_mm,
        free: no_layer,
    }
}

/// What is seen of a mesh that stays whole: nothing is clamped, because the mesh itself is built, and its bounds are looked at there.
fn of_whole(map: &ViewMap, target: &Target, groups: &Groups, depths: &Depths) -> Relief {
    let of_cell = |(c, cell): (usize, &Cell)| {
        let (group, face) = (groups.of_cell[c]?, cell.face?);
        Some(cell.corners.map(|p| {
            let (anchor, depth) = anchor(target, face as usize, map.points[p as usize]);
            depth * anchor.relative_depth(&depths.s) / depths.mu[group as usize]
        }))
    };
    Relief {
        depth: map.cells.iter().enumerate().map(of_cell).collect(),
        clamp_mm: 0.0,
        free: vec![[true; 3]; map.cells.len()],
    }
}
