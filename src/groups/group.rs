//! Groups and bounds as values.

use super::anchor::Anchor;
use crate::index::{CellId, ComponentId, FaceId, GroupId, SupportId};
use crate::support::Slab;
use crate::viewmap::{Cell, ViewMap};

/// A connected region of the image on one part of a support, of one mesh component.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub support: SupportId,
    /// Of the support's surface; see [`Support::part`](crate::support::Support::part).
    pub part: u32,
    pub component: ComponentId,
    /// Cells of the view map, rising.
    pub cells: Vec<CellId>,
    pub solid_angle_sr: f64,
}

/// `lower <= s / mu_g <= upper` at one point; `lower` may be 0: no near limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    pub group: GroupId,
    pub anchor: Anchor,
    pub lower: f64,
    pub upper: f64,
    /// Whether it draws an outline onto the support: then it is narrower than those around it.
    pub drawn: bool,
}

/// See the folder's head.
#[derive(Clone, Debug)]
pub struct Groups {
    pub groups: Vec<Group>,
    /// Group of every cell of the map.
    pub of_cell: Vec<Option<GroupId>>,
    /// The bounds at all corners of all cells; those from `needed` on follow from the others, but for rounding.
    pub bounds: Vec<Bound>,
    pub needed: usize,
    /// The layer of every support from this eye.
    pub slabs: Vec<Option<Slab>>,
}

/// A cell in which a support carries the model.
pub(crate) struct Carried<'a> {
    pub id: CellId,
    pub cell: &'a Cell,
    pub group: GroupId,
    /// Of the model.
    pub face: FaceId,
    pub slab: Slab,
}

impl Groups {
    /// The cells of a map that a layer carries the model in, rising.
    pub(crate) fn carried<'a>(&'a self, map: &'a ViewMap) -> impl Iterator<Item = Carried<'a>> {
        map.all().filter_map(|(id, cell)| {
            Some(Carried {
                id,
                cell,
                group: self.of_cell[id]?,
                face: cell.face?,
                slab: self.slabs[cell.support?]?,
            })
        })
    }

    /// Groups without any bound, rising: all of their vertices are free.
    pub fn unheld(&self) -> Vec<GroupId> {
        let mut held = vec![false; self.groups.len()];
        self.bounds.iter().for_each(|b| held[b.group] = true);
        GroupId::all(held.len()).filter(|g| !held[*g]).collect()
    }
}
