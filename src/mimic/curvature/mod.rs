//! The paper's curvature energy (Eq 9, weights Eq 13) in relative depths `s`, on the whole mesh, and its variants.
//!
//! Row of vertex `i`: `w_i / sqrt(A_i) * sum over j of c_ij v_j (s_j - s_i)`, three coordinates, `v_j` from the eye. With
//! `s = lambda / lambda0` instead of `lambda` this is the same problem, better scaled; written in differences it is exactly
//! zero for `s = 1`. The unknowns are what `s` and `mu` differ from a surface (1 at first) in units of a layer's typical width.
//! Bounds are Eq 11. The gauge is a mean of 1 of the area-weighted `s` over each block of components and groups that hang
//! together: the paper pins one vertex, but then the result depends on which.
//!
//! Variants: without the term `lambda_i / lambda0_i` of Eq 7 (Fig 5) the energy is not scale invariant, so that there is nothing
//! to be fixed by a gauge: it determines every depth itself, of every component. Without scales of groups bounds are absolute (Eq
//! 10) and fix what they reach. With the mean curvature (Eq 7 against Eq 9,
//! Fig 7) rows are divided by `H0_i`, never by less than a share of its mean (see [`sheet`]). `iterate` and the conic form
//! (appendix, Eq 17) have their own modules.

mod iterate;
mod problem;
mod sheet;

use super::depths::Depths;
use super::energy::CurvatureOptions;
use super::keeping::Keeping;
use super::program::Program;
use super::solve::SolveError;
use crate::sight::Sight;
use problem::Problem;

/// Depths of the whole mesh.
///
/// # Errors
/// If the first program is infeasible or cannot be solved. What befalls later ones of an iteration is told in the result.
pub(crate) fn depths(
    options: CurvatureOptions,
    sight: &Sight,
    keeping: &Keeping,
) -> Result<Depths, SolveError> {
    let problem = Problem::new(options, sight, keeping);
    let (first, _) = problem.first()?;
    if options.iterate == 0 {
        return Ok(first);
    }
    Ok(iterate::iterated(&problem, first))
}

/// The linearised problem with all the rows that its solution came to.
///
/// # Errors
/// As [`depths`].
pub(crate) fn program(
    options: CurvatureOptions,
    sight: &Sight,
    keeping: &Keeping,
) -> Result<Program, SolveError> {
    Ok(Problem::new(options, sight, keeping).first()?.1)
}
