//! Which pillar an eye meets first, in plan and exactly, over the bearings of its models.
//!
//! A pillar counts as endlessly high unless all rays to the models pass above it. Bodies do not overlap, so between neighbouring
//! tangents the nearest one does not change.

use super::brief::{Pillar, Shape};
use super::subject::{Subject, turn};
use glam::DVec2;

/// A pillar as one eye sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shadow {
    /// Bearings of the axis and of both outlines.
    pub middle: f64,
    pub from: f64,
    pub to: f64,
    /// Distance of the axis, millimetres.
    pub distance: f64,
    /// All rays to the models pass above it.
    pub below: bool,
}

impl Shadow {
    /// The shadow of a pillar; all around if the eye stands within its reach.
    pub fn new(subject: &Subject, pillar: &Pillar, shape: &Shape) -> Self {
        let offset = pillar.at - subject.o;
        let (middle, distance) = (turn(subject.ahead, offset), offset.length());
        let [left, right] = if distance <= shape.reach {
            [f64::NEG_INFINITY, f64::INFINITY]
        } else if shape.round {
            let half = (shape.reach / distance).asin();
            [-half, half]
        } else {
            let bearings = shape.profile.iter().map(|p| turn(offset, offset + *p));
            bearings.fold([0.0, 0.0], |r: [f64; 2], b| [r[0].min(b), r[1].max(b)])
        };
        let (from, to) = (middle + left, middle + right);
        Self {
            middle,
            from,
            to,
            distance,
            below: subject.passes_over(from, to, distance + shape.reach, shape.heights[1]),
        }
    }

    fn covers(&self, bearing: f64) -> bool {
        self.from <= bearing && bearing <= self.to
    }
}

/// A stretch of bearings over which the eye meets the same pillar first, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    pub from: f64,
    pub to: f64,
    pub pillar: Option<usize>,
}

/// Distance at which the ray from `eye` in the unit direction `way` meets a pillar's body, and the body's outward normal there;
/// `None` if it misses.
pub fn entry(eye: DVec2, way: DVec2, at: DVec2, shape: &Shape) -> Option<(f64, DVec2)> {
    let offset = at - eye;
    if shape.round {
        let off = way.perp_dot(offset);
        let under = shape.reach * shape.reach - off * off;
        let t = way.dot(offset) - under.max(0.0).sqrt();
        return (under >= 0.0 && t > 0.0).then(|| (t, (t * way - offset) / shape.reach));
    }
    let n = shape.profile.len();
    let mut best: Option<(f64, DVec2)> = None;
    for i in 0..n {
        let (p, q) = (
            offset + shape.profile[i],
            offset + shape.profile[(i + 1) % n],
        );
        let (sp, sq) = (way.perp_dot(p), way.perp_dot(q));
        if (sp < 0.0) == (sq < 0.0) {
            continue;
        }
        let t = way.dot(p + (q - p) * (sp / (sp - sq)));
        if t > 0.0 && best.is_none_or(|b| t < b.0) {
            best = Some((t, -(q - p).perp()));
        }
    }
    best.map(|(t, side)| (t, side.normalize_or_zero()))
}

/// The runs of one view, rising; those of one span join without gaps.
pub fn runs(
    subject: &Subject,
    pillars: &[Pillar],
    shapes: &[Shape],
    shadows: &[Shadow],
) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for [a, b] in &subject.spans {
        let near: Vec<usize> = (0..shadows.len())
            .filter(|i| shadows[*i].from < *b && shadows[*i].to > *a && !shadows[*i].below)
            .collect();
        let mut cuts: Vec<f64> = vec![*a, *b];
        let ends = near.iter().flat_map(|i| [shadows[*i].from, shadows[*i].to]);
        cuts.extend(ends.filter(|c| c > a && c < b));
        cuts.sort_unstable_by(f64::total_cmp);
        let mut fresh = true;
        for pair in cuts.windows(2).filter(|p| p[1] > p[0]) {
            let middle = (pair[0] + pair[1]) / 2.0;
            let way = subject.way(middle);
            let mut first: (f64, Option<usize>) = (f64::INFINITY, None);
            for i in near.iter().filter(|i| shadows[**i].covers(middle)) {
                let t = entry(subject.o, way, pillars[*i].at, &shapes[pillars[*i].shape]);
                if let Some((t, _)) = t.filter(|t| t.0 < first.0) {
                    first = (t, Some(*i));
                }
            }
            match runs.last_mut().filter(|r| !fresh && r.pillar == first.1) {
                Some(last) => last.to = pair[1],
                None => runs.push(Run {
                    from: pair[0],
                    to: pair[1],
                    pillar: first.1,
                }),
            }
            fresh = false;
        }
    }
    runs
}
