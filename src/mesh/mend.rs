//! Small repairs that make a nearly sound surface sound in f32.
//!
//! Boolean operations are right in f64 but leave slivers thinner than an f32 step; rounded, some of them cut their
//! neighbours. Takes a closed mesh; gives it rounded to f32 with slivers dissolved: needles lose their short edge, caps give
//! their area to the face across their long edge; surfaces that only touch are drawn apart. Promises not to open it and to move
//! nothing by more than the last of [`HEIGHTS_MM`] a step; does *not* promise success: `Solid::new` decides.

use crate::index::{FaceId, VertexId};
use crate::mesh::detach::detach;
use crate::mesh::intersect::self_intersections;
use crate::mesh::separate::{MARGINS_MM, separate};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::weld::{cancel_folds, drop_collapsed, drop_unreferenced, snap_to_f32};
use glam::DVec3;
use std::collections::VecDeque;

/// Faces lower than this are dissolved, in turn until nothing is in trouble: from two f32 steps at 100 mm up to a fiftieth of
/// what any printer resolves. Larger heights mend more and change more.
const HEIGHTS_MM: [f64; 7] = [2e-5, 6e-5, 2e-4, 5e-4, 1e-3, 2e-3, 4e-3];
/// A side up to this many heights long is collapsed where flipping is not possible.
const LAST_RESORT: f64 = 30.0;
/// More pairs than this are no slivers but a real overlap, which is not for mending.
const MAX_PAIRS: usize = 20_000;

/// A mended mesh.
#[derive(Clone, Debug)]
pub struct Mended {
    pub mesh: TriMesh,
    /// The first of the heights, counted from 0, that left nothing in trouble; beyond them the distances at which faces were drawn
    /// apart. The last where none was enough.
    pub rung: usize,
}

impl Mended {
    /// The heights, and the distances of drawing apart.
    pub const RUNGS: usize = HEIGHTS_MM.len() + MARGINS_MM.len();
}

/// Rounds to f32 and mends what that broke.
pub fn mend(mesh: &TriMesh) -> Mended {
    let mut mesh = snap_to_f32(mesh).mesh;
    let mut best: Option<(usize, TriMesh)> = None;
    for (rung, height) in HEIGHTS_MM.into_iter().enumerate() {
        let everywhere = rung == 0;
        let trouble = if everywhere {
            FaceId::all(mesh.faces.len()).collect()
        } else {
            trouble(&mesh)
        };
        if trouble.is_empty() {
            // The height before this one was enough.
            return Mended {
                mesh,
                rung: rung.saturating_sub(1),
            };
        }
        if !everywhere && best.as_ref().is_none_or(|b| trouble.len() < b.0) {
            best = Some((trouble.len(), mesh.clone()));
        }
        dissolve(&mut mesh, trouble, height);
    }
    let mesh = match best {
        Some((count, better)) if count < trouble(&mesh).len() => better,
        _ => mesh,
    };
    drawn_apart(mesh)
}

/// What dissolving left is drawn apart, if that helps everywhere.
fn drawn_apart(mesh: TriMesh) -> Mended {
    let pairs = self_intersections(&mesh, MAX_PAIRS);
    if pairs.is_empty() {
        let rung = HEIGHTS_MM.len() - 1;
        return Mended { mesh, rung };
    }
    let mut apart = mesh.clone();
    match separate(&mut apart, &pairs) {
        Some(distance) => Mended {
            mesh: apart,
            rung: HEIGHTS_MM.len() + distance,
        },
        None => Mended {
            mesh,
            rung: Mended::RUNGS - 1,
        },
    }
}

/// Faces that cut others, their neighbourhoods and faces without area, rising.
fn trouble(mesh: &TriMesh) -> Vec<FaceId> {
    let flat = FaceId::all(mesh.faces.len()).filter(|f| mesh.area_vector(*f) == DVec3::ZERO);
    let mut faces: Vec<FaceId> = self_intersections(mesh, MAX_PAIRS)
        .into_iter()
        .flatten()
        .chain(flat)
        .collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// Dissolves slivers lower than `height` among `faces` and their neighbours.
fn dissolve(mesh: &mut TriMesh, faces: Vec<FaceId>, height: f64) {
    let mut surgery = Surgery::new(mesh, faces, height);
    surgery.run();
    drop_collapsed(mesh);
    cancel_folds(mesh);
    detach(mesh);
    drop_unreferenced(mesh);
}

/// Local changes on a closed mesh; dead faces become `[v, v, v]`.
struct Surgery<'a> {
    mesh: &'a mut TriMesh,
    around: Vec<Vec<FaceId>>,
    queue: VecDeque<FaceId>,
    height: f64,
}

impl<'a> Surgery<'a> {
    /// Starts with `faces` and all faces that share a vertex with them.
    fn new(mesh: &'a mut TriMesh, faces: Vec<FaceId>, height: f64) -> Self {
        let mut around = vec![Vec::new(); mesh.vertices.len()];
        for (f, face) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
            face.iter().for_each(|v| around[*v].push(f));
        }
        let mut start: Vec<FaceId> = if faces.len() == mesh.faces.len() {
            faces
        } else {
            faces
                .iter()
                .flat_map(|f| mesh.faces[*f])
                .flat_map(|v| around[v].iter().copied())
                .collect()
        };
        start.sort_unstable();
        start.dedup();
        Self {
            mesh,
            around,
            queue: start.into(),
            height,
        }
    }

    fn run(&mut self) {
        // Collapses end by themselves and flips always raise the lower of two faces; the budget bounds the rest.
        let mut budget = 10 * self.queue.len() + 1000;
        while let Some(f) = self.queue.pop_front() {
            let [a, b, _] = self.mesh.faces[f];
            if a == b || self.height_of(self.mesh.faces[f]) >= self.height {
                continue;
            }
            if budget == 0 {
                return;
            }
            budget -= 1;
            let _ =
                self.collapse_sides(f, 2.0) || self.flip(f) || self.collapse_sides(f, LAST_RESORT);
        }
    }

    fn at(&self, v: VertexId) -> DVec3 {
        self.mesh.vertices[v]
    }

    fn side(&self, face: [VertexId; 3], k: usize) -> f64 {
        self.at(face[k]).distance(self.at(face[(k + 1) % 3]))
    }

    fn area_vector(&self, [a, b, c]: [VertexId; 3]) -> DVec3 {
        (self.at(b) - self.at(a)).cross(self.at(c) - self.at(a))
    }

    fn height_of(&self, face: [VertexId; 3]) -> f64 {
        let longest = (0..3).map(|k| self.side(face, k)).fold(0.0, f64::max);
        if longest == 0.0 {
            0.0
        } else {
            self.area_vector(face).length() / longest
        }
    }

    /// Collapses the shortest side, up to `times` the height, that allows it.
    fn collapse_sides(&mut self, f: FaceId, times: f64) -> bool {
        let face = self.mesh.faces[f];
        let mut sides = [0, 1, 2];
        sides.sort_by(|a, b| self.side(face, *a).total_cmp(&self.side(face, *b)));
        for k in sides {
            if self.side(face, k) > times * self.height {
                return false;
            }
            let (a, b) = (face[k], face[(k + 1) % 3]);
            if self.collapse(a, b) || self.collapse(b, a) {
                return true;
            }
        }
        false
    }

    fn ring(&self, v: VertexId) -> Vec<VertexId> {
        let mut ring: Vec<VertexId> = self.around[v]
            .iter()
            .flat_map(|f| self.mesh.faces[*f])
            .filter(|x| *x != v)
            .collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    /// Moves `from` onto `to` if the surface stays a closed manifold and no face that is not a sliver turns over.
    fn collapse(&mut self, from: VertexId, to: VertexId) -> bool {
        let (ring, other) = (self.ring(from), self.ring(to));
        let common = ring
            .iter()
            .filter(|v| other.binary_search(v).is_ok())
            .count();
        let faces = self.around[from].clone();
        let (dying, staying): (Vec<FaceId>, Vec<FaceId>) = faces
            .iter()
            .partition(|f| self.mesh.faces[**f].contains(&to));
        if common != 2 || dying.len() != 2 {
            return false;
        }
        let moved = |face: [VertexId; 3]| face.map(|v| if v == from { to } else { v });
        let turns = |f: &FaceId| {
            let face = self.mesh.faces[*f];
            let (before, after) = (self.area_vector(face), self.area_vector(moved(face)));
            self.height_of(face) > self.height
                && before.dot(after) <= 0.5 * before.length() * after.length()
        };
        if staying.iter().any(turns) {
            return false;
        }
        for f in dying {
            let gone = self.mesh.faces[f];
            self.mesh.faces[f] = [to; 3];
            gone.iter()
                .for_each(|v| self.around[*v].retain(|x| *x != f));
        }
        for f in staying {
            self.mesh.faces[f] = moved(self.mesh.faces[f]);
            self.around[to].push(f);
            self.queue.push_back(f);
        }
        self.around[from].clear();
        true
    }

    /// Swaps the longest side of a cap for the other diagonal, if that raises the lower of the two faces and folds nothing.
    fn flip(&mut self, f: FaceId) -> bool {
        let face = self.mesh.faces[f];
        let k = (0..3)
            .max_by(|a, b| self.side(face, *a).total_cmp(&self.side(face, *b)))
            .unwrap_or(0);
        let (a, b, v) = (face[k], face[(k + 1) % 3], face[(k + 2) % 3]);
        let others: Vec<FaceId> = self.around[a]
            .iter()
            .copied()
            .filter(|x| *x != f && self.mesh.faces[*x].contains(&b))
            .collect();
        let [other] = others[..] else { return false };
        let across = self.mesh.faces[other];
        let Some(d) = across.into_iter().find(|x| *x != a && *x != b) else {
            return false;
        };
        if d == v || self.ring(v).binary_search(&d).is_ok() {
            return false;
        }
        let (first, second) = ([a, d, v], [d, b, v]);
        let lower = self.height_of(first).min(self.height_of(second));
        let normal = self.area_vector(across);
        let folds =
            |face| self.area_vector(face).dot(normal) < 0.0 && self.height_of(across) > self.height;
        if lower <= self.height_of(face).min(self.height_of(across))
            || folds(first)
            || folds(second)
        {
            return false;
        }
        self.mesh.faces[f] = first;
        self.mesh.faces[other] = second;
        self.around[b].retain(|x| *x != f);
        self.around[a].retain(|x| *x != other);
        self.around[d].push(f);
        self.around[v].push(other);
        self.queue.extend([f, other]);
        true
    }
}
