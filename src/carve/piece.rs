//! One view's relief on one support, and what is carved out before it.

use super::boolean::{Boolean, BooleanError};
use super::{Repairs, ViewRelief, hollow};
use crate::groups::surface_in;
use crate::mesh::DisjointSets;
use crate::relief::block;
use crate::support::Slab;
use crate::viewmap::{SupportField, ViewMap};
use glam::DVec2;

/// A shell is carved down to this share of the way from its layer's back to the end of its backing.
const FLOOR: f64 = 0.5;
/// Facets of a shell whose depths differ by less where they meet are one sheet, millimetres: rounding and merged cells leave less.
const SHEET_MM: f64 = 0.05;

/// What one view makes of one support.
pub struct Piece<'a> {
    pub field: &'a SupportField<'a>,
    pub support: u32,
    pub slab: &'a Slab,
    pub view: &'a ViewRelief<'a>,
}

/// A relief as a solid, and the cells it had to give up, rising.
pub struct Made {
    pub solid: Boolean,
    pub dropped: Vec<u32>,
}

impl Piece<'_> {
    pub fn relief(
        &self,
        cells: &[u32],
        lap: f64,
        repairs: &mut Repairs,
    ) -> Result<Made, BooleanError> {
        let map = self.view.map;
        let back = |c: u32, q: DVec2| {
            if self.slab.is_shell() {
                self.shell(c, q, 1.0)
            } else {
                self.slab.plane(map.plane.direction(q), self.slab.backing())
            }
        };
        let behind = |c, k| hidden(map, c, k);
        let (mut solids, mut dropped) = (Vec::new(), Vec::new());
        for sheet in self.sheets(cells) {
            let made = block(map, &sheet, &self.view.relief.depth, back, behind, lap);
            repairs.filled += made.filled;
            repairs.dropped_cells += made.dropped.len();
            dropped.extend(made.dropped);
            solids.push(Boolean::new(&made.mesh)?);
        }
        dropped.sort_unstable();
        Ok(Made {
            solid: Boolean::union(solids)?,
            dropped,
        })
    }

    pub fn hollow(&self, cells: &[u32], bed: f64) -> Result<Boolean, BooleanError> {
        let (map, slab) = (self.view.map, self.slab);
        if slab.is_shell() {
            let floor = |c: u32, q: DVec2| self.shell(c, q, FLOOR);
            hollow::shell_hollow(map, slab, self.support, cells, bed, floor)
        } else {
            hollow::hollow(map, slab, self.support, cells, bed)
        }
    }

    /// Where a shell's backing ends (`share` 1), or part of the way to there.
    fn shell(&self, cell: u32, q: DVec2, share: f64) -> f64 {
        let surface = surface_in(self.view.map, self.field, self.slab, cell as usize, q);
        self.slab.shell_backing(surface, share)
    }

    /// Cells (rising) in parts over which the surface of a shell does not jump: where one fold of it hides another it does.
    fn sheets(&self, cells: &[u32]) -> Vec<Vec<u32>> {
        if !self.slab.is_shell() {
            return vec![cells.to_vec()];
        }
        let map = self.view.map;
        let local = |c: &u32| cells.binary_search(c).ok();
        let mut sets = DisjointSets::new(cells.len());
        for (i, c) in cells.iter().enumerate() {
            for (k, n) in map.neighbours[*c as usize].iter().enumerate() {
                let Some((n, j)) = n.and_then(|n| Some((n, local(&n)?))) else {
                    continue;
                };
                let corners = map.triangle(*c as usize);
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let apart = |q| self.shell(*c, q, 0.0) - self.shell(n, q, 0.0);
                if apart(a.midpoint(b)).abs() < SHEET_MM {
                    sets.join(i as u32, j as u32);
                }
            }
        }
        let of = |set: Vec<u32>| set.into_iter().map(|i| cells[i as usize]).collect();
        sets.members().into_iter().map(of).collect()
    }
}

/// Whether a nearer support hides what lies beyond side `k` of a cell.
fn hidden(map: &ViewMap, c: u32, k: usize) -> bool {
    let Some(n) = map.neighbours[c as usize][k] else {
        return false;
    };
    let (here, there) = (&map.cells[c as usize], &map.cells[n as usize]);
    here.support != there.support && there.support_depth < here.support_depth
}
