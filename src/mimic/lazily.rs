//! Solving with curved conditions: rows are added only where a solution needs them.

use super::conditions::{Condition, Conditions};
use super::program::{Program, Row};
use super::solve::{Method, SolveError, Solved};
use super::solving::Solving;

/// Log depth that a condition may be broken by, times the view's focal length: a quarter of a nanometre at 250 mm, above the rounding
/// of sums.
const BROKEN: f64 = 1e-9;
/// Conditions are tightened by this share of a layer's width, 7 nm of 7 mm, which is above the residuals of the solver: so the
/// result keeps them strictly.
pub(crate) const MARGIN: f64 = 1e-6;

/// Once a round adds no more rows than this, it and those after it are solved to the optimum: short of that, some few conditions could go
/// on being broken by what is left of the way. The plate takes its last rows in rounds of 100, 17 and 0.
const FEW: usize = 30;

/// Relative depths of all vertices and scales of all groups.
pub(crate) type DepthsAndScales = (Vec<f64>, Vec<f64>);

/// How an energy's unknowns relate to depths.
pub(crate) struct Meaning<'a> {
    pub depths: &'a dyn Fn(&[f64]) -> DepthsAndScales,
    /// The row of a condition's tangents at the depths and scales given.
    pub tangent: &'a dyn Fn(&Condition, &DepthsAndScales) -> Option<Row>,
    /// Of the view's image plane.
    pub focal: f64,
}

impl Meaning<'_> {
    fn breaks(&self, c: &Condition, (s, mu): &DepthsAndScales) -> bool {
        c.is_broken(s, mu, BROKEN / self.focal)
    }
}

/// Solves `program`, whose rows hold the tangents of some conditions already, until all of `conditions` hold; by `method` as far as
/// that goes, else by the interior point.
///
/// # Errors
/// As [`solve`].
pub(crate) fn solve_lazily(
    program: &mut Program,
    conditions: &Conditions,
    meaning: &Meaning,
    method: Method,
) -> Result<(Vec<f64>, Solved), SolveError> {
    let mut solving = Solving::new(program, method);
    let mut exact = method != Method::WarmInterior;
    let mut solution = solving.solve(program, exact)?;
    let first = solution.solved.optimality.objective;
    let (mut rounds, before) = (0, program.rows.len());
    let mut urgent = conditions.urgent;
    loop {
        let at = (meaning.depths)(&solution.u);
        let tangents = |list: &[Condition]| -> Vec<Row> {
            let broken = list.iter().filter(|c| meaning.breaks(c, &at));
            broken.filter_map(|c| (meaning.tangent)(c, &at)).collect()
        };
        let mut rows = tangents(&conditions.all[..urgent]);
        if rounds == conditions.rounds {
            rows.clear();
        } else if rows.is_empty() {
            // From here on all that is broken at once: one by one, events of either kind break the others' rows again.
            urgent = 0;
            rows = tangents(&conditions.all);
        }
        if rows.is_empty() && exact {
            break;
        }
        // Near the optimum much the same conditions are broken as there, so only the last rounds need be solved to the end.
        exact |= rows.len() <= FEW;
        rounds += u32::from(!rows.is_empty());
        let old = program.rows.len();
        program.rows.extend(rows);
        match solving.solve(program, exact) {
            Ok(better) => solution = better,
            // What the last solution breaks is counted below.
            Err(SolveError::Unsolved { .. }) => {
                program.rows.truncate(old);
                break;
            }
            Err(error) => return Err(error),
        }
    }
    let at = (meaning.depths)(&solution.u);
    let all = conditions.all.iter();
    let broken = all.filter(|c| meaning.breaks(c, &at));
    let solved = Solved {
        broken: broken.count(),
        rounds: solution.solved.rounds + rounds,
        added: program.rows.len() - before,
        objective_first: first,
        ..solution.solved
    };
    Ok((solution.u, solved))
}
