//! The mesh that everything else here is about.

use crate::geom::{against, area_vector};
use crate::index::{FaceId, VertexId};
use glam::{DMat4, DVec3};

/// An indexed triangle mesh. Faces turn counter-clockwise as seen from outside.
///
/// Promises only that indices are in range and coordinates finite (constructors of meshes check that);
/// not that it is closed, oriented or free of degenerate faces: ask for its defects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Positions in millimetres.
    pub vertices: Vec<DVec3>,
    /// Vertex indices, three a face.
    pub faces: Vec<[VertexId; 3]>,
}

impl TriMesh {
    /// From plain numbers, as files and tables have them.
    pub fn new(vertices: Vec<DVec3>, faces: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let faces = faces.into_iter().map(|f| f.map(VertexId));
        Self {
            vertices,
            faces: faces.collect(),
        }
    }

    pub fn corners(&self, face: FaceId) -> [DVec3; 3] {
        self.faces[face].map(|v| self.vertices[v])
    }

    /// Twice the area times the unit normal.
    pub fn area_vector(&self, face: FaceId) -> DVec3 {
        area_vector(self.corners(face))
    }

    /// Unit normal; zero for a degenerate face.
    pub fn normal(&self, face: FaceId) -> DVec3 {
        self.area_vector(face).normalize_or_zero()
    }

    /// Unit normal on the side that a ray along `direction` meets: eyes see both sides of an open surface, and which of them its
    /// file calls the outer one says nothing. Zero for a degenerate face.
    pub fn normal_against(&self, face: FaceId, direction: DVec3) -> DVec3 {
        against(self.normal(face), direction)
    }

    /// Signed volume in cubic millimetres: meaningful for closed meshes. Keeps its digits far from the origin.
    pub fn volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_default();
        let tetrahedron = |f| {
            let [a, b, c] = self.corners(f).map(|v| v - origin);
            a.dot(b.cross(c))
        };
        FaceId::all(self.faces.len()).map(tetrahedron).sum::<f64>() / 6.0
    }

    /// Surface area in square millimetres.
    pub fn area(&self) -> f64 {
        FaceId::all(self.faces.len())
            .map(|f| self.area_vector(f).length() / 2.0)
            .sum()
    }

    /// Smallest and largest corner over all vertices; `None` if there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let first = *self.vertices.first()?;
        Some(
            self.vertices
                .iter()
                .fold((first, first), |(lo, hi), v| (lo.min(*v), hi.max(*v))),
        )
    }

    /// The mesh moved by an affine matrix; turned inside out again if the matrix mirrors.
    pub fn transformed(&self, matrix: DMat4) -> Self {
        let vertices = self
            .vertices
            .iter()
            .map(|v| matrix.transform_point3(*v))
            .collect();
        let mirrored = matrix.determinant() < 0.0;
        let faces = self
            .faces
            .iter()
            .map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] })
            .collect();
        Self { vertices, faces }
    }

    /// Adds the faces of `other` with vertices of their own.
    pub fn append(&mut self, other: &Self) {
        let offset = self.vertices.len();
        self.vertices.extend_from_slice(&other.vertices);
        self.faces
            .extend(other.faces.iter().map(|f| f.map(|v| v.plus(offset))));
    }
}
