//! Whether pillars stand: their least width against their height.

use super::check::{PrintCheck, PrintFinding, PrintLimits};
use crate::certify::point::without_minus_zero;
use crate::geom::narrowest;
use crate::support::{Support, SupportKind};

/// The pillar whose least width is the smallest share of what its height wants.
pub(crate) fn slenderness(supports: &[Support], limits: &PrintLimits) -> Option<PrintCheck> {
    let pillars = supports.iter().filter_map(|s| match &s.kind {
        SupportKind::Pillar {
            axis, profile, top, ..
        } => {
            let (width, height) = (narrowest(profile), top.max(0.0));
            Some((s, axis.extend(height), width, height / limits.slimmest))
        }
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    });
    let (support, place, width, wanted) =
        pillars.min_by(|a, b| (a.2 / a.3).total_cmp(&(b.2 / b.3)))?;
    Some(PrintCheck {
        finding: PrintFinding::Slenderness {
            support: support.name.clone(),
            ratio: place.z / width,
            most: limits.slimmest,
        },
        place: without_minus_zero(place),
        value_mm: width,
        wanted_mm: wanted,
        limit_mm: wanted,
        ok: width >= wanted,
    })
}
