//! What a complex without intersections encloses: the boundary of all points with a winding number of at least 1.
//!
//! Around every edge the faces are sorted by exact turns; what lies between two neighbours is one region (Zhou, Grinspun, Zorin,
//! Jacobson 2016, "Mesh arrangements for solid geometry"). Winding numbers go from region to region through faces; one ray for
//! every connected part of the surface says where they begin.

use crate::index::{FaceId, indices};
use crate::mesh::boxes::BoxTree;
use crate::mesh::shells::{ClosedSurface, Shell, shells_of, winding_number};
use crate::mesh::topology::{DisjointSets, Edges, HalfEdge, face_components_of};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::turn3;
use crate::mesh::weld::{drop_unreferenced, duplicate_groups, retain_faces};
use glam::DVec3;

indices! {
    /// One side of a face: its front, outwards, or its back.
    SideId
}

impl SideId {
    const fn of(f: FaceId, is_front: bool) -> Self {
        Self(2 * f.0 + !is_front as u32)
    }
}

/// The boundary of what is enclosed at least once. Faces that cancel or lie inside are gone, some perhaps turned. What is that already
/// stays as it is.
pub(crate) fn enclosed(mesh: TriMesh) -> ClosedSurface {
    let edges = Edges::new(&mesh);
    if edges.iter().all(|sides| sides.len() == 2) {
        let shells = shells_of(&mesh, &edges);
        if shells.iter().all(Shell::is_sound) {
            return ClosedSurface {
                mesh,
                edges,
                shells,
            };
        }
    }
    ClosedSurface::new(boundary(mesh))
}

/// The boundary of what is enclosed at least once, whatever the mesh is.
fn boundary(mesh: TriMesh) -> TriMesh {
    let (mesh, times) = stacked(mesh);
    let edges = Edges::new(&mesh);
    let mut regions = DisjointSets::new(2 * mesh.faces.len());
    for sides in edges.iter() {
        let around = sorted_around(&mesh, sides);
        for (i, side) in around.iter().enumerate() {
            let next = &around[(i + 1) % around.len()];
            // Onwards a forward face shows its back, and a backward one its front.
            let on = SideId::of(side.face, !side.forward);
            let off = SideId::of(next.face, next.forward);
            regions.join(on.0, off.0);
        }
    }
    let winding = windings(&mesh, &times, &edges, &mut regions);
    let faces = FaceId::all(mesh.faces.len()).filter_map(|f| {
        let [a, b, c] = mesh.faces[f];
        let [front, back] = winding[f].map(|w| w >= 1);
        match (front, back) {
            (false, true) => Some([a, b, c]),
            (true, false) => Some([a, c, b]),
            _ => None,
        }
    });
    let mut mesh = TriMesh {
        faces: faces.collect(),
        vertices: mesh.vertices.clone(),
    };
    drop_unreferenced(&mut mesh);
    mesh
}

/// One face for all that have the same corners, and how many times it counts: those turned the other way count against it.
fn stacked(mut mesh: TriMesh) -> (TriMesh, Vec<i32>) {
    let mut times = vec![1; mesh.faces.len()];
    for group in duplicate_groups(&mesh) {
        let [a, b, c] = mesh.faces[group[0]];
        let along = [[a, b, c], [b, c, a], [c, a, b]];
        let turned = |f: &FaceId| {
            if along.contains(&mesh.faces[*f]) {
                1
            } else {
                -1
            }
        };
        times[group[0].at()] = group.iter().map(turned).sum();
        group[1..].iter().for_each(|f| times[f.at()] = 0);
    }
    let keep: Vec<bool> = times.iter().map(|t| *t != 0).collect();
    retain_faces(&mut mesh, &keep);
    times.retain(|t| *t != 0);
    (mesh, times)
}

/// The faces at an edge in the order in which one turns about it, from front to back of those that run forward.
pub(crate) fn sorted_around(mesh: &TriMesh, sides: &[HalfEdge]) -> Vec<HalfEdge> {
    let mut around = sides.to_vec();
    if around.len() <= 2 {
        return around;
    }
    let (low, high) = (mesh.vertices[sides[0].low], mesh.vertices[sides[0].high]);
    let apex = |h: &HalfEdge| mesh.vertices[h.end(2).vertex(mesh)];
    let turn = |from: &HalfEdge, to: &HalfEdge| turn3(low, high, apex(from), apex(to));
    let first = around[0];
    // The first, those less than half a turn on, the opposite one, those more than half a turn on.
    let part = |h: &HalfEdge| {
        let turned = turn(&first, h);
        if h.face == first.face {
            0
        } else if turned > 0.0 {
            1
        } else if turned == 0.0 {
            2
        } else {
            3
        }
    };
    around.sort_by(|x, y| {
        let onwards = || turn(y, x).total_cmp(&0.0).then(x.cmp(y));
        part(x).cmp(&part(y)).then_with(onwards)
    });
    around
}

/// How often every face's front and back are gone round.
fn windings(
    mesh: &TriMesh,
    times: &[i32],
    edges: &Edges,
    regions: &mut DisjointSets,
) -> Vec<[i32; 2]> {
    let region: Vec<[SideId; 2]> = FaceId::all(mesh.faces.len())
        .map(|f| [true, false].map(|front| SideId(regions.root(SideId::of(f, front).0))))
        .collect();
    let mut beyond: Vec<Vec<(SideId, i32)>> = vec![Vec::new(); 2 * mesh.faces.len()];
    for ([front, back], times) in region.iter().zip(times) {
        beyond[*front].push((*back, *times));
        beyond[*back].push((*front, -times));
    }
    let mut winding: Vec<Option<i32>> = vec![None; 2 * mesh.faces.len()];
    for (face, seed) in seeds(mesh, times, edges) {
        let start = region[face][0];
        winding[start] = Some(seed);
        let mut open = vec![(start, seed)];
        while let Some((at, here)) = open.pop() {
            for (next, step) in &beyond[at] {
                if winding[*next].is_none() {
                    winding[*next] = Some(here + step);
                    open.push((*next, here + step));
                }
            }
        }
    }
    let of = |region: SideId| winding[region].unwrap_or(0);
    region.into_iter().map(|sides| sides.map(of)).collect()
}

/// One face for each part that hangs together by edges, and how often its front is gone round.
fn seeds(mesh: &TriMesh, times: &[i32], edges: &Edges) -> Vec<(FaceId, i32)> {
    let component = face_components_of(edges, mesh.faces.len());
    // Of each part the face that a ray along x meets best.
    let mut best: Vec<(f64, FaceId)> = Vec::new();
    for (f, c) in FaceId::all(mesh.faces.len()).zip(&component) {
        let size = mesh.area_vector(f).x.abs();
        match best.get_mut(c.at()) {
            Some(slot) if size > slot.0 => *slot = (size, f),
            Some(_) => {}
            None => best.push((size, f)),
        }
    }
    let tree = BoxTree::of_faces(mesh);
    let seed = |(_, f): (f64, FaceId)| {
        let point = mesh.corners(f).iter().sum::<DVec3>() / 3.0;
        let beyond = winding_number(mesh, &tree, point, |g| if g == f { 0 } else { times[g] });
        // A ray from the front of a face that faces against it goes through that face too.
        let against = mesh.area_vector(f).x < 0.0;
        (f, beyond - if against { times[f] } else { 0 })
    };
    best.into_iter().map(seed).collect()
}
