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
use rayon::prelude::*;

/// Pairs nearer than this share of the model's depth (of the reading distance, for an eye at infinity) touch rather than overlap: an
/// order between them only adds noise.
const APART: f64 = 1e-4;
/// Sheets nearer than this along a side of cells hang together there, millimetres: merging thin cells moves them by as much.
pub const TOGETHER_MM: f64 = 0.02;
/// Height of a strip of the image in mean heights of faces: below 2 faces are in many strips, above 10 the sweeps are long.
const STRIP: f64 = 4.0;
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
    let events = |pairs: Vec<[FaceId; 2]>| {
        let (mut vertices, mut edges) = (Vec::new(), Vec::new());
        for pair in pairs {
            vertices.extend(finder.vertices_inside(pair));
            edges.extend(finder.edges_crossing(pair));
        }
        (vertices, edges)
    };
    let found: Vec<_> = overlapping(target, &seen_faces(map)).map(events).collect();
    let (vertices, edges): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let mut found = sorted(vertices.concat(), edges.concat());
    found.all.extend(at_seams(sight));
    found
}

/// Those of the events, each told by both its faces, with a vertex's nearest neighbours first.
pub(super) fn sorted(mut vertices: Vec<VertexEvent>, mut edges: Vec<EdgeEvent>) -> Orders {
    vertices.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // Both faces of an edge tell of its crossings.
    edges.sort_by_key(|e: &EdgeEvent| (e.0, e.1.front_group, e.1.back_group));
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
type EdgePair = [[VertexId; 2]; 2];
/// Two edges that cross in the image, and the order there.
pub(super) type EdgeEvent = (EdgePair, Order);
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
    fn edges_crossing(&self, pair: [FaceId; 2]) -> Vec<EdgeEvent> {
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

/// Pairs of faces whose boxes in the image meet, each once, rising, and cut up for tasks: the image is cut into strips, and in each a
/// sweep goes from left to right.
pub(super) fn overlapping(
    target: &Target,
    faces: &[FaceId],
) -> impl IndexedParallelIterator<Item = Vec<[FaceId; 2]>> {
    let image_box = |f: &FaceId| {
        let [a, b, c] = target.image_of(*f);
        (a.min(b).min(c), a.max(b).max(c), *f)
    };
    let mut boxes: Vec<ImageBox> = faces.iter().map(image_box).collect();
    boxes.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.2.cmp(&b.2)));
    let low = boxes.iter().fold(f64::INFINITY, |y, b| y.min(b.0.y));
    let tall = boxes.iter().map(|b| b.1.y - b.0.y).sum::<f64>() / boxes.len().max(1) as f64;
    let high = boxes.iter().fold(low, |y, b| y.max(b.1.y));
    let height = (STRIP * tall).max((high - low) / boxes.len() as f64);
    let strip = move |y: f64| ((y - low) / height) as usize;
    let top = boxes.iter().map(|b| strip(b.1.y)).max();
    let mut strips = vec![Vec::new(); top.map_or(0, |t| t + 1)];
    for b in boxes {
        (strip(b.0.y)..=strip(b.1.y)).for_each(|s| strips[s].push(b));
    }
    // Where both boxes begin in a strip or before, so that only one strip tells of them.
    let within = move |s: usize, a: &ImageBox, b: &ImageBox| {
        let meet = a.0.y <= b.1.y && b.0.y <= a.1.y;
        meet && strip(a.0.y.max(b.0.y)) == s
    };
    strips.into_par_iter().enumerate().map(move |(s, boxes)| {
        let (mut pairs, mut open) = (Vec::new(), Vec::<ImageBox>::new());
        for next in boxes {
            open.retain(|o| o.1.x >= next.0.x);
            let across = open.iter().filter(|o| within(s, o, &next));
            pairs.extend(across.map(|o| [o.2.min(next.2), o.2.max(next.2)]));
            open.push(next);
        }
        pairs.sort_unstable();
        pairs
    })
}

/// Lowest and highest corner of a face's image.
type ImageBox = (DVec2, DVec2, FaceId);

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
