//! Takes apart surfaces that only touch: vertices and edges with more faces than a manifold has.
//!
//! Rounding can bring two sheets together in a vertex or an edge. Faces around such an edge are paired so that each pair
//! encloses material; the vertices are split into one copy for each fan of faces that hang together, and the copies are
//! drawn a little into their own material, so that a real gap is left.

use crate::index::VertexId;
use crate::mesh::topology::{DisjointSets, Edges, FaceCorner, HalfEdge};
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;

/// How far touching surfaces are drawn back: hundreds of f32 steps, a thousandth of a printed line.
const GAP_MM: f64 = 1.5e-3;

/// Splits touching vertices and edges; gives the number of copies made. Faces keep their order.
pub fn detach(mesh: &mut TriMesh) -> usize {
    let mut fans = DisjointSets::new(3 * mesh.faces.len());
    for sides in Edges::new(mesh).iter() {
        for (x, y) in pairs(mesh, sides) {
            // One side runs against the other: the start of one is the end of the other.
            fans.join(x.end(0).0, y.end(1).0);
            fans.join(x.end(1).0, y.end(0).0);
        }
    }
    let mut owner: Vec<Option<u32>> = vec![None; mesh.vertices.len()];
    let mut copies: Vec<(u32, VertexId)> = Vec::new();
    for c in FaceCorner::all(3 * mesh.faces.len()) {
        let fan = fans.root(c.0);
        let vertex = c.vertex(mesh);
        let first = *owner[vertex].get_or_insert(fan);
        if first != fan {
            copies.push((fan, vertex));
        }
    }
    copies.sort_unstable();
    copies.dedup();
    split(mesh, &mut fans, &copies);
    copies.len()
}

/// The faces at an edge in pairs: of two, these; of more, neighbours around the edge with material between them.
fn pairs(mesh: &TriMesh, sides: &[HalfEdge]) -> Vec<(HalfEdge, HalfEdge)> {
    if let [x, y] = sides {
        return vec![(*x, *y)];
    }
    let (low, high) = (mesh.vertices[sides[0].low], mesh.vertices[sides[0].high]);
    let axis = (high - low).normalize_or_zero();
    let across = axis.any_orthonormal_vector();
    let angle = |h: &HalfEdge| {
        let apex = mesh.vertices[h.end(2).vertex(mesh)] - low;
        apex.dot(axis.cross(across)).atan2(apex.dot(across))
    };
    let mut around: Vec<(f64, HalfEdge)> = sides.iter().map(|h| (angle(h), *h)).collect();
    around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // Turning about the edge, material begins behind a backward side and ends at a forward one.
    let Some(start) = around.iter().position(|x| !x.1.forward) else {
        return Vec::new();
    };
    around.rotate_left(start);
    let mut open: Vec<HalfEdge> = Vec::new();
    let mut found = Vec::new();
    for (_, side) in around {
        if !side.forward {
            open.push(side);
        } else if let Some(begin) = open.pop() {
            found.push((begin, side));
        }
    }
    found
}

/// Gives the fans of `copies` vertices of their own and draws every fan at a split vertex into its material.
fn split(mesh: &mut TriMesh, fans: &mut DisjointSets, copies: &[(u32, VertexId)]) {
    let mut split: Vec<VertexId> = copies.iter().map(|c| c.1).collect();
    split.sort_unstable();
    split.dedup();
    if split.is_empty() {
        return;
    }
    let mut members: Vec<(u32, FaceCorner)> = Vec::new();
    for c in FaceCorner::all(3 * mesh.faces.len()) {
        if split.binary_search(&c.vertex(mesh)).is_ok() {
            members.push((fans.root(c.0), c));
        }
    }
    members.sort_unstable();
    let mut faces = mesh.faces.clone();
    for fan in members.chunk_by(|a, b| a.0 == b.0) {
        let outwards: DVec3 = fan.iter().map(|m| mesh.normal(m.1.face())).sum();
        let vertex = fan[0].1.vertex(mesh);
        let moved = mesh.vertices[vertex] - GAP_MM * outwards.normalize_or_zero();
        let new = VertexId::new(mesh.vertices.len());
        mesh.vertices.push(moved.as_vec3().as_dvec3());
        fan.iter().for_each(|m| faces[m.1.face()][m.1.k()] = new);
    }
    mesh.faces = faces;
}
