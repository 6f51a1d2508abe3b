//! The closed surfaces a mesh consists of, and how they lie in one another.
//!
//! Takes a closed, consistently wound mesh without self-intersections; gives for each shell its volume and in how many
//! others it lies, exactly (ray parity by signs of determinants, no tolerances).

use crate::index::{ComponentId, FaceId};
use crate::mesh::boxes::{Box3, BoxTree};
use crate::mesh::topology::{Edges, face_components, face_components_of};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::{turn2, turn3};
use crate::mesh::weld::drop_unreferenced;
use glam::DVec3;
use rayon::prelude::*;

/// One closed surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    pub first_face: FaceId,
    /// Cubic millimetres, negative for one that faces inwards (a cavity, or a part turned inside out).
    pub volume: f64,
    /// How often the other shells go round it: 0 in the open, 1 inside of a part, 0 inside of a part's cavity.
    pub winding: i32,
}

impl Shell {
    /// Whether material lies behind it and none in front of it: an outer surface in the open, or a cavity in a part.
    pub fn is_sound(&self) -> bool {
        self.is_outer() || (self.volume < 0.0 && self.winding == 1)
    }

    fn is_outer(&self) -> bool {
        self.volume > 0.0 && self.winding == 0
    }
}

/// A closed surface with what was found out about it, so that nobody has to again.
#[derive(Clone, Debug)]
pub(crate) struct ClosedSurface {
    pub mesh: TriMesh,
    pub edges: Edges,
    pub shells: Vec<Shell>,
}

impl ClosedSurface {
    pub(crate) fn new(mesh: TriMesh) -> Self {
        let edges = Edges::new(&mesh);
        let shells = shells_of(&mesh, &edges);
        Self {
            mesh,
            edges,
            shells,
        }
    }

    /// As [`without_cavities`].
    pub(crate) fn without_cavities(self) -> Self {
        if self.shells.iter().all(Shell::is_outer) {
            return self;
        }
        Self::new(without_cavities(self.mesh))
    }
}

/// More shells than this are not looked at for their place (each costs a ray, and a row of them quadratically many
/// hits): those facing inwards are then taken for cavities.
const MAX_PLACED: usize = 20_000;

/// The shells by rising first face.
pub fn shells(mesh: &TriMesh) -> Vec<Shell> {
    shells_of(mesh, &Edges::new(mesh))
}

/// As [`shells`], for edges already at hand.
pub(crate) fn shells_of(mesh: &TriMesh, edges: &Edges) -> Vec<Shell> {
    let component = face_components_of(edges, mesh.faces.len());
    let mut shells = volumes(mesh, &component);
    place(mesh, &component, &mut shells);
    shells
}

/// The shells with their volumes.
fn volumes(mesh: &TriMesh, component: &[ComponentId]) -> Vec<Shell> {
    let mut shells: Vec<Shell> = Vec::new();
    for (face, &c) in FaceId::all(component.len()).zip(component) {
        if c.at() == shells.len() {
            shells.push(Shell {
                first_face: face,
                volume: 0.0,
                winding: 0,
            });
        }
        // Measured from the shell's own corner: a part far from the origin keeps its digits.
        let origin = mesh.corners(shells[c].first_face)[0];
        let [p, q, r] = mesh.corners(face).map(|v| v - origin);
        shells[c].volume += p.dot(q.cross(r)) / 6.0;
    }
    shells
}

/// Finds how the shells lie in one another.
fn place(mesh: &TriMesh, component: &[ComponentId], shells: &mut [Shell]) {
    if shells.len() > MAX_PLACED {
        for shell in shells {
            shell.winding = i32::from(shell.volume < 0.0);
        }
    } else if shells.len() > 1 {
        let tree = BoxTree::of_faces(mesh);
        shells.par_iter_mut().enumerate().for_each(|(own, shell)| {
            let point = mesh.corners(shell.first_face)[0];
            shell.winding = winding(mesh, &tree, point, |face| component[face].at() != own);
        });
    }
}

/// The mesh without shells that face inwards and shells inside of others: hollows nobody can see or empty are filled.
pub fn without_cavities(mesh: TriMesh) -> TriMesh {
    let component = face_components(&mesh);
    let hollow: Vec<bool> = volumes(&mesh, &component)
        .iter()
        .map(|s| s.volume < 0.0)
        .collect();
    let filled = without(mesh, &component, &hollow);
    let component = face_components(&filled);
    let buried = buried(&filled, &component);
    without(filled, &component, &buried)
}

/// Which shells lie inside of others with all their faces: one that touches another may seem to by a single point.
fn buried(mesh: &TriMesh, component: &[ComponentId]) -> Vec<bool> {
    let mut buried: Vec<bool> = shells(mesh).iter().map(|s| s.winding > 0).collect();
    if buried.contains(&true) {
        let tree = BoxTree::of_faces(mesh);
        for (face, own) in FaceId::all(component.len()).zip(component) {
            if buried[*own] {
                let middle = mesh.corners(face).iter().sum::<DVec3>() / 3.0;
                let around = winding(mesh, &tree, middle, |f| component[f] != *own);
                buried[*own] = around > 0;
            }
        }
    }
    buried
}

/// The mesh without the shells that are `unwanted`.
fn without(mut mesh: TriMesh, component: &[ComponentId], unwanted: &[bool]) -> TriMesh {
    if !unwanted.contains(&true) {
        return mesh;
    }
    let mut component = component.iter();
    let kept = |c: Option<&ComponentId>| c.is_some_and(|c| !unwanted[*c]);
    mesh.faces.retain(|_| kept(component.next()));
    drop_unreferenced(&mut mesh);
    mesh
}

/// How often the faces that `count` selects go round the point.
fn winding(mesh: &TriMesh, tree: &BoxTree, point: DVec3, count: impl Fn(FaceId) -> bool) -> i32 {
    winding_number(mesh, tree, point, |f| i32::from(count(f)))
}

/// How often the faces go round the point, each as often as `times` says: the exits less the entries of its ray along +x.
pub fn winding_number(
    mesh: &TriMesh,
    tree: &BoxTree,
    point: DVec3,
    times: impl Fn(FaceId) -> i32,
) -> i32 {
    let ray = Box3 {
        lo: point,
        hi: DVec3::new(f64::INFINITY, point.y, point.z),
    };
    let mut total = 0;
    tree.overlapping(&ray, |face| {
        let face = FaceId(face.0);
        let times = times(face);
        if times != 0 {
            total += times * crossing(&mesh.corners(face), point);
        }
        true
    });
    total
}

/// +1 if the ray along +x leaves through the face's back, -1 if it enters through its front, 0 if it misses.
fn crossing(corners: &[DVec3; 3], point: DVec3) -> i32 {
    // Half-open rules on z give an edge to one of its two faces only, so no ray slips through or counts twice.
    let turns: i32 = (0..3)
        .map(|k| {
            let (u, v) = (corners[k], corners[(k + 1) % 3]);
            let side = turn2(0, u, v, point);
            let (rises, falls) = (
                u.z <= point.z && point.z < v.z,
                v.z <= point.z && point.z < u.z,
            );
            i32::from(rises && side > 0.0) - i32::from(falls && side < 0.0)
        })
        .sum();
    let behind = turn3(corners[0], corners[1], corners[2], point);
    match turns {
        1 if behind > 0.0 => 1,
        -1 if behind < 0.0 => -1,
        _ => 0,
    }
}
