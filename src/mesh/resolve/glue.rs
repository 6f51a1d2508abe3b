//! How two faces that are in each other's way come to share corners and edges instead.
//!
//! What is nearer than [`NEAR_MM`] becomes one: two corners, a corner and an edge, a corner and a face, two edges. Where nothing is
//! near, an edge goes through a face, and both get a corner there.

use super::complex::{Complex, NEAR_MM};
use crate::geom::{area_vector, distance_to_segment, distance_within, nearest_points};
use crate::index::{FaceId, VertexId};
use crate::mesh::topology::sides;
use glam::DVec3;

/// Nearer than this to a corner, a place is that corner, millimetres. At twice the above both parts of a bent edge are shorter than it.
const AT_MM: f64 = 2.0 * NEAR_MM;

type Side = [VertexId; 2];

/// What can be bent to go through a corner.
#[derive(Clone, Copy)]
enum Bendable {
    Edge(Side),
    Face(FaceId),
}

impl Bendable {
    fn corners(self, complex: &Complex) -> Vec<VertexId> {
        match self {
            Self::Edge(side) => side.to_vec(),
            Self::Face(f) => complex.mesh.faces[f].to_vec(),
        }
    }

    fn bend(self, complex: &mut Complex, v: VertexId) {
        match self {
            Self::Edge(side) => complex.bend_edge(side, v),
            Self::Face(f) => complex.bend_face(f, v),
        }
    }

    /// The corner of it that a place is at.
    fn corner_at(self, complex: &Complex, p: DVec3) -> Option<VertexId> {
        let far = |v: &VertexId| complex.place(*v).distance(p);
        let corners = self.corners(complex).into_iter();
        let near = corners.filter(|v| far(v) < AT_MM);
        near.min_by(|x, y| far(x).total_cmp(&far(y)))
    }

    /// Bends it through a corner, or makes one of the corner and that of its own which it is at.
    fn bend_or_merge(self, complex: &mut Complex, v: VertexId) {
        match self.corner_at(complex, complex.place(v)) {
            Some(u) => complex.merge(u, v),
            None => self.bend(complex, v),
        }
    }
}

/// One change that brings two faces nearer to sharing what they have in common.
enum Gluing {
    Merge(VertexId, VertexId),
    Bend(Bendable, VertexId),
}

/// Both come to have a corner there.
struct Join {
    what: [Bendable; 2],
    at: DVec3,
}

/// Makes one of a corner of two faces in each other's way and what it is near; tells whether there was one.
pub(crate) fn glue_corner(complex: &mut Complex, pair: [FaceId; 2]) -> bool {
    let change = near_corners(complex, pair)
        .or_else(|| corner_near_edge(complex, pair))
        .or_else(|| corner_near_face(complex, pair));
    match change {
        Some(Gluing::Merge(u, v)) => complex.merge(u, v),
        Some(Gluing::Bend(what, v)) => what.bend_or_merge(complex, v),
        None => return false,
    }
    true
}

/// Gives two faces in each other's way that have no corner near the other a corner where they cross; tells whether they do.
pub(crate) fn glue_crossing(complex: &mut Complex, pair: [FaceId; 2]) -> bool {
    let Some(Join { what, at }) = near_edges(complex, pair).or_else(|| pierced(complex, pair))
    else {
        return false;
    };
    let [first, second] = what;
    match what.map(|x| x.corner_at(complex, at)) {
        [Some(u), Some(v)] => complex.merge(u, v),
        [Some(u), None] => second.bend_or_merge(complex, u),
        [None, Some(v)] => first.bend_or_merge(complex, v),
        [None, None] => {
            let v = complex.add_vertex(at);
            first.bend(complex, v);
            second.bend(complex, v);
        }
    }
    true
}

/// Takes away a face without area.
pub(crate) fn flatten(complex: &mut Complex, f: FaceId) {
    let (side, apex) = complex.longest_side(complex.mesh.faces[f]);
    Bendable::Edge(side).bend_or_merge(complex, apex);
}

/// Corners of one face that the other does not have.
fn own(complex: &Complex, face: FaceId, other: FaceId) -> impl Iterator<Item = VertexId> + use<> {
    let other = complex.mesh.faces[other];
    let face = complex.mesh.faces[face];
    face.into_iter().filter(move |v| !other.contains(v))
}

fn sides_of(complex: &Complex, face: FaceId) -> impl Iterator<Item = Side> + use<> {
    sides(complex.mesh.faces[face]).into_iter()
}

fn nearest<T>(found: impl Iterator<Item = (f64, T)>) -> Option<T> {
    let near = found.filter(|(d, _)| *d < NEAR_MM);
    near.min_by(|x, y| x.0.total_cmp(&y.0)).map(|x| x.1)
}

/// The same of both faces of a pair: each with the other.
fn both_ways([a, b]: [FaceId; 2]) -> [[FaceId; 2]; 2] {
    [[a, b], [b, a]]
}

fn near_corners(complex: &Complex, [a, b]: [FaceId; 2]) -> Option<Gluing> {
    let pairs = own(complex, a, b).flat_map(|u| own(complex, b, a).map(move |v| (u, v)));
    let far = |u, v| complex.place(u).distance(complex.place(v));
    nearest(pairs.map(|(u, v)| (far(u, v), Gluing::Merge(u, v))))
}

fn corner_near_edge(complex: &Complex, pair: [FaceId; 2]) -> Option<Gluing> {
    let far =
        |v, [p, q]: Side| distance_to_segment(complex.place(v), complex.place(p), complex.place(q));
    nearest(both_ways(pair).into_iter().flat_map(|[face, other]| {
        own(complex, face, other).flat_map(move |v| {
            sides_of(complex, other).map(move |e| (far(v, e), Gluing::Bend(Bendable::Edge(e), v)))
        })
    }))
}

fn corner_near_face(complex: &Complex, pair: [FaceId; 2]) -> Option<Gluing> {
    nearest(both_ways(pair).into_iter().flat_map(|[face, other]| {
        own(complex, face, other).filter_map(move |v| {
            let far = distance_within(complex.place(v), complex.mesh.corners(other))?;
            Some((far, Gluing::Bend(Bendable::Face(other), v)))
        })
    }))
}

fn near_edges(complex: &Complex, [a, b]: [FaceId; 2]) -> Option<Join> {
    let pairs = sides_of(complex, a).flat_map(|e| {
        let apart = move |f: &Side| !e.iter().any(|v| f.contains(v));
        sides_of(complex, b).filter(apart).map(move |f| (e, f))
    });
    nearest(pairs.map(|(e, f)| {
        let [p, q] = nearest_points(e.map(|v| complex.place(v)), f.map(|v| complex.place(v)));
        let what = [e, f].map(Bendable::Edge);
        let at = p.midpoint(q);
        (p.distance(q), Join { what, at })
    }))
}

/// A side of one that goes through the other.
fn pierced(complex: &Complex, pair: [FaceId; 2]) -> Option<Join> {
    both_ways(pair).into_iter().find_map(|[face, other]| {
        let corners = complex.mesh.corners(other);
        let normal = area_vector(corners);
        sides_of(complex, face).find_map(|e| {
            if e.iter().any(|v| complex.mesh.faces[other].contains(v)) {
                return None;
            }
            let [p, q] = e.map(|v| complex.place(v));
            let [up, down] = [p, q].map(|x| (x - corners[0]).dot(normal));
            let at = p.lerp(q, (up / (up - down)).clamp(0.0, 1.0));
            let what = [Bendable::Face(other), Bendable::Edge(e)];
            (up * down <= 0.0 && distance_within(at, corners).is_some())
                .then_some(Join { what, at })
        })
    })
}
