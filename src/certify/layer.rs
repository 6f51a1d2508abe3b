//! Whether every relief stays in its layer and keeps the depth order of its model, looked at once more on the finished relief.
//!
//! Takes the view map, target and groups of a view with its relief. Over one cell the inverse depths of relief and layer are both
//! affine in the image (see `groups`), so that cell corners decide for the whole cell; sides' ends decide for sides where
//! sheets meet. Neither the program's rows nor its solution are used.

use crate::geom::nothing_mm;
use crate::groups::anchor;
use crate::index::CellId;
use crate::mimic::TOGETHER_MM;
use crate::relief::Relief;
use crate::sight::Sight;
use crate::support::Slab;
use crate::viewmap::Image;

/// Depths this near to a limit lie at it, as a share of the layer's thickness: a hundred times what conditions are tightened by, and a
/// thousandth of what is seen as relief.
const AT_LIMIT: f64 = 1e-4;

/// How far the relief leaves its layer anywhere but at free corners, millimetres along the ray.
pub fn bound_violation_mm(sight: &Sight, relief: &Relief) -> f64 {
    let image = &sight.image;
    let map = &image.map;
    let mut worst = 0.0f64;
    for (c, depths, slab) in on_layers(sight, relief) {
        let free = relief.free.get(c.at()).copied().unwrap_or_default();
        let corners = map.triangle(c).into_iter().zip(depths).enumerate();
        for (k, (q, z)) in corners.filter(|(k, _)| !free[*k]) {
            let (near, far) = image.layer_in(&slab, c, k);
            worst = worst.max((near - z).max(z - far) * map.plane.direction(q).length());
        }
    }
    worst
}

/// Cells with a relief, with its depths at their corners and the layer of their support.
fn on_layers(sight: &Sight, relief: &Relief) -> impl Iterator<Item = (CellId, [f64; 3], Slab)> {
    let cells = sight.image.map.all();
    cells.filter_map(|(c, cell)| Some((c, relief.depth[c]?, sight.groups.slabs[cell.support?]?)))
}

/// Share of the relief, by solid angle, whose cells lie at one limit of their layer with all corners: plateaus.
pub fn share_at_limit(sight: &Sight, relief: &Relief) -> f64 {
    let image = &sight.image;
    let map = &image.map;
    let (mut all, mut flat) = (0.0, 0.0);
    for (c, depths, slab) in on_layers(sight, relief) {
        let at = |limit: fn((f64, f64)) -> f64| {
            depths.iter().enumerate().all(|(k, z)| {
                let layer = image.layer_in(&slab, c, k);
                (z - limit(layer)).abs() <= AT_LIMIT * (layer.1 - layer.0)
            })
        };
        let solid_angle = map.solid_angle(c);
        all += solid_angle;
        if at(|l| l.0) || at(|l| l.1) {
            flat += solid_angle;
        }
    }
    if all > 0.0 { flat / all } else { 0.0 }
}

/// How far reliefs come before their datum and go behind it, millimetres as their layers measure it.
pub fn reach_mm(sight: &Sight, relief: &Relief) -> (f64, f64) {
    let image = &sight.image;
    let map = &image.map;
    let mut reach = (0.0f64, 0.0f64);
    for (c, depths, slab) in on_layers(sight, relief) {
        for (q, z) in map.triangle(c).into_iter().zip(depths) {
            let surface = image.surface_in(&slab, c, q);
            let behind = slab.behind_datum(map.plane.direction(q), surface.first, z);
            reach = (reach.0.max(-behind), reach.1.max(behind));
        }
    }
    reach
}

/// Ends of sides of cells at which the relief of a farther sheet of the model comes before that of a nearer one on the same layer.
pub fn order_inversions(sight: &Sight, relief: &Relief) -> usize {
    let Image { map, target, .. } = &sight.image;
    let mut count = 0;
    for (c, k, n) in sight.seams() {
        let (cell, other) = (&map.cells[c], &map.cells[n]);
        let (Some(here), Some(there)) = (relief.depth[c], relief.depth[n]) else {
            continue;
        };
        let (Some(f), Some(g)) = (cell.face, other.face) else {
            continue;
        };
        for end in [k, (k + 1) % 3] {
            let p = cell.corners[end];
            let Some(j) = other.corners.iter().position(|x| *x == p) else {
                continue;
            };
            let q = map.points[p];
            let [a, b] = [f, g].map(|f| anchor(target, f, q).1);
            let apart = (a - b).abs() > TOGETHER_MM;
            let step = (here[end] - there[j]) * map.plane.direction(q).length();
            let nothing = nothing_mm(a.max(b) / map.plane.focal);
            count += usize::from(apart && step * (a - b) < -nothing * (a - b).abs());
        }
    }
    count
}
