//! Whether pillars stand: their least width against their height.

use super::check::{PrintCheck, PrintFinding};
use crate::certify::point::without_minus_zero;
use crate::support::{Support, SupportKind, pillar_width};

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
            let (width, height) = (pillar_width(*axis, profile, *round), top.max(0.0));
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
