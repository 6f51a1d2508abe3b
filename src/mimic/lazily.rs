//! Solving with curved conditions: rows are added only where a solution needs them.

use super::conditions::Condition;
use super::program::{Program, Row};
use super::solve::{SolveError, Solved, solve, solve_again};

/// Log depth that a condition may be broken by, times the view's focal length: a quarter of a nanometre at 250 mm, above the rounding
/// of sums.
const BROKEN: f64 = 1e-9;
/// Conditions are tightened by this share of a layer's width, 7 nm of 7 mm, which is above the residuals of the solver: so the
/// result keeps them strictly.
pub const MARGIN: f64 = 1e-6;
/// Rounds after which what is left is clamped: four were the most so far.
const ROUNDS: u32 = 12;

/// Relative depths of all vertices and scales of all groups.
pub type DepthsAndScales = (Vec<f64>, Vec<f64>);

/// How an energy's unknowns relate to depths.
pub struct Meaning<'a> {
    pub depths: &'a dyn Fn(&[f64]) -> DepthsAndScales,
    /// The row of a condition's tangents at the depths given.
    pub tangent: &'a dyn Fn(&Condition, &[f64]) -> Option<Row>,
    /// Of the view's image plane.
    pub focal: f64,
}

impl Meaning<'_> {
    fn breaks(&self, c: &Condition, s: &[f64], mu: &[f64]) -> bool {
        c.excess(s, mu) > BROKEN / self.focal
    }
}

/// Solves `program`, whose rows hold the tangents of some conditions already, until all of `conditions` hold.
///
/// # Errors
/// As [`solve`].
pub fn solve_lazily(
    program: &mut Program,
    conditions: &[Condition],
    meaning: &Meaning,
) -> Result<(Vec<f64>, Solved), SolveError> {
    let mut solution = solve(program)?;
    let first = solution.solved.optimality.objective;
    let (mut rounds, before) = (0, program.rows.len());
    while rounds < ROUNDS {
        let (s, mu) = (meaning.depths)(&solution.u);
        let broken = conditions.iter().filter(|c| meaning.breaks(c, &s, &mu));
        let rows: Vec<Row> = broken.filter_map(|c| (meaning.tangent)(c, &s)).collect();
        if rows.is_empty() {
            break;
        }
        rounds += 1;
        let old = program.rows.len();
        program.rows.extend(rows);
        match solve_again(program, &solution, old) {
            Ok(better) => solution = better,
            // What the last solution breaks is counted below.
            Err(SolveError::Unsolved(_)) => {
                program.rows.truncate(old);
                break;
            }
            Err(error) => return Err(error),
        }
    }
    let (s, mu) = (meaning.depths)(&solution.u);
    let broken = conditions.iter().filter(|c| meaning.breaks(c, &s, &mu));
    let solved = Solved {
        broken: broken.count(),
        rounds: solution.solved.rounds + rounds,
        added: program.rows.len() - before,
        objective_first: first,
        ..solution.solved
    };
    Ok((solution.u, solved))
}
