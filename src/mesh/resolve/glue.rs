//! How two faces that are in each other's way come to share corners and edges instead.
//!
//! What is nearer than [`NEAR_MM`] becomes one: two corners, a corner and an edge, a corner and a face, two edges. Where nothing is
//! near, an edge goes through a face, and both get a corner there.

use super::complex::{Complex, distance_to_segment, share_on_segment};
use crate::index::{FaceId, VertexId};
use glam::DVec3;

/// Corners, edges and faces in each other's way that are nearer than this become one, millimetres. Sixty f32 steps at 100 mm, so that
/// rounding a new corner hardly ever brings about the next of its kind; a thousandth of a printed line, so that nobody sees it.
pub const NEAR_MM: f64 = 5e-4;

/// Nearer than this to a corner, a place is that corner, millimetres. At twice the above both parts of a bent edge are shorter than it.
const AT_MM: f64 = 2.0 * NEAR_MM;

type Side = [VertexId; 2];

/// One change that brings two faces nearer to sharing what they have in common.
enum Gluing {
    Merge(VertexId, VertexId),
    BendEdge(Side, VertexId),
    BendFace(FaceId, VertexId),
    JoinEdges(Side, Side, DVec3),
    Pierce(Side, FaceId, DVec3),
}

/// Changes two faces that cut, touch or overlap each other.
pub(crate) fn glue(complex: &mut Complex, pair: [FaceId; 2]) {
    let change = near_corners(complex, pair)
        .or_else(|| corner_near_edge(complex, pair))
        .or_else(|| corner_near_face(complex, pair))
        .or_else(|| near_edges(complex, pair))
        .or_else(|| pierced(complex, pair));
    match change {
        Some(Gluing::Merge(u, v)) => complex.merge(u, v),
        Some(Gluing::BendEdge(edge, v)) => bend_edge(complex, edge, v),
        Some(Gluing::BendFace(f, v)) => bend_face(complex, f, v),
        Some(Gluing::JoinEdges(e, f, p)) => {
            match (at_corner(complex, &e, p), at_corner(complex, &f, p)) {
                (Some(u), Some(v)) => complex.merge(u, v),
                (Some(u), None) => bend_edge(complex, f, u),
                (None, Some(v)) => bend_edge(complex, e, v),
                (None, None) => {
                    let v = complex.add_vertex(p);
                    complex.bend_edge(e, v);
                    complex.bend_edge(f, v);
                }
            }
        }
        Some(Gluing::Pierce(e, f, p)) => {
            let corners = complex.mesh.faces[f];
            match (at_corner(complex, &e, p), at_corner(complex, &corners, p)) {
                (Some(u), Some(v)) => complex.merge(u, v),
                (Some(u), None) => bend_face(complex, f, u),
                (None, Some(v)) => bend_edge(complex, e, v),
                (None, None) => {
                    let v = complex.add_vertex(p);
                    complex.bend_face(f, v);
                    complex.bend_edge(e, v);
                }
            }
        }
        None => {}
    }
}

/// The corner that a place is at.
fn at_corner(complex: &Complex, corners: &[VertexId], p: DVec3) -> Option<VertexId> {
    let far = |v: &VertexId| complex.place(*v).distance(p);
    let near = corners.iter().copied().filter(|v| far(v) < AT_MM);
    near.min_by(|x, y| far(x).total_cmp(&far(y)))
}

/// Bends an edge through a corner, or makes one of the corner and the end it is at.
pub(crate) fn bend_edge(complex: &mut Complex, edge: Side, v: VertexId) {
    match at_corner(complex, &edge, complex.place(v)) {
        Some(u) => complex.merge(u, v),
        None => complex.bend_edge(edge, v),
    }
}

/// Bends a face through a corner, or makes one of the corner and that of the face it is at.
fn bend_face(complex: &mut Complex, f: FaceId, v: VertexId) {
    let corners = complex.mesh.faces[f];
    match at_corner(complex, &corners, complex.place(v)) {
        Some(u) => complex.merge(u, v),
        None => complex.bend_face(f, v),
    }
}

/// Corners of one face that the other does not have.
fn own(complex: &Complex, face: FaceId, other: FaceId) -> impl Iterator<Item = VertexId> + use<> {
    let other = complex.mesh.faces[other];
    let face = complex.mesh.faces[face];
    face.into_iter().filter(move |v| !other.contains(v))
}

fn sides(complex: &Complex, face: FaceId) -> [[VertexId; 2]; 3] {
    let face = complex.mesh.faces[face];
    [0, 1, 2].map(|k| [face[k], face[(k + 1) % 3]])
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
            let edges = sides(complex, other).into_iter();
            edges.map(move |e| (far(v, e), Gluing::BendEdge(e, v)))
        })
    }))
}

fn corner_near_face(complex: &Complex, pair: [FaceId; 2]) -> Option<Gluing> {
    nearest(both_ways(pair).into_iter().flat_map(|[face, other]| {
        own(complex, face, other).filter_map(move |v| {
            let far = distance_within(complex.place(v), complex.mesh.corners(other))?;
            Some((far, Gluing::BendFace(other, v)))
        })
    }))
}

fn near_edges(complex: &Complex, [a, b]: [FaceId; 2]) -> Option<Gluing> {
    let pairs = sides(complex, a).into_iter().flat_map(|e| {
        let others = sides(complex, b).into_iter();
        others
            .filter(move |f| !e.iter().any(|v| f.contains(v)))
            .map(move |f| (e, f))
    });
    nearest(pairs.map(|(e, f)| {
        let [p, q] = nearest_points(e.map(|v| complex.place(v)), f.map(|v| complex.place(v)));
        (p.distance(q), Gluing::JoinEdges(e, f, p.midpoint(q)))
    }))
}

/// A side of one that goes through the other.
fn pierced(complex: &Complex, pair: [FaceId; 2]) -> Option<Gluing> {
    both_ways(pair).into_iter().find_map(|[face, other]| {
        let corners = complex.mesh.corners(other);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        sides(complex, face).into_iter().find_map(|e| {
            if e.iter().any(|v| complex.mesh.faces[other].contains(v)) {
                return None;
            }
            let [p, q] = e.map(|v| complex.place(v));
            let [up, down] = [p, q].map(|x| (x - corners[0]).dot(normal));
            let x = p.lerp(q, (up / (up - down)).clamp(0.0, 1.0));
            (up * down <= 0.0 && distance_within(x, corners).is_some())
                .then_some(Gluing::Pierce(e, other, x))
        })
    })
}

/// How far a point is from the plane of a face, if its foot lies in the face. Millimetres.
fn distance_within(p: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let inside = |u: DVec3, v: DVec3| (v - u).cross(p - u).dot(normal) >= 0.0;
    (inside(a, b) && inside(b, c) && inside(c, a))
        .then(|| (p - a).dot(normal.normalize_or_zero()).abs())
}

/// Of two segments the points nearest to each other (Ericson, Real-Time Collision Detection, 5.1.9).
fn nearest_points([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> [DVec3; 2] {
    let (d, e, w) = (q - p, s - r, p - r);
    let (dd, ee, de) = (d.length_squared(), e.length_squared(), d.dot(e));
    let square = dd * ee - de * de;
    let t = if square > 0.0 {
        ((de * e.dot(w) - ee * d.dot(w)) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let on_other = r.lerp(s, share_on_segment(p.lerp(q, t), r, s));
    [p.lerp(q, share_on_segment(on_other, p, q)), on_other]
}
