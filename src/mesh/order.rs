//! One numbering for every mesh: results must not depend on the order in which a file lists its vertices and faces.

use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;

/// The same surface with vertices rising by coordinates (x, then y, then z), every face beginning with its lowest vertex, and
/// faces rising, and the new number of every vertex. Unique if no two vertices share their coordinates; the winding stays.
pub fn numbered(mesh: &TriMesh) -> (TriMesh, Vec<u32>) {
    // Adding 0 makes -0 and 0 one number.
    let place = |v: &DVec3| (*v + 0.0).to_array();
    let by_place = |a: &[f64; 3], b: &[f64; 3]| {
        let axes = (0..3).map(|k| a[k].total_cmp(&b[k]));
        axes.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    };
    let mut sorted: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let places: Vec<[f64; 3]> = mesh.vertices.iter().map(place).collect();
    sorted.sort_by(|v, w| by_place(&places[*v as usize], &places[*w as usize]));
    let mut number = vec![0; sorted.len()];
    for (new, old) in sorted.iter().enumerate() {
        number[*old as usize] = new as u32;
    }
    let lowest_first = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| number[v as usize]);
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        turns.into_iter().min().unwrap_or([a, b, c])
    };
    let mut faces: Vec<[u32; 3]> = mesh.faces.iter().map(lowest_first).collect();
    faces.sort_unstable();
    let vertices = sorted.iter().map(|v| places[*v as usize].into()).collect();
    (TriMesh { vertices, faces }, number)
}
