//! Solving a program: the only module that names `clarabel`.

use super::program::{Program, RowKind};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};
use sprs::{CsMat, TriMat};

/// More iterations than any program met so far needed (15-60).
const MAX_ITERATIONS: u32 = 200;

/// What the solver reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    pub variables: usize,
    pub rows: usize,
    /// Rows with a positive multiplier.
    pub active: usize,
    pub iterations: u32,
    pub objective: f64,
    pub primal_residual: f64,
    pub dual_residual: f64,
    /// Relative gap between primal and dual objective.
    pub gap: f64,
}

/// Why there is no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The rows contradict each other; the one with the largest share in the contradiction.
    #[error("no depths satisfy all bounds")]
    Infeasible(Option<RowKind>),
    #[error("the solver stopped without a solution: {0}")]
    Unsolved(String),
}

impl SolveError {
    /// The same without the row it names.
    pub fn without_row(self) -> Self {
        match self {
            Self::Infeasible(_) => Self::Infeasible(None),
            other => other,
        }
    }
}

/// Solves the program; gives its variables.
pub fn solve(program: &Program) -> Result<(Vec<f64>, Solved), SolveError> {
    let p = csc(&program.quadratic);
    let (a, b) = constraints(program);
    let cones = [
        ZeroConeT(program.equalities.len()),
        NonnegativeConeT(program.rows.len()),
    ];
    let settings = DefaultSettings {
        verbose: false,
        max_iter: MAX_ITERATIONS,
        max_threads: 1,
        direct_solve_method: "faer".into(),
        presolve_enable: false,
        ..DefaultSettings::default()
    };
    let mut solver = DefaultSolver::new(&p, &program.linear, &a, &b, &cones, settings)
        .map_err(|e| SolveError::Unsolved(e.to_string()))?;
    solver.solve();
    let (solution, info) = (&solver.solution, &solver.info);
    let multipliers = &solution.z[program.equalities.len()..];
    match solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {}
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            let worst = (0..multipliers.len())
                .max_by(|i, j| multipliers[*i].abs().total_cmp(&multipliers[*j].abs()));
            return Err(SolveError::Infeasible(worst.map(|i| program.rows[i].kind)));
        }
        other => {
            return Err(SolveError::Unsolved(format!(
                "{other:?} after {} iterations",
                solution.iterations
            )));
        }
    }
    let slacks = &solution.s[program.equalities.len()..];
    let solved = Solved {
        variables: program.variables,
        rows: program.rows.len(),
        active: (0..slacks.len())
            .filter(|i| multipliers[*i] > slacks[*i])
            .count(),
        iterations: solution.iterations,
        objective: solution.obj_val,
        primal_residual: solution.r_prim,
        dual_residual: solution.r_dual,
        gap: info.gap_rel,
    };
    Ok((solution.x.clone(), solved))
}

/// `A` and `b` of `A u + slack = b`: equalities first, then rows.
fn constraints(program: &Program) -> (CscMatrix<f64>, Vec<f64>) {
    let height = program.equalities.len() + program.rows.len();
    let mut triplets = TriMat::new((height, program.variables));
    let lines = program
        .equalities
        .iter()
        .map(|(t, _)| t)
        .chain(program.rows.iter().map(|r| &r.terms));
    for (i, terms) in lines.enumerate() {
        terms
            .iter()
            .for_each(|&(j, v)| triplets.add_triplet(i, j, v));
    }
    let b = program
        .equalities
        .iter()
        .map(|(_, v)| *v)
        .chain(program.rows.iter().map(|r| r.limit))
        .collect();
    (csc(&triplets.to_csc()), b)
}

fn csc(matrix: &CsMat<f64>) -> CscMatrix<f64> {
    let (starts, rows, values) = matrix.clone().into_raw_storage();
    CscMatrix::new(matrix.rows(), matrix.cols(), starts, rows, values)
}
