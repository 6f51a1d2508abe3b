//! The view map itself: cells of an eye's image, and what is seen in each.

use crate::geom::ImagePlane;
use crate::geom::rings::Rings;
use crate::index::{CellId, FaceId, FacetId, PointId, SupportId};
use crate::mesh::DisjointSets;
use glam::DVec2;
use std::collections::BTreeMap;

/// One triangle of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Indices of image points, counter-clockwise.
    pub corners: [PointId; 3],
    /// The model face seen here.
    pub face: Option<FaceId>,
    /// The support first hit here.
    pub support: Option<SupportId>,
    /// The face of the supports' mesh hit here, for [`facet_depth`](super::SupportField::facet_depth).
    pub facet: Option<FacetId>,
    /// The face of the supports' mesh at which rays leave the wall behind, where a layer goes through that.
    pub leaves: Option<FacetId>,
    /// Depth along the forward axis at which the cell's centre meets it; infinite without.
    pub support_depth: f64,
    /// Which corners lie on the outline of the face's component, as the eye sees it.
    pub outline: [bool; 3],
}

/// See the folder's head.
#[derive(Clone, Debug)]
pub struct ViewMap {
    pub plane: ImagePlane,
    pub points: Vec<DVec2>,
    pub cells: Vec<Cell>,
    /// The cell across the side from corner `k` to `k + 1`.
    pub neighbours: Vec<[Option<CellId>; 3]>,
    /// Solid angle in steradians of cells whose label was still in doubt after the last round: 0 unless faces are tangled.
    pub doubtful_sr: f64,
    /// The grid that its points were snapped to, from 0 of [`GRIDS`](super::GRIDS): coarser ones are tried where one fails.
    pub grid: usize,
}

impl ViewMap {
    pub fn triangle(&self, cell: CellId) -> [DVec2; 3] {
        self.cells[cell].corners.map(|p| self.points[p])
    }

    /// All cells with their indices, rising.
    pub fn all(&self) -> impl Iterator<Item = (CellId, &Cell)> {
        CellId::all(self.cells.len()).zip(&self.cells)
    }

    /// Number of connected regions of cells that are `inside`.
    pub fn regions(&self, inside: impl Fn(CellId) -> bool) -> usize {
        let mut sets = DisjointSets::new(self.cells.len());
        let all = || CellId::all(self.cells.len());
        let pairs = all().flat_map(|c| self.neighbours[c].iter().flatten().map(move |n| (c, *n)));
        pairs
            .filter(|(c, n)| inside(*c) && inside(*n))
            .for_each(|(c, n)| sets.join(c.0, n.0));
        all()
            .filter(|c| inside(*c) && sets.root(c.0) == c.0)
            .count()
    }

    /// The boundary of a set of cells (rising) as closed rings, `scale` times as large as the image.
    pub fn outlines(&self, cells: &[CellId], scale: f64) -> Rings {
        let mut next: BTreeMap<PointId, Vec<PointId>> = BTreeMap::new();
        for c in cells {
            let cell = &self.cells[*c];
            for k in 0..3 {
                if self.neighbours[*c][k].is_none_or(|n| cells.binary_search(&n).is_err()) {
                    next.entry(cell.corners[k])
                        .or_default()
                        .push(cell.corners[(k + 1) % 3]);
                }
            }
        }
        let mut rings = Vec::new();
        while let Some((&start, _)) = next.first_key_value() {
            let mut ring = Vec::new();
            let mut at = start;
            while let Some(ends) = next.get_mut(&at) {
                let to = ends.pop();
                if ends.is_empty() {
                    next.remove(&at);
                }
                ring.push((self.points[at] * scale).to_array());
                at = to.unwrap_or(start);
            }
            rings.push(ring);
        }
        rings
    }

    /// Mean of three image points.
    pub fn points_mean(&self, corners: [PointId; 3]) -> DVec2 {
        corners.iter().map(|p| self.points[*p]).sum::<DVec2>() / 3.0
    }

    /// Solid angle of a cell in steradians, as [`ImagePlane::solid_angle`] has it.
    pub fn solid_angle(&self, cell: CellId) -> f64 {
        self.plane.solid_angle(self.triangle(cell)).abs()
    }
}

/// Why no view map could be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewMapError {
    #[error("part of its models lies beside or behind the eye")]
    BesideEye,
    #[error("no part of the models is seen from the eye")]
    NothingSeen,
    /// Where in the image.
    #[error("lines of the image run too close together to be told apart")]
    Triangulation(DVec2),
}
