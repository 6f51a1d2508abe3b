//! Depths as a result, and what every energy needs to find them.

use super::conditions::Condition;
use super::iterated::Iterated;
use super::solve::Solved;
use crate::groups::Groups;
use crate::index::GroupId;
use crate::viewmap::Image;

/// The optimised depths of one view.
#[derive(Clone, Debug)]
pub struct Depths {
    /// Relative depth of every target vertex; 1 where the vertex takes no part.
    pub s: Vec<f64>,
    /// Scale of every group; positive.
    pub mu: Vec<f64>,
    pub solved: Solved,
    /// How an iteration of the Laplacian went, if there was one.
    pub iterated: Option<Iterated>,
}

/// The solid angle seen of every face, steradians.
pub(crate) fn seen_solid_angles(image: &Image) -> Vec<f64> {
    let Image { target, map, .. } = image;
    let mut seen = vec![0.0; target.mesh.faces.len()];
    for (c, cell) in map.all() {
        if let Some(f) = cell.face {
            seen[f] += map.solid_angle(c);
        }
    }
    seen
}

/// The median width of the bounds in log depth, but no less than `least`: the unit of all unknowns, so that the solver's tolerances
/// mean the same in every scene.
pub(crate) fn typical_width(groups: &Groups, least: f64) -> f64 {
    let widths = groups.bounds.iter().map(|b| (b.upper / b.lower).ln());
    let mut widths: Vec<f64> = widths.filter(|w| w.is_finite()).collect();
    widths.sort_by(f64::total_cmp);
    widths
        .get(widths.len() / 2)
        .copied()
        .filter(|w| *w > 0.0)
        .map_or(1.0, |w| w.max(least))
}

/// The smallest scale that keeps a group within its upper bounds (the paper's choice among equal optima: as close to the
/// support as the layer allows), in closed form because a regulariser does not determine it to the last digits. Groups that
/// an order ties to another keep the scale `free` of the solution.
pub(crate) fn scales(
    groups: &Groups,
    conditions: &[Condition],
    s: &[f64],
    free: impl Fn(GroupId) -> f64,
) -> Vec<f64> {
    let mut mu = vec![f64::MIN_POSITIVE; groups.groups.len()];
    for bound in &groups.bounds {
        let slot = &mut mu[bound.group];
        *slot = slot.max(bound.anchor.relative_depth(s) / bound.upper);
    }
    // A group of free vertices only has nothing to be scaled to.
    let unbounded = mu.iter_mut().filter(|mu| **mu == f64::MIN_POSITIVE);
    unbounded.for_each(|mu| *mu = 1.0);
    let tied = conditions.iter().filter_map(Condition::between_groups);
    tied.flatten().for_each(|g| mu[g] = free(g));
    mu
}
