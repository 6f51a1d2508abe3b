//! Corners that a surface can spare: where it is flat, or along straight edges.
//!
//! A relief has a corner wherever a line of its view map crosses one of the model's edges, and a boolean adds more; most of them lie in
//! faces or edges that go on straight. Takes a closed manifold; moves each such corner onto a neighbour. The surface moves by no more than
//! the tolerance, however many corners go: measured at corners, spokes' middles and faces' centres, from before to after and back. No
//! face turns over. What crosses afterwards is for [`resolved`](crate::mesh::resolved) to find.

use crate::geom::{area_vector, distance_to_triangle, height};
use crate::index::{FaceId, VertexId};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::weld::drop_unreferenced;
use glam::DVec3;
use std::collections::VecDeque;

/// Faces turn by less than this, as a cosine: a degree.
const TURN: f64 = 0.99985;
/// Corners with more neighbours than this stay: to look at them costs the square of that.
const MOST_NEIGHBOURS: usize = 24;

/// The mesh without corners that it can spare within `tolerance` millimetres. A corner with open or crowded edges stays.
pub fn without_spare_corners(mesh: TriMesh, tolerance: f64) -> TriMesh {
    let mut around = vec![Vec::new(); mesh.vertices.len()];
    for (f, face) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
        face.iter().for_each(|v| around[*v].push(f));
    }
    let mut sparing = Sparing {
        moved: vec![0.0; mesh.vertices.len()],
        mesh,
        around,
        tolerance,
    };
    let mut queue: VecDeque<VertexId> = VertexId::all(sparing.moved.len()).collect();
    while let Some(v) = queue.pop_front() {
        // Every corner spared is one less: it ends.
        queue.extend(sparing.spare(v));
    }
    let mut mesh = sparing.mesh;
    mesh.faces.retain(|[a, b, _]| a != b);
    drop_unreferenced(&mut mesh);
    mesh
}

struct Sparing {
    mesh: TriMesh,
    around: Vec<Vec<FaceId>>,
    /// How far the surface around each corner may be from where it was, millimetres.
    moved: Vec<f64>,
    tolerance: f64,
}

impl Sparing {
    /// Moves `v` onto the neighbour that changes least, if the tolerance allows one; gives the corners to look at again.
    fn spare(&mut self, v: VertexId) -> Vec<VertexId> {
        let ring = self.ring(v);
        if ring.len() > MOST_NEIGHBOURS || ring.len() != self.around[v].len() {
            return Vec::new();
        }
        let left = self.tolerance - self.moved[v];
        let change = |w: &VertexId| Some((self.change(v, *w, left)?, *w));
        let changes = ring.iter().filter_map(change);
        let best = changes.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let Some((by, to)) = best.filter(|(_, w)| self.ring_stays(&ring, *w)) else {
            return Vec::new();
        };
        self.moved[to] = self.moved[to].max(self.moved[v] + by);
        for f in std::mem::take(&mut self.around[v]) {
            let face = self.mesh.faces[f];
            if face.contains(&to) {
                for x in face {
                    self.around[x].retain(|g| *g != f);
                }
                self.mesh.faces[f] = [to; 3];
            } else {
                self.mesh.faces[f] = face.map(|x| if x == v { to } else { x });
                self.around[to].push(f);
            }
        }
        ring
    }

    /// Neighbours of `v`, rising.
    fn ring(&self, v: VertexId) -> Vec<VertexId> {
        let faces = self.around[v].iter();
        let mut ring: Vec<VertexId> = faces.flat_map(|f| self.mesh.faces[*f]).collect();
        ring.retain(|x| *x != v);
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    /// Whether the surface stays a manifold when a corner with these neighbours moves onto `w`: they have just two in common.
    fn ring_stays(&self, ring: &[VertexId], w: VertexId) -> bool {
        let other = self.ring(w);
        let common = ring.iter().filter(|x| other.binary_search(x).is_ok());
        common.count() == 2
    }

    /// How far the surface around `v` moves when that goes onto `w`; `None` if by more than `left`, or if a face would turn.
    fn change(&self, v: VertexId, w: VertexId, left: f64) -> Option<f64> {
        let before = self.around[v].iter().map(|f| self.mesh.faces[*f]);
        let before: Vec<[DVec3; 3]> = before
            .map(|face| from_corner(face, v).map(|x| self.corner(x)))
            .collect();
        let normals: Vec<DVec3> = before.iter().map(|f| self.normal(f)).collect();
        let mut after: Vec<[DVec3; 3]> = Vec::new();
        for ((f, old), normal) in self.around[v].iter().zip(&before).zip(&normals) {
            if self.mesh.faces[*f].contains(&w) {
                continue;
            }
            let new = [self.corner(w), old[1], old[2]];
            if area_vector(*old).dot(area_vector(new)) <= 0.0 {
                return None;
            }
            let turned = self.normal(&new);
            let is_like = |n: &DVec3| n.dot(turned) > TURN;
            // A sliver has no normal worth keeping: what it becomes must look like some face there.
            let fits = turned == DVec3::ZERO
                || match *normal {
                    DVec3::ZERO => normals.iter().any(is_like),
                    own => is_like(&own),
                };
            if !fits {
                return None;
            }
            after.push(new);
        }
        let off = |p: DVec3, faces: &[[DVec3; 3]]| {
            let far = faces.iter().map(|f| distance_to_triangle(p, *f));
            far.fold(f64::INFINITY, f64::min)
        };
        let mut worst = off(self.corner(v), &after);
        // Corner, spokes and faces of either lie near the other.
        for (from, to) in [(&before, &after), (&after, &before)] {
            for [a, b, c] in from {
                if worst > left {
                    return None;
                }
                worst = worst
                    .max(off((*a + *b + *c) / 3.0, to))
                    .max(off(a.midpoint(*b), to));
            }
        }
        (worst <= left).then_some(worst)
    }

    fn corner(&self, v: VertexId) -> DVec3 {
        self.mesh.vertices[v]
    }

    /// Unit; zero for a face lower than the tolerance.
    fn normal(&self, face: &[DVec3; 3]) -> DVec3 {
        if height(*face) < self.tolerance {
            DVec3::ZERO
        } else {
            area_vector(*face).normalize_or_zero()
        }
    }
}

/// A face's corners from `v` on.
fn from_corner(face: [VertexId; 3], v: VertexId) -> [VertexId; 3] {
    let k = face.iter().position(|x| *x == v).unwrap_or(0);
    [face[k], face[(k + 1) % 3], face[(k + 2) % 3]]
}
