//! What the plan's page tells, worked out before anything is drawn.

use super::vista::{Grain, Vista, horizon, obstacles};
use crate::horizon::Horizon;
use crate::support::{Support, SupportKind};
use crate::view::View;

/// Longest step of a free edge, radians, so that arcs look round.
const ARC_STEP: f64 = 0.01;

/// See the module.
pub(crate) struct Facts<'a> {
    pub title: &'a str,
    pub views: &'a [View],
    pub supports: &'a [Support],
    /// One per view: what its eye meets, and how that is drawn.
    pub horizons: Vec<Horizon>,
    pub vistas: Vec<Vista>,
    /// For every support the view that sees most of it, if any does.
    pub owners: Vec<Option<usize>>,
    /// How far every eye may move, millimetres; empty if that is not known.
    pub rooms: &'a [Option<f64>],
}

impl<'a> Facts<'a> {
    pub(crate) fn new(
        title: &'a str,
        views: &'a [View],
        supports: &'a [Support],
        rooms: &'a [Option<f64>],
    ) -> Self {
        let obstacles = obstacles(supports);
        let horizons: Vec<Horizon> = views.iter().map(|v| horizon(v, &obstacles)).collect();
        let vista = |h: &Horizon| Vista::of(h, &obstacles, Grain::Step(ARC_STEP));
        Self {
            title,
            views,
            supports,
            vistas: horizons.iter().map(vista).collect(),
            owners: (0..supports.len()).map(|k| owner(&horizons, k)).collect(),
            horizons,
            rooms,
        }
    }

    pub(crate) fn pillars(&self) -> usize {
        self.supports
            .iter()
            .filter(|s| matches!(s.kind, SupportKind::Pillar { .. }))
            .count()
    }
}

/// The view that sees the support `k` over the widest angle; the earlier one of equals.
fn owner(horizons: &[Horizon], k: usize) -> Option<usize> {
    let mut best = (None, 0.0);
    for (view, horizon) in horizons.iter().enumerate() {
        let angle = horizon.angle_of(k);
        if angle > best.1 {
            best = (Some(view), angle);
        }
    }
    best.0
}
