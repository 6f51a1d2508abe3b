//! Finds depths, by the energy wanted.

use super::depths::Depths;
use super::energy::{Energy, NormalOptions};
use super::keeping::Keeping;
use super::opening::Opening;
use super::ordering::{Order, Orders};
use super::solve::SolveError;
use super::{compress, curvature, gradient, normal};
use crate::sight::Sight;

/// Finds the depths that minimise `energy` within the groups' bounds.
///
/// # Errors
/// If the program is infeasible or the solver gives up; the error names the row that stands in the way.
pub fn depths(energy: Energy, sight: &Sight, keeping: &Keeping) -> Result<Depths, SolveError> {
    match energy {
        Energy::Normal(options) => normal::depths(options, sight, keeping, None),
        Energy::Curvature(options) => curvature::depths(options, sight, keeping),
        Energy::Linear => compress::linear(sight),
        Energy::Gradient(options) => gradient::depths(options, sight),
    }
}

/// [`depths`] of a mesh cut at the outlines of supports, under [`Energy::Normal`]. Every piece has its own scale then, so that
/// those of the groups are 1.
///
/// # Errors
/// As [`depths`].
pub fn opened_depths(
    options: NormalOptions,
    sight: &Sight,
    orders: &[Order],
    opening: &Opening,
) -> Result<Depths, SolveError> {
    let orders = Orders {
        all: orders.to_vec(),
        nearest: orders.len(),
    };
    normal::depths(options, sight, &Keeping::seen(orders), Some(opening))
}
