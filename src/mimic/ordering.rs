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
use crate::groups::{Anchor, Groups, anchor};
use crate::viewmap::{SupportField, Target, ViewMap};
use glam::DVec2;

/// Pairs nearer than this share of the model's depth touch rather than overlap: an order between them only adds noise.
const APART: f64 = 1e-4;
/// A vertex this far inside the image of a face (barycentric) lies in it rather than on its side, where edges cross.
const INSIDE: f64 = 1e-9;

/// `front` stays before `back` on their common ray: `s_front depth_front / mu_front <= s_back depth_back / mu_back`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    pub front: Anchor,
    pub front_group: u32,
    pub back: Anchor,
    pub back_group: u32,
    /// `depth_front / depth_back` in the model, below 1.
    pub ratio: f64,
}

/// The orders of one view.
#[derive(Clone, Debug, Default)]
pub struct Orders {
    /// Of all events: first those between a vertex and the nearest face before or behind it, by vertex; then the others.
    pub all: Vec<Order>,
    pub nearest: usize,
}

/// Orders at all events of one view, on rays that meet a support which carries both faces.
pub fn orders(target: &Target, map: &ViewMap, field: &SupportField, groups: &Groups) -> Orders {
    let finder = Finder {
        target,
        map,
        field,
        lookup: FaceGroups::new(map, groups),
    };
    let (mut vertices, mut edges) = (Vec::new(), Vec::new());
    for pair in overlapping(target, &seen_faces(map)) {
        vertices.extend(finder.vertices_inside(pair));
        edges.extend(finder.edges_crossing(pair));
    }
    vertices.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // Both faces of an edge tell of its crossings.
    edges.sort_by_key(|e: &(EdgePair, Order)| e.0);
    edges.dedup_by_key(|e| e.0);
    let is_nearest = |i: &usize| *i == 0 || vertices[*i - 1].0 != vertices[*i].0;
    let (nearest, others): (Vec<usize>, Vec<usize>) =
        (0..vertices.len()).partition(|i| is_nearest(i));
    let of_vertices = nearest.iter().chain(&others).map(|i| vertices[*i].2);
    Orders {
        all: of_vertices.chain(edges.iter().map(|e| e.1)).collect(),
        nearest: nearest.len(),
    }
}

/// The vertices of two edges, each pair rising.
type EdgePair = [[u32; 2]; 2];
/// A vertex and whether it is behind a face; how far, relatively; the order of both.
type VertexEvent = ((u32, bool), f64, Order);

struct Finder<'a> {
    target: &'a Target,
    map: &'a ViewMap,
    field: &'a SupportField<'a>,
    lookup: FaceGroups,
}

impl Finder<'_> {
    /// Vertices of one face that lie in the image of the other.
    fn vertices_inside(&self, pair: [u32; 2]) -> Vec<VertexEvent> {
        let faces = pair.map(|f| self.target.mesh.faces[f as usize]);
        let images = pair.map(|f| self.target.image_of(f as usize));
        let mut events = Vec::new();
        for (own, other) in [(0, 1), (1, 0)] {
            let [a, b, c] = images[other];
            for (v, q) in faces[own].into_iter().zip(images[own]) {
                let inside = barycentric(a, b, c, q).min_element() > INSIDE;
                if !inside || faces[other].contains(&v) {
                    continue;
                }
                if let Some((behind, order)) = self.order([pair[own], pair[other]], q) {
                    events.push(((v, behind), -order.ratio, order));
                }
            }
        }
        events
    }

    /// Crossings of an edge of one face with one of the other in the image.
    fn edges_crossing(&self, pair: [u32; 2]) -> Vec<(EdgePair, Order)> {
        let faces = pair.map(|f| self.target.mesh.faces[f as usize]);
        let images = pair.map(|f| self.target.image_of(f as usize));
        let mut events = Vec::new();
        for (i, j) in (0..9).map(|n| (n / 3, n % 3)) {
            let mut sides = [(0, i), (1, j)].map(|(f, k)| {
                let (a, b): (u32, u32) = (faces[f][k], faces[f][(k + 1) % 3]);
                [a.min(b), a.max(b)]
            });
            if sides[0].iter().any(|v| sides[1].contains(v)) {
                continue;
            }
            let [a, b] = [images[0][i], images[0][(i + 1) % 3]];
            let crossing = segment_crossing(a, b, images[1][j], images[1][(j + 1) % 3]);
            if let Some((_, order)) = crossing.and_then(|t| self.order(pair, a.lerp(b, t))) {
                sides.sort_unstable();
                events.push((sides, order));
            }
        }
        events
    }

    /// The order of two faces on the ray `q`, and whether the first is behind; `None` if they touch there, or no support
    /// carries both.
    fn order(&self, faces: [u32; 2], q: DVec2) -> Option<(bool, Order)> {
        let at = faces.map(|f| anchor(self.target, f as usize, q));
        let [own, other] = at.map(|a| a.1);
        if (own - other).abs() < APART * own.max(other) {
            return None;
        }
        let direction = self.map.plane.direction(q);
        let (support, _) = self.field.first_hit(self.map.plane.eye, direction)?;
        let groups = [
            self.lookup.get(faces[0], support)?,
            self.lookup.get(faces[1], support)?,
        ];
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
}

fn seen_faces(map: &ViewMap) -> Vec<u32> {
    let mut faces: Vec<u32> = map.cells.iter().filter_map(|c| c.face).collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// Pairs of faces whose boxes in the image overlap, each once: a sweep over their left ends.
fn overlapping(target: &Target, faces: &[u32]) -> Vec<[u32; 2]> {
    let image_box = |f: &u32| {
        let [a, b, c] = target.image_of(*f as usize);
        (a.min(b).min(c), a.max(b).max(c), *f)
    };
    let mut boxes: Vec<(DVec2, DVec2, u32)> = faces.iter().map(image_box).collect();
    boxes.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.2.cmp(&b.2)));
    let mut pairs = Vec::new();
    let mut open: Vec<(DVec2, DVec2, u32)> = Vec::new();
    for next in boxes {
        open.retain(|o| o.1.x > next.0.x);
        let across = open.iter().filter(|o| o.0.y < next.1.y && next.0.y < o.1.y);
        pairs.extend(across.map(|o| [o.2.min(next.2), o.2.max(next.2)]));
        open.push(next);
    }
    pairs.sort_unstable();
    pairs
}

/// The group of a face on a support.
struct FaceGroups {
    /// `(face, support, group)`, sorted.
    entries: Vec<(u32, u32, u32)>,
}

impl FaceGroups {
    fn new(map: &ViewMap, groups: &Groups) -> Self {
        let entry = |(c, cell): (usize, &crate::viewmap::Cell)| {
            Some((cell.face?, cell.support?, groups.of_cell[c]?))
        };
        let mut entries: Vec<_> = map.cells.iter().enumerate().filter_map(entry).collect();
        entries.sort_unstable();
        entries.dedup();
        Self { entries }
    }

    fn get(&self, face: u32, support: u32) -> Option<u32> {
        let i = self
            .entries
            .partition_point(|e| (e.0, e.1) < (face, support));
        self.entries
            .get(i)
            .filter(|e| (e.0, e.1) == (face, support))
            .map(|e| e.2)
    }
}
