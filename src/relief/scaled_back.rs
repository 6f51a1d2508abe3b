//! The optimised surface cut and scaled back, as depths over the view map.

use crate::groups::{Carried, anchor};
use crate::mimic::Depths;
use crate::sight::Sight;

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

/// Cuts and scales back. Of a torn surface `sight` is that of the cut mesh.
pub fn relief(sight: &Sight, depths: &Depths) -> Relief {
    let Sight { image, groups, .. } = sight;
    let (target, map) = (&image.target, &image.map);
    let mut clamp_mm = 0.0f64;
    let mut depth = vec![None; map.cells.len()];
    let marked = if target.free.is_empty() {
        0
    } else {
        map.cells.len()
    };
    let mut no_layer = vec![[false; 3]; marked];
    for carried in groups.carried(map) {
        let Carried {
            id,
            cell,
            group,
            face,
            slab,
        } = carried;
        depth[id] = Some([0, 1, 2].map(|k| {
            let q = map.points[cell.corners[k]];
            let (anchor, model_depth) = anchor(target, face, q);
            let free = model_depth * anchor.relative_depth(&depths.s) / depths.mu[group];
            if anchor.is_free(target) {
                no_layer[id][k] = true;
                return free;
            }
            let (near, far) = image.layer_in(&slab, id, k);
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
