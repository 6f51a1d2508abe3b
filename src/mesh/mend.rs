//! Small repairs that make a nearly sound surface sound in f32.
//!
//! Boolean operations are right in f64 but leave slivers thinner than an f32 step; rounded, some of them cut their
//! neighbours. Takes a closed mesh; gives it rounded to f32 with the faces in trouble collapsed along short edges or
//! flipped. Promises not to open it and to move nothing by more than [`REACH_MM`] a step; does *not* promise success:
//! `Solid::new` decides.

use crate::mesh::TriMesh;
use crate::mesh::intersect::self_intersections;
use crate::mesh::weld::{drop_collapsed, drop_unreferenced, snap_to_f32};
use glam::DVec3;

/// The longest edge that may be collapsed: a twentieth of a printed line, so that no repair is ever seen.
const REACH_MM: f64 = 0.02;
/// Repairs that need more rounds than this do not converge.
const MAX_ROUNDS: usize = 12;
/// More pairs than this are no slivers but a real overlap, which is not for mending.
const MAX_PAIRS: usize = 4000;

/// Rounds to f32 and mends what that broke.
pub fn mend(mesh: &TriMesh) -> TriMesh {
    let mut mesh = snap_to_f32(mesh).mesh;
    let mut best: Option<(usize, TriMesh)> = None;
    for round in 0..MAX_ROUNDS {
        let pairs = self_intersections(&mesh, MAX_PAIRS);
        let flat: Vec<u32> = flat_faces(&mesh).collect();
        let trouble = pairs.len() + flat.len();
        if best.as_ref().is_none_or(|b| trouble < b.0) {
            best = Some((trouble, mesh.clone()));
        }
        if trouble == 0 || pairs.len() >= MAX_PAIRS {
            break;
        }
        let reach = REACH_MM * (0.25 + 0.25 * round.min(3) as f64);
        if !treat_all(&mut mesh, &pairs, flat, reach) {
            break;
        }
    }
    best.map_or(mesh, |b| b.1)
}

/// Treats the thinner face of every pair (the cause; the stout one is only in its way) and the flat ones, thinnest first.
fn treat_all(mesh: &mut TriMesh, pairs: &[[u32; 2]], flat: Vec<u32>, reach: f64) -> bool {
    let mut surgery = Surgery::new(mesh);
    let thinner = |p: &[u32; 2]| if surgery.height(p[0]) <= surgery.height(p[1]) { p[0] } else { p[1] };
    let mut faces: Vec<u32> = pairs.iter().map(thinner).chain(flat).collect();
    faces.sort_unstable();
    faces.dedup();
    faces.sort_by(|a, b| surgery.height(*a).total_cmp(&surgery.height(*b)));
    let changed = faces.iter().filter(|f| surgery.treat(**f, reach)).count();
    drop_collapsed(mesh);
    drop_unreferenced(mesh);
    changed > 0
}

/// Faces whose corners lie on one line.
fn flat_faces(mesh: &TriMesh) -> impl Iterator<Item = u32> {
    (0..mesh.faces.len() as u32).filter(|f| mesh.area_vector(*f as usize) == DVec3::ZERO)
}

/// Local changes on a closed mesh; dead faces become `[v, v, v]`.
struct Surgery<'a> {
    mesh: &'a mut TriMesh,
    around: Vec<Vec<u32>>,
    /// Faces changed in this round are left alone until the next look.
    touched: Vec<bool>,
}

impl<'a> Surgery<'a> {
    fn new(mesh: &'a mut TriMesh) -> Self {
        let mut around = vec![Vec::new(); mesh.vertices.len()];
        for (f, face) in mesh.faces.iter().enumerate() {
            face.iter().for_each(|v| around[*v as usize].push(f as u32));
        }
        let touched = vec![false; mesh.faces.len()];
        Self { mesh, around, touched }
    }

    fn edge(&self, f: u32, k: usize) -> f64 {
        let corners = self.mesh.corners(f as usize);
        corners[k].distance(corners[(k + 1) % 3])
    }

    fn longest(&self, f: u32) -> usize {
        (0..3).max_by(|a, b| self.edge(f, *a).total_cmp(&self.edge(f, *b))).unwrap_or(0)
    }

    fn height(&self, f: u32) -> f64 {
        self.mesh.area_vector(f as usize).length() / self.edge(f, self.longest(f)).max(f64::MIN_POSITIVE)
    }

    /// Collapses the shortest edge that allows it, or flips the longest.
    fn treat(&mut self, f: u32, reach: f64) -> bool {
        if self.touched[f as usize] {
            return false;
        }
        let mut sides = [0, 1, 2];
        sides.sort_by(|a, b| self.edge(f, *a).total_cmp(&self.edge(f, *b)));
        for k in sides {
            if self.edge(f, k) > reach {
                break;
            }
            let (a, b) = (self.mesh.faces[f as usize][k], self.mesh.faces[f as usize][(k + 1) % 3]);
            if self.collapse(a, b) || self.collapse(b, a) {
                return true;
            }
        }
        self.height(f) < reach && self.flip(f, self.longest(f))
    }

    fn ring(&self, v: u32) -> Vec<u32> {
        let mut ring: Vec<u32> = self.around[v as usize].iter().flat_map(|f| self.mesh.faces[*f as usize]).filter(|x| *x != v).collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    /// Moves `from` onto `to` if the surface stays a closed manifold and no sizeable face turns over.
    fn collapse(&mut self, from: u32, to: u32) -> bool {
        let (ring, other) = (self.ring(from), self.ring(to));
        let common = ring.iter().filter(|v| other.binary_search(v).is_ok()).count();
        let shared = self.around[from as usize].iter().filter(|f| self.mesh.faces[**f as usize].contains(&to)).count();
        if common != 2 || shared != 2 {
            return false;
        }
        let faces = self.around[from as usize].clone();
        let stay: Vec<u32> = faces.iter().copied().filter(|f| !self.mesh.faces[*f as usize].contains(&to)).collect();
        let target = self.mesh.vertices[to as usize];
        let turns = |f: &u32| {
            let before = self.mesh.area_vector(*f as usize);
            let [a, b, c] = self.mesh.faces[*f as usize].map(|v| if v == from { target } else { self.mesh.vertices[v as usize] });
            let after = (b - a).cross(c - a);
            after == DVec3::ZERO || (self.height(*f) > 1e-3 && before.dot(after) < 0.0)
        };
        if faces.iter().any(|f| self.touched[*f as usize]) || stay.iter().any(turns) {
            return false;
        }
        for f in &faces {
            self.touched[*f as usize] = true;
            let face = &mut self.mesh.faces[*f as usize];
            if face.contains(&to) {
                let gone = *face;
                *face = [to; 3];
                gone.iter().for_each(|v| self.around[*v as usize].retain(|x| x != f));
            } else {
                face.iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
                self.around[to as usize].push(*f);
            }
        }
        self.around[from as usize].clear();
        true
    }

    /// Swaps the diagonal of the two faces at side `k`, if the new edge does not exist yet.
    fn flip(&mut self, f: u32, k: usize) -> bool {
        let face = self.mesh.faces[f as usize];
        let (a, b, v) = (face[k], face[(k + 1) % 3], face[(k + 2) % 3]);
        let others: Vec<u32> =
            self.around[a as usize].iter().copied().filter(|x| *x != f && self.mesh.faces[*x as usize].contains(&b)).collect();
        let [other] = others[..] else { return false };
        let Some(d) = self.mesh.faces[other as usize].into_iter().find(|x| *x != a && *x != b) else { return false };
        if d == v || self.touched[other as usize] || self.ring(v).binary_search(&d).is_ok() {
            return false;
        }
        self.mesh.faces[f as usize] = [a, d, v];
        self.mesh.faces[other as usize] = [d, b, v];
        self.around[b as usize].retain(|x| *x != f);
        self.around[a as usize].retain(|x| *x != other);
        self.around[d as usize].push(f);
        self.around[v as usize].push(other);
        self.touched[f as usize] = true;
        self.touched[other as usize] = true;
        true
    }
}
