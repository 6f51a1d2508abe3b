//! Cutting the target's mesh: a vertex for every bundle of corners that stay together.

use super::fusion::PatchDepths;
use super::options::{Prefer, StepOptions};
use super::patches::{PatchId, Patches};
use crate::groups::Anchor;
use crate::index::{FaceId, VertexId, indices};
use crate::mesh::{DisjointSets, TriMesh};
use crate::mimic::{Depths, Opening, Order, Step, Tie};
use crate::viewmap::{Image, Target, ViewMap};

/// Force on a millimetre of tear towards the preferred depth, relative to the mean diagonal of the quadratic form: far above its
/// regulariser, and too little to bend a surface by a thousandth of its layer.
const PREFERENCE: f64 = 1e-5;

/// Weight of patches given away because they were too narrow: the rest does not bend for them, but they do not crumple.
const ABSORBED: f64 = 1e-3;

/// Rows ask for a little more than the least step: the solver stops a thousandth short.
const MARGIN: f64 = 1.01;
/// Corners are joined below this many least steps, so that what stays apart has room to move.
const CLOSED: f64 = 1.5;

/// Weights that differ by less belong to the same point: rounding of image coordinates.
const SHARED: f64 = 1e-3;

/// How a target is cut along outlines and tear lines.
pub(crate) struct Cut {
    /// The target's vertex at every vertex of the cut mesh.
    pub vertices: Vec<VertexId>,
    /// Vertices of the cut mesh at every patch's corners.
    pub corners: Vec<[VertexId; 3]>,
    /// The depth order of sheets that meet along contours, at every corner there.
    pub orders: Vec<Order>,
    /// Log relief depth over the model's of every vertex.
    start: Vec<f64>,
    steps: Vec<Step>,
    ties: Vec<Tie>,
    /// Corners of two patches at one vertex, for all patches that meet along a seam.
    pairs: Vec<(Corner, Corner)>,
}

/// A corner of a patch.
pub(crate) type Corner = (PatchId, u8);

indices! {
    /// A corner among those of all patches.
    CornerId
}

/// Cuts where the field's corners stand at least `least_mm` apart; corners share a vertex where they are nearer, higher than
/// allowed, in the wrong order, or `closed`, so that the program has a solution to begin with. Gives the cut target with the view map that
/// refers to it.
pub(crate) fn cut(
    image: &Image,
    patches: &Patches,
    field: &PatchDepths,
    least_mm: f64,
    closed: &[(Corner, Corner)],
) -> (Target, ViewMap, Cut) {
    let Image { target, map, .. } = image;
    let pairs = corner_pairs(target, patches);
    let vertex = |c: Corner| vertex(target, patches, c);
    // Depths in the relief: the nearer corner decides.
    let printable = |(a, b): (Corner, Corner), near: f64, far: f64| {
        far.exp() - near.exp() >= CLOSED * least_mm / target.depth[vertex(a)]
            && far - near <= highest(patches, a, b)
    };
    let mut bundles = Bundles::new(field);
    for (a, b) in closed {
        bundles.put_together(index(*a), index(*b));
    }
    bundles.join(&pairs, printable);
    while bundles.join_disordered(patches, &pairs) {
        bundles.join(&pairs, printable);
    }
    let (corners, start) = bundles.numbered();
    let mut vertices = vec![VertexId(0); start.len()];
    for (p, c) in corners.iter().enumerate() {
        (0..3).for_each(|k| vertices[c[k]] = vertex((PatchId::new(p), k as u8)));
    }
    let steps = steps_between(target, patches, &pairs, &corners, &start, least_mm);
    let mesh = TriMesh {
        vertices: vertices.iter().map(|v| target.mesh.vertices[*v]).collect(),
        faces: corners.clone(),
    };
    let mut map = map.clone();
    for (cell, patch) in map.cells.iter_mut().zip(&patches.of_cell) {
        cell.face = patch.map(|p| FaceId(p.0));
    }
    let cut_target = target.cut(mesh, &vertices);
    let cut = Cut {
        orders: orders(patches, &corners),
        pairs,
        ties: ties(patches, &corners, &start, CLOSED * least_mm / patches.depth),
        vertices,
        corners,
        start,
        steps,
    };
    (cut_target, map, cut)
}

/// The lowest step at a vertex of the cut `target`, millimetres of depth.
pub(crate) fn lowest_mm(steps: &[Step], target: &Target, depths: &Depths) -> Option<f64> {
    let z = |v: VertexId| target.depth[v] * depths.s[v];
    let heights = steps.iter().map(|s| z(s.far) - z(s.near));
    heights.min_by(f64::total_cmp)
}

impl Cut {
    /// The corners that the steps with these numbers part.
    pub(crate) fn parted_by(&self, steps: &[usize]) -> Vec<(Corner, Corner)> {
        let of = |(p, k): Corner| self.corners[p][usize::from(k)];
        let mut ends: Vec<[VertexId; 2]> = steps
            .iter()
            .filter_map(|i| self.steps.get(*i))
            .flat_map(|s| [[s.near, s.far], [s.far, s.near]])
            .collect();
        ends.sort_unstable();
        let parted = |(a, b): &&(Corner, Corner)| ends.binary_search(&[of(*a), of(*b)]).is_ok();
        self.pairs.iter().filter(parted).copied().collect()
    }

    /// What the program must know of the cut. Pieces that are free are pulled together or apart along tears and outlines.
    /// Patches that are `absorbed` hardly count.
    pub(crate) fn opening(
        &self,
        patches: &Patches,
        options: &StepOptions,
        absorbed: &[bool],
    ) -> Opening {
        let sign = match options.prefer {
            Prefer::Tolerance => PREFERENCE,
            Prefer::Camouflage => -PREFERENCE,
        };
        let mut push = vec![0.0; self.start.len()];
        let mut pull = |patch: PatchId, weights: &[f64; 3], force: f64| {
            for (v, w) in self.corners[patch].iter().zip(weights) {
                push[*v] += force * w;
            }
        };
        for seam in &patches.seams {
            let [i, j] = seam.patches;
            let [first, second] = seam.patches.map(|p| self.corners[p].map(|v| self.start[v]));
            for (end, [a, b]) in seam.ends.iter().enumerate() {
                let first_is_near = seam.jump(end, &first, &second) < 0.0;
                let force = sign * seam.length_mm / 2.0 * if first_is_near { 1.0 } else { -1.0 };
                pull(i, a, force);
                pull(j, b, -force);
            }
        }
        for rim in &patches.rims {
            pull(
                rim.patch,
                &[1.0 / 3.0; 3],
                sign * rim.length_mm * if rim.near { 1.0 } else { -1.0 },
            );
        }
        Opening {
            start: self.start.clone(),
            push,
            steps: self.steps.clone(),
            ties: self.ties.clone(),
            counts: absorbed
                .iter()
                .map(|a| if *a { ABSORBED } else { 1.0 })
                .collect(),
        }
    }
}

/// The steps between bundles that were not joined, rising by vertices.
fn steps_between(
    target: &Target,
    patches: &Patches,
    pairs: &[(Corner, Corner)],
    corners: &[[VertexId; 3]],
    start: &[f64],
    least_mm: f64,
) -> Vec<Step> {
    let at = |(p, k): Corner| corners[p][usize::from(k)];
    let step = |(a, b): &(Corner, Corner)| {
        let (v, w) = (at(*a), at(*b));
        let (near, far) = if start[v] < start[w] { (v, w) } else { (w, v) };
        let (p, k) = *a;
        // At the layer's front a step must be largest in log depth.
        let front = patches.patches[p].room[usize::from(k)].0.exp();
        let z = target.depth[vertex(target, patches, *a)];
        Step {
            near,
            far,
            least: (MARGIN * least_mm / z / front).ln_1p(),
            most: highest(patches, *a, *b),
        }
    };
    let apart = pairs.iter().filter(|(a, b)| at(*a) != at(*b));
    let mut steps: Vec<Step> = apart.map(step).collect();
    steps.sort_by(|s, t| {
        let key = |s: &Step| (s.near, s.far);
        key(s).cmp(&key(t)).then(s.most.total_cmp(&t.most))
    });
    steps.dedup_by_key(|s| (s.near, s.far));
    steps
}

/// The highest step allowed between two corners, log depth.
fn highest(patches: &Patches, a: Corner, b: Corner) -> f64 {
    let of = |(p, _): Corner| patches.patches[p].highest;
    of(a).min(of(b))
}

fn vertex(target: &Target, patches: &Patches, (p, k): Corner) -> VertexId {
    target.mesh.faces[patches.patches[p].face][usize::from(k)]
}

fn index((p, k): Corner) -> CornerId {
    CornerId(3 * p.0 + u32::from(k))
}

/// Corners with the mean depth of each bundle.
struct Bundles {
    sets: DisjointSets,
    /// Sum and count at every root.
    sums: Vec<(f64, f64)>,
}

impl Bundles {
    fn new(field: &PatchDepths) -> Self {
        Self {
            sets: DisjointSets::new(3 * field.len()),
            sums: field.iter().flatten().map(|y| (*y, 1.0)).collect(),
        }
    }

    fn root(&mut self, corner: CornerId) -> CornerId {
        CornerId(self.sets.root(corner.0))
    }

    fn mean(&mut self, corner: CornerId) -> f64 {
        let root = self.root(corner);
        let (sum, count) = self.sums[root];
        sum / count
    }

    /// Joins pairs whose step from near to far is not `printable`, until all are: joining moves means, so that others may come
    /// near.
    fn join(
        &mut self,
        pairs: &[(Corner, Corner)],
        printable: impl Fn((Corner, Corner), f64, f64) -> bool,
    ) {
        loop {
            let mut joined = false;
            for (a, b) in pairs {
                let (x, y) = (self.mean(index(*a)), self.mean(index(*b)));
                if !printable((*a, *b), x.min(y), x.max(y)) {
                    joined |= self.put_together(index(*a), index(*b));
                }
            }
            if !joined {
                return;
            }
        }
    }

    /// Joins the common corners of patches whose order along a contour the means have turned round; whether there were any.
    fn join_disordered(&mut self, patches: &Patches, pairs: &[(Corner, Corner)]) -> bool {
        let mut joined = false;
        for seam in &patches.seams {
            let [i, j] = seam.patches;
            let [first, second] = [i, j].map(|p| [0, 1, 2].map(|k| self.mean(index((p, k)))));
            let wrong = (0..2).any(|end| {
                let gap = seam.gaps[end];
                gap != 0.0 && (seam.jump(end, &first, &second) - gap) * gap.signum() > 0.0
            });
            if wrong {
                let first = pairs.partition_point(|(a, _)| a.0 < i);
                let common = pairs[first..].iter().take_while(|(a, _)| a.0 == i);
                for (a, b) in common.filter(|(_, b)| b.0 == j) {
                    joined |= self.put_together(index(*a), index(*b));
                }
            }
        }
        joined
    }

    /// Joins two corners; whether they were apart.
    fn put_together(&mut self, a: CornerId, b: CornerId) -> bool {
        let (i, j) = (self.root(a), self.root(b));
        if i == j {
            return false;
        }
        let (s, t) = (self.sums[i], self.sums[j]);
        self.sets.join(i.0, j.0);
        let root = self.root(i);
        self.sums[root] = (s.0 + t.0, s.1 + t.1);
        true
    }

    /// The bundle of every patch's corners, and the bundles' means.
    fn numbered(mut self) -> (Vec<[VertexId; 3]>, Vec<f64>) {
        let (count, number) = self.sets.numbers();
        let number: Vec<VertexId> = number.into_iter().map(VertexId).collect();
        let mut means = vec![0.0; count];
        for (corner, n) in CornerId::all(number.len()).zip(&number) {
            means[*n] = self.mean(corner);
        }
        (
            number.chunks(3).map(|c| [c[0], c[1], c[2]]).collect(),
            means,
        )
    }
}

/// Corners of two patches at the same vertex, for all patches that meet along a seam.
fn corner_pairs(target: &Target, patches: &Patches) -> Vec<(Corner, Corner)> {
    let mut pairs = Vec::new();
    for seam in &patches.seams {
        let [a, b] = seam.patches;
        if patches.patches[a].group != patches.patches[b].group {
            continue;
        }
        let corners = |p: PatchId| (0..3u8).map(move |k| (p, k));
        for c in corners(a) {
            let same = |d: &Corner| vertex(target, patches, c) == vertex(target, patches, *d);
            pairs.extend(corners(b).find(same).map(|d| (c, d)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Exact for the relief: `1/lambda` is affine along a side on both sheets, so that its ends decide.
fn orders(patches: &Patches, corners: &[[VertexId; 3]]) -> Vec<Order> {
    let mut orders = Vec::new();
    for seam in &patches.seams {
        for (weights, gap) in seam.ends.iter().zip(seam.gaps) {
            let end = |k: usize| {
                let patch = seam.patches[k];
                let anchor = Anchor {
                    vertices: corners[patch],
                    weights: weights[k],
                };
                (anchor, patches.patches[patch].group)
            };
            let (first, second) = (end(0), end(1));
            let (front, back) = if gap > 0.0 {
                (first, second)
            } else {
                (second, first)
            };
            if gap != 0.0 {
                orders.push(Order {
                    front: front.0,
                    front_group: front.1,
                    back: back.0,
                    back_group: back.1,
                    ratio: (-gap.abs()).exp(),
                });
            }
        }
    }
    orders
}

/// Where patches meet closer than `least` (log depth) without sharing the vertices around: at sides whose faces are no
/// neighbours, because a thin face between them was merged away.
fn ties(patches: &Patches, corners: &[[VertexId; 3]], start: &[f64], least: f64) -> Vec<Tie> {
    let mut ties = Vec::new();
    for seam in &patches.seams {
        for (weights, gap) in seam.ends.iter().zip(seam.gaps) {
            let side = |k: usize, sign: f64| {
                let vertices = corners[seam.patches[k]];
                (0..3).map(move |i| (vertices[i], sign * weights[k][i]))
            };
            let mut tie: Tie = side(0, 1.0).chain(side(1, -1.0)).collect();
            tie.sort_by_key(|t| t.0);
            tie.dedup_by(|b, a| {
                let same = a.0 == b.0;
                a.1 += if same { b.1 } else { 0.0 };
                same
            });
            tie.retain(|t| t.1.abs() > SHARED);
            let open: f64 = tie.iter().map(|(v, w)| w * start[*v]).sum();
            if gap == 0.0 && !tie.is_empty() && open.abs() < least {
                ties.push(tie);
            }
        }
    }
    ties
}
