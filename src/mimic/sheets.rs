//! The depth order of all sheets of a whole mesh, seen or hidden: the events of `ordering`, found exactly.
//!
//! Here nothing may cross at all, and near silhouettes, where faces are edge-on, a point a nanometre beside its place lies
//! micrometres off in depth. So whether a vertex lies inside a face is decided by exact signs, and where edges cross both points are
//! mixes of the edges' own ends, never of edge-on faces.

use super::ordering::{EdgeEvent, Order, Orders, VertexEvent, order, overlapping, sorted};
use crate::geom::orient;
use crate::groups::{Anchor, vertex_anchor};
use crate::index::{FaceId, GroupId, VertexId};
use crate::mesh::topology::sides;
use crate::mesh::{Edges, TriMesh};
use crate::viewmap::Target;
use glam::DVec2;
use rayon::prelude::*;

/// Sheets nearer than this share of the depth meet in the model: half a nanometre at 400 mm, above what rounding does to depths.
const TOUCHING: f64 = 1e-9;
/// How much of the gap between two sheets must be left, if that is less than the gap wanted: near silhouettes, where sheets meet.
const GAP_SHARE: f64 = 0.02;
/// Edges that miss each other by less than this share of their length cross: on regular meshes vertices lie on edges exactly.
const REACH: f64 = 1e-9;
/// Edges whose directions differ by less (the sine of the angle) run side by side: their ends tell.
const PARALLEL: f64 = 1e-12;
/// The group of a whole mesh.
const ONLY: GroupId = GroupId(0);

/// Orders at all events of a whole mesh that is one group: all sheets on every ray. In the result sheets are to stay `gap_mm`
/// apart, along the forward axis, but need not keep more than [`GAP_SHARE`] of what parts them in the model.
pub fn sheet_orders(target: &Target, gap_mm: f64) -> Orders {
    let (vertices, edges) = events(target, |_| true);
    let mut orders = sorted(vertices, edges);
    for order in &mut orders.all {
        let depth = target.depth[order.back.vertices[0]];
        let gap = (gap_mm / depth).min(-GAP_SHARE * order.ratio.ln());
        order.ratio *= gap.exp();
    }
    orders
}

/// Number of all events of a whole mesh whose order `is_turned`.
pub fn turned_sheets(target: &Target, is_turned: impl Fn(&Order) -> bool + Sync) -> usize {
    let (vertices, edges) = events(target, is_turned);
    vertices.len() + edges.len()
}

/// Events whose order is wanted.
fn events(
    target: &Target,
    wanted: impl Fn(&Order) -> bool + Sync,
) -> (Vec<VertexEvent>, Vec<EdgeEvent>) {
    let faces: Vec<FaceId> = FaceId::all(target.mesh.faces.len()).collect();
    let first_sides = first_sides(&target.mesh);
    let events = |pairs: Vec<[FaceId; 2]>| {
        let (mut vertices, mut edges) = (Vec::new(), Vec::new());
        for pair in pairs {
            let inside = vertices_inside(target, pair).into_iter();
            vertices.extend(inside.filter(|e| wanted(&e.2)));
            let crossing = edges_crossing(target, &first_sides, pair).into_iter();
            edges.extend(crossing.filter(|e| wanted(&e.1)));
        }
        (vertices, edges)
    };
    let found: Vec<_> = overlapping(target, &faces).map(events).collect();
    let (vertices, edges): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    (vertices.concat(), edges.concat())
}

/// For every face by which of its sides, bits 0 to 2, it is the first of the side's faces: those tell of an edge's crossings.
fn first_sides(mesh: &TriMesh) -> Vec<u8> {
    let mut first = vec![0; mesh.faces.len()];
    for edge in Edges::new(mesh).iter() {
        first[edge[0].face] |= 1 << edge[0].corner;
    }
    first
}

/// Vertices of one face strictly inside the image of the other.
fn vertices_inside(target: &Target, pair: [FaceId; 2]) -> Vec<VertexEvent> {
    let faces = pair.map(|f| target.mesh.faces[f]);
    let images = pair.map(|f| target.image_of(f));
    let mut events = Vec::new();
    for (own, other) in [(0, 1), (1, 0)] {
        let [a, b, c] = images[other];
        for (v, q) in faces[own].into_iter().zip(images[own]) {
            let turns = [orient(b, c, q), orient(c, a, q), orient(a, b, q)];
            let inside = turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0);
            if !inside || faces[other].contains(&v) {
                continue;
            }
            let there = mixed(target, faces[other], turns.map(f64::abs));
            let here = (vertex_anchor(v), target.depth[v]);
            let event = order([here, there], [ONLY; 2], TOUCHING * there.1);
            events.extend(event.map(|(behind, order)| ((v, ONLY, behind), -order.ratio, order)));
        }
    }
    events
}

/// Crossings of an edge of one face with one of the other in the image.
fn edges_crossing(target: &Target, first_sides: &[u8], pair: [FaceId; 2]) -> Vec<EdgeEvent> {
    let edges = pair.map(|f| sides(target.mesh.faces[f]).map(|[a, b]| [a.min(b), a.max(b)]));
    let told = pair.map(|f| first_sides[f.at()]);
    let mut events = Vec::new();
    for [m, n] in (0..9).map(|n| [n / 3, n % 3]) {
        let [i, j] = [edges[0][m], edges[1][n]];
        let elsewhere = told[0] & (1 << m) == 0 || told[1] & (1 << n) == 0;
        if elsewhere || i.iter().any(|v| j.contains(v)) {
            continue;
        }
        // From both faces alike.
        let sides = [i.min(j), i.max(j)];
        let ends = sides.map(|e| e.map(|v| target.image[v]));
        if let Some(shares) = crossing(ends) {
            let at = [0, 1].map(|k| {
                let [a, b] = sides[k];
                mixed(target, [a, b, b], [1.0 - shares[k], shares[k], 0.0])
            });
            let event = order(at, [ONLY; 2], TOUCHING * at[0].1);
            events.extend(event.map(|(_, order)| (sides, order)));
        }
    }
    events
}

/// How far along each of two segments they cross, if they do.
fn crossing([[a, b], [c, d]]: [[DVec2; 2]; 2]) -> Option<[f64; 2]> {
    let (ab, cd, ac) = (b - a, d - c, c - a);
    let det = ab.perp_dot(cd);
    if det.abs() <= PARALLEL * ab.length() * cd.length() {
        return None;
    }
    let shares = [ac.perp_dot(cd) / det, ac.perp_dot(ab) / det];
    let reached = |t: &f64| (-REACH..=1.0 + REACH).contains(t);
    let clamped = shares.map(|t| t.clamp(0.0, 1.0));
    shares.iter().all(reached).then_some(clamped)
}

/// The point of the image that is this mix of three vertices' images, as an anchor with its depth in the model.
fn mixed(target: &Target, vertices: [VertexId; 3], shares: [f64; 3]) -> (Anchor, f64) {
    let sum: f64 = shares.iter().sum();
    let inverse = [0, 1, 2].map(|k| shares[k] / sum / target.depth[vertices[k]]);
    let total: f64 = inverse.iter().sum();
    let anchor = Anchor {
        vertices,
        weights: inverse.map(|w| w / total),
    };
    (anchor, 1.0 / total)
}
