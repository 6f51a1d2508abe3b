//! The tear lines of a finished surface, for pictures and figures.

use super::fusion::PatchDepths;
use super::options::UNSEEN_RAD;
use super::patches::{PatchId, Patches, Seam};
use crate::geom::parallax;
use crate::groups::{Anchor, anchor};
use crate::index::VertexId;
use crate::mesh::DisjointSets;
use crate::mimic::Depths;
use crate::viewmap::{Image, Target};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Lower steps are none: the relief makes one level of them.
const STEP_MM: f64 = 3e-3;

/// A piece of a tear line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLine {
    /// Its ends in the image, as directions from the eye.
    pub ends: [DVec3; 2],
    /// How far apart the two sides lie along the rays of both ends, millimetres.
    pub height_mm: [f64; 2],
    /// Difference of the two sides' inverse distances from the eye at both ends, 1/mm: the angle it opens by for each
    /// millimetre the eye moves sideways. Of an eye at infinity as from the reading distance.
    pub parallax: [f64; 2],
    /// Length at the model's mean depth, millimetres.
    pub length_mm: f64,
}

/// The tears of a view in figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSummary {
    /// Lines along which two pieces meet in a step.
    pub lines: usize,
    /// Pieces of surface that hang together, contours of the model and outlines of pillars dividing them too.
    pub pieces: usize,
    /// Length of all tear lines at the model's mean depth.
    pub length_mm: f64,
    /// Lowest step at a vertex of the cut (from there steps may fall to nothing at the end of a line).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lowest_mm: Option<f64>,
    /// Mean height over the length, and largest.
    pub mean_mm: f64,
    pub highest_mm: f64,
    /// How far the eye may move before the largest step opens by two arc-minutes if it moves square to it: in whatever
    /// direction, it may move that far.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_mm: Option<f64>,
    /// Seen area of strips too narrow to print that were given to a neighbour.
    pub absorbed_mm2: f64,
    /// How often tears were made dearer because their bounds contradicted each other.
    pub given_up: usize,
}

/// The number of tear lines: pairs of pieces that meet in a step.
pub(crate) fn count(target: &Target, patches: &Patches, field: &PatchDepths) -> usize {
    let step = |s: &Seam, end: usize| {
        let [a, b] = s.patches.map(|p| &field[p]);
        s.jump(end, a, b).abs() * patches.depth
    };
    meetings(target, patches, |n| {
        (0..2).any(|k| step(&patches.seams[n], k) > STEP_MM)
    })
    .0
}

/// Pairs of pieces that meet in a tear, and pieces. Index of `torn`: seam.
fn meetings(target: &Target, patches: &Patches, torn: impl Fn(usize) -> bool) -> (usize, usize) {
    let mut sets = DisjointSets::new(patches.patches.len());
    let (open, closed): (Vec<usize>, Vec<usize>) =
        tears(target, patches).map(|t| t.0).partition(|n| torn(*n));
    for n in closed {
        let [a, b] = patches.seams[n].patches;
        sets.join(a.0, b.0);
    }
    let mut pairs: Vec<[u32; 2]> = open
        .iter()
        .map(|n| patches.seams[*n].patches.map(|p| sets.root(p.0)))
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    (pairs.len(), sets.numbers().0)
}

/// Seams where the model hangs together, with their indices: no contours, however near their sheets are.
fn tears<'a>(target: &'a Target, patches: &'a Patches) -> impl Iterator<Item = (usize, &'a Seam)> {
    let face = |p: PatchId| target.mesh.faces[patches.patches[p].face];
    let hang_together = move |s: &Seam| {
        let [a, b] = s.patches.map(face);
        s.hangs_together() && a.iter().any(|v| b.contains(v))
    };
    let seams = patches.seams.iter().enumerate();
    seams.filter(move |(_, s)| hang_together(s))
}

/// All tear lines of the solved surface, and their figures.
pub(crate) fn lines(
    image: &Image,
    patches: &Patches,
    corners: &[[VertexId; 3]],
    depths: &Depths,
) -> (Vec<StepLine>, StepSummary) {
    let Image { target, map, .. } = image;
    // Distance in the model, and relative depth.
    let place = |p: PatchId, q: DVec2| {
        let patch = &patches.patches[p];
        let (Anchor { weights, .. }, z) = anchor(target, patch.face, q);
        let vertices = corners[p];
        let s = Anchor { vertices, weights }.relative_depth(&depths.s);
        let ray = map.plane.direction(q).length();
        (z * ray, s / depths.mu[patch.group])
    };
    let focal = map.plane.focal;
    let mut lines = Vec::new();
    let mut torn = vec![false; patches.seams.len()];
    for (n, s) in tears(target, patches) {
        // What the model's own sheets lie apart, where they count as together, is no step.
        let sides = s.line.map(|q| {
            let [(a, s), (b, t)] = s.patches.map(|p| place(p, q));
            [s, t].map(|s| (a + b) / 2.0 * s)
        });
        let line = StepLine {
            ends: s.line.map(|q| map.plane.direction(q)),
            height_mm: sides.map(|[a, b]| (a - b).abs()),
            parallax: sides.map(|[a, b]| parallax(a, b).abs() * focal * focal),
            length_mm: s.length_mm,
        };
        let cut = s.patches.map(|p| corners[p]);
        let together = stay_together(target, patches, s.patches, cut);
        if !together && line.height_mm.iter().any(|h| *h > STEP_MM) {
            torn[n] = true;
            lines.push(line);
        }
    }
    let (count, pieces) = meetings(target, patches, |n| torn[n]);
    let summary = StepSummary {
        lines: count,
        pieces,
        ..measured(&lines)
    };
    (lines, summary)
}

/// Whether two patches share all vertices of the cut mesh that they shared before.
fn stay_together(
    target: &Target,
    patches: &Patches,
    pair: [PatchId; 2],
    cut: [[VertexId; 3]; 2],
) -> bool {
    let [a, b] = pair.map(|p| target.mesh.faces[patches.patches[p].face]);
    let mut places = (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
    places.all(|(k, l)| a[k] != b[l] || cut[0][k] == cut[1][l])
}

fn measured(lines: &[StepLine]) -> StepSummary {
    let heights = || {
        let all = lines.iter().flat_map(|l| l.height_mm);
        all.filter(|h| *h > STEP_MM)
    };
    let length_mm: f64 = lines.iter().map(|l| l.length_mm).sum();
    let weighted = lines
        .iter()
        .map(|l| l.length_mm * (l.height_mm[0] + l.height_mm[1]) / 2.0);
    let weighted: f64 = weighted.sum();
    let highest_mm = heights().fold(0.0, f64::max);
    let parallax = lines.iter().flat_map(|l| l.parallax).fold(0.0, f64::max);
    StepSummary {
        length_mm,
        mean_mm: if length_mm > 0.0 {
            weighted / length_mm
        } else {
            0.0
        },
        highest_mm,
        tolerance_mm: (parallax > 0.0).then(|| UNSEEN_RAD / parallax),
        ..StepSummary::default()
    }
}
