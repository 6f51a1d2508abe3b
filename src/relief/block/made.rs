//! Makes a block: pulls its cells apart, fills in their depths, and closes them.

use super::apart::{lap, pull_apart};
use super::cells::BlockCells;
use super::fill::settle;
use super::walls::closed;
use crate::index::CellId;
use crate::mesh::TriMesh;
use crate::viewmap::ViewMap;
use glam::DVec2;

/// A closed, outward oriented solid and what was changed to make it one.
#[derive(Clone, Debug, Default)]
pub struct Block {
    pub mesh: TriMesh,
    /// Corners whose depth was filled in.
    pub filled: usize,
    /// Cells of the map given up because their corner could not be pulled apart, rising.
    pub dropped: Vec<CellId>,
}

/// The solid over `cells` (rising) with corner depths `depth` (index: cell of the map) and a back at `back(cell, q)`, which
/// hardly differs between neighbouring cells at a point they share.
/// `hidden(cell, side)` tells whether the support of the cell goes on behind that side, hidden by a nearer one: there the relief
/// goes on by `lap_mm`. Reliefs of neighbouring pillars whose depths overlap would touch in a wall along the rays there; so they
/// truly overlap, unseen. Below 0.01 mm mending could not tell overlap from contact.
pub fn block(
    map: &ViewMap,
    cells: &[CellId],
    depth: &[Option<[f64; 3]>],
    back: impl Fn(CellId, DVec2) -> f64,
    hidden: impl Fn(CellId, usize) -> bool,
    lap_mm: f64,
) -> Block {
    let has_depth = |c: &CellId| depth[*c].is_some();
    let mut kept: Vec<CellId> = cells.iter().copied().filter(has_depth).collect();
    let mut dropped = Vec::new();
    loop {
        let mut cells = BlockCells::new(map, &kept, depth);
        let stuck = pull_apart(&mut cells, map);
        if stuck.is_empty() {
            let filled = settle(&mut cells);
            lap(&mut cells, &hidden, lap_mm);
            dropped.sort_unstable();
            return Block {
                mesh: closed(&cells, back),
                filled,
                dropped,
            };
        }
        dropped.extend(&stuck);
        kept.retain(|c| stuck.binary_search(c).is_err());
    }
}
