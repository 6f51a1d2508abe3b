//! A program on its way through the rounds of rows: its blocks, each solved by the method that suits it.
//!
//! A block whose rows stay as they were keeps its solution, one with more rows keeps its factor.

use super::blocks::{Blocks, ProgramBlock};
use super::certificate::optimality;
use super::dual::Dual;
use super::interior::Interior;
use super::program::Program;
use super::solve::{Method, Solution, SolveError, Solved, SolvedBlock, by_interior_point};
use rayon::prelude::*;

/// Solves the program by the interior point.
///
/// # Errors
/// If rows contradict each other or the solver gives up.
pub fn solve(program: &Program) -> Result<Solution, SolveError> {
    solve_by(program, Method::InteriorPoint)
}

/// The same by `method` as far as that goes: `method` of what is solved says whether it did.
///
/// # Errors
/// As [`solve`].
pub fn solve_by(program: &Program, method: Method) -> Result<Solution, SolveError> {
    Solving::new(program, method).solve(program, true)
}

/// See the module.
pub(crate) struct Solving {
    blocks: Blocks,
    /// Of every block.
    states: Vec<BlockState>,
    method: Method,
}

/// How far a block has come.
enum BlockState {
    /// Not solved yet.
    New,
    Solved(SolvedState),
}

/// A block as it was solved.
struct SolvedState {
    part: SolvedBlock,
    way: BlockSolver,
    /// With so many rows.
    rows: usize,
    exact: bool,
}

/// What a block is solved by if it has more rows.
enum BlockSolver {
    Dual(Box<Dual>),
    Interior(Box<Interior>),
    /// From nothing.
    Anew,
}

impl Solving {
    pub(crate) fn new(program: &Program, method: Method) -> Self {
        let blocks = Blocks::new(program);
        Self {
            states: blocks.all.iter().map(|_| BlockState::New).collect(),
            blocks,
            method,
        }
    }

    /// The optimum of the program, to whose end rows may have been added since the last time; where that saves time something near it,
    /// unless it is to be `exact`.
    ///
    /// # Errors
    /// As [`solve`].
    pub(crate) fn solve(&mut self, program: &Program, exact: bool) -> Result<Solution, SolveError> {
        if let Some(before) = self.blocks.add(program) {
            self.take_over(&before);
        }
        let method = self.method;
        let states = std::mem::take(&mut self.states);
        let parts = states.into_par_iter().zip(&self.blocks.all);
        let states = parts.map(|(state, block)| solved(state, &block.program, method, exact));
        self.states = all_solved(states.collect())?;
        Ok(self.whole(program))
    }

    /// States of blocks that are as they were before.
    fn take_over(&mut self, before: &[ProgramBlock]) {
        let mut old: Vec<Option<BlockState>> = self.states.drain(..).map(Some).collect();
        let state = |block: &ProgramBlock| {
            let first = |b: &ProgramBlock| b.variables.first().copied();
            let at = before.binary_search_by_key(&first(block), first).ok()?;
            let same = before[at].variables == block.variables;
            old[at].take_if(|_| same)
        };
        let states = self.blocks.all.iter().map(state);
        self.states = states.map(|s| s.unwrap_or(BlockState::New)).collect();
    }

    fn whole(&self, program: &Program) -> Solution {
        let mut whole = Solution {
            u: vec![0.0; program.variables],
            z: vec![0.0; program.rows.len()],
            y: vec![0.0; program.equalities.len()],
            solved: Solved {
                variables: program.variables,
                rows: program.rows.len(),
                blocks: self.blocks.all.len(),
                method: self.method,
                ..Solved::default()
            },
        };
        for (block, state) in self.blocks.all.iter().zip(&self.states) {
            let BlockState::Solved(SolvedState { part, .. }) = state else {
                continue;
            };
            let place = |to: &mut [f64], at: &[usize], from: &[f64]| {
                at.iter().zip(from).for_each(|(i, v)| to[*i] = *v);
            };
            place(&mut whole.u, &block.variables, &part.u);
            place(&mut whole.z, &block.rows, &part.z);
            place(&mut whole.y, &block.equalities, &part.y);
            let told = &mut whole.solved;
            told.iterations = told.iterations.max(part.iterations);
            // Lone unknowns that nothing binds are no matter of method.
            if part.method == Method::InteriorPoint && !block.rows.is_empty() {
                told.method = Method::InteriorPoint;
            }
        }
        whole.solved.optimality = optimality(program, &whole.u, &whole.z, &whole.y);
        whole
    }
}

/// Solves one block, unless it is solved already. A way that fails once is not tried again.
fn solved(
    state: BlockState,
    program: &Program,
    method: Method,
    exact: bool,
) -> Result<BlockState, SolveError> {
    let rows = program.rows.len();
    let way = match state {
        BlockState::Solved(known) if known.rows == rows && (known.exact || !exact) => {
            return Ok(BlockState::Solved(known));
        }
        BlockState::Solved(known) => known.way,
        BlockState::New => BlockSolver::new(program, method),
    };
    let done = |part, way, exact| {
        Ok(BlockState::Solved(SolvedState {
            part,
            way,
            rows,
            exact,
        }))
    };
    match way {
        BlockSolver::Dual(mut dual) => {
            if let Some(part) = dual.solve(program) {
                return done(part, BlockSolver::Dual(dual), true);
            }
        }
        BlockSolver::Interior(mut interior) => {
            if let Some(part) = interior.solve(program, exact) {
                return done(part, BlockSolver::Interior(interior), exact);
            }
        }
        BlockSolver::Anew => {}
    }
    done(by_interior_point(program)?, BlockSolver::Anew, true)
}

impl BlockSolver {
    fn new(program: &Program, method: Method) -> Self {
        let way = match method {
            Method::DualWorkingSet => Dual::new(program).map(|d| Self::Dual(Box::new(d))),
            Method::WarmInterior => Interior::new(program).map(|i| Self::Interior(Box::new(i))),
            Method::InteriorPoint => None,
        };
        way.unwrap_or(Self::Anew)
    }
}

/// All blocks, or what is wrong with them: the contradictions of all, or else the first failure, whatever the thread count.
fn all_solved(results: Vec<Result<BlockState, SolveError>>) -> Result<Vec<BlockState>, SolveError> {
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
