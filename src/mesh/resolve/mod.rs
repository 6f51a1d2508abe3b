//! The last step to a solid: a closed surface with f32 coordinates in which nothing cuts, touches or overlaps anything.
//!
//! Booleans are right in f64, but leave slivers and films thinner than an f32 step; rounded, some of them cut their neighbours. Takes
//! any mesh with as many forward as backward sides at every edge, however it crosses itself; gives the boundary of all points that it
//! goes round at least once:
//!
//! 1. flat parts become Delaunay ([`make_delaunay`]), coordinates are rounded to f32, slivers dissolve;
//! 2. while faces are in each other's way, corners and edges nearer than [`NEAR_MM`] become one, and edges that go through a face get
//!    a corner there ([`glue`](glue::glue)): iterated snap rounding, as of triangle soups in Lazard and Valque 2025;
//! 3. winding numbers tell what is inside ([`enclosed`]);
//! 4. surfaces that only touch are drawn apart ([`part_touching`]), and 2 to 4 begin again if there were any.
//!
//! Every bend of step 2 is final (see [`Complex`]), so steps without new corners come to an end. New ones are made only where no
//! corner of either face is near; nothing bounds their number, so [`ROUNDS`] does: in that case there is an error, never a wrong solid.

mod complex;
mod glue;
mod regions;
mod touching;

use super::boxes::{Box3, BoxTree};
use super::delaunay::make_delaunay;
use super::intersect::{meet, self_intersections};
use super::tri_mesh::TriMesh;
use super::weld::snap_to_f32;
use crate::index::{FaceId, VertexId};
use complex::Complex;
use glam::DVec3;
use glue::{bend_edge, glue};
use rayon::prelude::*;
use regions::enclosed;
use std::collections::VecDeque;
use touching::part_touching;

pub use glue::NEAR_MM;

/// Faces lower than this are dissolved, millimetres: two f32 steps at 100 mm.
const SLIVER_MM: f64 = 2e-5;
/// Rounds of gluing before it is given up. Solids of forests need one to nine.
const ROUNDS: usize = 100;
/// Times that touching surfaces are drawn apart before it is given up. Solids of forests need one or two.
const TURNS: usize = 12;

/// A surface without intersections, and what it took.
#[derive(Clone, Debug, Default)]
pub struct Resolved {
    pub(super) mesh: TriMesh,
    /// Pairs of faces that were in each other's way after rounding.
    pub pairs: usize,
    /// Rounds of gluing.
    pub rounds: usize,
    /// No point of the surface was moved by more, millimetres; rounding to f32 not counted.
    pub moved_mm: f64,
}

impl Resolved {
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    pub fn into_mesh(self) -> TriMesh {
        self.mesh
    }
}

/// What stayed in each other's way.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{pairs} pairs of faces stay in each other's way, two of them at {place:.3}")]
pub struct Tangled {
    pub pairs: usize,
    pub place: DVec3,
}

/// See the module.
///
/// # Errors
/// If faces stay in each other's way after [`ROUNDS`] rounds.
pub fn resolved(mesh: &TriMesh) -> Result<Resolved, Tangled> {
    let mut mesh = mesh.clone();
    make_delaunay(&mut mesh);
    let mut complex = Complex::new(snap_to_f32(&mesh).mesh);
    dissolve(&mut complex);
    straighten(&mut complex, 0);
    let dissolved_mm = complex.moved;
    let mut mesh = complex.into_mesh();
    let mut pairs = self_intersections(&mesh, usize::MAX);
    let mut found = Resolved {
        pairs: pairs.len(),
        moved_mm: dissolved_mm,
        ..Resolved::default()
    };
    for _ in 0..TURNS {
        let mut complex = Complex::new(mesh);
        found.rounds += untangle(&mut complex, pairs)?;
        found.moved_mm = found.moved_mm.max(complex.moved);
        mesh = complex.into_mesh();
        mesh = enclosed(mesh);
        let changed = part_touching(&mut mesh);
        if changed.is_empty() {
            found.mesh = mesh;
            return Ok(found);
        }
        pairs = pairs_with(&mesh, &changed);
    }
    Err(Tangled {
        pairs: pairs.len(),
        place: mesh.vertices.first().copied().unwrap_or_default(),
    })
}

/// Pairs in each other's way of which one is among `faces` (rising).
fn pairs_with(mesh: &TriMesh, faces: &[FaceId]) -> Vec<[FaceId; 2]> {
    let boxes: Vec<Box3> = FaceId::all(mesh.faces.len())
        .map(|f| Box3::of_face(mesh, f))
        .collect();
    let tree = BoxTree::new(&boxes);
    let mut pairs = Vec::new();
    for f in faces {
        tree.overlapping(&boxes[f.at()], |b| {
            let pair = [(*f).min(FaceId(b.0)), (*f).max(FaceId(b.0))];
            if pair[0] != pair[1] && meet(mesh, pair) {
                pairs.push(pair);
            }
            true
        });
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Takes away faces that rounding may have turned over, where that leaves no lower one.
fn dissolve(complex: &mut Complex) {
    let mut queue: VecDeque<FaceId> = FaceId::all(complex.mesh.faces.len()).collect();
    while let Some(f) = queue.pop_front() {
        if !complex.is_alive(f) {
            continue;
        }
        let before = complex.mesh.faces.len();
        let face = complex.mesh.faces[f];
        let height = complex.height(face);
        let [u, v] = complex.shortest_side(face);
        let (side, apex) = complex.longest_side(face);
        if complex.place(u).distance(complex.place(v)) < SLIVER_MM {
            complex.merge(u, v);
        } else if height < SLIVER_MM && rises(complex, f, side, apex, height) {
            complex.flip_edge(side, apex);
        }
        queue.extend((before..complex.mesh.faces.len()).map(FaceId::new));
    }
}

/// Whether all faces at the long side of sliver `f` fall into higher ones when that goes through the sliver's apex.
fn rises(complex: &Complex, f: FaceId, side: [VertexId; 2], apex: VertexId, height: f64) -> bool {
    complex.faces_at(side).into_iter().all(|g| {
        let face = complex.mesh.faces[g];
        let with_apex = |out: VertexId| face.map(|v| if v == out { apex } else { v });
        g == f
            || face.contains(&apex)
            || side
                .iter()
                .all(|out| complex.height(with_apex(*out)) > height)
    })
}

/// Glues until nothing is in anything's way; gives the number of rounds.
fn untangle(complex: &mut Complex, mut pairs: Vec<[FaceId; 2]>) -> Result<usize, Tangled> {
    let first = complex.mesh.faces.len();
    let boxes: Vec<Box3> = FaceId::all(first)
        .map(|f| Box3::of_face(&complex.mesh, f))
        .collect();
    let tree = BoxTree::new(&boxes);
    straighten(complex, 0);
    pairs.extend(new_pairs(complex, &tree, first, first));
    for round in 0..ROUNDS {
        let Some(&[f, _]) = pairs.first() else {
            return Ok(round);
        };
        if round + 1 == ROUNDS {
            return Err(Tangled {
                pairs: pairs.len(),
                place: complex.mesh.corners(f)[0],
            });
        }
        let before = complex.mesh.faces.len();
        for pair in pairs {
            if pair.iter().all(|f| complex.is_alive(*f)) && meet(&complex.mesh, pair) {
                glue(complex, pair);
            }
        }
        straighten(complex, before);
        pairs = new_pairs(complex, &tree, first, before);
    }
    unreachable!("the last round ends it")
}

/// Takes away new faces without area, which meet nothing and so would stay: those from number `since` on.
fn straighten(complex: &mut Complex, since: usize) {
    let mut next = since;
    while next < complex.mesh.faces.len() {
        let f = FaceId::new(next);
        next += 1;
        if complex.is_alive(f) && complex.is_flat(f) {
            let (side, apex) = complex.longest_side(complex.mesh.faces[f]);
            bend_edge(complex, side, apex);
        }
    }
}

/// Pairs in each other's way of which one is a face from number `since` on. `tree` has the faces before number `first`.
fn new_pairs(complex: &Complex, tree: &BoxTree, first: usize, since: usize) -> Vec<[FaceId; 2]> {
    let mesh = &complex.mesh;
    let added = (first..mesh.faces.len()).map(FaceId::new);
    let added: Vec<FaceId> = added.filter(|f| complex.is_alive(*f)).collect();
    let boxes: Vec<Box3> = added.iter().map(|f| Box3::of_face(mesh, *f)).collect();
    let added_tree = BoxTree::new(&boxes);
    let newest = &added[added.partition_point(|f| f.at() < since)..];
    let of_one = |f: &FaceId| {
        let own = Box3::of_face(mesh, *f);
        let mut pairs = Vec::new();
        let mut look = |other: FaceId| {
            // Of two new faces the later one looks.
            if other < *f && complex.is_alive(other) && meet(mesh, [other, *f]) {
                pairs.push([other, *f]);
            }
            true
        };
        tree.overlapping(&own, |b| look(FaceId(b.0)));
        added_tree.overlapping(&own, |b| look(added[b.at()]));
        pairs
    };
    let found: Vec<Vec<[FaceId; 2]>> = newest.par_iter().map(of_one).collect();
    let mut pairs: Vec<[FaceId; 2]> = found.into_iter().flatten().collect();
    pairs.sort_unstable();
    pairs
}
