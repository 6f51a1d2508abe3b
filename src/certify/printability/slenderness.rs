//! Whether pillars stand: their least width against their height.

use super::check::{PrintCheck, PrintFinding};
use crate::certify::point::without_minus_zero;
use crate::geom::narrowest;
use crate::support::{Support, SupportKind};
use glam::DVec2;

/// The pillar whose least width is the smallest share of what its height wants.
pub(crate) fn slenderness(supports: &[Support], slimmest: f64) -> Option<PrintCheck> {
    let pillars = supports.iter().filter_map(|s| match &s.kind {
        SupportKind::Pillar {
            axis,
            profile,
            top,
            round,
            ..
        } => {
            // A round pillar is as wide as the circle that its outline stands for.
            let across = |p: &DVec2| 2.0 * p.distance(*axis);
            let width = match round {
                true => profile.iter().map(across).fold(0.0, f64::max),
                false => narrowest(profile),
            };
            let height = top.max(0.0);
            Some((s, axis.extend(height), width, height / slimmest))
        }
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    });
    let (support, place, width, wanted) =
        pillars.min_by(|a, b| (a.2 / a.3).total_cmp(&(b.2 / b.3)))?;
    Some(PrintCheck {
        finding: PrintFinding::Slenderness {
            support: support.name.clone(),
            ratio: place.z / width,
            most: slimmest,
        },
        place: without_minus_zero(place),
        value_mm: width,
        wanted_mm: wanted,
        limit_mm: wanted,
        ok: width >= wanted,
    })
}
