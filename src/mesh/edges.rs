//! The undirected edges of a mesh with the faces on them.

use crate::mesh::TriMesh;

/// An undirected edge `a < b` and the faces that have it, in rising order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    pub a: u32,
    pub b: u32,
    pub faces: Vec<u32>,
}

/// All edges, sorted by `(a, b)`.
pub fn edges(mesh: &TriMesh) -> Vec<Edge> {
    let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * mesh.faces.len());
    for (f, face) in mesh.faces.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            sides.push((a.min(b), a.max(b), f as u32));
        }
    }
    sides.sort_unstable();
    sides
        .chunk_by(|x, y| (x.0, x.1) == (y.0, y.1))
        .map(|c| Edge { a: c[0].0, b: c[0].1, faces: c.iter().map(|s| s.2).collect() })
        .collect()
}
