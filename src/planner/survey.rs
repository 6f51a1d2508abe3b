//! What holds of a layout and what does not: coverage, conflicts, gaps, eye tolerance, exactly and in plan.
//!
//! Takes subjects and pillars. Gives every fault in millimetres (0: none), so that a search can walk towards a layout without
//! faults, and the rates at which cuts open. A layout without faults has, in plan, coverage 1 and conflicts 0: every ray to a
//! model meets a pillar of its own view first, with an overlap behind every cut; no other view's relief stands in it, nor any solid
//! nearer to another than the gap. Vertically, all rays meet their pillars below the top and above the base.

use super::brief::{Brief, Pillar, Shape};
use super::skyline::{Run, Shadow, runs};
use super::subject::Subject;
use crate::geom::{gap, parallax};
use crate::support::Datum;
use glam::DVec2;

/// By how much the farther pillar reaches behind the nearer one at a cut, and beyond a model's outline, millimetres: polygons inside
/// their circles and rounding to printable coordinates take a hundredth of it.
pub const OVERLAP_MM: f64 = 0.3;
/// Strips of relief narrower than this are not planned, millimetres: three lines of a 0.4 mm nozzle.
pub const NARROWEST_MM: f64 = 1.2;
/// Room between a relief and other views' sight lines, millimetres.
const SIGHT_ROOM_MM: f64 = 0.1;
/// Thickness behind a layer's back that is relief too, at most; see [`Slab::backing`](crate::support::Slab::backing).
const BACKING_MM: f64 = 0.8;

/// Where a pillar's relief may lie, seen from its owner: offsets of planes behind the axis plane, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets {
    pub near: f64,
    /// With the backing.
    pub far: f64,
    /// Without it, and the middle of the layer.
    pub back: f64,
    pub middle: f64,
}

impl Offsets {
    pub fn new(shape: &Shape) -> Self {
        let layer = shape.layer;
        let near = match layer.datum {
            Datum::AxisPlane => -layer.front,
            Datum::Surface => -layer.front - shape.reach,
        };
        Self {
            near,
            far: layer.back + BACKING_MM,
            back: layer.back,
            middle: (near + layer.back) / 2.0,
        }
    }
}

/// Faults of a layout, millimetres each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faults {
    /// Width of the models' parts that meet no pillar.
    pub uncovered: f64,
    /// Width that meets another view's pillar.
    pub foreign: f64,
    /// Overlap missing behind cuts and outlines.
    pub loose: f64,
    /// Width missing of strips too narrow.
    pub narrow: f64,
    /// Rays above the pillars' tops or below their feet.
    pub beyond_ends: f64,
    /// How deep reliefs stand in sight lines of other views.
    pub in_sight: f64,
    /// Room missing between solids.
    pub tight: f64,
    /// How far pillars stick out of the region.
    pub outside: f64,
    /// Opening of cuts beyond what the tolerance allows, as width.
    pub open: f64,
    /// Pillars too many or too few.
    pub count: f64,
}

impl Faults {
    pub fn sum(&self) -> f64 {
        self.uncovered
            + self.foreign
            + self.loose
            + self.narrow
            + self.beyond_ends
            + self.in_sight
            + self.tight
            + self.outside
            + self.open
            + self.count
    }
}

/// A layout seen from all eyes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Index: view, then pillar.
    pub shadows: Vec<Vec<Shadow>>,
    /// Index: view.
    pub runs: Vec<Vec<Run>>,
    pub faults: Faults,
    /// Fastest opening of any cut, radians per millimetre that the eye moves sideways: with reliefs in the middle of their
    /// layers, and at their worst places. Index: view.
    pub rates: Vec<[f64; 2]>,
}

/// Surveys a layout. `brief` gives shapes, region, gap and limits.
pub fn survey(subjects: &[Subject], brief: &Brief, pillars: &[Pillar]) -> Survey {
    let shapes = &brief.shapes;
    let mut found = Survey::default();
    for subject in subjects {
        let of = |p: &Pillar| Shadow::new(subject, p, &shapes[p.shape]);
        found.shadows.push(pillars.iter().map(of).collect());
    }
    complete(subjects, brief, pillars, &mut found);
    found
}

/// The same where the shadows are known.
pub fn complete(subjects: &[Subject], brief: &Brief, pillars: &[Pillar], found: &mut Survey) {
    let shapes = &brief.shapes;
    let mut faults = Faults::default();
    found.runs.clear();
    found.rates.clear();
    for (v, subject) in subjects.iter().enumerate() {
        let runs = runs(subject, pillars, shapes, &found.shadows[v]);
        let of_view = OfView {
            subject,
            view: v,
            shapes,
            pillars,
            shadows: &found.shadows[v],
        };
        of_view.look(&runs, &mut faults);
        let rates = of_view.rates(&runs);
        let allowed = crate::steps::UNSEEN_RAD / brief.tolerance_mm[v].max(1e-9);
        if rates[1] > allowed {
            let far = (subject.middle.truncate() - subject.o).length();
            faults.open += (rates[1] - allowed) * far * far;
        }
        found.rates.push(rates);
        found.runs.push(runs);
    }
    let pieces = pieces(subjects, shapes, pillars, found);
    in_sight(subjects, shapes, pillars, found, &pieces, &mut faults);
    tight(brief, pillars, &pieces, &mut faults);
    for pillar in pillars.iter().filter(|p| !p.fixed) {
        faults.outside += brief.outside(pillar.at, shapes[pillar.shape].reach);
    }
    let [fewest, most] = brief.count;
    faults.count = fewest
        .saturating_sub(pillars.len())
        .max(pillars.len().saturating_sub(most)) as f64;
    found.faults = faults;
}

struct OfView<'a> {
    subject: &'a Subject,
    view: usize,
    shapes: &'a [Shape],
    pillars: &'a [Pillar],
    shadows: &'a [Shadow],
}

impl OfView<'_> {
    /// Faults of what the eye meets.
    fn look(&self, runs: &[Run], faults: &mut Faults) {
        let subject = self.subject;
        let middle = (subject.middle.truncate() - subject.o).length();
        for (k, run) in runs.iter().enumerate() {
            let Some(i) = run.pillar else {
                faults.uncovered += (run.to - run.from) * middle + OVERLAP_MM;
                continue;
            };
            let (shadow, shape) = (&self.shadows[i], &self.shapes[self.pillars[i].shape]);
            let width = (run.to - run.from) * shadow.distance;
            if self.pillars[i].owner != Some(self.view) {
                faults.foreign += width + OVERLAP_MM;
                continue;
            }
            let offsets = Offsets::new(shape);
            let near = shadow.distance + offsets.near.min(-shape.reach);
            let far = (shadow.distance + offsets.far) / (shadow.to - shadow.middle).cos();
            faults.beyond_ends += subject.beyond_ends(run.from, run.to, near, far, shape);
            faults.narrow += (NARROWEST_MM - width).max(0.0);
            let left = k
                .checked_sub(1)
                .map(|p| &runs[p])
                .filter(|r| r.to == run.from);
            let right = runs.get(k + 1).filter(|r| r.from == run.to);
            let behind = |next: Option<&Run>| next.and_then(|n| n.pillar).map(|j| &self.shadows[j]);
            let overlap = |own: f64, other: Option<f64>| {
                // At a cut one of the two reaches on behind the other; at an outline this one does.
                let missing = OVERLAP_MM - own.max(other.unwrap_or(0.0)) * shadow.distance;
                missing.max(0.0) * if other.is_some() { 0.5 } else { 1.0 }
            };
            faults.loose += overlap(
                run.from - shadow.from,
                behind(left).map(|s| s.to - run.from),
            );
            faults.loose += overlap(shadow.to - run.to, behind(right).map(|s| run.to - s.from));
        }
    }

    /// See [`Survey::rates`].
    fn rates(&self, runs: &[Run]) -> [f64; 2] {
        let mut worst = [0.0f64; 2];
        for pair in runs.windows(2).filter(|p| p[0].to == p[1].from) {
            let [Some(i), Some(j)] = [pair[0].pillar, pair[1].pillar] else {
                continue;
            };
            let at = |k: usize, offset: fn(&Offsets) -> f64| {
                let shadow = &self.shadows[k];
                let offsets = Offsets::new(&self.shapes[self.pillars[k].shape]);
                (shadow.distance + offset(&offsets)) / (pair[0].to - shadow.middle).cos()
            };
            let rate = |i: usize, j: usize, from: fn(&Offsets) -> f64, to: fn(&Offsets) -> f64| {
                parallax(at(i, from), at(j, to))
            };
            worst[0] = worst[0].max(rate(i, j, |o| o.middle, |o| o.middle).abs());
            let extreme =
                rate(i, j, |o| o.near, |o| o.back).max(rate(j, i, |o| o.near, |o| o.back));
            worst[1] = worst[1].max(extreme);
        }
        worst
    }
}

/// The room in plan that the relief of one run may fill.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub view: usize,
    pub pillar: usize,
    pub run: usize,
    /// Near side from first to last bearing, then the far side back: a convex quadrilateral.
    pub corners: [DVec2; 4],
}

fn pieces(
    subjects: &[Subject],
    shapes: &[Shape],
    pillars: &[Pillar],
    found: &Survey,
) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (view, runs) in found.runs.iter().enumerate() {
        for (run, r) in runs.iter().enumerate() {
            let Some(pillar) = r.pillar.filter(|i| pillars[*i].owner == Some(view)) else {
                continue;
            };
            let shadow = &found.shadows[view][pillar];
            let offsets = Offsets::new(&shapes[pillars[pillar].shape]);
            let subject = &subjects[view];
            let (one, other) = (subject.way(r.from), subject.way(r.to));
            let reach = |bearing: f64, offset: f64| {
                (shadow.distance + offset) / (bearing - shadow.middle).cos()
            };
            let corners = [
                subject.o + reach(r.from, offsets.near) * one,
                subject.o + reach(r.to, offsets.near) * other,
                subject.o + reach(r.to, offsets.far) * other,
                subject.o + reach(r.from, offsets.far) * one,
            ];
            pieces.push(Piece {
                view,
                pillar,
                run,
                corners,
            });
        }
    }
    pieces
}

/// Reliefs of one view that stand in sight lines of another.
fn in_sight(
    subjects: &[Subject],
    shapes: &[Shape],
    pillars: &[Pillar],
    found: &Survey,
    pieces: &[Piece],
    faults: &mut Faults,
) {
    for own in pieces {
        let run = &found.runs[own.view][own.run];
        let subject = &subjects[own.view];
        let offsets = Offsets::new(&shapes[pillars[own.pillar].shape]);
        let ahead = (pillars[own.pillar].at - subject.o).normalize_or_zero();
        let back = found.shadows[own.view][own.pillar].distance + offsets.far;
        let (one, other) = (subject.way(run.from), subject.way(run.to));
        let eye = subject.o;
        for piece in pieces.iter().filter(|p| p.view != own.view) {
            // How deep the piece stands behind each side of the sight lines' triangle; the least tells.
            let depth = |inward: &dyn Fn(DVec2) -> f64| {
                piece
                    .corners
                    .iter()
                    .map(|c| inward(*c - eye))
                    .fold(f64::NEG_INFINITY, f64::max)
            };
            let right = depth(&|p| one.perp_dot(p));
            if right < 0.0 {
                continue;
            }
            let left = depth(&|p| p.perp_dot(other));
            let before = depth(&|p| back - ahead.dot(p));
            let deep = right.min(left).min(before) + SIGHT_ROOM_MM;
            if deep <= 0.0 {
                continue;
            }
            // Sides of the piece that hold the whole triangle off.
            let triangle = [eye, own.corners[2], own.corners[3]];
            let held = (0..4).map(|k| {
                let (a, b) = (piece.corners[k], piece.corners[(k + 1) % 4]);
                let outward = -(b - a).perp().normalize_or_zero();
                triangle
                    .iter()
                    .map(|t| -outward.dot(*t - a))
                    .fold(f64::NEG_INFINITY, f64::max)
            });
            let held = held.fold(f64::INFINITY, f64::min) + SIGHT_ROOM_MM;
            faults.in_sight += deep.min(held).max(0.0);
        }
    }
}

/// Room between bodies, and between reliefs and what is not their own pillar.
fn tight(brief: &Brief, pillars: &[Pillar], pieces: &[Piece], faults: &mut Faults) {
    let shapes = &brief.shapes;
    for (i, a) in pillars.iter().enumerate() {
        for b in &pillars[i + 1..] {
            if a.fixed && b.fixed {
                continue;
            }
            let reach = shapes[a.shape].reach + shapes[b.shape].reach + brief.gap;
            let apart = a.at.distance(b.at);
            if apart < reach {
                faults.tight += if shapes[a.shape].round && shapes[b.shape].round {
                    reach - apart
                } else {
                    (brief.gap - bodies_apart(a, b, shapes)).max(0.0)
                };
            }
        }
    }
    let circles: Vec<(DVec2, f64)> = pieces.iter().map(circle).collect();
    for (n, piece) in pieces.iter().enumerate() {
        let (middle, radius) = circles[n];
        for (i, pillar) in pillars.iter().enumerate() {
            let shape = &shapes[pillar.shape];
            if i == piece.pillar || middle.distance(pillar.at) > radius + shape.reach + brief.gap {
                continue;
            }
            let apart = if shape.round {
                to_quad(&piece.corners, pillar.at) - shape.reach
            } else {
                let body: Vec<DVec2> = shape.profile.iter().map(|p| pillar.at + *p).collect();
                gap(&piece.corners, &body)
            };
            faults.tight += (brief.gap - apart).max(0.0);
        }
        for (m, other) in pieces.iter().enumerate().skip(n + 1) {
            let far = middle.distance(circles[m].0) > radius + circles[m].1 + brief.gap;
            if other.pillar != piece.pillar && !far {
                faults.tight += (brief.gap - gap(&piece.corners, &other.corners)).max(0.0);
            }
        }
    }
}

fn bodies_apart(a: &Pillar, b: &Pillar, shapes: &[Shape]) -> f64 {
    let body =
        |p: &Pillar| -> Vec<DVec2> { shapes[p.shape].profile.iter().map(|q| p.at + *q).collect() };
    gap(&body(a), &body(b))
}

fn circle(piece: &Piece) -> (DVec2, f64) {
    let middle = piece.corners.iter().sum::<DVec2>() / 4.0;
    let radius = piece
        .corners
        .iter()
        .map(|c| c.distance(middle))
        .fold(0.0, f64::max);
    (middle, radius)
}

/// Distance of a point from a quadrilateral, 0 inside.
fn to_quad(corners: &[DVec2; 4], p: DVec2) -> f64 {
    let inside =
        (0..4).all(|k| (corners[(k + 1) % 4] - corners[k]).perp_dot(p - corners[k]) >= 0.0);
    let turned =
        (0..4).all(|k| (corners[(k + 1) % 4] - corners[k]).perp_dot(p - corners[k]) <= 0.0);
    if inside || turned {
        return 0.0;
    }
    (0..4)
        .map(|k| crate::geom::to_segment(p, corners[k], corners[(k + 1) % 4]))
        .fold(f64::INFINITY, f64::min)
}
