//! Vertices around which no two faces are in each other's way.
//!
//! Seen along an axis, the faces around a vertex of a smooth surface lie side by side, once around it. Then any two of them have
//! nothing in common but that vertex and perhaps an edge, and need not be compared: that is most of all faces whose boxes meet.
//! Exact: coordinates are dropped, not rounded, and only signs of determinants and comparisons decide.

use crate::geom::area_vector;
use crate::index::VertexId;
use crate::mesh::topology::{FaceCorner, sorted_by_vertex};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::turn2;
use glam::DVec3;
use rayon::prelude::*;

/// For each vertex whether its faces lie side by side. Vertices with open or crowded edges do not count.
pub(crate) fn plain_fans(mesh: &TriMesh) -> Vec<bool> {
    let corners = FaceCorner::all(3 * mesh.faces.len()).map(|c| (c.vertex(mesh), c));
    let by_vertex = sorted_by_vertex(corners.collect(), |(v, _)| *v);
    let fans = by_vertex.par_chunk_by(|a, b| a.0 == b.0);
    let found: Vec<(VertexId, bool)> = fans.map(|fan| (fan[0].0, is_plain(mesh, fan))).collect();
    let mut plain = vec![false; mesh.vertices.len()];
    found.into_iter().for_each(|(v, is)| plain[v] = is);
    plain
}

/// Whether the faces of a vertex, given with all its corners, lie side by side.
fn is_plain(mesh: &TriMesh, fan: &[(VertexId, FaceCorner)]) -> bool {
    let v = fan[0].0;
    // The side of each face opposite to the vertex.
    let opposite =
        |c: FaceCorner| [1, 2].map(|on| FaceCorner::of(c.face(), c.k() + on).vertex(mesh));
    let opposite: Vec<[VertexId; 2]> = fan.iter().map(|(_, c)| opposite(*c)).collect();
    // Each begins where one other ends.
    let [mut starts, mut ends] =
        [0, 1].map(|k| opposite.iter().map(|side| side[k]).collect::<Vec<_>>());
    starts.sort_unstable();
    ends.sort_unstable();
    if starts != ends || starts.windows(2).any(|pair| pair[0] == pair[1]) {
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
