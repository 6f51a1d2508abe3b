//! Takes apart surfaces that only touch: vertices and edges with more faces than a manifold has.
//!
//! Around such an edge the faces are paired so that each pair encloses material; vertices are split into one copy for each fan of
//! faces that hang together, and the copies are drawn a little into their own material, so that a real gap is left.

use super::complex::NEAR_MM;
use super::regions::sorted_around;
use crate::index::{FaceId, VertexId};
use crate::mesh::shells::ClosedSurface;
use crate::mesh::topology::{DisjointSets, Edges, FaceCorner, HalfEdge, bowtie_vertices};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::weld::drop_unreferenced;
use glam::DVec3;

/// How far touching surfaces are drawn back, millimetres: so far that gluing does not join them again, and four thousandths of a
/// printed line.
const GAP_MM: f64 = 3.0 * NEAR_MM;

/// Whether a surface has an edge or a vertex with more faces than a manifold has.
pub(crate) fn touches(surface: &ClosedSurface) -> bool {
    let ClosedSurface { mesh, edges, .. } = surface;
    edges.iter().any(|sides| sides.len() > 2) || !bowtie_vertices(mesh, edges).is_empty()
}

/// Splits touching edges and vertices of the boundary of a solid; gives the faces that changed, rising.
pub(crate) fn part_touching(mesh: &mut TriMesh) -> Vec<FaceId> {
    let before = VertexId::new(mesh.vertices.len());
    open_edges(mesh);
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
    let is_new = |f: &FaceId| mesh.faces[*f].iter().any(|v| *v >= before);
    let changed: Vec<FaceId> = FaceId::all(mesh.faces.len()).filter(is_new).collect();
    if !changed.is_empty() {
        drop_unreferenced(mesh);
    }
    changed
}

/// Gives each surface at a crowded edge a corner of its own in the middle of it: the surfaces may hang together at both ends.
fn open_edges(mesh: &mut TriMesh) {
    let edges = Edges::new(mesh);
    let crowded = edges.iter().filter(|sides| sides.len() > 2);
    let crowded: Vec<Vec<HalfEdge>> = crowded.map(<[HalfEdge]>::to_vec).collect();
    let mut changed = vec![false; mesh.faces.len()];
    for sides in crowded {
        // A face with two crowded edges waits for the next time.
        if sides.iter().any(|s| changed[s.face]) {
            continue;
        }
        for (x, y) in pairs(mesh, &sides) {
            let middle = mesh.vertices[x.low].midpoint(mesh.vertices[x.high]);
            let outwards = mesh.normal(x.face) + mesh.normal(y.face);
            let own = VertexId::new(mesh.vertices.len());
            mesh.vertices.push(drawn_in(middle, outwards));
            for side in [x, y] {
                let face = mesh.faces[side.face];
                mesh.faces[side.face] = face.map(|v| if v == side.high { own } else { v });
                let rest = face.map(|v| if v == side.low { own } else { v });
                mesh.faces.push(rest);
                changed[side.face] = true;
            }
        }
    }
}

/// A place on a surface, drawn into the material behind it.
fn drawn_in(p: DVec3, outwards: DVec3) -> DVec3 {
    let p = p - GAP_MM * outwards.normalize_or_zero();
    p.as_vec3().as_dvec3()
}

/// The faces at an edge in pairs: of two, these; of more, neighbours around the edge with material between them.
fn pairs(mesh: &TriMesh, sides: &[HalfEdge]) -> Vec<(HalfEdge, HalfEdge)> {
    if let [x, y] = sides {
        return vec![(*x, *y)];
    }
    let around = sorted_around(mesh, sides);
    let next = |i: usize| around[(i + 1) % around.len()];
    let found = around.iter().enumerate().map(|(i, side)| (*side, next(i)));
    // Onwards from a forward side there is material.
    found.filter(|(x, y)| x.forward && !y.forward).collect()
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
        let new = VertexId::new(mesh.vertices.len());
        mesh.vertices
            .push(drawn_in(mesh.vertices[vertex], outwards));
        fan.iter().for_each(|m| faces[m.1.face()][m.1.k()] = new);
    }
    mesh.faces = faces;
}
