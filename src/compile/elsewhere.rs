//! What eyes see that do not stand in their places: tolerance and camouflage, with their picture.

use super::OutputFile;
use super::files::file;
use super::sight::{Shape, Sight};
use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::certify::camouflage::{Camouflage, camouflage};
use crate::certify::tolerance::{Movement, Tolerance, confirm, tolerance};
use crate::diagram::curves::{Curve, curves};
use crate::scene::Scene;
use crate::support::SupportKind;
use crate::view::View;
use rayon::prelude::*;

/// Width of camouflage.png, pixels.
const CAMOUFLAGE_PX: u32 = 1600;

/// The tolerance of every view, confirmed by rays at the forest, whose `bvh` is given.
pub fn tolerances(
    scene: &Scene,
    sights: &[Sight],
    shapes: &[Shape],
    forest: &Forest,
    bvh: &Bvh,
) -> Vec<Tolerance> {
    let of_view = |(s, shape): (&Sight, &Shape)| {
        let supports = &scene.supports;
        let mut found = tolerance(s.view, &s.map, &s.target, &shape.relief, supports);
        confirm(&mut found, &s.map.plane, forest.whole.mesh(), bvh);
        found
    };
    sights.par_iter().zip(shapes).map(of_view).collect()
}

/// How far eyes may move on the level with the picture still one, millimetres; none where nothing ever opens.
pub fn rooms(tolerances: &[Tolerance]) -> Vec<Option<f64>> {
    let room = |t: &Tolerance| {
        let Movement { side, fore, .. } = t.one_picture_mm;
        side.into_iter().chain(fore).reduce(f64::min)
    };
    tolerances.iter().map(room).collect()
}

/// The camouflage of every view.
pub fn camouflages(scene: &Scene, forest: &Forest, bvh: &Bvh) -> Vec<Camouflage> {
    let mesh = forest.whole.mesh();
    let floor = scene.supports.iter().find_map(|s| match s.kind {
        SupportKind::Base { top, .. } => Some(top),
        SupportKind::Pillar { .. } => None,
    });
    let floor = floor.unwrap_or(forest.whole.bounds().0.z);
    let views = scene.views.iter();
    views.map(|v| camouflage(v, mesh, bvh, floor)).collect()
}

/// `camouflage.svg` and `camouflage.png`.
pub fn camouflage_files(scene: &Scene, found: &[Camouflage]) -> Vec<OutputFile> {
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
        file("camouflage.svg", drawing.svg(&scene.title).into_bytes()),
        file("camouflage.png", drawing.png(CAMOUFLAGE_PX)),
    ]
}
