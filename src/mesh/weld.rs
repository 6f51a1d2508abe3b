//! Joining vertices at the same place, and dropping what no longer forms a surface.
//!
//! Every function says what it changed; none changes the order of what it keeps.

use crate::index::{FaceId, VertexId};
use crate::mesh::topology::sorted_by_vertex;
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;
use rayon::slice::ParallelSliceMut;
use std::collections::HashMap;

/// A mesh whose vertices were joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    pub mesh: TriMesh,
    /// The new index of each old vertex.
    pub vertex_of: Vec<VertexId>,
    /// How many vertices went away.
    pub merged: usize,
}

/// Joins vertices no further than `tolerance` millimetres from the first vertex of their cluster, which stays where it
/// is. Tolerance 0 joins equal coordinates (and 0 with -0). Faces all stay, some perhaps with repeated indices.
pub fn weld(mesh: &TriMesh, tolerance: f64) -> Welded {
    let all = vec![true; mesh.vertices.len()];
    weld_some(mesh, tolerance, &all)
}

/// As [`weld`], but vertices that are not `eligible` stay by themselves.
pub fn weld_some(mesh: &TriMesh, tolerance: f64, eligible: &[bool]) -> Welded {
    let leader = if tolerance > 0.0 {
        near_leaders(&mesh.vertices, tolerance, eligible)
    } else {
        equal_leaders(&mesh.vertices, eligible)
    };
    let mut vertex_of = Vec::with_capacity(leader.len());
    let mut vertices = Vec::new();
    for (v, &first) in VertexId::all(leader.len()).zip(&leader) {
        if first == v {
            vertex_of.push(VertexId::new(vertices.len()));
            vertices.push(mesh.vertices[v]);
        } else {
            vertex_of.push(vertex_of[first]);
        }
    }
    let faces = mesh.faces.iter().map(|f| f.map(|v| vertex_of[v])).collect();
    let merged = mesh.vertices.len() - vertices.len();
    let mesh = TriMesh { vertices, faces };
    Welded {
        mesh,
        vertex_of,
        merged,
    }
}

/// For each vertex the first eligible one with the same coordinates.
fn equal_leaders(vertices: &[DVec3], eligible: &[bool]) -> Vec<VertexId> {
    let key = |v: &DVec3| v.to_array().map(|x| (x + 0.0).to_bits());
    let mut keyed: Vec<([u64; 3], VertexId)> = VertexId::all(vertices.len())
        .filter(|&v| eligible[v])
        .map(|v| (key(&vertices[v]), v))
        .collect();
    keyed.par_sort_unstable();
    let mut leader: Vec<VertexId> = VertexId::all(vertices.len()).collect();
    for same in keyed.chunk_by(|a, b| a.0 == b.0) {
        for (_, v) in same {
            leader[*v] = same[0].1;
        }
    }
    leader
}

/// For each eligible vertex the nearest cluster leader within the tolerance, or itself as a new leader.
fn near_leaders(vertices: &[DVec3], tolerance: f64, eligible: &[bool]) -> Vec<VertexId> {
    // From the corner of the cloud, so that cell numbers far from the origin do not run out of an i64.
    let corner = vertices
        .iter()
        .copied()
        .reduce(DVec3::min)
        .unwrap_or_default();
    let cell = |p: DVec3| {
        ((p - corner) / tolerance)
            .floor()
            .to_array()
            .map(|x| x as i64)
    };
    // Looked up only, never iterated: no hash order reaches the result.
    let mut leaders_in: HashMap<[i64; 3], Vec<VertexId>> = HashMap::new();
    let mut leader: Vec<VertexId> = VertexId::all(vertices.len()).collect();
    for v in VertexId::all(vertices.len()).filter(|&v| eligible[v]) {
        let p = vertices[v];
        let home = cell(p);
        let nearest = neighbour_cells(home)
            .filter_map(|c| leaders_in.get(&c))
            .flatten()
            .map(|&l| (vertices[l].distance(p), l))
            .filter(|(d, _)| *d <= tolerance)
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        match nearest {
            Some((_, l)) => leader[v] = l,
            None => leaders_in.entry(home).or_default().push(v),
        }
    }
    leader
}

fn neighbour_cells([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27i64).map(move |k| {
        [
            x.saturating_add(k % 3 - 1),
            y.saturating_add(k / 3 % 3 - 1),
            z.saturating_add(k / 9 - 1),
        ]
    })
}

/// Drops faces that repeat an index; gives how many.
pub fn drop_collapsed(mesh: &mut TriMesh) -> usize {
    let before = mesh.faces.len();
    mesh.faces.retain(|[a, b, c]| a != b && b != c && c != a);
    before - mesh.faces.len()
}

/// Drops vertices that no face uses; gives how many.
pub fn drop_unreferenced(mesh: &mut TriMesh) -> usize {
    let kept = keep_referenced(mesh);
    kept.iter().filter(|v| v.is_none()).count()
}

/// Drops vertices that no face uses; gives the new index of each old vertex that stays.
pub fn keep_referenced(mesh: &mut TriMesh) -> Vec<Option<VertexId>> {
    let mut used = vec![false; mesh.vertices.len()];
    for v in mesh.faces.iter().flatten() {
        used[*v] = true;
    }
    keep_vertices(mesh, &used)
}

/// Drops the vertices not marked true; gives the new index of each old vertex that stays.
///
/// # Panics
/// If a face uses a vertex that is to go.
pub fn keep_vertices(mesh: &mut TriMesh, kept: &[bool]) -> Vec<Option<VertexId>> {
    let mut next = 0;
    let number = |kept: &bool| {
        next += u32::from(*kept);
        kept.then(|| VertexId(next - 1))
    };
    let new_index: Vec<Option<VertexId>> = kept.iter().map(number).collect();
    let mut keep = kept.iter();
    mesh.vertices.retain(|_| keep.next() == Some(&true));
    for face in &mut mesh.faces {
        *face = face.map(|v| new_index[v].expect("every corner is kept"));
    }
    new_index
}

/// Drops every face that has the same three vertices as an earlier one, whichever way round; gives how many.
pub fn drop_duplicates(mesh: &mut TriMesh) -> usize {
    let groups = duplicate_groups(mesh);
    let mut keep = vec![true; mesh.faces.len()];
    for group in &groups {
        for &face in &group[1..] {
            keep[face] = false;
        }
    }
    retain_faces(mesh, &keep)
}

/// Keeps the faces marked true; gives how many went.
pub fn retain_faces(mesh: &mut TriMesh, keep: &[bool]) -> usize {
    let before = mesh.faces.len();
    let mut marks = keep.iter();
    mesh.faces.retain(|_| marks.next() == Some(&true));
    before - mesh.faces.len()
}

/// Sets of two or more faces with the same three vertices, faces rising.
pub fn duplicate_groups(mesh: &TriMesh) -> Vec<Vec<FaceId>> {
    let keyed: Vec<([VertexId; 3], FaceId)> = FaceId::all(mesh.faces.len())
        .map(|f| {
            let mut key = mesh.faces[f];
            key.sort_unstable();
            (key, f)
        })
        .collect();
    sorted_by_vertex(keyed, |(key, _)| key[0])
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|same| same.len() > 1)
        .map(|same| same.iter().map(|s| s.1).collect())
        .collect()
}

/// What rounding to the coordinates of printable files did to a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapped {
    pub mesh: TriMesh,
    /// Faces that lost an edge to the rounding and were dropped: their neighbours now share that edge.
    pub collapsed: usize,
    /// Faces dropped in pairs because both sides of a fold became the same triangle.
    pub folded: usize,
}

/// Rounds coordinates to f32 (kept as f64), joins vertices that become equal and drops the faces that vanish with
/// them. A closed mesh stays closed in the sense that each edge has as many forward as backward faces.
pub fn snap_to_f32(mesh: &TriMesh) -> Snapped {
    let mut mesh = weld(&rounded_to_f32(mesh), 0.0).mesh;
    let collapsed = drop_collapsed(&mut mesh);
    let folded = cancel_folds(&mut mesh);
    drop_unreferenced(&mut mesh);
    Snapped {
        mesh,
        collapsed,
        folded,
    }
}

pub(crate) fn rounded_to_f32(mesh: &TriMesh) -> TriMesh {
    let vertices = mesh
        .vertices
        .iter()
        .map(|v| v.as_vec3().as_dvec3())
        .collect();
    TriMesh {
        vertices,
        faces: mesh.faces.clone(),
    }
}

/// Drops pairs of faces with the same vertices and opposite winding; gives the number of faces dropped.
pub fn cancel_folds(mesh: &mut TriMesh) -> usize {
    let mut keep = vec![true; mesh.faces.len()];
    for group in duplicate_groups(mesh) {
        let (even, odd): (Vec<FaceId>, Vec<FaceId>) =
            group.iter().partition(|f| is_even(mesh.faces[**f]));
        for (a, b) in even.into_iter().zip(odd) {
            keep[a] = false;
            keep[b] = false;
        }
    }
    retain_faces(mesh, &keep)
}

/// Whether the indices are a rotation of their rising order.
fn is_even([a, b, c]: [VertexId; 3]) -> bool {
    let falls = [a > b, b > c, c > a];
    falls.iter().filter(|f| **f).count() == 1
}
