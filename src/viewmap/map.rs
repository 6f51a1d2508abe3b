//! The view map itself: cells of an eye's image, and what is seen in each.

use crate::geom::ImagePlane;
use crate::mesh::DisjointSets;
use glam::DVec2;

/// One triangle of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Indices of image points, counter-clockwise.
    pub corners: [u32; 3],
    /// The model face seen here.
    pub face: Option<u32>,
    /// The support first hit here.
    pub support: Option<u32>,
    /// The face of the supports' mesh hit here, for [`SupportField::facet_depth`].
    pub facet: Option<u32>,
    /// The face of the supports' mesh at which rays leave the wall behind, where a layer goes through that.
    pub leaves: Option<u32>,
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
    pub neighbours: Vec<[Option<u32>; 3]>,
    /// Solid angle in steradians of cells whose label was still in doubt after the last round: 0 unless faces are tangled.
    pub doubtful_sr: f64,
}

impl ViewMap {
    pub fn triangle(&self, cell: usize) -> [DVec2; 3] {
        self.cells[cell].corners.map(|p| self.points[p as usize])
    }

    /// Number of connected regions of cells that are `inside`.
    pub fn regions(&self, inside: impl Fn(usize) -> bool) -> usize {
        let mut sets = DisjointSets::new(self.cells.len());
        let pairs = (0..self.cells.len())
            .flat_map(|c| self.neighbours[c].iter().flatten().map(move |n| (c, *n)));
        pairs
            .filter(|(c, n)| inside(*c) && inside(*n as usize))
            .for_each(|(c, n)| sets.join(c as u32, n));
        (0..self.cells.len())
            .filter(|c| inside(*c) && sets.root(*c as u32) == *c as u32)
            .count()
    }

    /// Mean of three image points.
    pub fn points_mean(&self, corners: [u32; 3]) -> DVec2 {
        corners
            .iter()
            .map(|p| self.points[*p as usize])
            .sum::<DVec2>()
            / 3.0
    }

    /// Solid angle of a cell in steradians, as [`ImagePlane::solid_angle`] has it.
    pub fn solid_angle(&self, cell: usize) -> f64 {
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
    #[error("the image could not be triangulated: {0}")]
    Triangulation(String),
}
