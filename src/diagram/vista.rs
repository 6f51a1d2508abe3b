//! What an eye sees of the pillars in plan, as it is drawn: a visibility polygon over the bearings of its models.
//!
//! Two-dimensional on purpose: pillars count as endlessly high. The exact answer is the view map's; this one explains it. Which pillar
//! is met where is the [`Horizon`]'s; here its runs get outlines.

use crate::horizon::{Footprint, Horizon, Obstacle, Run, Viewpoint};
use crate::support::{Datum, Layer, Support, SupportKind};
use crate::view::View;
use glam::DVec2;
use std::f64::consts::PI;

/// Step off a tangent, radians: hits the pillar surely, moves a point 1 m away by 1 nm.
const NUDGE: f64 = 1e-9;
/// Runs narrower than this, radians, come from rounding: they are neither drawn nor counted.
pub const NARROWEST: f64 = 4.0 * NUDGE;

/// Parallel rays whose level part is shorter than this (the sine of 3 degrees) come from straight above.
const LEAST_LEVEL: f64 = 0.05;

/// How closely an outline is followed between the ends of a run; corners are always met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grain {
    /// No two bearings are farther apart than this, radians: free edges, which end on a circle, look round too.
    Step(f64),
    /// A disc is so many chords, closer together towards the tangents, where it is steep; free edges are not followed.
    Chords(usize),
}

/// A stretch of bearings over which the eye sees the same pillar, or none.
#[derive(Clone, Debug, PartialEq)]
pub struct Sector {
    /// Index of the obstacle; `None` where the eye looks past all of them.
    pub obstacle: Option<usize>,
    /// Bearings, rising, with the horizontal distance of the hit in millimetres (infinite if none). At least two.
    pub hits: Vec<(f64, f64)>,
}

/// What one eye sees over the bearings at which its models stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Vista {
    pub eye: DVec2,
    /// Unit vector towards the look-at point: bearing 0.
    pub ahead: DVec2,
    /// Disjoint and rising intervals, each cut into sectors.
    pub intervals: Vec<Vec<Sector>>,
}

/// Pillars as obstacles, `None` for supports that are none; indices are those of the supports. They are the polygons with which they
/// are built.
pub fn obstacles(supports: &[Support]) -> Vec<Option<Obstacle<'_>>> {
    let obstacle = |s| match s {
        &Support {
            kind: SupportKind::Pillar {
                axis, ref profile, ..
            },
            ..
        } => Some(Obstacle {
            at: DVec2::ZERO,
            footprint: Footprint::Polygon {
                corners: profile,
                inside: axis,
            },
        }),
        _ => None,
    };
    supports.iter().map(obstacle).collect()
}

/// A view's eye in plan.
pub fn viewpoint(view: &View) -> Viewpoint {
    let place = view.eye.truncate();
    Viewpoint::At {
        place,
        ahead: (view.look_at.truncate() - place).normalize_or(DVec2::X),
    }
}

/// What the eye of a view meets over the bearings of its models.
pub fn horizon(view: &View, obstacles: &[Option<Obstacle>]) -> Horizon {
    let viewpoint = viewpoint(view);
    let bodies = view.models.iter().map(|m| &m.mesh.vertices);
    let spans = if is_upright(view) {
        Vec::new()
    } else {
        viewpoint.spans(bodies.map(|b| b.iter().map(|v| v.truncate())))
    };
    Horizon::new(viewpoint, &spans, obstacles)
}

/// Whether a view's rays all come from straight above, so that a plan shows nothing of them.
fn is_upright(view: &View) -> bool {
    view.orthographic && view.from().truncate().length() < LEAST_LEVEL
}

impl Vista {
    /// Follows the outlines on runs that are given by intervals.
    pub fn new<'a, 'b, R: Iterator<Item = &'b Run>>(
        viewpoint: &Viewpoint,
        intervals: impl Iterator<Item = R>,
        obstacle: impl Fn(usize) -> Option<Obstacle<'a>>,
        grain: Grain,
    ) -> Self {
        let (eye, ahead) = match *viewpoint {
            Viewpoint::At { place, ahead } => (place, ahead),
            Viewpoint::Infinity { ahead } => (DVec2::ZERO, ahead),
        };
        let interval = |runs: R| {
            let mut sectors: Vec<Sector> = Vec::new();
            for run in runs {
                let met = run.obstacle.and_then(&obstacle);
                let hits = grain.hits(viewpoint, run, met.as_ref());
                match sectors.last_mut().filter(|s| s.obstacle == run.obstacle) {
                    Some(last) => last.hits.extend(hits),
                    None => sectors.push(Sector {
                        obstacle: run.obstacle,
                        hits,
                    }),
                }
            }
            sectors
        };
        Self {
            eye,
            ahead,
            intervals: intervals.map(interval).collect(),
        }
    }

    /// Of a horizon; outlines have points at all tangents, those of hidden pillars too.
    pub fn of(horizon: &Horizon, obstacles: &[Option<Obstacle>], grain: Grain) -> Self {
        let wide = |r: &&Run| r.width() > NARROWEST;
        Self::new(
            horizon.viewpoint(),
            horizon.stretches().map(|s| s.iter().filter(wide)),
            |k| obstacles[k],
            grain,
        )
    }

    pub fn sectors(&self) -> impl Iterator<Item = &Sector> {
        self.intervals.iter().flatten()
    }

    pub fn direction(&self, bearing: f64) -> DVec2 {
        DVec2::from_angle(bearing).rotate(self.ahead)
    }

    pub fn point(&self, bearing: f64, distance: f64) -> DVec2 {
        self.eye + distance * self.direction(bearing)
    }

    /// The room a relief may fill on this sector, in plan: the front limit from first to last bearing, then the back limit in reverse.
    /// `None` for supports without a layer. With it the line it is measured from.
    pub fn constrained(
        &self,
        sector: &Sector,
        supports: &[Support],
    ) -> Option<(Vec<DVec2>, Vec<DVec2>)> {
        let support = &supports[sector.obstacle?];
        let (SupportKind::Pillar { axis, .. }, Some(layer)) = (&support.kind, support.layer) else {
            return None;
        };
        // The limits of a flat slab are straight: the ends tell all.
        let step = match layer.datum() {
            Datum::Plane => sector.hits.len().saturating_sub(1).max(1),
            Datum::Surface => 1,
        };
        let rays = sector.hits.iter().step_by(step);
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

impl Grain {
    fn hits(
        self,
        viewpoint: &Viewpoint,
        run: &Run,
        obstacle: Option<&Obstacle>,
    ) -> Vec<(f64, f64)> {
        let distance = |bearing: f64| {
            let Some(obstacle) = obstacle else {
                return f64::INFINITY;
            };
            let ray = viewpoint.ray(bearing);
            let hub = obstacle.at + obstacle.footprint.inside();
            // Only rounding misses: the nearest point to the middle will do.
            obstacle.entry(&ray).map_or_else(
                || ray.way.dot(hub - ray.from).max(0.0),
                |impact| impact.distance,
            )
        };
        let bearings = self.bearings(viewpoint, run, obstacle);
        bearings.into_iter().map(|b| (b, distance(b))).collect()
    }

    /// Rising, from end to end.
    fn bearings(self, viewpoint: &Viewpoint, run: &Run, obstacle: Option<&Obstacle>) -> Vec<f64> {
        let nudge = NUDGE.min(run.width() / 4.0);
        let (from, to) = (run.from + nudge, run.to - nudge);
        let mut bearings = Vec::new();
        if let Some(Obstacle {
            at,
            footprint: Footprint::Polygon { corners, .. },
        }) = obstacle
        {
            let corners = corners.iter().map(|p| viewpoint.bearing(*at + *p));
            let turned = corners.map(|b| viewpoint.from_on(from, b));
            bearings.extend(turned.filter(|b| from <= *b && *b < to));
        }
        match self {
            Self::Step(most) => {
                let steps = ((to - from) / most).ceil() as usize;
                let at = |k: usize| from + (to - from) * k as f64 / steps as f64;
                bearings.extend((0..=steps).map(at));
            }
            Self::Chords(n) => {
                let round = obstacle
                    .filter(|o| matches!(o.footprint, Footprint::Disc { .. }))
                    .map_or(1, |_| n);
                let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
                let at = |k: usize| middle - half * (PI * k as f64 / n as f64).cos();
                bearings.extend((1..round).map(at));
                bearings.extend([from, to]);
            }
        }
        bearings.sort_by(f64::total_cmp);
        bearings
    }
}
