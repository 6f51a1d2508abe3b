//! The last step to a solid: a closed surface with f32 coordinates in which nothing cuts, touches or overlaps anything.
//!
//! Booleans are right in f64, but leave slivers and films thinner than an f32 step; rounded, some of them cut their neighbours. Takes
//! any mesh with as many forward as backward sides at every edge, however it crosses itself; gives the boundary of all points that it
//! goes round at least once:
//!
//! 1. flat parts become Delaunay ([`make_delaunay`]), coordinates are rounded to f32, slivers dissolve;
//! 2. while faces are in each other's way, corners and edges nearer than [`NEAR_MM`] become one; where none are, edges that cross or go
//!    through a face get a corner there ([`glue`]): iterated snap rounding, as of triangle soups in Lazard and Valque 2025. Flat parts
//!    of what is new become Delaunay, so that sheets with the same corners come to have the same faces;
//! 3. winding numbers tell what is inside ([`enclosed`]);
//! 4. surfaces that only touch are drawn apart ([`part_touching`]), and 2 to 4 begin again if there were any.
//!
//! Every bend of step 2 is final (see [`bends`]), so steps without new corners come to an end. New ones are made only where no
//! corner of either face is near; nothing else bounds their number, so [`ROUNDS`] does, and nothing bounds how far many small moves add
//! up, so [`MOST_MOVED_MM`] does: then there is an error, never a wrong solid. Of 85,000 random heaps of boxes that almost share planes
//! (turned by a millionth, or not at all) three ended so.

mod bends;
mod complex;
mod glue;
mod regions;
mod touching;

use super::boxes::{Box3, BoxTree};
use super::delaunay::make_delaunay;
use super::intersect::{meet, self_intersections};
use super::shells::ClosedSurface;
use super::topology::sides;
use super::tri_mesh::TriMesh;
use super::weld::snap_to_f32;
use crate::index::{FaceId, VertexId};
use bends::replaced;
use complex::Complex;
use glam::DVec3;
use glue::{flatten, glue_corner, glue_crossing};
use rayon::prelude::*;
use regions::enclosed;
use std::collections::VecDeque;
use touching::{part_touching, touches};

pub use complex::NEAR_MM;

/// Faces lower than this are dissolved, millimetres: two f32 steps at 100 mm.
const SLIVER_MM: f64 = 2e-5;
/// Rounds of gluing before it is given up. Solids of forests need none to four; a dense grid of thin pillars ten.
const ROUNDS: usize = 100;
/// Times that touching surfaces are drawn apart before it is given up. Solids of forests need one or two.
const TURNS: usize = 12;

/// What moves a point by more than this is refused, millimetres: a quarter of a printed line, the least that might be seen. Solids of
/// forests need 1e-5 to 1e-3, dense grids of thin pillars 0.008.
pub const MOST_MOVED_MM: f64 = 0.1;

/// What it took to leave no intersections.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resolving {
    /// Pairs of faces that were in each other's way after rounding.
    pub pairs: usize,
    /// Rounds of gluing.
    pub rounds: usize,
    /// No point of the surface was moved by more, millimetres; rounding to f32 not counted.
    pub moved_mm: f64,
}

impl Resolving {
    /// Adds that of another surface: pairs are counted, rounds and moves are the most.
    pub fn add(&mut self, other: &Self) {
        self.pairs += other.pairs;
        self.rounds = self.rounds.max(other.rounds);
        self.moved_mm = self.moved_mm.max(other.moved_mm);
    }
}

/// A surface without intersections, and what it took.
#[derive(Clone, Debug)]
pub struct Resolved {
    pub(super) surface: ClosedSurface,
    pub took: Resolving,
}

impl Resolved {
    pub fn mesh(&self) -> &TriMesh {
        &self.surface.mesh
    }

    /// The mesh without hollows that nobody can reach and parts that lie in others.
    pub fn without_cavities(self) -> TriMesh {
        self.surface.without_cavities().mesh
    }
}

/// What stayed in each other's way.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "surfaces cross or touch at {place:.3} mm and cannot be parted within {MOST_MOVED_MM} mm ({pairs} pairs of faces cross)"
)]
pub struct Tangled {
    pub pairs: usize,
    /// Millimetres.
    pub place: DVec3,
}

/// See the module.
///
/// # Errors
/// If faces stay in each other's way after [`ROUNDS`] rounds, surfaces touch after [`TURNS`] turns, or a point would move by more than
/// [`MOST_MOVED_MM`].
pub fn resolved(mesh: &TriMesh) -> Result<Resolved, Tangled> {
    let mut mesh = mesh.clone();
    make_delaunay(&mut mesh);
    let mut complex = Complex::new(snap_to_f32(&mesh).mesh);
    dissolve(&mut complex);
    straighten(&mut complex, 0);
    let mut took = Resolving::default();
    mesh = finished(complex, &mut took)?;
    let mut pairs = self_intersections(&mesh, usize::MAX);
    took.pairs = pairs.len();
    let mut place = DVec3::ZERO;
    for turn in 0..TURNS {
        // In most solids nothing is in anything's way from the first.
        if turn > 0 || !pairs.is_empty() {
            let mut complex = Complex::new(mesh);
            took.rounds += untangle(&mut complex, pairs)?;
            mesh = finished(complex, &mut took)?;
        }
        let surface = enclosed(mesh);
        if !touches(&surface) {
            return Ok(Resolved { surface, took });
        }
        mesh = surface.mesh;
        let changed = part_touching(&mut mesh);
        place = changed.first().map_or(place, |f| mesh.corners(*f)[0]);
        pairs = pairs_with(&mesh, &changed);
    }
    Err(Tangled {
        pairs: pairs.len(),
        place,
    })
}

/// What a complex has become, unless that moved a point too far.
fn finished(complex: Complex, took: &mut Resolving) -> Result<TriMesh, Tangled> {
    took.moved_mm = took.moved_mm.max(complex.moved);
    if complex.moved > MOST_MOVED_MM {
        return Err(Tangled {
            pairs: took.pairs,
            place: complex.moved_at,
        });
    }
    Ok(complex.into_mesh())
}

/// Pairs in each other's way of which one is among `faces`.
fn pairs_with(mesh: &TriMesh, faces: &[FaceId]) -> Vec<[FaceId; 2]> {
    let tree = BoxTree::of_faces(mesh);
    let mut pairs = Vec::new();
    for f in faces {
        tree.overlapping(&Box3::of_face(mesh, *f), |b| {
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
        let is_higher = |out: &VertexId| complex.height(replaced(face, *out, apex)) > height;
        g == f || face.contains(&apex) || side.iter().all(is_higher)
    })
}

/// Glues until nothing is in anything's way; gives the number of rounds.
fn untangle(complex: &mut Complex, mut pairs: Vec<[FaceId; 2]>) -> Result<usize, Tangled> {
    let first = complex.mesh.faces.len();
    let tree = BoxTree::of_faces(&complex.mesh);
    straighten(complex, 0);
    pairs.extend(new_pairs(complex, &tree, first, first));
    let mut round = 0;
    while let Some([f, _]) = pairs.first() {
        round += 1;
        if round == ROUNDS {
            return Err(Tangled {
                pairs: pairs.len(),
                place: complex.mesh.corners(*f)[0],
            });
        }
        let before = complex.mesh.faces.len();
        // New corners bring about new crossings: they come last.
        let had_corners = glue_all(complex, &pairs, glue_corner);
        if !had_corners {
            glue_all(complex, &pairs, glue_crossing);
        }
        straighten(complex, before);
        make_flat_parts_delaunay(complex, before);
        pairs.retain(|pair| are_alive(complex, *pair));
        pairs.extend(new_pairs(complex, &tree, first, before));
        pairs.sort_unstable();
    }
    Ok(round)
}

/// Whether both are there still: then they are in each other's way as they were, for no change moves a corner.
fn are_alive(complex: &Complex, pair: [FaceId; 2]) -> bool {
    pair.iter().all(|f| complex.is_alive(*f))
}

/// Glues what is still in each other's way; tells whether that changed anything.
fn glue_all(
    complex: &mut Complex,
    pairs: &[[FaceId; 2]],
    glue: fn(&mut Complex, [FaceId; 2]) -> bool,
) -> bool {
    let mut changed = false;
    for pair in pairs {
        changed |= are_alive(complex, *pair) && glue(complex, *pair);
    }
    changed
}

/// Flips the edges of faces from number `since` on where that makes better faces.
fn make_flat_parts_delaunay(complex: &mut Complex, since: usize) {
    for_each_new(complex, since, |complex, f| {
        // A flip takes `f` away; what comes in its place has its turn later.
        let all = sides(complex.mesh.faces[f]);
        all.into_iter().any(|side| complex.flip_if_better(side));
    });
}

/// Takes away new faces without area, which meet nothing and so would stay: those from number `since` on.
fn straighten(complex: &mut Complex, since: usize) {
    for_each_new(complex, since, |complex, f| {
        if complex.is_flat(f) {
            flatten(complex, f);
        }
    });
}

/// Visits faces that are there when their turn comes, from number `since` on, with all that come meanwhile.
fn for_each_new(complex: &mut Complex, since: usize, visit: impl Fn(&mut Complex, FaceId)) {
    let mut next = since;
    while next < complex.mesh.faces.len() {
        let f = FaceId::new(next);
        next += 1;
        if complex.is_alive(f) {
            visit(complex, f);
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
