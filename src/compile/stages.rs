//! Stages that several goals have in common.

use super::built::Built;
use super::certificates::{Settled, settled};
use super::progress::Progress;
use super::sight::{Shape, Sight, see};
use crate::bvh::Bvh;
use crate::carve::{Forest, ViewRelief, Whole, carve, joined};
use crate::diag::Diagnostic;
use crate::scene::Scene;
use crate::viewmap::SupportField;
use crate::words::carrier::carrier;
use crate::words::coverage::warnings;
use rayon::prelude::*;

/// What every eye sees, and who gets what several want.
///
/// # Errors
/// All that keeps views from being seen or settled.
pub fn seen<'a>(
    scene: &'a Scene,
    field: &SupportField,
    progress: Progress,
) -> Result<(Vec<Sight<'a>>, Settled), Vec<Diagnostic>> {
    progress("view maps", 0.02);
    let mut sights = all(scene.views.par_iter().map(|v| see(v, field, scene.whole)))?;
    let settled = settled(scene, &mut sights, field)?;
    Ok((sights, settled))
}

/// What of the models nothing will carry, as warnings: for goals that do not judge the finished forest.
pub fn missing(scene: &Scene, field: &SupportField, sights: &[Sight]) -> Vec<Diagnostic> {
    let carrier = carrier(&scene.supports);
    let of = |s: &Sight| warnings(&s.view.name, &s.coverage(scene, field, &[]), carrier);
    sights.par_iter().flat_map_iter(of).collect()
}

/// Depths, reliefs and solids.
///
/// # Errors
/// All depths that cannot be found, or why there are no solids.
pub fn built<'a>(
    scene: &'a Scene,
    field: &'a SupportField<'a>,
    sights: Vec<Sight<'a>>,
    progress: Progress,
) -> Result<Built<'a>, Vec<Diagnostic>> {
    progress("quadratic programs", 0.15);
    let shapes = all(sights.par_iter().map(|s| s.shape(scene, field)))?;
    progress("solids", 0.45);
    let forest = solids(field, &sights, &shapes)?;
    Ok(Built {
        bvh: Bvh::new(forest.whole.mesh()),
        scene,
        field,
        sights,
        shapes,
        forest,
    })
}

/// Reliefs or whole meshes as solids.
fn solids(
    field: &SupportField,
    sights: &[Sight],
    shapes: &[Shape],
) -> Result<Forest, Vec<Diagnostic>> {
    let both = || sights.iter().zip(shapes);
    let wholes: Option<Vec<Whole>> = both().map(|(s, r)| s.joined(r)).collect();
    let forest = match wholes {
        Some(wholes) => joined(field, &wholes),
        None => {
            let reliefs: Vec<ViewRelief> = both().map(|(s, r)| s.relief(&r.relief)).collect();
            carve(field, &reliefs)
        }
    };
    forest.map_err(|e| {
        let error = Diagnostic::error(e.to_string());
        let crossings = shapes.iter().filter_map(|s| s.crossings);
        let pairs: usize = crossings.map(|c| c.self_intersections).sum();
        let whole = shapes.iter().any(|s| s.whole.is_some());
        vec![if whole && pairs > 0 {
            error.help(format!(
                "whole meshes cross themselves at {pairs} pairs of faces: `ordering: true` in `energy` prevents it"
            ))
        } else {
            error
        }]
    })
}

/// All results, or all errors of all views.
fn all<T: Send>(
    results: impl ParallelIterator<Item = Result<T, Vec<Diagnostic>>>,
) -> Result<Vec<T>, Vec<Diagnostic>> {
    let results: Vec<_> = results.collect();
    let (good, bad): (Vec<_>, Vec<_>) = results.into_iter().partition(Result::is_ok);
    if bad.is_empty() {
        Ok(good.into_iter().flatten().collect())
    } else {
        Err(bad.into_iter().filter_map(Result::err).flatten().collect())
    }
}
