//! What stands on the base, and the printer's bed under it.

use super::checked::Checked;
use crate::diag::Diagnostic;
use crate::geom::to_segment;
use crate::scene::defaults;
use crate::scene::layout::Room;
use crate::scene::resolved::Making;
use crate::scene::supports::{BasePlate, Standing, shapes};
use crate::scene::text::{Reader, error_at, short, warning_at};
use glam::DVec2;

/// Every pillar must stand on the base.
pub(crate) fn standing(reader: &mut Reader, pillars: &[Standing], base: &BasePlate) {
    let mut seen = std::collections::BTreeSet::new();
    for pillar in pillars {
        let on = pillar
            .profile
            .iter()
            .filter(|p| shapes::contains(&base.outline, **p))
            .count();
        if on == pillar.profile.len() || !seen.insert((pillar.span.start, on == 0)) {
            continue;
        }
        let where_ = format!("({}, {})", short(pillar.axis.x), short(pillar.axis.y));
        let help =
            "enlarge the base, leave its size out (it then fits all pillars), or move the pillar";
        reader.problems.push(if on == 0 {
            error_at(
                &pillar.span,
                format!("{} at {where_} stands beside the base", pillar.name),
            )
            .help(help)
        } else {
            warning_at(
                &pillar.span,
                format!(
                    "{} at {where_} hangs over the edge of the base",
                    pillar.name
                ),
            )
            .help(help)
        });
    }
}

/// The region must lie on the base.
pub(crate) fn region(room: &Room, base: &BasePlate) -> Option<Diagnostic> {
    let n = base.outline.len();
    let on_rim =
        |p: DVec2| (0..n).any(|i| to_segment(p, base.outline[i], base.outline[(i + 1) % n]) < 1e-6);
    let on = |p: &DVec2| shapes::contains(&base.outline, *p) || on_rim(*p);
    let help = "enlarge the base, leave its size out (it then fits the region), or make the region smaller";
    if shapes::gap(&room.region, &base.outline) > 0.0 {
        return Some(error_at(&room.span, "the region lies beside the base").help(help));
    }
    let hangs = room.region.iter().any(|p| !on(p));
    hangs.then(|| warning_at(&room.span, "the region hangs over the edge of the base").help(help))
}

/// Size of the whole forest against the printer's bed, number of pillars against patience.
pub(crate) fn size(reader: &mut Reader, checked: &Checked, making: &Making) {
    let (pillars, base, room) = (checked.pillars, checked.base, checked.room);
    let points = pillars
        .iter()
        .flat_map(|p| &p.profile)
        .chain(base.iter().flat_map(|b| &b.outline))
        .chain(room.iter().flat_map(|r| &r.region));
    let bounds = points.fold(None, |b: Option<(DVec2, DVec2)>, p| {
        Some(b.map_or((*p, *p), |(l, h)| (l.min(*p), h.max(*p))))
    });
    let Some((lo, hi)) = bounds else { return };
    let standing = pillars.iter().chain(room.iter().flat_map(|r| &r.samples));
    let Some(tallest) = standing.max_by(|a, b| a.height.total_cmp(&b.height)) else {
        return;
    };
    let height = tallest.height + base.map_or(0.0, |b| b.thickness);
    let Some([x, y, z]) = making.limits.bed else {
        return;
    };
    let size = hi - lo;
    let fits = (size.x <= x && size.y <= y) || (size.x <= y && size.y <= x);
    let span = base
        .and_then(|b| b.span.clone())
        .unwrap_or(tallest.span.clone());
    if !fits {
        reader.problems.push(
            warning_at(&span, format!("the forest is {} x {} mm, larger than the printer's bed of {x} x {y} mm", short(size.x), short(size.y)))
                .help("give the size of your printer: `printer: (bed: (300, 300, 300))`, or cut it into plates with `build --split`"),
        );
    }
    if height > z {
        reader.problems.push(
            warning_at(
                &tallest.span,
                format!(
                    "the forest is {} mm tall, taller than the printer's {z} mm",
                    short(height)
                ),
            )
            .help("lower the pillars, or print them in pieces"),
        );
    }
    if pillars.len() as u64 > defaults::MANY_PILLARS {
        reader.problems.push(
            warning_at(
                &span,
                format!(
                    "{} pillars: slicers take hours for more than about {}",
                    pillars.len(),
                    defaults::MANY_PILLARS
                ),
            )
            .help("fewer, thicker pillars show models as well"),
        );
    }
}
