//! The models of one eye, projected and ready for rays.

use crate::bvh::Bvh;
use crate::geom::{ImagePlane, orient};
use crate::index::{FaceId, VertexId};
use crate::mesh::{Edges, TriMesh, picked};
use crate::view::Marks;
use glam::DVec2;

/// What is looked at, ready for rays.
pub struct Target {
    pub mesh: TriMesh,
    pub bvh: Bvh,
    /// Image of every vertex in the plane the target was made for.
    pub image: Vec<DVec2>,
    /// Depth of every vertex along the plane's forward axis.
    pub depth: Vec<f64>,
    /// Factor on every vertex's weight `w` (paper Eq 13); empty: 1 everywhere.
    pub weights: Vec<f64>,
    /// Which vertices have no depth bounds; empty: none.
    pub free: Vec<bool>,
    /// Whether every edge has two faces: then only faces turned to the eye can be seen.
    closed: bool,
}

impl Target {
    /// `None` if part of the mesh does not lie in front of the eye.
    pub fn new(mesh: TriMesh, plane: &ImagePlane) -> Option<Self> {
        let image = mesh
            .vertices
            .iter()
            .map(|v| plane.project(*v))
            .collect::<Option<Vec<_>>>()?;
        let depth = mesh.vertices.iter().map(|v| plane.depth(*v)).collect();
        let closed = Edges::new(&mesh).iter().all(|e| e.len() == 2);
        Some(Self {
            bvh: Bvh::new(&mesh),
            mesh,
            image,
            depth,
            weights: Vec::new(),
            free: Vec::new(),
            closed,
        })
    }

    /// The same target with what a scene says of its vertices.
    pub fn marked(self, marks: Marks) -> Self {
        Self {
            weights: marks.weights,
            free: marks.free,
            ..self
        }
    }

    /// Factor on the weight of a vertex.
    pub fn weight(&self, vertex: VertexId) -> f64 {
        self.weights.get(vertex.at()).copied().unwrap_or(1.0)
    }

    /// Factor on the weight of a face: the mean of its vertices'.
    pub fn face_weight(&self, face: FaceId) -> f64 {
        if self.weights.is_empty() {
            return 1.0;
        }
        let corners = self.mesh.faces[face].map(|v| self.weight(v));
        corners.iter().sum::<f64>() / 3.0
    }

    /// Whether a vertex has no depth bounds.
    pub fn is_free(&self, vertex: VertexId) -> bool {
        self.free.get(vertex.at()) == Some(&true)
    }

    /// The same surface as another mesh: `mesh` has a vertex at each of `vertices` of this one.
    pub fn cut(&self, mesh: TriMesh, vertices: &[VertexId]) -> Self {
        Self {
            bvh: Bvh::new(&mesh),
            mesh,
            image: vertices.iter().map(|v| self.image[*v]).collect(),
            depth: vertices.iter().map(|v| self.depth[*v]).collect(),
            weights: picked(&self.weights, vertices),
            free: picked(&self.free, vertices),
            closed: false,
        }
    }

    /// The rectangle around the model's image, a little widened: the part of the image that is mapped.
    pub(super) fn image_box(&self) -> (DVec2, DVec2) {
        let first = self.image[0];
        let (lo, hi) = self
            .image
            .iter()
            .fold((first, first), |(lo, hi), q| (lo.min(*q), hi.max(*q)));
        let margin = 0.02 * (hi - lo).max_element();
        (lo - margin, hi + margin)
    }

    pub fn image_of(&self, face: FaceId) -> [DVec2; 3] {
        self.mesh.faces[face].map(|v| self.image[v])
    }

    /// Whether the face could be seen from the eye if nothing stood before it.
    pub(super) fn may_be_seen(&self, face: FaceId) -> bool {
        let [a, b, c] = self.image_of(face);
        let turn = orient(a, b, c);
        turn > 0.0 || (turn < 0.0 && !self.closed)
    }
}
