//! One numbering for every mesh: results must not depend on the order in which a file lists its vertices and faces.

use crate::index::VertexId;
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;

/// The same surface with vertices rising by coordinates (x, then y, then z), every face beginning with its lowest vertex, and
/// faces rising, and the new number of every vertex. Unique if no two vertices share their coordinates; the winding stays.
pub fn numbered(mesh: &TriMesh) -> (TriMesh, Vec<VertexId>) {
    // Adding 0 makes -0 and 0 one number.
    let place = |v: &DVec3| (*v + 0.0).to_array();
    let by_place = |a: &[f64; 3], b: &[f64; 3]| {
        let axes = (0..3).map(|k| a[k].total_cmp(&b[k]));
        axes.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    };
    let mut sorted: Vec<VertexId> = VertexId::all(mesh.vertices.len()).collect();
    let places: Vec<[f64; 3]> = mesh.vertices.iter().map(place).collect();
    sorted.sort_by(|v, w| by_place(&places[*v], &places[*w]));
    let mut number = vec![VertexId(0); sorted.len()];
    for (new, old) in VertexId::all(sorted.len()).zip(&sorted) {
        number[*old] = new;
    }
    let lowest_first = |face: &[VertexId; 3]| {
        let [a, b, c] = face.map(|v| number[v]);
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        turns.into_iter().min().unwrap_or([a, b, c])
    };
    let mut faces: Vec<[VertexId; 3]> = mesh.faces.iter().map(lowest_first).collect();
    faces.sort_unstable();
    let vertices = sorted.iter().map(|v| places[*v].into()).collect();
    (TriMesh { vertices, faces }, number)
}
