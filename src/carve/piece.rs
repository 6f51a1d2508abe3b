//! One view's relief on one support, and what is carved out before it.

use super::boolean::{Boolean, BooleanError};
use super::forest::Repairs;
use super::hollow::{self, CarvingEdge};
use super::sound::SPARE_MM;
use crate::index::{CellId, SupportId};
use crate::mesh::{DisjointSets, without_spare_corners};
use crate::relief::{Relief, block};
use crate::sight::Sight;
use crate::support::Slab;
use crate::viewmap::{Image, ViewMap};
use glam::DVec2;

/// A shell is carved down to this share of the way from its layer's back to the end of its backing.
const FLOOR: f64 = 0.5;

/// What one view makes of one support.
pub(crate) struct ReliefOnSupport<'a> {
    image: &'a Image<'a>,
    relief: &'a Relief,
    support: SupportId,
    pub slab: Slab,
    /// With a relief, rising.
    cells: Vec<CellId>,
}

/// A relief as a solid, and the cells it had to give up, rising.
pub(crate) struct ReliefSolid {
    pub solid: Boolean,
    pub dropped: Vec<CellId>,
}

impl<'a> ReliefOnSupport<'a> {
    /// `None` if the view has no relief there.
    pub(crate) fn new(
        sight: &'a Sight<'a>,
        relief: &'a Relief,
        support: SupportId,
    ) -> Option<Self> {
        let cells = &sight.image.map.cells;
        let on = |c: &CellId| cells[*c].support == Some(support) && relief.depth[*c].is_some();
        let cells: Vec<CellId> = CellId::all(cells.len()).filter(on).collect();
        let slab = sight.groups.slabs[support].filter(|_| !cells.is_empty())?;
        Some(Self {
            image: &sight.image,
            relief,
            support,
            slab,
            cells,
        })
    }

    pub(crate) fn relief(
        &self,
        lap: f64,
        repairs: &mut Repairs,
    ) -> Result<ReliefSolid, BooleanError> {
        let map = &self.image.map;
        let back = |c: CellId, q: DVec2| {
            if self.slab.is_shell() {
                self.shell(c, q, 1.0)
            } else {
                self.slab.plane(map.plane.direction(q), self.slab.backing())
            }
        };
        let behind = |c, k| hidden(map, c, k);
        let (mut solids, mut dropped) = (Vec::new(), Vec::new());
        for sheet in self.sheets() {
            let made = block(map, &sheet, &self.relief.depth, back, behind, lap);
            repairs.filled += made.filled;
            repairs.dropped_cells += made.dropped.len();
            dropped.extend(made.dropped);
            solids.push(Boolean::new(&without_spare_corners(made.mesh, SPARE_MM))?);
        }
        dropped.sort_unstable();
        Ok(ReliefSolid {
            solid: Boolean::union(solids)?,
            dropped,
        })
    }

    /// What is carved out before the relief.
    pub(crate) fn hollow(&self, edge: CarvingEdge) -> Result<Boolean, BooleanError> {
        let (map, slab, cells) = (&self.image.map, &self.slab, &self.cells);
        if slab.is_shell() {
            let floor = |c: CellId, q: DVec2| self.shell(c, q, FLOOR);
            hollow::shell_hollow(map, slab, self.support, cells, edge, floor)
        } else {
            let mesh = &self.image.field.supports[self.support].mesh;
            hollow::hollow(map, slab, (self.support, mesh), cells, edge)
        }
    }

    /// Where a shell's backing ends (`share` 1), or part of the way to there.
    fn shell(&self, cell: CellId, q: DVec2, share: f64) -> f64 {
        let surface = self.image.surface_in(&self.slab, cell, q);
        self.slab.shell_backing(surface, share)
    }

    /// Cells (rising) in parts over which the surface of a shell does not jump: where one fold of it hides another it does.
    fn sheets(&self) -> Vec<Vec<CellId>> {
        let cells = &self.cells;
        if !self.slab.is_shell() {
            return vec![cells.clone()];
        }
        let map = &self.image.map;
        let local = |c: &CellId| cells.binary_search(c).ok();
        let mut sets = DisjointSets::new(cells.len());
        for (i, c) in cells.iter().enumerate() {
            for (k, n) in map.neighbours[*c].iter().enumerate() {
                let Some((n, j)) = n.and_then(|n| Some((n, local(&n)?))) else {
                    continue;
                };
                if self.image.layer_goes_on(&self.slab, *c, k, n) {
                    sets.join(i as u32, j as u32);
                }
            }
        }
        let of = |set: Vec<usize>| set.into_iter().map(|i| cells[i]).collect();
        sets.members().into_iter().map(of).collect()
    }
}

/// Whether a nearer support hides what lies beyond side `k` of a cell.
fn hidden(map: &ViewMap, c: CellId, k: usize) -> bool {
    let Some(n) = map.neighbours[c][k] else {
        return false;
    };
    let (here, there) = (&map.cells[c], &map.cells[n]);
    here.support != there.support && there.support_depth < here.support_depth
}
