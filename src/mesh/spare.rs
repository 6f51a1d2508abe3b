//! Corners that a surface can spare: where it is flat, or along straight edges.
//!
//! A relief has a corner wherever a line of its view map crosses one of the model's edges, and a boolean adds more; most of them lie in
//! faces or edges that go on straight. Takes a closed manifold; moves each such corner onto a neighbour. The surface moves by no more than
//! the tolerance, however many corners go, and no face turns over. What crosses afterwards is for [`resolved`](crate::mesh::resolved) to find.

use crate::geom::{area_vector, height};
use crate::index::{FaceId, VertexId};
use crate::mesh::topology::faces_around;
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::weld::drop_unreferenced;
use glam::{DVec2, DVec3};
use std::collections::VecDeque;

/// Faces turn by less than this, as a cosine: a degree.
const TURN: f64 = 0.99985;
/// Corners with more neighbours than this stay: to look at them costs the square of that.
const MOST_NEIGHBOURS: usize = 24;

/// The mesh without corners that it can spare within `tolerance` millimetres. A corner with open or crowded edges stays.
pub fn without_spare_corners(mesh: TriMesh, tolerance: f64) -> TriMesh {
    without_spare_corners_where(mesh, tolerance, |_| true)
}

/// The same, where of corners at other places than `may_be_spare` tells only those are looked at that lose a neighbour.
pub(crate) fn without_spare_corners_where(
    mesh: TriMesh,
    tolerance: f64,
    may_be_spare: impl Fn(DVec3) -> bool,
) -> TriMesh {
    let count = mesh.vertices.len();
    let mut sparing = Sparing {
        moved: vec![0.0; count],
        is_waiting: mesh.vertices.iter().map(|p| may_be_spare(*p)).collect(),
        around: faces_around(&mesh),
        mesh,
        tolerance,
    };
    let waiting = VertexId::all(count).filter(|v| sparing.is_waiting[*v]);
    let mut queue: VecDeque<VertexId> = waiting.collect();
    while let Some(v) = queue.pop_front() {
        sparing.is_waiting[v] = false;
        // Every corner spared is one less: it ends.
        for x in sparing.spare(v) {
            if !std::mem::replace(&mut sparing.is_waiting[x], true) {
                queue.push_back(x);
            }
        }
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
    /// Corners to be looked at.
    is_waiting: Vec<bool>,
    tolerance: f64,
}

/// The faces around a corner, seen along a direction from which none hides another.
struct Star {
    spokes: Vec<Spoke>,
    tolerance: f64,
}

/// A face at a corner.
struct Spoke {
    /// From that corner on.
    ids: [VertexId; 3],
    corners: [DVec3; 3],
    /// The second and third corner.
    seen: [Seen; 2],
    /// Unit; zero for a face lower than the tolerance.
    normal: DVec3,
}

/// A point as it is seen from above the corner, which is the origin.
#[derive(Clone, Copy)]
struct Seen {
    at: DVec2,
    height: f64,
}

impl Sparing {
    /// Moves `v` onto the neighbour that changes least, if the tolerance allows one; gives the corners to look at again.
    fn spare(&mut self, v: VertexId) -> Vec<VertexId> {
        let ring = self.ring(v);
        if ring.len() > MOST_NEIGHBOURS || ring.len() != self.around[v].len() {
            return Vec::new();
        }
        let Some(star) = self.star(v) else {
            return Vec::new();
        };
        let mut left = self.tolerance - self.moved[v];
        let mut best = None;
        for w in &ring {
            let change = star.change(*w, left);
            if let Some(by) = change.filter(|by| best.is_none_or(|(least, _)| *by < least)) {
                left = by;
                best = Some((by, *w));
            }
        }
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

    /// What is around `v`; `None` if that is seen from no side as a whole.
    fn star(&self, v: VertexId) -> Option<Star> {
        let corners = |ids: [VertexId; 3]| ids.map(|x| self.mesh.vertices[x]);
        let normal = |f: &FaceId| unit_normal(corners(self.mesh.faces[*f]), self.tolerance);
        let normals: Vec<DVec3> = self.around[v].iter().map(normal).collect();
        let first = normals.iter().find(|n| **n != DVec3::ZERO)?;
        let by_turn = |a: &&DVec3, b: &&DVec3| a.dot(*first).total_cmp(&b.dot(*first));
        let upright = normals.iter().filter(|n| **n != DVec3::ZERO);
        // Halfway between the two planes of an edge.
        let up = (first + upright.min_by(by_turn)?).try_normalize()?;
        let (right, forward) = up.any_orthonormal_pair();
        let seen = |p: DVec3| {
            let from = p - self.mesh.vertices[v];
            Seen {
                at: DVec2::new(from.dot(right), from.dot(forward)),
                height: from.dot(up),
            }
        };
        let spokes = self.around[v].iter().zip(normals).map(|(f, normal)| {
            let ids = from_corner(self.mesh.faces[*f], v);
            let corners = corners(ids);
            Spoke {
                ids,
                seen: [seen(corners[1]), seen(corners[2])],
                corners,
                normal,
            }
        });
        let star = Star {
            spokes: spokes.collect(),
            tolerance: self.tolerance,
        };
        let is_upright = |s: &Spoke| s.normal == DVec3::ZERO || s.normal.dot(up) > 0.0;
        star.spokes.iter().all(is_upright).then_some(star)
    }

    /// Whether the surface stays a manifold when a corner with these neighbours moves onto `w`: they have just two in common.
    fn ring_stays(&self, ring: &[VertexId], w: VertexId) -> bool {
        let other = self.ring(w);
        let common = ring.iter().filter(|x| other.binary_search(x).is_ok());
        common.count() == 2
    }
}

impl Star {
    /// How far the surface moves when the corner goes onto its neighbour `w`; `None` if by more than `left`, or if a face would turn.
    fn change(&self, w: VertexId, left: f64) -> Option<f64> {
        let to = self.spokes.iter().find(|s| s.ids[1] == w)?;
        let kept = || self.spokes.iter().filter(|s| !s.ids.contains(&w));
        kept()
            .all(|s| self.stays_turned(s, to.corners[1]))
            .then(|| self.rise(kept(), to.seen[0], left))?
    }

    /// Whether a face looks where it did when the corner goes to `to`.
    fn stays_turned(&self, spoke: &Spoke, to: DVec3) -> bool {
        let old = spoke.corners;
        let new = [to, old[1], old[2]];
        let turned = unit_normal(new, self.tolerance);
        let is_like = |n: DVec3| n.dot(turned) > TURN;
        // A sliver has no normal worth keeping: what it becomes must look like some face there.
        let fits = || match (turned, spoke.normal) {
            (DVec3::ZERO, _) => true,
            (_, DVec3::ZERO) => self.spokes.iter().any(|s| is_like(s.normal)),
            (_, own) => is_like(own),
        };
        area_vector(old).dot(area_vector(new)) > 0.0 && fits()
    }

    /// How far the surface rises or falls when the faces that are `kept` have their corner at `to`; `None` if by more than `left`.
    ///
    /// Before and after it is a height over each place seen. Their difference is linear between crossings of its edges, so it is largest
    /// at one of them or at the corner.
    fn rise<'a>(&self, kept: impl Iterator<Item = &'a Spoke>, to: Seen, left: f64) -> Option<f64> {
        let mut worst = 0.0f64;
        // The face under the corner, by its least share of it: rounding may leave that outside of all faces.
        let mut under = (f64::NEG_INFINITY, 0.0);
        for spoke in kept {
            let [a, b] = spoke.seen;
            let shares = [(a.at, b.at), (b.at, to.at), (to.at, a.at)].map(|(p, q)| p.perp_dot(q));
            let whole: f64 = shares.iter().sum();
            if whole > 0.0 {
                let [s, t, u] = shares.map(|s| s / whole);
                let least = s.min(t).min(u);
                if least > under.0 {
                    under = (least, s * to.height + t * a.height + u * b.height);
                }
            } else if spoke.normal != DVec3::ZERO {
                return None;
            }
            for other in &self.spokes {
                worst = worst.max(rise_at_crossing(other.seen[0], [to, a]).unwrap_or(0.0));
                if worst > left {
                    return None;
                }
            }
        }
        worst = worst.max(under.1.abs());
        (worst <= left).then_some(worst)
    }
}

/// How far the way from the corner to `end` lies above or below the edge that it crosses, if it does.
fn rise_at_crossing(end: Seen, [p, q]: [Seen; 2]) -> Option<f64> {
    let (from, to) = (end.at.perp_dot(p.at), end.at.perp_dot(q.at));
    let across = q.at - p.at;
    let (here, there) = (across.perp_dot(-p.at), across.perp_dot(end.at - p.at));
    if from * to >= 0.0 || here * there >= 0.0 {
        return None;
    }
    let height = p.height + from / (from - to) * (q.height - p.height);
    Some((here / (here - there) * end.height - height).abs())
}

/// Zero for a face lower than `tolerance`.
fn unit_normal(face: [DVec3; 3], tolerance: f64) -> DVec3 {
    if height(face) < tolerance {
        DVec3::ZERO
    } else {
        area_vector(face).normalize_or_zero()
    }
}

/// A face's corners from `v` on.
fn from_corner(face: [VertexId; 3], v: VertexId) -> [VertexId; 3] {
    let k = face.iter().position(|x| *x == v).unwrap_or(0);
    [face[k], face[(k + 1) % 3], face[(k + 2) % 3]]
}
