//! Takes apart surfaces that only touch: vertices and edges with more faces than a manifold has.
//!
//! Rounding can bring two sheets together in a vertex or an edge. Faces around such an edge are paired so that each pair
//! encloses material; the vertices are split into one copy for each fan of faces that hang together, and the copies are
//! drawn a little into their own material, so that a real gap is left.

use crate::mesh::topology::{DisjointSets, Edges, HalfEdge};
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;

/// How far touching surfaces are drawn back: hundreds of f32 steps, a thousandth of a printed line.
const GAP_MM: f64 = 1.5e-3;

/// Splits touching vertices and edges; gives the number of copies made. Faces keep their order.
pub fn detach(mesh: &mut TriMesh) -> usize {
    let corner = |h: &HalfEdge, end: u8| 3 * h.face + u32::from((h.corner + end) % 3);
    let mut fans = DisjointSets::new(3 * mesh.faces.len());
    for sides in Edges::new(mesh).iter() {
        for (x, y) in pairs(mesh, sides) {
            // One side runs against the other: the start of one is the end of the other.
            fans.join(corner(&x, 0), corner(&y, 1));
            fans.join(corner(&x, 1), corner(&y, 0));
        }
    }
    let mut owner: Vec<Option<u32>> = vec![None; mesh.vertices.len()];
    let mut copies: Vec<(u32, u32)> = Vec::new();
    for c in 0..3 * mesh.faces.len() as u32 {
        let fan = fans.root(c);
        let vertex = mesh.faces[c as usize / 3][c as usize % 3];
        let first = *owner[vertex as usize].get_or_insert(fan);
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
    let (low, high) = (
        mesh.vertices[sides[0].low as usize],
        mesh.vertices[sides[0].high as usize],
    );
    let axis = (high - low).normalize_or_zero();
    let across = axis.any_orthonormal_vector();
    let angle = |h: &HalfEdge| {
        let apex =
            mesh.vertices[mesh.faces[h.face as usize][(h.corner as usize + 2) % 3] as usize] - low;
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
fn split(mesh: &mut TriMesh, fans: &mut DisjointSets, copies: &[(u32, u32)]) {
    let mut split: Vec<u32> = copies.iter().map(|c| c.1).collect();
    split.sort_unstable();
    split.dedup();
    if split.is_empty() {
        return;
    }
    let mut members: Vec<(u32, u32)> = Vec::new();
    for c in 0..3 * mesh.faces.len() as u32 {
        if split
            .binary_search(&mesh.faces[c as usize / 3][c as usize % 3])
            .is_ok()
        {
            members.push((fans.root(c), c));
        }
    }
    members.sort_unstable();
    let mut faces = mesh.faces.clone();
    for fan in members.chunk_by(|a, b| a.0 == b.0) {
        let outwards: DVec3 = fan.iter().map(|m| mesh.normal(m.1 as usize / 3)).sum();
        let vertex = mesh.faces[fan[0].1 as usize / 3][fan[0].1 as usize % 3];
        let moved = mesh.vertices[vertex as usize] - GAP_MM * outwards.normalize_or_zero();
        let new = mesh.vertices.len() as u32;
        mesh.vertices.push(moved.as_vec3().as_dvec3());
        fan.iter()
            .for_each(|m| faces[m.1 as usize / 3][m.1 as usize % 3] = new);
    }
    mesh.faces = faces;
}
