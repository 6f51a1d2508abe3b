//! What holds of a layout and what does not: coverage, conflicts, gaps, eye tolerance, exactly and in plan.
//!
//! Takes subjects and pillars. Gives every fault with its size in millimetres, so that a search can walk towards a layout without
//! faults, and the rates at which cuts open. A layout without faults has, in plan, coverage 1 and conflicts 0: every ray to a
//! model meets a pillar of its own view first, with an overlap behind every cut; no other view's relief stands in it, nor any solid
//! nearer to another than the gap. Vertically, all rays meet their pillars below the top and above the base.

mod eye;
mod room;

use super::brief::{Brief, Pillar, Shape};
use super::skyline::{Run, Shadow, runs};
use super::subject::Subject;
use crate::steps::UNSEEN_RAD;
use crate::support::Datum;
use eye::OfView;
use glam::DVec2;
use room::{placed, tight};

/// Thickness behind a layer's back that is relief too, at most; see [`Slab::backing`](crate::support::Slab::backing).
const BACKING_MM: f64 = 0.8;

/// Where a pillar's relief may lie, seen from its owner: offsets of planes behind the axis plane, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets {
    pub near: f64,
    /// Of the layer, and with the backing.
    pub back: f64,
    pub far: f64,
    /// Middle of the layer.
    pub middle: f64,
}

impl Offsets {
    pub fn new(shape: &Shape) -> Self {
        let layer = shape.layer;
        let near = match layer.datum() {
            Datum::Plane => -layer.front,
            Datum::Surface => -layer.front - shape.reach,
        };
        Self {
            near,
            back: layer.back(),
            far: layer.back() + BACKING_MM,
            middle: (near + layer.back()) / 2.0,
        }
    }
}

/// What can be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A part of the models meets no pillar.
    Uncovered,
    /// A part of the models meets another view's pillar.
    Foreign,
    /// Overlap is missing behind a cut or an outline.
    Loose,
    /// A strip is too narrow.
    Narrow,
    /// What stays of a pillar behind another is too thin.
    Fin,
    /// Rays pass above a pillar's top or below its foot.
    Ends,
    /// A relief stands in sight lines of another view.
    Sight,
    /// Room is missing between solids.
    Tight,
    /// A pillar sticks out of the region.
    Outside,
    /// A cut opens faster than the tolerance allows.
    Open,
    /// Too many pillars, or too few.
    Count,
}

/// A fault; see [`Kind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    pub kind: Kind,
    /// The view that suffers.
    pub view: Option<usize>,
    /// The pillars that have a part in it.
    pub pillars: [Option<usize>; 2],
    /// How much is wrong: widths, depths and gaps as such, the rest as far as it would have to move.
    pub mm: f64,
    pub at: DVec2,
}

/// A layout seen from all eyes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Index: view, then pillar.
    pub shadows: Vec<Vec<Shadow>>,
    /// Index: view.
    pub runs: Vec<Vec<Run>>,
    pub faults: Vec<Fault>,
    /// Fastest opening of any cut, radians per millimetre that the eye moves sideways: with reliefs in the middle of their
    /// layers, and at their worst places. Index: view.
    pub rates: Vec<[f64; 2]>,
}

impl Survey {
    /// Surveys a layout. `brief` gives shapes, region, gap and limits.
    pub fn new(subjects: &[&Subject], brief: &Brief, pillars: &[Pillar]) -> Self {
        let shadow = |s: &Subject, p: &Pillar| Shadow::new(s, p, &brief.shapes[p.shape]);
        let of = |s: &&Subject| pillars.iter().map(|p| shadow(s, p)).collect();
        Self::with_shadows(subjects, brief, pillars, subjects.iter().map(of).collect())
    }

    /// The same where the shadows are known.
    pub fn with_shadows(
        subjects: &[&Subject],
        brief: &Brief,
        pillars: &[Pillar],
        shadows: Vec<Vec<Shadow>>,
    ) -> Self {
        let mut found = Self {
            shadows,
            ..Self::default()
        };
        for (view, subject) in subjects.iter().enumerate() {
            let shadows = &found.shadows[view];
            let runs = runs(subject, pillars, &brief.shapes, shadows);
            let eye = OfView {
                subject,
                view,
                brief,
                pillars,
                shadows,
            };
            eye.look(&runs, &mut found.faults);
            let rates = eye.rates(&runs);
            found
                .faults
                .extend(eye.open(rates[1], brief.tolerance_mm[view]));
            found.rates.push(rates);
            found.runs.push(runs);
        }
        let pieces = found.pieces(subjects, &brief.shapes, pillars);
        found.in_sight(subjects, pillars, &pieces);
        tight(brief, pillars, &pieces, &mut found.faults);
        placed(brief, pillars, &mut found.faults);
        found
    }

    /// How much is wrong in all, millimetres; 0 if nothing is.
    pub fn wrong(&self) -> f64 {
        self.faults.iter().map(|f| f.mm).sum()
    }

    /// Guaranteed eye tolerance of a view, millimetres.
    pub fn tolerance(&self, view: usize) -> f64 {
        UNSEEN_RAD / self.rates[view][1].max(f64::MIN_POSITIVE)
    }

    /// Least of all views.
    pub fn least_tolerance(&self) -> f64 {
        (0..self.rates.len())
            .map(|v| self.tolerance(v))
            .fold(f64::INFINITY, f64::min)
    }
}

/// Horizontal distances between which rays meet a pillar or its relief.
pub fn reach_of(shadow: &Shadow, shape: &Shape) -> [f64; 2] {
    let offsets = Offsets::new(shape);
    let near = shadow.distance + offsets.near.min(-shape.reach);
    let far = (shadow.distance + offsets.far) / (shadow.to - shadow.middle).min(1.0).cos();
    [near, far]
}
