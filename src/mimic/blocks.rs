//! The independent parts of a program: unknowns that no term and no row ties together.
//!
//! The tears of one view leave its supports nothing in common, so that its program falls into one block a support. Small blocks
//! are solved sooner than their sum, side by side, and again only where rows were added.

use super::program::{Program, Row};
use crate::index::indices;
use crate::mesh::DisjointSets;
use std::mem::take;

indices! {
    /// A block of a program.
    BlockId
}

/// A part of a program with its places in the whole.
pub(crate) struct ProgramBlock {
    pub program: Program,
    /// Variable of the whole program of each of the block's.
    pub variables: Vec<usize>,
    pub equalities: Vec<usize>,
    pub rows: Vec<usize>,
}

/// All blocks of a program.
pub(crate) struct Blocks {
    /// By their first variables.
    pub all: Vec<ProgramBlock>,
    /// Block of every unknown, and its place there.
    home: Vec<BlockId>,
    place: Vec<usize>,
    /// So many rows of the program are in blocks.
    rows: usize,
}

impl Blocks {
    pub(crate) fn new(program: &Program) -> Self {
        let members = parts(program).members();
        let mut home = vec![BlockId(0); program.variables];
        let mut place = vec![0; program.variables];
        for (b, variables) in BlockId::all(members.len()).zip(&members) {
            for (i, v) in variables.iter().enumerate() {
                (home[*v], place[*v]) = (b, i);
            }
        }
        let blocks = members.into_iter();
        let mut made = Self {
            all: blocks.map(|variables| empty(program, variables)).collect(),
            home,
            place,
            rows: 0,
        };
        made.take_over(program);
        made.add_rows(program);
        made
    }

    /// All but the rows.
    fn take_over(&mut self, program: &Program) {
        for (i, (terms, value)) in program.equalities.iter().enumerate() {
            let own = self.numbered(terms);
            if let Some(block) = self.home_of(terms) {
                block.equalities.push(i);
                block.program.equalities.push((own, *value));
            }
        }
        for terms in &program.factor {
            let own = self.numbered(terms);
            if let Some(block) = self.home_of(terms) {
                block.program.factor.push(own);
            }
        }
        let sizes = self.all.iter().map(|b| b.variables.len());
        let mut entries: Vec<sprs::TriMat<f64>> =
            sizes.map(|n| sprs::TriMat::new((n, n))).collect();
        for (value, (i, j)) in &program.quadratic {
            entries[self.home[i].at()].add_triplet(self.place[i], self.place[j], *value);
        }
        for (block, entries) in self.all.iter_mut().zip(entries) {
            block.program.quadratic = entries.to_csc();
        }
    }

    /// Takes over the rows that were added to the program; what they tie together becomes one block. Gives the blocks there were
    /// before, if there is such a row.
    pub(crate) fn add(&mut self, program: &Program) -> Option<Vec<ProgramBlock>> {
        let home = |term: &(usize, f64)| self.home[term.0];
        let within = |row: &Row| row.terms.iter().all(|t| home(t) == home(&row.terms[0]));
        if program.rows[self.rows..].iter().all(within) {
            self.add_rows(program);
            return None;
        }
        let before = take(&mut self.all);
        *self = Self::new(program);
        Some(before)
    }

    fn add_rows(&mut self, program: &Program) {
        for (i, row) in program.rows.iter().enumerate().skip(self.rows) {
            let terms = self.numbered(&row.terms);
            // A row without terms says nothing of any unknown.
            if let Some(block) = self.home_of(&row.terms) {
                block.rows.push(i);
                block.program.rows.push(Row {
                    terms,
                    ..row.clone()
                });
            }
        }
        self.rows = program.rows.len();
    }

    fn home_of(&mut self, terms: &[(usize, f64)]) -> Option<&mut ProgramBlock> {
        terms.first().map(|t| &mut self.all[self.home[t.0].at()])
    }

    fn numbered(&self, terms: &[(usize, f64)]) -> Vec<(usize, f64)> {
        terms.iter().map(|(v, c)| (self.place[*v], *c)).collect()
    }
}

/// The unknowns that hang together.
fn parts(program: &Program) -> DisjointSets {
    let mut sets = DisjointSets::new(program.variables);
    let mut join = |terms: &[(usize, f64)]| {
        terms
            .windows(2)
            .for_each(|t| sets.join(t[0].0 as u32, t[1].0 as u32));
    };
    program.equalities.iter().for_each(|(t, _)| join(t));
    program.rows.iter().for_each(|r| join(&r.terms));
    for (_, (i, j)) in &program.quadratic {
        sets.join(i as u32, j as u32);
    }
    sets
}

fn empty(program: &Program, variables: Vec<usize>) -> ProgramBlock {
    ProgramBlock {
        program: Program {
            variables: variables.len(),
            quadratic: sprs::CsMat::zero((0, 0)),
            factor: Vec::new(),
            linear: variables.iter().map(|v| program.linear[*v]).collect(),
            equalities: Vec::new(),
            rows: Vec::new(),
        },
        variables,
        equalities: Vec::new(),
        rows: Vec::new(),
    }
}
