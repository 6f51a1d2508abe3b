//! The independent parts of a program: unknowns that no term and no row ties together.
//!
//! The tears of one view leave its supports nothing in common, so that its program falls into one block a support. Small blocks
//! are solved sooner than their sum, side by side, and again only where rows were added.

use super::program::{Program, Row};
use crate::index::indices;
use crate::mesh::DisjointSets;

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

/// The blocks, by their first variables.
pub(crate) fn blocks(program: &Program) -> Vec<ProgramBlock> {
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
    let blocks = sets.members();
    // Block of every unknown, and its place there.
    let mut home_of = vec![BlockId(0); program.variables];
    let mut place = vec![0; program.variables];
    for (b, variables) in BlockId::all(blocks.len()).zip(&blocks) {
        for (i, v) in variables.iter().enumerate() {
            (home_of[*v], place[*v]) = (b, i);
        }
    }
    let numbered = |terms: &[(usize, f64)]| terms.iter().map(|(v, c)| (place[*v], *c)).collect();
    let mut made: Vec<ProgramBlock> = blocks
        .into_iter()
        .map(|variables| empty(program, variables))
        .collect();
    let home = |terms: &[(usize, f64)]| terms.first().map(|t| home_of[t.0]);
    for (i, (terms, value)) in program.equalities.iter().enumerate() {
        let Some(block) = home(terms).map(|b| &mut made[b]) else {
            continue;
        };
        block.equalities.push(i);
        block.program.equalities.push((numbered(terms), *value));
    }
    for (i, row) in program.rows.iter().enumerate() {
        // A row without terms says nothing of any unknown.
        let Some(block) = home(&row.terms).map(|b| &mut made[b]) else {
            continue;
        };
        block.rows.push(i);
        block.program.rows.push(Row {
            terms: numbered(&row.terms),
            ..row.clone()
        });
    }
    for terms in &program.factor {
        if let Some(b) = home(terms) {
            made[b].program.factor.push(numbered(terms));
        }
    }
    let mut entries: Vec<sprs::TriMat<f64>> = made
        .iter()
        .map(|b| sprs::TriMat::new((b.variables.len(), b.variables.len())))
        .collect();
    for (value, (i, j)) in &program.quadratic {
        entries[home_of[i]].add_triplet(place[i], place[j], *value);
    }
    for (block, entries) in made.iter_mut().zip(entries) {
        block.program.quadratic = entries.to_csc();
    }
    made
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
