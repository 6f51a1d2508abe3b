//! Pairs of faces that cut, touch or overlap each other where they should not.
//!
//! Takes a welded mesh with finite coordinates; gives every pair of faces that have a point in common beyond the
//! vertices and the edge they share. Exact: only signs of adaptive-precision determinants decide (Shewchuk 1997), so
//! a vertex that lies exactly on a foreign face counts and one a rounding error above it does not.
//! Faces of zero area and faces with the same three vertices are left out: they are other defects.

use crate::index::{ComponentId, FaceId};
use crate::mesh::boxes::{BoxTree, LeafId};
use crate::mesh::fans::plain_fans;
use crate::mesh::topology::{DisjointSets, face_components};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::{projection_axis, turn2, turn3};
use glam::DVec3;
use rayon::prelude::*;

/// Leaves of up to four faces tested between two looks at the limit. Larger blocks cost seconds past the limit where all faces are in
/// one place; smaller ones cost waiting at their ends.
const BLOCK: usize = 1 << 8;

/// Pairs of face indices `[a, b]`, `a < b`, sorted. Stops soon after `limit` pairs: a result at least that long means
/// "and perhaps more"; which ones it then holds still depends on the mesh alone.
pub fn self_intersections(mesh: &TriMesh, limit: usize) -> Vec<[FaceId; 2]> {
    some_intersections(mesh, limit, u64::MAX).0
}

/// The same, stopping also soon after so many pairs were compared; gives whether all were.
pub(crate) fn some_intersections(
    mesh: &TriMesh,
    limit: usize,
    comparisons: u64,
) -> (Vec<[FaceId; 2]>, bool) {
    let looking = MeetingFaces {
        mesh,
        axis: (0..mesh.faces.len())
            .into_par_iter()
            .map(|f| projection_axis(&mesh.corners(FaceId::new(f))))
            .collect(),
        plain: plain_fans(mesh),
        tree: BoxTree::of_faces(mesh),
        limit,
    };
    let (mut pairs, mut compared) = (Vec::new(), 0);
    let mut all = true;
    for block in looking.tree.leaves().chunks(BLOCK) {
        if compared >= comparisons || pairs.len() >= limit {
            all = false;
            break;
        }
        let found = block.par_iter().map(|leaf| looking.pairs_of(*leaf));
        let found: Vec<(Vec<[FaceId; 2]>, u64)> = found.collect();
        for (own, count) in found {
            pairs.extend(own);
            compared += count;
        }
    }
    pairs.sort_unstable();
    // A single leaf may have been left at the limit.
    let all = all && pairs.len() < limit;
    (pairs, all)
}

/// For each face the number of its object: components that share edges, cut or touch each other are one, numbered by their first face.
pub fn face_objects(mesh: &TriMesh) -> Vec<ComponentId> {
    let component = face_components(mesh);
    let Some(last) = component.iter().max().filter(|c| c.0 > 0) else {
        return component;
    };
    let mut sets = DisjointSets::new(last.at() + 1);
    for pair in self_intersections(mesh, usize::MAX) {
        let [a, b] = pair.map(|f| component[f].0);
        sets.join(a, b);
    }
    let number = sets.numbers().1;
    component.iter().map(|c| ComponentId(number[*c])).collect()
}

/// A mesh whose faces are compared.
struct MeetingFaces<'a> {
    mesh: &'a TriMesh,
    /// Of each face an axis to drop; `None` for one without area.
    axis: Vec<Option<usize>>,
    /// Vertices whose faces need not be compared with each other.
    plain: Vec<bool>,
    tree: BoxTree,
    limit: usize,
}

impl MeetingFaces<'_> {
    /// The pairs of a leaf's faces with each other and with those of later leaves, and how many were compared.
    fn pairs_of(&self, leaf: LeafId) -> (Vec<[FaceId; 2]>, u64) {
        let mut pairs = Vec::new();
        let mut compared = 0;
        self.tree.meeting(leaf, |[a, b]| {
            compared += 1;
            let pair = [FaceId(a.0.min(b.0)), FaceId(a.0.max(b.0))];
            if self.meet(pair) {
                pairs.push(pair);
            }
            pairs.len() < self.limit
        });
        (pairs, compared)
    }

    fn meet(&self, pair: [FaceId; 2]) -> bool {
        let [a, b] = pair.map(|f| self.mesh.faces[f]);
        if a.iter().any(|v| self.plain[*v] && b.contains(v)) {
            return false;
        }
        match pair.map(|f| self.axis[f]) {
            [Some(x), Some(y)] => faces_intersect(self.mesh, pair, [x, y]),
            _ => false,
        }
    }
}

/// Whether two faces cut, touch or overlap each other beyond what they share. A face without area does not.
pub(crate) fn meet(mesh: &TriMesh, pair: [FaceId; 2]) -> bool {
    match pair.map(|f| projection_axis(&mesh.corners(f))) {
        [Some(a), Some(b)] => faces_intersect(mesh, pair, [a, b]),
        _ => false,
    }
}

fn faces_intersect(mesh: &TriMesh, [a, b]: [FaceId; 2], [axis_a, axis_b]: [usize; 2]) -> bool {
    let (va, vb) = (mesh.faces[a], mesh.faces[b]);
    let shared_a = [0, 1, 2].map(|k| vb.contains(&va[k]));
    let (ta, tb) = (
        Flat::new(mesh.corners(a), axis_a),
        Flat::new(mesh.corners(b), axis_b),
    );
    match shared_a.iter().filter(|s| **s).count() {
        0 => separate_faces_meet(&ta, &tb),
        1 => {
            let apex_a = shared_a.iter().position(|s| *s).unwrap_or(0);
            let apex_b = vb.iter().position(|v| *v == va[apex_a]).unwrap_or(0);
            ta.meets_segment(tb.corner(apex_b + 1), tb.corner(apex_b + 2))
                || tb.meets_segment(ta.corner(apex_a + 1), ta.corner(apex_a + 2))
        }
        2 => {
            let far_a = shared_a.iter().position(|s| !*s).unwrap_or(0);
            let far_b = (0..3).find(|&k| !va.contains(&vb[k])).unwrap_or(0);
            folded_onto(&ta, far_a, tb.corner(far_b))
        }
        _ => false,
    }
}

/// For a face with corner `far` opposite to the edge it shares with a face whose third corner is `other`: whether they
/// lie in one plane on the same side of that edge.
fn folded_onto(face: &Flat, far: usize, other: DVec3) -> bool {
    let (u, v, w) = (face.corner(far + 1), face.corner(far + 2), face.corner(far));
    turn3(u, v, w, other) == 0.0
        && same_sign(turn2(face.axis, u, v, w), turn2(face.axis, u, v, other))
}

/// Faces without a common vertex meet exactly if an edge of one meets the other.
fn separate_faces_meet(a: &Flat, b: &Flat) -> bool {
    if a.has_on_one_side(b) || b.has_on_one_side(a) {
        return false;
    }
    (0..3).any(|k| a.meets_segment(b.corner(k), b.corner(k + 1)))
        || (0..3).any(|k| b.meets_segment(a.corner(k), a.corner(k + 1)))
}

/// A face of non-zero area with an axis along which its projection keeps that.
struct Flat {
    corners: [DVec3; 3],
    axis: usize,
}

impl Flat {
    fn new(corners: [DVec3; 3], axis: usize) -> Self {
        Self { corners, axis }
    }

    fn corner(&self, k: usize) -> DVec3 {
        self.corners[k % 3]
    }

    fn side(&self, p: DVec3) -> f64 {
        turn3(self.corners[0], self.corners[1], self.corners[2], p)
    }

    /// Whether all of `other` lies strictly on one side of this face's plane.
    fn has_on_one_side(&self, other: &Self) -> bool {
        let first = self.side(other.corners[0]);
        first != 0.0
            && same_sign(first, self.side(other.corners[1]))
            && same_sign(first, self.side(other.corners[2]))
    }

    /// Whether the closed segment has a point in the closed face.
    fn meets_segment(&self, p: DVec3, q: DVec3) -> bool {
        let (sp, sq) = (self.side(p), self.side(q));
        if sp == 0.0 && sq == 0.0 {
            return self.meets_segment_in_plane(p, q);
        }
        if same_sign(sp, sq) {
            return false;
        }
        let turns = [0, 1, 2].map(|k| turn3(p, q, self.corner(k), self.corner(k + 1)));
        turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0)
    }

    /// Two closed convex sets in a plane are apart exactly if the line of an edge of one has the other strictly beyond
    /// it: three edges of the face and the segment itself.
    fn meets_segment_in_plane(&self, p: DVec3, q: DVec3) -> bool {
        let turn = |a, b, c| turn2(self.axis, a, b, c);
        let inner = turn(self.corners[0], self.corners[1], self.corners[2]);
        let beyond = |k: usize, r: DVec3| {
            let side = turn(self.corner(k), self.corner(k + 1), r);
            side != 0.0 && !same_sign(side, inner)
        };
        if (0..3).any(|k| beyond(k, p) && beyond(k, q)) {
            return false;
        }
        let first = turn(p, q, self.corners[0]);
        first == 0.0 || !(1..3).all(|k| same_sign(first, turn(p, q, self.corners[k])))
    }
}

fn same_sign(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}
