//! What eyes see that do not stand in their places: tolerance and camouflage, with their picture.

use super::built::Built;
use super::output::OutputFile;
use crate::certify::camouflage::{Camouflage, camouflage};
use crate::certify::tolerance::{Movement, Tolerance, confirm, tolerance};
use crate::diagram::curves::{Curve, curves};
use crate::relief::Relief;
use crate::report::CertificateReport;
use crate::scene::Scene;
use crate::sight::Sight;
use crate::support::SupportKind;
use crate::view::View;
use crate::viewmap::Image;
use rayon::prelude::*;

/// Width of camouflage.png, pixels.
const CAMOUFLAGE_PX: u32 = 1600;

/// The tolerance of a view, confirmed by rays at the forest.
pub(crate) fn confirmed_tolerance(built: &Built, sight: &Sight, relief: &Relief) -> Tolerance {
    let supports = &built.scene.supports;
    let Image {
        view, map, target, ..
    } = &sight.image;
    let mut found = tolerance(view, map, target, relief, supports);
    let mesh = built.forest.whole.mesh();
    confirm(&mut found, &map.plane, mesh, &built.bvh);
    found
}

/// How far eyes may move on the level with the picture still one, millimetres; none where nothing ever opens, and for eyes at infinity.
pub(crate) fn rooms(certificates: &[CertificateReport]) -> Vec<Option<f64>> {
    let room = |c: &CertificateReport| {
        let Movement { side, fore, .. } = c.tolerance.one_picture_mm;
        side.into_iter().chain(fore).reduce(f64::min)
    };
    let has_place = |c: &&CertificateReport| c.tolerance.one_picture_deg.is_none();
    let room = |c: &CertificateReport| Some(c).filter(has_place).and_then(room);
    certificates.iter().map(room).collect()
}

/// The camouflage of every view, if the scene wants it.
pub(crate) fn camouflages(built: &Built) -> Vec<Camouflage> {
    let (scene, whole) = (built.scene, &built.forest.whole);
    if !scene.output.camouflage {
        return Vec::new();
    }
    let floor = scene.supports.iter().find_map(|s| match s.kind {
        SupportKind::Base { top, .. } => Some(top),
        SupportKind::Pillar { .. } | SupportKind::Body { .. } => None,
    });
    let floor = floor.unwrap_or(whole.bounds().0.z);
    let views = scene.views.par_iter();
    views
        .map(|v| camouflage(v, whole.mesh(), &built.bvh, floor))
        .collect()
}

/// `camouflage.svg` and `camouflage.png`, if there is any.
pub(crate) fn camouflage_files(scene: &Scene, found: &[Camouflage]) -> Vec<OutputFile> {
    if found.is_empty() {
        return Vec::new();
    }
    let curve = |(of_view, view): (&Camouflage, &View)| Curve {
        name: view.name.clone(),
        colour: view.colour,
        points: of_view
            .curve
            .iter()
            .map(|p| (p.angle_deg, p.likeness))
            .collect(),
        half_deg: of_view.half_likeness_deg,
        worst: of_view.worst_off_view_deg.zip(of_view.worst_likeness),
    };
    let list: Vec<Curve> = found.iter().zip(&scene.views).map(curve).collect();
    let drawing = curves(&scene.title, &list);
    vec![
        OutputFile::new("camouflage.svg", drawing.svg(&scene.title).into_bytes()),
        OutputFile::new("camouflage.png", drawing.png(CAMOUFLAGE_PX)),
    ]
}
