//! A convex quadratic program in the form every energy is brought to: minimise `u'Pu / 2 + q'u` subject to sparse rows.

use sprs::{CsMat, TriMat};

/// What a row stands for, so that an error can name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// The near limit of a bound (by index).
    Near(u32),
    /// The far limit of a bound (by index).
    Far(u32),
    /// A depth order (by index).
    Order(u32),
    /// A step of a cut mesh (by index).
    Step(u32),
    /// The least scale of a group (by index).
    Scale(u32),
}

/// `sum of coefficient * u[variable] <= limit`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub kind: RowKind,
    pub terms: Vec<(usize, f64)>,
    pub limit: f64,
}

impl Row {
    /// The same with all variables from `first` on held at 0.
    pub fn without(mut self, first: usize) -> Self {
        self.terms.retain(|t| t.0 < first);
        self
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Program {
    pub variables: usize,
    /// Upper triangle of `P`, `variables` x `variables`, compressed columns.
    pub quadratic: CsMat<f64>,
    /// Rows of a matrix `F` with `P = F'F`: if there are any, the program is solved in conic form (see `conic`).
    pub factor: Vec<Vec<(usize, f64)>>,
    /// `q`.
    pub linear: Vec<f64>,
    /// Equalities `sum = value`.
    pub equalities: Vec<(Vec<(usize, f64)>, f64)>,
    pub rows: Vec<Row>,
}

impl Program {
    /// Terms of all equalities, then of all rows.
    pub(crate) fn lines(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        let equalities = self.equalities.iter().map(|(terms, _)| &terms[..]);
        equalities.chain(self.rows.iter().map(|row| &row.terms[..]))
    }
}

/// Gathers `P` term by term.
pub(crate) struct Quadratic {
    triplets: TriMat<f64>,
    factor: Vec<Vec<(usize, f64)>>,
}

impl Quadratic {
    pub(crate) fn new(variables: usize) -> Self {
        Self {
            triplets: TriMat::new((variables, variables)),
            factor: Vec::new(),
        }
    }

    /// Adds `weight * (u_i - u_j)^2`; the weight may be negative, so that this has no part in a factor.
    pub(crate) fn difference(&mut self, i: usize, j: usize, weight: f64) {
        self.triplets.add_triplet(i, i, 2.0 * weight);
        self.triplets.add_triplet(j, j, 2.0 * weight);
        self.triplets.add_triplet(i.min(j), i.max(j), -2.0 * weight);
    }

    /// Adds `weight * u_i^2`.
    pub(crate) fn square(&mut self, i: usize, weight: f64) {
        self.form(&[(i, 1.0)], weight);
    }

    /// Adds `weight * (sum of coefficient * u)^2`.
    pub(crate) fn form(&mut self, terms: &[(usize, f64)], weight: f64) {
        let root = (2.0 * weight).sqrt();
        self.factor.push(gathered(
            terms.iter().map(|(i, a)| (*i, root * a)).collect(),
        ));
        for (n, &(i, a)) in terms.iter().enumerate() {
            self.triplets.add_triplet(i, i, 2.0 * weight * a * a);
            for &(j, b) in &terms[n + 1..] {
                self.triplets
                    .add_triplet(i.min(j), i.max(j), 2.0 * weight * a * b);
            }
        }
    }

    /// The upper triangle.
    pub(crate) fn finish(self) -> CsMat<f64> {
        self.triplets.to_csc()
    }

    /// The upper triangle, and rows of an `F` with `P = F'F` if no differences were added.
    pub(crate) fn finish_with_factor(self) -> (CsMat<f64>, Vec<Vec<(usize, f64)>>) {
        (self.triplets.to_csc(), self.factor)
    }
}

/// Mean of the diagonal of the first `n` variables: the scale regularisers are relative to.
pub(crate) fn mean_diagonal(quadratic: &CsMat<f64>, n: usize) -> f64 {
    let sum: f64 = quadratic
        .iter()
        .filter(|(_, (i, j))| i == j && *i < n)
        .map(|(v, _)| v)
        .sum();
    sum / n.max(1) as f64
}

/// Terms of one variable as one, in rising order.
pub(crate) fn gathered(mut terms: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    terms.sort_by_key(|t| t.0);
    terms.dedup_by(|b, a| {
        let same = a.0 == b.0;
        a.1 += if same { b.1 } else { 0.0 };
        same
    });
    terms.retain(|t| t.1 != 0.0);
    terms
}

/// `P x` from the upper triangle of `P`.
pub(crate) fn times(upper: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; x.len()];
    for (v, (i, j)) in upper {
        product[i] += v * x[j];
        if i != j {
            product[j] += v * x[i];
        }
    }
    product
}
