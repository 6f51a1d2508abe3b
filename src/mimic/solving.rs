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
    solver: BlockSolver,
    /// With so many rows.
    rows: usize,
    exact: bool,
}

/// What a block is solved by, which goes on if it has more rows; the next where one fails.
enum BlockSolver {
    Dual(Box<Dual>),
    Interior(Box<Interior>),
    /// From nothing every time.
    Conic,
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
            if !block.rows.is_empty() {
                told.method = told.method.max(part.method);
            }
        }
        whole.solved.optimality = optimality(program, &whole.u, &whole.z, &whole.y);
        whole
    }
}

/// Solves one block, unless it is solved already. A solver that fails once is left for the next for good.
///
/// # Errors
/// As [`solve`].
fn solved(
    state: BlockState,
    program: &Program,
    method: Method,
    exact: bool,
) -> Result<BlockState, SolveError> {
    let rows = program.rows.len();
    let mut solver = match state {
        BlockState::Solved(known) if known.rows == rows && (known.exact || !exact) => {
            return Ok(BlockState::Solved(known));
        }
        BlockState::Solved(known) => known.solver,
        BlockState::New => BlockSolver::new(program, method),
    };
    loop {
        let (part, exact) = match &mut solver {
            BlockSolver::Dual(dual) => (dual.solve(program), true),
            BlockSolver::Interior(interior) => (interior.solve(program, exact), exact),
            BlockSolver::Conic => (Some(by_interior_point(program)?), true),
        };
        if let Some(part) = part {
            return Ok(BlockState::Solved(SolvedState {
                part,
                solver,
                rows,
                exact,
            }));
        }
        solver = match solver {
            BlockSolver::Dual(_) => BlockSolver::new(program, Method::WarmInterior),
            BlockSolver::Interior(_) | BlockSolver::Conic => BlockSolver::Conic,
        };
    }
}

impl BlockSolver {
    /// That of the method, or the next one.
    fn new(program: &Program, method: Method) -> Self {
        let dual = || Some(Self::Dual(Box::new(Dual::new(program)?)));
        let interior = || Some(Self::Interior(Box::new(Interior::new(program)?)));
        match method {
            Method::DualWorkingSet => dual().or_else(interior),
            Method::WarmInterior => interior(),
            Method::InteriorPoint => None,
        }
        .unwrap_or(Self::Conic)
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
