//! Stages that several goals have in common.

use super::built::Built;
use super::certificates::{Settled, settled};
use super::progress::Progress;
use super::sight::{carried, optimise, see};
use crate::bvh::Bvh;
use crate::carve::{Forest, Operand, carve};
use crate::diag::Diagnostic;
use crate::kinds::Optimised;
use crate::scene::Scene;
use crate::sight::Sight;
use crate::viewmap::SupportField;
use crate::words;
use crate::words::carrier::carrier;
use crate::words::coverage::warnings;
use rayon::prelude::*;

/// What every eye sees, and who gets what several want.
///
/// # Errors
/// All that keeps views from being seen or settled.
pub(crate) fn seen<'a>(
    scene: &'a Scene,
    field: &'a SupportField<'a>,
    progress: Progress,
) -> Result<(Vec<Sight<'a>>, Settled), Vec<Diagnostic>> {
    progress("view maps", 0.02);
    let sights = all(scene.views.par_iter().map(|v| see(v, field, scene)))?;
    progress("contested surface", 0.12);
    settled(scene, sights)
}

/// What of the models nothing will carry, as warnings: for goals that do not judge the finished forest.
pub(crate) fn missing(scene: &Scene, sights: &[Sight]) -> Vec<Diagnostic> {
    let carrier = carrier(&scene.supports);
    let of = |s: &Sight| warnings(s.name(), &carried(s, scene, &[]), carrier);
    sights.par_iter().flat_map_iter(of).collect()
}

/// Depths, reliefs and solids.
///
/// # Errors
/// All depths that cannot be found, or why there are no solids.
pub(crate) fn built<'a>(
    scene: &'a Scene,
    field: &'a SupportField<'a>,
    sights: &'a [Sight<'a>],
    progress: Progress,
) -> Result<Built<'a>, Vec<Diagnostic>> {
    progress("quadratic programs", 0.15);
    let shapes = all(sights.par_iter().map(|s| optimise(s, scene)))?;
    progress("solids", 0.45);
    let forest = solids(field, &shapes, scene.making.line)?;
    Ok(Built {
        bvh: Bvh::new(forest.whole.mesh()),
        scene,
        field,
        sights,
        shapes,
        forest,
    })
}

/// The forest of what every view puts on the supports; `line` is the finest that can be made, millimetres.
fn solids(
    field: &SupportField,
    shapes: &[Box<dyn Optimised + '_>],
    line: f64,
) -> Result<Forest, Vec<Diagnostic>> {
    let operands: Vec<Operand> = shapes.iter().map(|s| s.operand()).collect();
    carve(field, &operands, line).map_err(|e| {
        let crossing = |(shape, operand): (&dyn Optimised, &Operand)| match operand {
            Operand::Mesh { .. } => shape.crossings().map_or(0, |c| c.self_intersections),
            Operand::Relief { .. } => 0,
        };
        let pairs = shapes
            .iter()
            .map(AsRef::as_ref)
            .zip(&operands)
            .map(crossing)
            .sum();
        vec![words::solids::unsound(&e, pairs)]
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
