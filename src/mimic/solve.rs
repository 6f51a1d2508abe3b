//! Solving a program: the only module that names `clarabel`.

use super::blocks::{ProgramBlock, blocks};
use super::certificate::{Optimality, optimality};
use super::conic::conic;
use super::program::{Program, Row, RowKind};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT, ZeroConeT,
};
use rayon::prelude::*;
use sprs::{CsMat, TriMat};

/// More iterations than any program met so far needed (15-60).
const MAX_ITERATIONS: u32 = 200;

/// Gap and residuals at which the conic form ends. Its gap is that of `v`, half a squared length: at the solver's own 1e-8 unknowns
/// have four digits, and the certificate refuses them.
const CONIC_TOLERANCE: f64 = 1e-11;

/// Rows with a smaller share in a contradiction than this, of the largest, are rounding: true shares differ by the weights of corners.
const MATTERS: f64 = 1e-3;

/// How a program was solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    #[default]
    InteriorPoint,
    /// One factorisation and a small dual (`dual`).
    DualWorkingSet,
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

/// Solves the program, block by block.
///
/// # Errors
/// If rows contradict each other or the solver gives up.
pub fn solve(program: &Program) -> Result<Solution, SolveError> {
    let nothing = Solution {
        u: vec![0.0; program.variables],
        z: Vec::new(),
        y: vec![0.0; program.equalities.len()],
        solved: Solved::default(),
    };
    solve_where(program, nothing, &|_| true)
}

/// Solves the program again to which rows were added from `new_rows` on: only blocks that these belong to.
///
/// # Errors
/// As [`solve`].
pub(crate) fn solve_again(
    program: &Program,
    before: &Solution,
    new_rows: usize,
) -> Result<Solution, SolveError> {
    let changed = |b: &ProgramBlock| b.rows.last().is_some_and(|r| *r >= new_rows);
    solve_where(program, before.clone(), &changed)
}

/// Solves the blocks that are `wanted`; the rest of `solution` stays.
fn solve_where(
    program: &Program,
    mut solution: Solution,
    wanted: &dyn Fn(&ProgramBlock) -> bool,
) -> Result<Solution, SolveError> {
    let blocks = blocks(program);
    let count = blocks.len();
    let todo: Vec<ProgramBlock> = blocks.into_iter().filter(wanted).collect();
    let solved = all_solved(todo.par_iter().map(solve_block).collect())?;
    solution.z.resize(program.rows.len(), 0.0);
    for (block, part) in todo.iter().zip(&solved) {
        let place = |to: &mut [f64], at: &[usize], from: &[f64]| {
            at.iter().zip(from).for_each(|(i, v)| to[*i] = *v);
        };
        place(&mut solution.u, &block.variables, &part.u);
        place(&mut solution.z, &block.rows, &part.z);
        place(&mut solution.y, &block.equalities, &part.y);
    }
    let iterations = solved.iter().map(|p| p.iterations).max().unwrap_or(0);
    solution.solved = Solved {
        variables: program.variables,
        rows: program.rows.len(),
        blocks: count,
        iterations: iterations.max(solution.solved.iterations),
        optimality: optimality(program, &solution.u, &solution.z, &solution.y),
        ..Solved::default()
    };
    Ok(solution)
}

/// All blocks, or what is wrong with them: the contradictions of all, or else the first failure, whatever the thread count.
fn all_solved(
    results: Vec<Result<SolvedBlock, SolveError>>,
) -> Result<Vec<SolvedBlock>, SolveError> {
    let (mut solved, mut contradicting, mut failed) = (Vec::new(), Vec::new(), None);
    for result in results {
        match result {
            Ok(block) => solved.push(block),
            Err(SolveError::Infeasible(rows)) => contradicting.push(rows),
            Err(other) => failed = failed.or(Some(other)),
        }
    }
    match (contradicting.is_empty(), failed) {
        (false, _) => Err(SolveError::Infeasible(contradicting.concat())),
        (true, Some(error)) => Err(error),
        (true, None) => Ok(solved),
    }
}

/// The solution of one block.
struct SolvedBlock {
    u: Vec<f64>,
    z: Vec<f64>,
    y: Vec<f64>,
    iterations: u32,
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

fn solve_block(block: &ProgramBlock) -> Result<SolvedBlock, SolveError> {
    let program = &block.program;
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
