//! Sparse Cholesky `P = L L'` of a positive definite matrix: the only module that names `faer`.
//!
//! Besides whole solutions it gives `L^-1 g` for a sparse `g` alone: it has entries only along the paths of the elimination tree
//! from the entries of `g` to the root, some thousand of a mesh's unknowns.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};
use sprs::CsMat;

/// A factorised matrix.
pub(crate) struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    /// Supernode of every column of `L`.
    supernode: Vec<usize>,
    /// Column of `L` of every unknown.
    place: Vec<usize>,
}

/// `L^-1 g`: entries of whole supernodes, rising.
pub(crate) struct Half {
    /// Supernodes, and where the entries of each begin.
    parts: Vec<(u32, u32)>,
    values: Vec<f64>,
}

impl Factor {
    /// Factorises a matrix given by its upper triangle, compressed columns; nothing if it is not positive definite or memory
    /// runs out.
    pub(crate) fn new(upper: &CsMat<f64>) -> Option<Self> {
        let mut made = Self::of_pattern(upper)?;
        made.factorise_again(upper)?;
        Some(made)
    }

    /// The factor of no matrix yet, but of this pattern; nothing if memory runs out.
    pub(crate) fn of_pattern(upper: &CsMat<f64>) -> Option<Self> {
        let n = upper.cols();
        let starts = upper.indptr();
        let pattern =
            SymbolicSparseColMatRef::new_checked(n, n, starts.as_slice()?, None, upper.indices());
        // Paths are walked by supernodes.
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let order = SymmetricOrdering::Amd;
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Upper, order, params).ok()?;
        let (_, place) = symbolic.perm()?.arrays();
        let place = place.to_vec();
        let tree = supernodes(&symbolic)?;
        let mut supernode = vec![0; n];
        for s in 0..tree.n_supernodes() {
            supernode[tree.supernode_begin()[s]..tree.supernode_end()[s]].fill(s);
        }
        Some(Self {
            values: vec![0.0; symbolic.len_val()],
            symbolic,
            supernode,
            place,
        })
    }

    /// Factorises a matrix of the same pattern; nothing, and no factor either, if it is not positive definite or memory runs out.
    pub(crate) fn factorise_again(&mut self, upper: &CsMat<f64>) -> Option<()> {
        let n = upper.cols();
        let starts = upper.indptr();
        let pattern =
            SymbolicSparseColMatRef::new_checked(n, n, starts.as_slice()?, None, upper.indices());
        let spec: Spec<LltParams, f64> = Spec::default();
        let request = self
            .symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, spec);
        let mut memory = MemBuffer::try_new(request).ok()?;
        self.symbolic
            .factorize_numeric_llt(
                &mut self.values,
                SparseColMatRef::new(pattern, upper.data()),
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                spec,
            )
            .ok()?;
        Some(())
    }

    /// `P^-1` times a vector, in place.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        let request: StackReq = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let mut memory = MemBuffer::new(request);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// `L^-1` times a sparse vector. `work` has an entry for every unknown, all zero before and after.
    pub(crate) fn half(&self, terms: &[(usize, f64)], work: &mut [f64]) -> Half {
        let Some(tree) = supernodes(&self.symbolic) else {
            unreachable!("checked when it was made")
        };
        for (i, v) in terms {
            work[self.place[*i]] += v;
        }
        let (mut parts, mut values, mut local) = (Vec::new(), Vec::new(), Vec::new());
        for s in self.path(tree, terms) {
            let node = tree.supernode(s);
            let (start, pattern) = (node.start(), node.pattern());
            let width = tree.supernode_end()[s] - start;
            let height = width + pattern.len();
            let columns = &self.values[tree.col_ptr_for_val()[s]..][..width * height];
            local.clear();
            local.extend_from_slice(&work[start..start + width]);
            local.resize(height, 0.0);
            for (j, column) in columns.chunks_exact(height).enumerate() {
                let x = local[j] / column[j];
                local[j] = x;
                let below = local[j + 1..].iter_mut().zip(&column[j + 1..]);
                below.for_each(|(y, l)| *y -= l * x);
            }
            work[start..start + width].fill(0.0);
            for (i, y) in pattern.iter().zip(&local[width..]) {
                work[*i] += y;
            }
            parts.push((s as u32, values.len() as u32));
            values.extend_from_slice(&local[..width]);
        }
        Half { parts, values }
    }

    /// Supernodes on the ways from the terms to the root, rising.
    fn path(&self, tree: &SymbolicSupernodalCholesky<usize>, terms: &[(usize, f64)]) -> Vec<usize> {
        let (mut path, mut seen) = (Vec::new(), vec![false; tree.n_supernodes()]);
        for (i, _) in terms {
            let mut up = Some(self.supernode[self.place[*i]]);
            // The ways meet for good.
            while let Some(s) = up.filter(|s| !seen[*s]) {
                seen[s] = true;
                path.push(s);
                let above = tree.supernode(s).pattern().first();
                up = above.map(|c| self.supernode[*c]);
            }
        }
        path.sort_unstable();
        path
    }
}

impl Half {
    /// The scalar product.
    pub(crate) fn dot(&self, other: &Self) -> f64 {
        let (mut i, mut j, mut sum) = (0, 0, 0.0);
        while i < self.parts.len() && j < other.parts.len() {
            let (a, b) = (self.parts[i].0, other.parts[j].0);
            if a == b {
                let both = self.part(i).iter().zip(other.part(j));
                sum += both.map(|(x, y)| x * y).sum::<f64>();
            }
            i += usize::from(a <= b);
            j += usize::from(b <= a);
        }
        sum
    }

    fn part(&self, i: usize) -> &[f64] {
        let start = self.parts[i].1 as usize;
        let end = self
            .parts
            .get(i + 1)
            .map_or(self.values.len(), |p| p.1 as usize);
        &self.values[start..end]
    }
}

fn supernodes(symbolic: &SymbolicCholesky<usize>) -> Option<&SymbolicSupernodalCholesky<usize>> {
    match symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(tree) => Some(tree),
        SymbolicCholeskyRaw::Simplicial(_) => None,
    }
}
