//! `P + A'DA + eps I` for any weights `D` of a program's lines: one pattern, analysed once and factorised for every `D`.

use super::factor::Factor;
use super::program::Program;
use sprs::{CsMat, TriMat};

/// `eps`: what keeps a singular `P` invertible where no line holds it. The mean diagonal of `P` is about 1.
const PROXIMAL: f64 = 1e-9;

/// A line ties each of its terms to all others. Bounds and orders tie up to 28 pairs each, some ten times as many as `P`; the mean of all
/// vertices of a mesh ties thousands of times as many and would fill the memory.
const FILL: usize = 100;

/// A line of a program: an equality or a row.
pub(crate) type Terms = [(usize, f64)];

/// See the module.
pub(crate) struct Weighted {
    /// Upper triangle, with the values of `P + eps I`.
    fixed: CsMat<f64>,
    /// Where the products of each line's terms stand in it: equalities first, then rows.
    products: Vec<Vec<usize>>,
    factor: Factor,
}

impl Weighted {
    /// Of the lines of a program; nothing if memory runs out, or if they tie more than [`FILL`] times as many pairs as `P` does.
    pub(crate) fn new(program: &Program) -> Option<Self> {
        let n = program.variables;
        let tied: usize = program.lines().map(|terms| terms.len().pow(2)).sum();
        if tied > FILL * (program.quadratic.nnz() + program.lines().count()) {
            return None;
        }
        let mut triplets = TriMat::new((n, n));
        for (v, (i, j)) in &program.quadratic {
            triplets.add_triplet(i, j, *v);
        }
        (0..n).for_each(|i| triplets.add_triplet(i, i, PROXIMAL));
        for terms in program.lines() {
            pairs(terms).for_each(|(i, j, _)| triplets.add_triplet(i, j, 0.0));
        }
        let fixed: CsMat<f64> = triplets.to_csc();
        let products = program.lines().map(|terms| places(&fixed, terms));
        Some(Self {
            products: products.collect::<Option<_>>()?,
            factor: Factor::of_pattern(&fixed)?,
            fixed,
        })
    }

    /// Takes in the rows that were added to the end of the program; whether the pattern has their products.
    pub(crate) fn take_in(&mut self, program: &Program) -> bool {
        let added = program.lines().skip(self.products.len());
        let added: Option<Vec<_>> = added.map(|terms| places(&self.fixed, terms)).collect();
        added.is_some_and(|added| {
            self.products.extend(added);
            true
        })
    }

    /// Factorises for the weights of all lines; nothing if memory runs out or a weight is no number.
    pub(crate) fn factorise(&mut self, program: &Program, weights: &[f64]) -> Option<()> {
        let mut values = self.fixed.clone();
        let data = values.data_mut();
        for ((terms, places), d) in program.lines().zip(&self.products).zip(weights) {
            for ((_, _, product), at) in pairs(terms).zip(places) {
                data[*at] += d * product;
            }
        }
        self.factor.factorise_again(&values)
    }

    /// The inverse of the last form times a vector, in place.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        self.factor.solve(x);
    }
}

fn places(pattern: &CsMat<f64>, terms: &Terms) -> Option<Vec<usize>> {
    let place = |(i, j, _)| pattern.nnz_index(i, j).map(|at| at.0);
    pairs(terms).map(place).collect()
}

/// The upper triangle of the products of a line's terms with each other.
fn pairs(terms: &Terms) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    terms.iter().enumerate().flat_map(move |(k, (i, a))| {
        let rest = terms[k..].iter();
        rest.map(move |(j, b)| (*i.min(j), *i.max(j), a * b))
    })
}
