//! Proof that a solution is the optimum, from its multipliers alone: nothing is believed that the solver says of itself.
//!
//! For `min u'Pu / 2 + q'u` with rows `A u <= b` and equalities `E u = e`, multipliers `z >= 0` and `y`:
//! the primal residual is the largest row or equality broken, the dual residual the largest entry of `P u + q + A'z + E'y`, and
//! `u'Pu / 2 + q'u` exceeds the optimum by at most the duality gap `u'Pu + q'u + b'z + e'y`, but for what the residuals amount
//! to. Unknowns have a layer's width as their unit (normal energy) or the model's depth (curvature), the mean diagonal of `P` is
//! about 1.

use super::program::{Program, times};

/// What residuals and gap of an optimum must be below.
const PROVED: f64 = 1e-6;

/// Residuals and gap of a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Optimality {
    pub objective: f64,
    /// Rows with a positive multiplier.
    pub active: usize,
    pub primal_residual: f64,
    pub dual_residual: f64,
    /// Relative to the objective where that is above 1.
    pub gap: f64,
}

impl Optimality {
    /// Whether residuals and gap are small enough for a solution to count as the optimum; not a number is not.
    pub(crate) fn is_proof(&self) -> bool {
        [self.primal_residual, self.dual_residual, self.gap]
            .iter()
            .all(|part| *part <= PROVED)
    }
}

/// Measures a solution `u` with multipliers of rows and equalities.
pub fn optimality(program: &Program, u: &[f64], z: &[f64], y: &[f64]) -> Optimality {
    let at = |terms: &[(usize, f64)]| terms.iter().map(|(j, v)| v * u[*j]).sum::<f64>();
    let pu = times(&program.quadratic, u);
    let mut gradient: Vec<f64> = pu.iter().zip(&program.linear).map(|(p, q)| p + q).collect();
    let (mut primal_residual, mut active, mut bound) = (0.0f64, 0, 0.0);
    for (row, z) in program.rows.iter().zip(z) {
        let excess = at(&row.terms) - row.limit;
        primal_residual = primal_residual.max(excess);
        active += usize::from(*z > -excess);
        bound += row.limit * z;
        row.terms.iter().for_each(|(j, v)| gradient[*j] += v * z);
    }
    for ((terms, value), y) in program.equalities.iter().zip(y) {
        primal_residual = primal_residual.max((at(terms) - value).abs());
        bound += value * y;
        terms.iter().for_each(|(j, v)| gradient[*j] += v * y);
    }
    let square: f64 = u.iter().zip(&pu).map(|(u, p)| u * p).sum();
    let linear: f64 = u.iter().zip(&program.linear).map(|(u, q)| u * q).sum();
    let objective = square / 2.0 + linear;
    Optimality {
        objective,
        active,
        primal_residual,
        dual_residual: gradient.iter().fold(0.0, |a, g| a.max(g.abs())),
        gap: (square + linear + bound).abs() / objective.abs().max(1.0),
    }
}
