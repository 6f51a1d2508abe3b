//! Vertices around which no two faces are in each other's way.
//!
//! Seen along an axis, the faces around a vertex of a smooth surface lie side by side, once around it. Then any two of them have
//! nothing in common but that vertex and perhaps an edge, and need not be compared: that is most of all faces whose boxes meet.
//! Exact: coordinates are dropped, not rounded, and only signs of determinants and comparisons decide.

use crate::geom::area_vector;
use crate::index::{FaceId, VertexId};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::turn2;
use glam::DVec3;
use rayon::prelude::*;

/// Vertices with more faces are left to the comparison of pairs: whether their faces close costs the square of that.
const MOST_FACES: usize = 32;

/// For each vertex whether its faces lie side by side. Vertices with open or crowded edges do not count.
pub(crate) fn plain_fans(mesh: &TriMesh) -> Vec<bool> {
    let around = FacesAround::new(mesh);
    let vertices = 0..mesh.vertices.len() as u32;
    vertices
        .into_par_iter()
        .map(|v| is_plain(mesh, VertexId(v), around.faces(VertexId(v))))
        .collect()
}

/// The faces around each vertex.
struct FacesAround {
    /// Where those of a vertex begin; one more than there are vertices.
    start: Vec<usize>,
    faces: Vec<FaceId>,
}

impl FacesAround {
    fn new(mesh: &TriMesh) -> Self {
        let mut start = vec![0; mesh.vertices.len() + 1];
        for v in mesh.faces.iter().flatten() {
            start[v.at() + 1] += 1;
        }
        for v in 1..start.len() {
            start[v] += start[v - 1];
        }
        let mut next = start.clone();
        let mut faces = vec![FaceId(0); 3 * mesh.faces.len()];
        for (f, face) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
            for v in face {
                faces[next[v.at()]] = f;
                next[v.at()] += 1;
            }
        }
        Self { start, faces }
    }

    fn faces(&self, v: VertexId) -> &[FaceId] {
        &self.faces[self.start[v.at()]..self.start[v.at() + 1]]
    }
}

fn is_plain(mesh: &TriMesh, v: VertexId, faces: &[FaceId]) -> bool {
    if faces.len() > MOST_FACES {
        return false;
    }
    // The side of each face opposite to the vertex.
    let mut opposite = [[v; 2]; MOST_FACES];
    for (side, f) in opposite.iter_mut().zip(faces) {
        let face = mesh.faces[*f];
        let k = face.iter().position(|x| *x == v).unwrap_or(0);
        *side = [face[(k + 1) % 3], face[(k + 2) % 3]];
    }
    let opposite = &opposite[..faces.len()];
    let follows = |end: VertexId| opposite.iter().filter(|side| side[0] == end).count() == 1;
    if !opposite.iter().all(|side| follows(side[1])) {
        return false;
    }
    let at = |v: VertexId| mesh.vertices[v];
    let normals = opposite
        .iter()
        .map(|[p, q]| area_vector([at(v), at(*p), at(*q)]));
    let normal: DVec3 = normals.sum();
    let axis = normal.abs().max_position();
    let is_upright = |[p, q]: &[VertexId; 2]| {
        let turn = turn2(axis, at(v), at(*p), at(*q));
        if normal[axis] > 0.0 {
            turn > 0.0
        } else {
            turn < 0.0
        }
    };
    // All turn the same way, and one of them crosses the ray from the vertex along the next axis: so they go round it once.
    let height = |x: VertexId| at(x)[(axis + 2) % 3];
    let is_below = |x: VertexId| height(x) <= height(v);
    let rises = |[p, q]: &&[VertexId; 2]| match normal[axis] > 0.0 {
        true => is_below(*p) && !is_below(*q),
        false => is_below(*q) && !is_below(*p),
    };
    opposite.iter().all(is_upright) && opposite.iter().filter(rises).count() == 1
}
