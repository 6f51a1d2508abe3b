//! Finds depths, by the energy wanted.

use super::depths::Depths;
use super::energy::{Energy, NormalOptions};
use super::keeping::Keeping;
use super::opening::Opening;
use super::ordering::{Order, Orders};
use super::program::Program;
use super::solve::SolveError;
use super::{compress, curvature, gradient, normal};
use crate::sight::Sight;

/// Finds the depths that minimise `energy` within the groups' bounds.
///
/// # Errors
/// If the program is infeasible or the solver gives up; the error names the row that stands in the way.
pub fn depths(energy: Energy, sight: &Sight, keeping: &Keeping) -> Result<Depths, SolveError> {
    match energy {
        Energy::Normal(options) => {
            normal::depths(options, sight, keeping, None).map(|found| found.0)
        }
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
    normal::depths(options, sight, &Keeping::seen(orders), Some(opening)).map(|found| found.0)
}

/// The quadratic program that [`depths`] solves, with all the rows that its solution came to; of an energy that is reweighted the last one,
/// of one that is iterated the first. None where depths are not the optimum of a program.
///
/// # Errors
/// As [`depths`].
pub fn program_of(
    energy: Energy,
    sight: &Sight,
    keeping: &Keeping,
) -> Result<Option<Program>, SolveError> {
    match energy {
        Energy::Normal(options) => {
            normal::depths(options, sight, keeping, None).map(|found| Some(found.1))
        }
        Energy::Curvature(options) => curvature::program(options, sight, keeping).map(Some),
        Energy::Linear | Energy::Gradient(_) => Ok(None),
    }
}
