//! What a solution of a program is, and finding it by the interior point: the only module that names `clarabel`.

use super::certificate::Optimality;
use super::conic::conic;
use super::program::{Program, Row, RowKind};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT, ZeroConeT,
};
use sprs::{CsMat, TriMat};

/// More iterations than any program met so far needed (15-60).
const MAX_ITERATIONS: u32 = 200;

/// Gap and residuals at which the conic form ends. Its gap is that of `v`, half a squared length: at the solver's own 1e-8 unknowns
/// have four digits, and the certificate refuses them.
const CONIC_TOLERANCE: f64 = 1e-11;

/// Rows with a smaller share in a contradiction than this, of the largest, are rounding: true shares differ by the weights of corners.
const MATTERS: f64 = 1e-3;

/// How a program was solved; where one fails the next takes over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// One factorisation and a small dual (`dual`), for few binding rows.
    DualWorkingSet,
    /// An interior point on the normal equations (`interior`), for many.
    WarmInterior,
    /// A general conic solver (`clarabel`), which also proves contradictions.
    #[default]
    InteriorPoint,
}

/// What was reached for a program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solved {
    pub variables: usize,
    pub rows: usize,
    /// Independent parts that were solved one by one.
    pub blocks: usize,
    pub method: Method,
    /// Of the part that needed most; of the dual working set, rounds in which rows were taken in hand.
    pub iterations: u32,
    /// Objective, residuals and duality gap, measured on the result.
    pub optimality: Optimality,
    /// How often it was solved again with more rows, how many were added, and the objective before.
    pub rounds: u32,
    pub added: usize,
    pub objective_first: f64,
    /// Conditions that are broken all the same.
    pub broken: usize,
    /// What fixes the offsets that the energy leaves open.
    pub gauge: &'static str,
    /// What the depths are if not the optimum of an energy within the bounds: then there is nothing to prove, and residuals say
    /// nothing.
    pub not_an_optimum: Option<&'static str>,
}

/// The solution of one block.
#[derive(Clone, Debug)]
pub struct SolvedBlock {
    pub u: Vec<f64>,
    /// Multipliers of rows and equalities.
    pub z: Vec<f64>,
    pub y: Vec<f64>,
    pub method: Method,
    pub iterations: u32,
}

/// A solved program.
#[derive(Clone, Debug)]
pub struct Solution {
    pub u: Vec<f64>,
    /// Multipliers of rows and equalities.
    pub z: Vec<f64>,
    pub y: Vec<f64>,
    pub solved: Solved,
}

/// Why there is no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Rows contradict each other: those that matter, by falling share in the contradiction.
    #[error("no depths satisfy all bounds")]
    Infeasible(Vec<RowKind>),
    /// Neither depths nor a contradiction were found: why, and the row that the last try breaks most.
    #[error("no depths were found: {reason}")]
    Unsolved {
        reason: String,
        worst: Option<RowKind>,
    },
}

impl SolveError {
    /// The same without the rows it names.
    pub fn without_rows(self) -> Self {
        match self {
            Self::Infeasible(_) => Self::Infeasible(Vec::new()),
            other => other,
        }
    }
}

/// A program as the solver takes it: `min x'Px / 2 + q'x`, `A x + slack = b`, slacks in cones.
struct Standard {
    p: CscMatrix<f64>,
    q: Vec<f64>,
    a: CscMatrix<f64>,
    b: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    settings: DefaultSettings<f64>,
}

impl Standard {
    fn new(program: &Program) -> Self {
        let settings = DefaultSettings {
            verbose: false,
            max_iter: MAX_ITERATIONS,
            max_threads: 1,
            direct_solve_method: "faer".into(),
            presolve_enable: false,
            ..DefaultSettings::default()
        };
        if program.factor.is_empty() {
            let (a, b) = constraints(program);
            return Self {
                p: csc(&program.quadratic),
                q: program.linear.clone(),
                a,
                b,
                cones: vec![
                    ZeroConeT(program.equalities.len()),
                    NonnegativeConeT(program.rows.len()),
                ],
                settings,
            };
        }
        let form = conic(program);
        let [equal, rows, cone] = form.parts;
        Self {
            p: CscMatrix::zeros((form.linear.len(), form.linear.len())),
            q: form.linear,
            a: csc(&form.lines.to_csc()),
            b: form.limits,
            cones: vec![
                ZeroConeT(equal),
                NonnegativeConeT(rows),
                SecondOrderConeT(cone),
            ],
            settings: DefaultSettings {
                tol_gap_abs: CONIC_TOLERANCE,
                tol_gap_rel: CONIC_TOLERANCE,
                tol_feas: CONIC_TOLERANCE,
                ..settings
            },
        }
    }
}

/// Solves one block.
///
/// # Errors
/// If rows contradict each other or the solver gives up.
pub(crate) fn by_interior_point(program: &Program) -> Result<SolvedBlock, SolveError> {
    let Standard {
        p,
        q,
        a,
        b,
        cones,
        settings,
    } = Standard::new(program);
    let mut solver =
        DefaultSolver::new(&p, &q, &a, &b, &cones, settings).map_err(|e| SolveError::Unsolved {
            reason: e.to_string(),
            worst: None,
        })?;
    solver.solve();
    let solution = &solver.solution;
    let (y, z) = solution.z.split_at(program.equalities.len());
    let z = &z[program.factor.len()..][..program.rows.len()];
    match solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(SolvedBlock {
            u: solution.x[..program.variables].to_vec(),
            z: z.to_vec(),
            y: y.to_vec(),
            method: Method::InteriorPoint,
            iterations: solution.iterations,
        }),
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            let mut shares: Vec<usize> = (0..z.len()).collect();
            shares.sort_by(|i, j| z[*j].abs().total_cmp(&z[*i].abs()));
            let least = shares.first().map_or(0.0, |i| MATTERS * z[*i].abs());
            let mattering = shares.into_iter().filter(|i| z[*i].abs() > least);
            Err(SolveError::Infeasible(
                mattering.map(|i| program.rows[i].kind).collect(),
            ))
        }
        other => Err(SolveError::Unsolved {
            reason: gave_up(other, solution.iterations),
            worst: most_broken(program, &solution.x),
        }),
    }
}

fn gave_up(status: SolverStatus, steps: u32) -> String {
    match status {
        SolverStatus::MaxIterations => format!("after {steps} steps the solver was not there yet"),
        SolverStatus::InsufficientProgress | SolverStatus::NumericalError => {
            format!("after {steps} steps the solver got no nearer")
        }
        other => format!("the solver stopped after {steps} steps ({other:?})"),
    }
}

/// The row that `u` breaks most, by the length of its terms.
fn most_broken(program: &Program, u: &[f64]) -> Option<RowKind> {
    let broken = |row: &Row| {
        let terms = row.terms.iter();
        let length = terms.clone().map(|(_, c)| c * c).sum::<f64>().sqrt();
        (terms.map(|(j, c)| c * u[*j]).sum::<f64>() - row.limit) / length
    };
    let rows = program.rows.iter().map(|row| (broken(row), row.kind));
    let worst = rows.filter(|(by, _)| *by > 0.0);
    worst
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, kind)| kind)
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
