//! Which sheets lie before which (paper Eq 12): the depth order of the model along the eye's rays.
//!
//! The paper orders vertices against the faces before and behind them, and says itself that edges may cross all the same.
//! Whole sheets keep their order if two kinds of event do: a vertex of one face inside the image of another, and the crossing
//! of two edges in the image. For let two faces overlap in the image. They do so in a convex polygon, the intersection of two
//! triangles, each of whose corners is one of the two. On a face `1/lambda = q.p`, affine in the image point `p`; on either face
//! so is the relief's, because scaling the corners of a triangle along their rays gives another plane. The
//! difference of the two reliefs' inverse depths is affine over the polygon, hence nowhere negative if it is not so at the corners:
//! orders that hold at all events hold on every ray. (Where faces meet in the model - common vertices, or depths closer than
//! [`APART`] - the corner is a touch, not an order, and only its other corners count.)
//!
//! Events are found once, for all pairs of seen faces that overlap; each vertex's nearest neighbours before and behind are
//! rows of the program from the start, the rest only where a solution breaks them.

use crate::geom::{barycentric, segment_crossing};
use crate::groups::{Anchor, anchor};
use crate::index::{CellId, FaceId, GroupId, VertexId};
use crate::sight::Sight;
use crate::viewmap::{Cell, Target, ViewMap};
use glam::DVec2;

/// Pairs nearer than this share of the model's depth (of the reading distance, for an eye at infinity) touch rather than overlap: an
/// order between them only adds noise.
const APART: f64 = 1e-4;
/// Sheets nearer than this along a side of cells hang together there, millimetres: merging thin cells moves them by as much.
pub const TOGETHER_MM: f64 = 0.02;
/// A vertex this far inside the image of a face (barycentric) lies in it rather than on its side, where edges cross.
const INSIDE: f64 = 1e-9;

/// `front` stays before `back` on their common ray: `s_front depth_front / mu_front <= s_back depth_back / mu_back`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    pub front: Anchor,
    pub front_group: GroupId,
    pub back: Anchor,
    pub back_group: GroupId,
    /// `depth_front / depth_back` in the model, below 1 (of a whole mesh a little more: see [`sheet_orders`](super::sheet_orders)).
    pub ratio: f64,
}

/// The orders of one view.
#[derive(Clone, Debug, Default)]
pub struct Orders {
    /// Of all events: first those between a vertex and the nearest face before or behind it, by vertex; then the others.
    pub all: Vec<Order>,
    pub nearest: usize,
}

/// Orders at all events of one view, in every group that carries both faces and between groups that meet; and at the ends of sides
/// of cells where sheets meet in the relief: merging thin cells has moved some of these off their faces.
pub fn orders(sight: &Sight) -> Orders {
    let (target, map) = (&sight.image.target, &sight.image.map);
    let finder = Finder {
        target,
        apart: APART / map.plane.focal,
        lookup: FaceGroups::new(sight),
    };
    let (mut vertices, mut edges) = (Vec::new(), Vec::new());
    for pair in overlapping(target, &seen_faces(map)) {
        vertices.extend(finder.vertices_inside(pair));
        edges.extend(finder.edges_crossing(pair));
    }
    let mut found = sorted(vertices, edges);
    found.all.extend(at_seams(sight));
    found
}

/// Those of the events, each told by both its faces, with a vertex's nearest neighbours first.
pub(super) fn sorted(mut vertices: Vec<VertexEvent>, mut edges: Vec<(EdgePair, Order)>) -> Orders {
    vertices.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // Both faces of an edge tell of its crossings.
    edges.sort_by_key(|e: &(EdgePair, Order)| (e.0, e.1.front_group, e.1.back_group));
    edges.dedup_by_key(|e| (e.0, e.1.front_group, e.1.back_group));
    let is_nearest = |i: &usize| *i == 0 || vertices[*i - 1].0 != vertices[*i].0;
    let (nearest, others): (Vec<usize>, Vec<usize>) =
        (0..vertices.len()).partition(|i| is_nearest(i));
    let of_vertices = nearest.iter().chain(&others).map(|i| vertices[*i].2);
    Orders {
        all: of_vertices.chain(edges.iter().map(|e| e.1)).collect(),
        nearest: nearest.len(),
    }
}

/// Orders at both ends of all sides at which sheets of one layer meet.
fn at_seams(sight: &Sight) -> Vec<Order> {
    let Sight { image, groups, .. } = sight;
    let (target, map) = (&image.target, &image.map);
    let mut orders = Vec::new();
    for (c, k, n) in sight.seams() {
        let cells = [c, n];
        let [Some(face), Some(other)] = cells.map(|c| map.cells[c].face) else {
            continue;
        };
        let [Some(g), Some(h)] = cells.map(|c| groups.of_cell[c]) else {
            continue;
        };
        for end in [k, (k + 1) % 3] {
            let q = map.points[map.cells[c].corners[end]];
            let at = [face, other].map(|f| anchor(target, f, q));
            orders.extend(order(at, [g, h], TOGETHER_MM).map(|o| o.1));
        }
    }
    orders
}

/// The order of two points on one ray, with their depths and groups, and whether the first is behind; `None` if they are no
/// farther `apart` than that, millimetres.
pub(super) fn order(
    at: [(Anchor, f64); 2],
    groups: [GroupId; 2],
    apart: f64,
) -> Option<(bool, Order)> {
    let [own, other] = at.map(|a| a.1);
    if (own - other).abs() <= apart {
        return None;
    }
    let behind = own > other;
    let (front, back) = if behind { (1, 0) } else { (0, 1) };
    let order = Order {
        front: at[front].0,
        front_group: groups[front],
        back: at[back].0,
        back_group: groups[back],
        ratio: at[front].1 / at[back].1,
    };
    Some((behind, order))
}

/// The vertices of two edges, each pair rising.
pub(super) type EdgePair = [[VertexId; 2]; 2];
/// A vertex, its group and whether it is behind a face; how far, relatively; the order of both.
pub(super) type VertexEvent = ((VertexId, GroupId, bool), f64, Order);

struct Finder<'a> {
    target: &'a Target,
    /// Share of the depth.
    apart: f64,
    lookup: FaceGroups,
}

impl Finder<'_> {
    /// Vertices of one face that lie in the image of the other.
    fn vertices_inside(&self, pair: [FaceId; 2]) -> Vec<VertexEvent> {
        let faces = pair.map(|f| self.target.mesh.faces[f]);
        let images = pair.map(|f| self.target.image_of(f));
        let mut events = Vec::new();
        for (own, other) in [(0, 1), (1, 0)] {
            let [a, b, c] = images[other];
            for (v, q) in faces[own].into_iter().zip(images[own]) {
                let inside = barycentric(a, b, c, q).min_element() > INSIDE;
                if !inside || faces[other].contains(&v) {
                    continue;
                }
                for (behind, order) in self.orders([pair[own], pair[other]], q) {
                    let group = if behind {
                        order.back_group
                    } else {
                        order.front_group
                    };
                    events.push(((v, group, behind), -order.ratio, order));
                }
            }
        }
        events
    }

    /// Crossings of an edge of one face with one of the other in the image.
    fn edges_crossing(&self, pair: [FaceId; 2]) -> Vec<(EdgePair, Order)> {
        let faces = pair.map(|f| self.target.mesh.faces[f]);
        let images = pair.map(|f| self.target.image_of(f));
        let mut events = Vec::new();
        for (i, j) in (0..9).map(|n| (n / 3, n % 3)) {
            let mut sides = [(0, i), (1, j)].map(|(f, k)| {
                let (a, b) = (faces[f][k], faces[f][(k + 1) % 3]);
                [a.min(b), a.max(b)]
            });
            if sides[0].iter().any(|v| sides[1].contains(v)) {
                continue;
            }
            let [a, b] = [images[0][i], images[0][(i + 1) % 3]];
            let crossing = segment_crossing(a, b, images[1][j], images[1][(j + 1) % 3]);
            if let Some(t) = crossing {
                sides.sort_unstable();
                let orders = self.orders(pair, a.lerp(b, t)).into_iter();
                events.extend(orders.map(|(_, order)| (sides, order)));
            }
        }
        events
    }

    /// The order of two faces on the ray `q` in all groups that they need one in, and whether the first is behind. The ray need
    /// not meet the group: where an outline cuts the polygon, its far corners hold the rest in order.
    fn orders(&self, faces: [FaceId; 2], q: DVec2) -> Vec<(bool, Order)> {
        let common = self.lookup.common(faces);
        if common.is_empty() {
            return Vec::new();
        }
        let at = faces.map(|f| anchor(self.target, f, q));
        let apart = self.apart * at[0].1.max(at[1].1);
        let orders = common.iter().filter_map(|g| order(at, *g, apart));
        orders.collect()
    }
}

fn seen_faces(map: &ViewMap) -> Vec<FaceId> {
    let mut faces: Vec<FaceId> = map.cells.iter().filter_map(|c| c.face).collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// Pairs of faces whose boxes in the image overlap, each once: a sweep over their left ends.
pub(super) fn overlapping(target: &Target, faces: &[FaceId]) -> Vec<[FaceId; 2]> {
    let image_box = |f: &FaceId| {
        let [a, b, c] = target.image_of(*f);
        (a.min(b).min(c), a.max(b).max(c), *f)
    };
    let mut boxes: Vec<(DVec2, DVec2, FaceId)> = faces.iter().map(image_box).collect();
    boxes.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.2.cmp(&b.2)));
    let mut pairs = Vec::new();
    let mut open: Vec<(DVec2, DVec2, FaceId)> = Vec::new();
    for next in boxes {
        open.retain(|o| o.1.x > next.0.x);
        let across = open.iter().filter(|o| o.0.y < next.1.y && next.0.y < o.1.y);
        pairs.extend(across.map(|o| [o.2.min(next.2), o.2.max(next.2)]));
        open.push(next);
    }
    pairs.sort_unstable();
    pairs
}

/// The groups of faces, and which groups meet.
struct FaceGroups {
    /// `(face, group)`, sorted.
    entries: Vec<(FaceId, GroupId)>,
    /// Pairs of different groups with a common seam, each way round, sorted.
    meeting: Vec<[GroupId; 2]>,
}

impl FaceGroups {
    fn new(sight: &Sight) -> Self {
        let of_cell = &sight.groups.of_cell;
        let entry = |(c, cell): (CellId, &Cell)| Some((cell.face?, of_cell[c]?));
        let mut entries: Vec<_> = sight.image.map.all().filter_map(entry).collect();
        entries.sort_unstable();
        entries.dedup();
        let pair = |(c, _, n): (CellId, usize, CellId)| Some([of_cell[c]?, of_cell[n]?]);
        let different = sight.seams().filter_map(pair).filter(|[g, h]| g != h);
        let mut meeting: Vec<_> = different.flat_map(|[g, h]| [[g, h], [h, g]]).collect();
        meeting.sort_unstable();
        meeting.dedup();
        Self { entries, meeting }
    }

    fn of(&self, face: FaceId) -> &[(FaceId, GroupId)] {
        let first = self.entries.partition_point(|e| e.0 < face);
        let past = self.entries.partition_point(|e| e.0 <= face);
        &self.entries[first..past]
    }

    /// The groups in which two faces need an order: in one that carries both, and in two that meet. Those that do not are on different
    /// supports, on parts between which the layer jumps, or apart in the image: nothing of theirs can cross.
    fn common(&self, [a, b]: [FaceId; 2]) -> Vec<[GroupId; 2]> {
        let mut pairs = Vec::new();
        for x in self.of(a) {
            let groups = self.of(b).iter().map(|y| [x.1, y.1]);
            pairs.extend(groups.filter(|p| p[0] == p[1] || self.meeting.binary_search(p).is_ok()));
        }
        pairs
    }
}
