//! The paper's conic form of a quadratic program (appendix, Eq 17).
//!
//! With `P = F'F` the program `min u'Pu / 2 + q'u` is `min v + q'u` with `t = F u` and `c v >= sum of t_i^2`, `c = 2`. The paper's
//! rotated cone is written as the ordinary one: `(v + 1/2)^2 - (v - 1/2)^2 = 2 v`, so that it says
//! `|(v - 1/2, t)| <= v + 1/2`. The unknowns are `u`, `t` and `v`. At the optimum the multipliers of `t = F u` are `t` itself, hence those
//! of rows and equalities are the quadratic program's, and the same certificate holds them to account.

use super::program::Program;
use sprs::TriMat;

/// Lines `A x + slack = b`: first the program's equalities, then `t = F u`, then the program's rows, then the cone's slacks.
pub(crate) struct Conic {
    pub linear: Vec<f64>,
    pub lines: TriMat<f64>,
    pub limits: Vec<f64>,
    /// Lines of equality, of rows, of the cone.
    pub parts: [usize; 3],
}

/// The program in conic form.
pub(crate) fn conic(program: &Program) -> Conic {
    let (n, m) = (program.variables, program.factor.len());
    let v = n + m;
    let parts = [program.equalities.len() + m, program.rows.len(), m + 2];
    let mut lines = TriMat::new((parts.iter().sum(), v + 1));
    let mut limits = Vec::with_capacity(lines.rows());
    let mut line = |terms: &[(usize, f64)], more: Option<(usize, f64)>, limit: f64| {
        let i = limits.len();
        let all = terms.iter().copied().chain(more);
        all.for_each(|(j, a)| lines.add_triplet(i, j, a));
        limits.push(limit);
    };
    for (terms, value) in &program.equalities {
        line(terms, None, *value);
    }
    for (k, terms) in program.factor.iter().enumerate() {
        line(terms, Some((n + k, -1.0)), 0.0);
    }
    for row in &program.rows {
        line(&row.terms, None, row.limit);
    }
    line(&[], Some((v, -1.0)), 0.5);
    line(&[], Some((v, -1.0)), -0.5);
    for k in 0..m {
        line(&[], Some((n + k, -1.0)), 0.0);
    }
    let mut linear = program.linear.clone();
    linear.resize(v, 0.0);
    linear.push(1.0);
    Conic {
        linear,
        lines,
        limits,
        parts,
    }
}
