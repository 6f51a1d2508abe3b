//! The last line for the terminal.

use super::pictures::Pictures;
use crate::carve::Forest;
use crate::scene::Scene;
use crate::support::SupportKind;

pub(crate) fn pillars(scene: &Scene) -> usize {
    scene
        .supports
        .iter()
        .filter(|s| matches!(s.kind, SupportKind::Pillar { .. }))
        .count()
}

/// What reliefs are carried by: "27 pillars", "1 support", or both.
pub(crate) fn carriers(scene: &Scene) -> String {
    let bodies = scene.supports.iter().filter(|s| s.is_body()).count();
    let pillars = pillars(scene);
    let plural = if bodies == 1 { "" } else { "s" };
    match (pillars, bodies) {
        (_, 0) => format!("{pillars} pillars"),
        (0, _) => format!("{bodies} support{plural}"),
        _ => format!("{pillars} pillars, {bodies} other support{plural}"),
    }
}

pub(crate) fn counts(scene: &Scene) -> String {
    format!("{}, {} views", carriers(scene), scene.views.len())
}

/// What was made, and how like it is.
pub(crate) fn headline(scene: &Scene, forest: &Forest, pictures: &[Pictures]) -> String {
    let (lo, hi) = forest.whole.bounds();
    let size = hi - lo;
    let likeness: Vec<String> = scene
        .views
        .iter()
        .zip(pictures)
        .map(|(v, p)| format!("{} {:.1} deg", v.name, p.likeness.mean_deg))
        .collect();
    format!(
        "{}, {:.0} x {:.0} x {:.0} mm, {:.0} cm3, watertight; {}",
        carriers(scene),
        size.x,
        size.y,
        size.z,
        forest.whole.volume_mm3() / 1000.0,
        likeness.join(" / ")
    )
}
