//! Necks: carved pillars where they are thinnest.
//!
//! Takes a pillar with its reliefs, because the backing of a relief carries as well as the pillar it replaces. Gives the section
//! whose widest inscribed circle is the smallest: a neck, wherever in the section it lies.

use super::check::{PrintCheck, PrintFinding, Printed};
use crate::certify::point::without_minus_zero;
use crate::geom::inscribed;
use crate::index::FaceId;
use crate::mesh::TriMesh;
use crate::support::SupportKind;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Distance between sections, millimetres: a neck of any strength is longer.
const STEP_MM: f64 = 0.5;
/// Error of a section's width, millimetres.
const PRECISION_MM: f64 = 0.01;
/// Heights are shifted by this, millimetres: a plane through a vertex tells nothing of its two sides.
const OFF_VERTICES_MM: f64 = 0.001_234_5;

/// The pillar whose thinnest section leaves least beyond its layer's core.
pub(crate) fn core(printed: &Printed) -> Option<PrintCheck> {
    let found: Vec<_> = printed
        .supports
        .par_iter()
        .zip(printed.standing)
        .filter_map(|(support, mesh)| {
            let SupportKind::Pillar { bottom, top, .. } = support.kind else {
                return None;
            };
            let wanted = support.layer?.core;
            Some((support, thinnest(mesh, bottom.max(0.0), top)?, wanted))
        })
        .collect();
    let (support, neck, wanted) = found
        .into_iter()
        .min_by(|a, b| (a.1.width - a.2).total_cmp(&(b.1.width - b.2)))?;
    Some(PrintCheck {
        finding: PrintFinding::Core {
            support: support.name.clone(),
            area_mm2: neck.area,
        },
        place: without_minus_zero(neck.place),
        value_mm: neck.width,
        wanted_mm: wanted,
        limit_mm: wanted,
        ok: neck.width >= wanted,
    })
}

/// A pillar where it is thinnest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neck {
    /// Middle of the widest circle.
    pub place: DVec3,
    /// Diameter of that circle, millimetres.
    pub width: f64,
    /// Square millimetres of the whole section.
    pub area: f64,
}

/// The thinnest section between two heights; `None` if they lie closer than two steps.
pub(crate) fn thinnest(mesh: &TriMesh, bottom: f64, top: f64) -> Option<Neck> {
    let count = ((top - bottom) / STEP_MM) as usize;
    let height = |k: usize| bottom + STEP_MM * (k as f64 + 0.5) + OFF_VERTICES_MM;
    let mut worst: Option<Neck> = None;
    for (k, outline) in outlines(mesh, count, bottom, height).iter().enumerate() {
        let enough = worst.map_or(f64::INFINITY, |w| w.width / 2.0);
        let circle = inscribed(outline, PRECISION_MM / 2.0, enough);
        let width = circle.map_or(0.0, |c| 2.0 * c.radius);
        if worst.is_none_or(|w| width < w.width) {
            let centre = circle.map_or_else(|| middle(mesh), |c| c.centre);
            worst = Some(Neck {
                place: centre.extend(height(k)),
                width,
                area: area(outline),
            });
        }
    }
    worst
}

fn middle(mesh: &TriMesh) -> DVec2 {
    mesh.bounds()
        .map_or(DVec2::ZERO, |(lo, hi)| ((lo + hi) / 2.0).truncate())
}

/// The outline at each height, as segments with the material on their left.
fn outlines(
    mesh: &TriMesh,
    count: usize,
    bottom: f64,
    height: impl Fn(usize) -> f64,
) -> Vec<Vec<[DVec2; 2]>> {
    let mut outlines = vec![Vec::new(); count];
    for face in FaceId::all(mesh.faces.len()) {
        let corners = mesh.corners(face);
        let low = corners.iter().map(|c| c.z).fold(f64::INFINITY, f64::min);
        let high = corners
            .iter()
            .map(|c| c.z)
            .fold(f64::NEG_INFINITY, f64::max);
        let first = ((low - bottom) / STEP_MM - 1.0).max(0.0) as usize;
        for k in (first..count).take_while(|k| height(*k) <= high) {
            outlines[k].extend(cut(&corners, height(k)));
        }
    }
    outlines
}

/// Where a face crosses a height: on the left of the way from the upward to the downward crossing lies what the face bounds.
fn cut(corners: &[DVec3; 3], z: f64) -> Option<[DVec2; 2]> {
    let (mut up, mut down) = (None, None);
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if (a.z > z) == (b.z > z) {
            continue;
        }
        // From the lower end on, so that both faces at an edge cut it in the same point.
        let (low, high) = if a.z > z { (b, a) } else { (a, b) };
        let at = low.lerp(high, (z - low.z) / (high.z - low.z)).truncate();
        *(if b.z > z { &mut up } else { &mut down }) = Some(at);
    }
    Some([down?, up?])
}

/// Area inside of directed segments, square millimetres.
fn area(outline: &[[DVec2; 2]]) -> f64 {
    let twice: f64 = outline.iter().map(|[a, b]| a.perp_dot(*b)).sum();
    (twice / 2.0).abs()
}
