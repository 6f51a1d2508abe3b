//! What an eye sees of the pillars in plan: a visibility polygon over the horizontal angles of its models.
//!
//! Two-dimensional on purpose: pillars count as endlessly high. The exact answer is the view map's; this one explains it.
//! Between neighbouring tangent directions the nearest pillar does not change (pillars do not overlap), so the
//! range is exact up to the profile polygons; overlapping pillars are resolved at their vertices only.

use crate::support::{Datum, Layer, Support, SupportKind};
use crate::view::View;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// Step off a tangent direction, radians: hits the pillar surely, moves a point 1 m away by 1 nm.
const NUDGE: f64 = 1e-9;

/// Parallel rays whose level part is shorter than this (the sine of 3 degrees) come from straight above.
const LEAST_LEVEL: f64 = 0.05;

/// Longest angular step of a free edge, radians, so that arcs look round.
const ARC_STEP: f64 = 0.01;

/// A stretch of directions over which the eye sees the same pillar, or none.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Index into the supports; `None` where the eye looks past all of them.
    pub support: Option<usize>,
    /// Directions in radians from [`Sight::ahead`], counter-clockwise and rising, with the horizontal distance of the
    /// hit in millimetres (infinite if none). At least two.
    pub hits: Vec<(f64, f64)>,
}

impl Run {
    /// Width in radians.
    pub fn angle(&self) -> f64 {
        self.hits.last().map_or(0.0, |l| l.0) - self.hits.first().map_or(0.0, |f| f.0)
    }
}

/// What one eye sees over the angles at which its models stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    pub eye: DVec2,
    /// Unit vector towards the look-at point: direction 0.
    pub ahead: DVec2,
    /// Disjoint and rising intervals of the models, each cut into runs.
    pub intervals: Vec<Vec<Run>>,
}

impl Sight {
    /// Works out the sight of `view` on the pillars among `supports`.
    pub fn new(view: &View, supports: &[Support]) -> Self {
        let eye = view.eye.truncate();
        let ahead = (view.look_at.truncate() - eye)
            .try_normalize()
            .unwrap_or(DVec2::X);
        let pillars: Vec<Shadow> = supports
            .iter()
            .enumerate()
            .filter_map(|(k, s)| Shadow::new(k, s, eye, ahead))
            .collect();
        let spans = if is_upright(view) {
            Vec::new()
        } else {
            model_spans(view, eye, ahead)
        };
        let intervals = spans
            .into_iter()
            .map(|span| runs(span, &pillars, eye, ahead))
            .collect();
        Self {
            eye,
            ahead,
            intervals,
        }
    }

    pub fn runs(&self) -> impl Iterator<Item = &Run> {
        self.intervals.iter().flatten()
    }

    pub fn direction(&self, angle: f64) -> DVec2 {
        DVec2::from_angle(angle).rotate(self.ahead)
    }

    pub fn point(&self, angle: f64, distance: f64) -> DVec2 {
        self.eye + distance * self.direction(angle)
    }

    /// Angle in radians over which the eye sees the support `k`.
    pub fn angle_of(&self, k: usize) -> f64 {
        self.runs()
            .filter(|r| r.support == Some(k))
            .map(Run::angle)
            .sum()
    }

    /// Width of all models together, radians.
    pub fn width(&self) -> f64 {
        self.runs().map(Run::angle).sum()
    }

    /// Share of that width at which the eye meets a pillar; 1 if there is no width.
    pub fn coverage(&self) -> f64 {
        let width = self.width();
        let met: f64 = self
            .runs()
            .filter(|r| r.support.is_some())
            .map(Run::angle)
            .sum();
        if width > 0.0 { met / width } else { 1.0 }
    }

    /// The room a relief may fill on this run, in plan: the front limit from first to last direction, then the back limit in reverse.
    /// `None` for supports without a layer. With it the line it is measured from.
    pub fn constrained(&self, run: &Run, supports: &[Support]) -> Option<(Vec<DVec2>, Vec<DVec2>)> {
        let support = &supports[run.support?];
        let (SupportKind::Pillar { axis, .. }, Some(layer)) = (&support.kind, support.layer) else {
            return None;
        };
        // The limits of a flat slab are straight: the ends tell all.
        let step = match layer.datum() {
            Datum::Plane => run.hits.len().saturating_sub(1).max(1),
            Datum::Surface => 1,
        };
        let rays = run.hits.iter().step_by(step);
        let limits = rays.map(|&(angle, hit)| (angle, self.limits(layer, *axis, angle, hit)));
        let limits: Vec<(f64, [f64; 3])> = limits
            .filter(|(_, d)| d.iter().all(|x| x.is_finite()))
            .collect();
        let at = |k: usize| move |&(angle, d): &(f64, [f64; 3])| self.point(angle, d[k]);
        let room = limits
            .iter()
            .map(at(0))
            .chain(limits.iter().rev().map(at(2)));
        Some((room.collect(), limits.iter().map(at(1)).collect()))
    }

    /// Distances on one ray of the layer's front, datum and back.
    fn limits(&self, layer: Layer, axis: DVec2, angle: f64, hit: f64) -> [f64; 3] {
        let distance = self.eye.distance(axis);
        let at = match layer.datum() {
            Datum::Surface => hit,
            Datum::Plane => distance * distance / self.direction(angle).dot(axis - self.eye),
        };
        [
            at * (1.0 - layer.front / distance),
            at,
            at * (1.0 + layer.back() / distance),
        ]
    }
}

/// Whether a view's rays all come from straight above, so that a plan shows nothing of them.
fn is_upright(view: &View) -> bool {
    view.orthographic && view.from().truncate().length() < LEAST_LEVEL
}

/// A pillar as one eye sees it in plan.
struct Shadow<'a> {
    index: usize,
    profile: &'a [DVec2],
    /// Directions of the profile's corners.
    corners: Vec<f64>,
    from: f64,
    to: f64,
}

impl<'a> Shadow<'a> {
    /// `None` for supports that are no pillars and for a pillar around the eye.
    fn new(index: usize, support: &'a Support, eye: DVec2, ahead: DVec2) -> Option<Self> {
        let SupportKind::Pillar { axis, profile, .. } = &support.kind else {
            return None;
        };
        let centre = *axis - eye;
        let middle = ahead.angle_to(centre);
        // Relative to the axis, so that no pillar is torn apart at the back of the eye.
        let corners: Vec<f64> = profile
            .iter()
            .map(|p| middle + centre.angle_to(*p - eye))
            .collect();
        let from = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let to = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (to - from < PI).then_some(Self {
            index,
            profile,
            corners,
            from,
            to,
        })
    }

    fn covers(&self, angle: f64) -> bool {
        (angle - self.from).rem_euclid(TAU) <= self.to - self.from
    }

    /// The directions of `list` that lie inside the interval `a..b`, turned by whole turns where needed.
    fn within(list: impl Iterator<Item = f64>, a: f64, b: f64) -> impl Iterator<Item = f64> {
        list.map(move |x| a + (x - a).rem_euclid(TAU))
            .filter(move |x| *x < b)
    }

    /// Distance of the first point of the profile on a ray.
    fn hit(&self, eye: DVec2, direction: DVec2) -> Option<f64> {
        let n = self.profile.len();
        let edges = (0..n).map(|i| (self.profile[i] - eye, self.profile[(i + 1) % n] - eye));
        edges
            .filter_map(|(p, q)| edge_hit(p, q, direction))
            .min_by(f64::total_cmp)
    }
}

/// Distance at which the ray from the origin meets the segment `pq`.
fn edge_hit(p: DVec2, q: DVec2, direction: DVec2) -> Option<f64> {
    let (sp, sq) = (direction.perp_dot(p), direction.perp_dot(q));
    if sp == sq || (sp < 0.0) == (sq < 0.0) && sp != 0.0 && sq != 0.0 {
        return None;
    }
    let t = direction.dot(p + (q - p) * (sp / (sp - sq)));
    (t > 0.0).then_some(t)
}

/// Angular intervals of the view's models, merged where they overlap.
fn model_spans(view: &View, eye: DVec2, ahead: DVec2) -> Vec<(f64, f64)> {
    let mut spans: Vec<(f64, f64)> = Vec::new();
    for model in &view.models {
        let angles = model
            .mesh
            .vertices
            .iter()
            .map(|v| ahead.angle_to(v.truncate() - eye))
            .filter(|a| a.is_finite());
        let (lo, hi) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), a| {
            (lo.min(a), hi.max(a))
        });
        if lo < hi {
            spans.push((lo, hi));
        }
    }
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, f64)> = Vec::new();
    for span in spans {
        match merged.last_mut() {
            Some(last) if span.0 <= last.1 => last.1 = last.1.max(span.1),
            _ => merged.push(span),
        }
    }
    merged
}

/// Cuts an interval at the pillars' tangents and sees in each part which pillar is nearest.
fn runs((a, b): (f64, f64), pillars: &[Shadow], eye: DVec2, ahead: DVec2) -> Vec<Run> {
    let mut cuts: Vec<f64> =
        Shadow::within(pillars.iter().flat_map(|p| [p.from, p.to]), a, b).collect();
    cuts.extend([a, b]);
    cuts.sort_by(f64::total_cmp);
    let mut runs: Vec<Run> = Vec::new();
    for cut in cuts.windows(2).filter(|c| c[1] - c[0] > 4.0 * NUDGE) {
        let middle = (cut[0] + cut[1]) / 2.0;
        let here: Vec<&Shadow> = pillars.iter().filter(|p| p.covers(middle)).collect();
        let direction = |angle: f64| DVec2::from_angle(angle).rotate(ahead);
        let first = |angle: f64| {
            let hits = here
                .iter()
                .filter_map(|p| p.hit(eye, direction(angle)).map(|t| (p.index, t)));
            hits.min_by(|x, y| x.1.total_cmp(&y.1))
                .map_or((None, f64::INFINITY), |(k, t)| (Some(k), t))
        };
        let nearest = first(middle).0;
        let corners = here
            .iter()
            .filter(|p| Some(p.index) == nearest)
            .flat_map(|p| p.corners.iter().copied());
        let (from, to) = (cut[0] + NUDGE, cut[1] - NUDGE);
        let mut angles: Vec<f64> = Shadow::within(corners, from, to).collect();
        let steps = ((to - from) / ARC_STEP).ceil() as usize;
        angles.extend((0..=steps).map(|k| from + (to - from) * k as f64 / steps as f64));
        angles.sort_by(f64::total_cmp);
        for angle in angles {
            let (support, distance) = first(angle);
            push(&mut runs, support, (angle, distance));
        }
    }
    runs.retain(|r| r.hits.len() > 1);
    runs
}

fn push(runs: &mut Vec<Run>, support: Option<usize>, hit: (f64, f64)) {
    match runs.last_mut() {
        Some(last) if last.support == support => last.hits.push(hit),
        _ => runs.push(Run {
            support,
            hits: vec![hit],
        }),
    }
}
