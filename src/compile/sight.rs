//! One view on its way through the stages that concern it alone, with what goes wrong in words.

use crate::certify::coverage::{Coverage, coverage};
use crate::diag::Diagnostic;
use crate::geom::SQUARE_ARCMIN;
use crate::index::{CellId, SupportId};
use crate::kinds::Optimised;
use crate::scene::Scene;
use crate::sight::{Loss, Sight};
use crate::view::View;
use crate::viewmap::SupportField;
use crate::words;

/// Projects, maps and groups one view, and holds what its kind of relief holds.
///
/// # Errors
/// If the models do not lie before the eye, nothing of them is seen, no support carries or holds them, or they cannot stay whole.
pub(crate) fn see<'a>(
    view: &'a View,
    field: &'a SupportField<'a>,
    scene: &Scene,
) -> Result<Sight<'a>, Vec<Diagnostic>> {
    let (name, supports) = (&view.name, field.supports);
    let sight = Sight::new(view, field).map_err(|e| words::sight::unseen(name, supports, &e))?;
    if sight.groups.bounds.is_empty() {
        return Err(vec![words::sight::all_free(name, supports)]);
    }
    let held = scene.relief.held(sight);
    held.map_err(|e| vec![words::sight::split(name, supports, e)])
}

/// Leaves cells to other views.
///
/// # Errors
/// If nothing is left, or the view's meshes are not cut.
pub(crate) fn give_up<'a>(
    sight: Sight<'a>,
    lost: Vec<Loss>,
    scene: &Scene,
) -> Result<Sight<'a>, Diagnostic> {
    if !lost.is_empty() && !scene.relief.gives_way() {
        return Err(words::contest::indivisible(sight.name()));
    }
    let left = sight.without(lost);
    if left.groups.groups.is_empty() {
        return Err(words::contest::nothing_left(left.name()));
    }
    Ok(left)
}

/// Optimises, cuts and scales back.
///
/// # Errors
/// If no surface lies within all bounds, or the solver gives up.
pub(crate) fn optimise<'a>(
    sight: &'a Sight<'a>,
    scene: &Scene,
) -> Result<Box<dyn Optimised + 'a>, Vec<Diagnostic>> {
    let found = scene.relief.optimised(sight);
    found.map_err(|e| vec![words::sight::unsolved(sight, &e)])
}

/// Warnings of free parts that an eye sees before a support by themselves, so that nothing holds them to it.
pub(crate) fn unheld(sights: &[Sight], scene: &Scene) -> Vec<Diagnostic> {
    let least = scene.seen_arcmin.powi(2) / SQUARE_ARCMIN;
    let warning = |sight: &Sight| {
        let groups = sight.groups.unheld();
        let groups = groups.iter().map(|g| &sight.groups.groups[*g]);
        let wide = groups.filter(|g| g.solid_angle_sr > least);
        let mut on: Vec<SupportId> = wide.map(|g| g.support).collect();
        on.sort_unstable();
        on.dedup();
        (!on.is_empty()).then(|| words::sight::unheld(sight, &on))
    };
    sights.iter().filter_map(warning).collect()
}

/// Warnings of iterations that did not converge.
pub(crate) fn unsettled(sights: &[Sight], shapes: &[Box<dyn Optimised + '_>]) -> Vec<Diagnostic> {
    let views = sights.iter().zip(shapes.iter().map(AsRef::as_ref));
    let warning = |(sight, shape): (&Sight, &dyn Optimised)| {
        words::iterated::unsettled(sight.name(), shape.depths().iterated.as_ref()?)
    };
    views.filter_map(warning).collect()
}

/// What of the models a support carries, and why the rest is not. `given_up` are cells without relief in the solid.
pub(crate) fn carried(sight: &Sight, scene: &Scene, given_up: &[CellId]) -> Coverage {
    let views: Vec<&str> = scene.views.iter().map(|v| v.name.as_str()).collect();
    coverage(sight, &views, given_up, scene.seen_arcmin)
}
