//! What a file says of its vertices and faces besides where they are, and the file's mesh as it was.
//!
//! Attributes belong to the mesh *as read*: vertices and faces in the file's order, nothing joined. Making a model fit to be
//! looked at joins, drops and renumbers vertices; [`Original`] keeps both sides of that and where each vertex went, so that
//! whoever writes the model again finds every corner's texture point and whoever needs a value at a vertex of the model gets
//! one. Placing moves vertices only, so attributes do not know of it.

use crate::index::{FaceId, VertexId};
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec2;

/// Marks a face corner without a texture point.
pub const NO_UV: u32 = u32::MAX;

/// Texture points and which of them every face corner has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Uvs {
    pub points: Vec<DVec2>,
    /// Indices of points, or [`NO_UV`]. Index: face.
    pub corners: Vec<[u32; 3]>,
}

/// A number for every vertex under a name of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexScalar {
    /// Without blanks.
    pub name: String,
    /// Finite. Index: vertex.
    pub values: Vec<f64>,
}

/// See the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// Red, green, blue (sRGB) and opacity of every vertex, 0 to 1; empty: the file has none.
    pub colours: Vec<[f64; 4]>,
    pub uvs: Option<Uvs>,
    /// In the file's order; names differ.
    pub scalars: Vec<VertexScalar>,
}

/// Names of the colour's channels as attributes.
const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];

impl Attributes {
    pub fn is_empty(&self) -> bool {
        self.colours.is_empty() && self.uvs.is_none() && self.scalars.is_empty()
    }

    /// What [`Attributes::values`] knows, colours first.
    pub fn names(&self) -> Vec<&str> {
        let channels = if self.colours.is_empty() { 0 } else { 4 };
        let scalars = self.scalars.iter().map(|s| s.name.as_str());
        CHANNELS[..channels]
            .iter()
            .copied()
            .chain(scalars)
            .collect()
    }

    /// The values of an attribute, one a vertex: a scalar by its name, or a channel of the colours, 0 to 1.
    pub fn values(&self, name: &str) -> Option<Vec<f64>> {
        if let Some(scalar) = self.scalars.iter().find(|s| s.name == name) {
            return Some(scalar.values.clone());
        }
        let channel = CHANNELS.iter().position(|c| *c == name)?;
        let values = self.colours.iter().map(|c| c[channel]);
        (!self.colours.is_empty()).then(|| values.collect())
    }
}

impl Uvs {
    /// The texture point of every vertex, if all its corners agree; vertices without one get (0, 0).
    pub fn per_vertex(&self, mesh: &TriMesh) -> Option<Vec<DVec2>> {
        let mut found: Vec<Option<DVec2>> = vec![None; mesh.vertices.len()];
        let corners = mesh
            .faces
            .iter()
            .flatten()
            .zip(self.corners.iter().flatten());
        for (vertex, uv) in corners {
            let point = self.points.get(*uv as usize).copied().unwrap_or_default();
            let slot = &mut found[*vertex];
            if *slot.get_or_insert(point) != point {
                return None;
            }
        }
        Some(found.into_iter().map(Option::unwrap_or_default).collect())
    }
}

/// A model's mesh as its file has it (polygons cut into triangles), and what became of its vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Original {
    /// In the file's coordinates.
    pub mesh: TriMesh,
    pub attributes: Attributes,
    /// The model's vertex at every vertex of the file; `None` where no face used it. Several may have become one.
    pub vertex_of: Vec<Option<VertexId>>,
    /// What this is a simplified form of, if so.
    pub lowered_from: Option<LoweredFrom>,
}

/// A model before it was simplified.
#[derive(Clone, Debug, PartialEq)]
pub struct LoweredFrom {
    /// How many vertices and faces its file has.
    pub vertices: usize,
    pub faces: usize,
    /// Fit to be looked at, in the file's coordinates.
    pub mesh: TriMesh,
}

impl Original {
    /// The values of an attribute at the model's `count` vertices: the mean of those that became one.
    pub fn values(&self, name: &str, count: usize) -> Option<Vec<f64>> {
        let values = self.attributes.values(name)?;
        let mut sums = vec![(0.0, 0.0); count];
        for (value, vertex) in values.iter().zip(&self.vertex_of) {
            if let Some(slot) = vertex.and_then(|v| sums.get_mut(v.at())) {
                *slot = (slot.0 + value, slot.1 + 1.0);
            }
        }
        Some(
            sums.iter()
                .map(|(sum, n)| sum / f64::max(*n, 1.0))
                .collect(),
        )
    }

    /// The file's face that became each face of the model, by their vertices; a face that became several takes the first.
    /// `None` where there is no such face.
    pub fn faces_of(&self, model: &TriMesh) -> Vec<Option<FaceId>> {
        let key = |mut face: [VertexId; 3]| {
            face.sort_unstable();
            face
        };
        let became = |face: &[VertexId; 3]| {
            let [a, b, c] = face.map(|v| self.vertex_of[v]);
            Some(key([a?, b?, c?]))
        };
        let faces = FaceId::all(self.mesh.faces.len()).zip(&self.mesh.faces);
        let mut known: Vec<([VertexId; 3], FaceId)> = faces
            .filter_map(|(f, face)| Some((became(face)?, f)))
            .collect();
        known.sort_unstable();
        let find = |face: &[VertexId; 3]| {
            let at = known.partition_point(|k| k.0 < key(*face));
            known.get(at).filter(|k| k.0 == key(*face)).map(|k| k.1)
        };
        model.faces.iter().map(find).collect()
    }
}

/// Entries of a list that is empty or has one for every vertex.
pub fn picked<T: Copy>(list: &[T], vertices: &[VertexId]) -> Vec<T> {
    if list.is_empty() {
        return Vec::new();
    }
    vertices.iter().map(|v| list[*v]).collect()
}
