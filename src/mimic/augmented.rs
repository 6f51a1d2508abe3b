//! Programs of which many rows bind: an augmented Lagrangian whose inner problems are solved by Newton steps.
//!
//! A proximal method of multipliers (Rockafellar 1976; the steps are those of QPALM, Hermans, Themelis & Patrinos 2022). With
//! `r = A u - b + y / rho`, positive where a row is broken or pressed,
//!
//! ```text
//! phi(u) = u'Pu / 2 + q'u + rho / 2 |max(0, r)|^2 + eps / 2 |u - u_0|^2
//! ```
//!
//! is convex and its gradient piecewise linear. A Newton step takes the rows with `r > 0` for equalities: one factorisation of
//! `P + rho A_F'A_F + eps I`, whose pattern is the same for every `F`; an exact line search makes it converge from anywhere. Afterwards
//! `y = max(0, rho r)` are better multipliers and `u_0 = u`. Gives the optimum, proved, or nothing: programs whose rows contradict
//! each other are the interior point's (`solve`), which says which do.

use super::certificate::optimality;
use super::factor::Factor;
use super::program::{Program, Row, times};
use super::solve::{Method, SolvedBlock};
use sprs::{CsMat, TriMat};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Penalties, relative to the mean diagonal of `P`, which is about 1: a soft one first, under which rows are taken in by whole regions (at
/// 1000 the first round of a plate takes 115 steps instead of 15). It grows where a round of multipliers leaves more than [`SLOW`] of
/// what rows are broken by, up to the hardest: under those, steps go from row to row.
const SOFTEST: f64 = 1.0;
const HARDER: f64 = 10.0;
const HARDEST: f64 = 1e5;
const SLOW: f64 = 0.1;
/// The penalty from which a solution is taken up again when rows were added: the softest would let go of what binds, and harder
/// ones took a third more steps.
const AGAIN: f64 = 10.0;
/// `eps`: what keeps a singular `P` invertible where no row holds it.
const PROXIMAL: f64 = 1e-9;
/// Rounds of multipliers, and Newton steps of all rounds: twice the most seen (198, on a plate with 85,000 unknowns).
const ROUNDS: usize = 40;
const STEPS: u32 = 400;
/// Rows are held to this, in units of the unknowns, and gradients to this.
const HELD: f64 = 1e-7;
const FLAT: f64 = 1e-8;
/// Gradients of the first round, and how much better each next is: exact inner solutions are wasted on multipliers that are far off.
const LOOSE: f64 = 1e-2;
const TIGHTER: f64 = 0.1;
/// A round at the hardest penalty that leaves more than this share of what rows were broken by leads nowhere: rows contradict each other.
const STUCK: f64 = 0.5;
/// Terms below this share of the largest multiplier have vanished. To take a hard program for a contradiction costs time alone: the
/// interior point decides.
const VANISHED: f64 = 1e-3;

/// The optimum of a program; nothing if it is not proved within the limits. `near` is that of the program before rows were added to
/// its end.
pub(crate) fn by_multipliers(program: &Program, near: Option<&SolvedBlock>) -> Option<SolvedBlock> {
    let mut climb = Climb::new(program)?;
    if let Some(near) = near {
        climb.start_at(near);
    }
    let (mut before, mut loose) = (f64::INFINITY, LOOSE);
    for _ in 0..ROUNDS {
        climb.descend(loose)?;
        let contradiction = climb.take_multipliers();
        let broken = climb.broken();
        if broken <= HELD && climb.slope() <= FLAT {
            return climb.proved();
        }
        let stuck = climb.rho >= HARDEST && broken > STUCK * before;
        if contradiction || stuck {
            return None;
        }
        if broken > SLOW * before {
            climb.rho = (HARDER * climb.rho).min(HARDEST);
        }
        before = broken;
        loose = (TIGHTER * loose).max(FLAT / 2.0);
    }
    None
}

/// A program on its way to better multipliers.
struct Climb<'a> {
    program: &'a Program,
    /// Terms and limits: equalities first, then rows.
    lines: Vec<(&'a [(usize, f64)], f64)>,
    equalities: usize,
    /// The pattern of `P + A'A`, upper triangle, with the values of `P + eps I`.
    fixed: CsMat<f64>,
    /// Where the products of each line's terms stand in it.
    products: Vec<Vec<usize>>,
    factor: Factor,
    /// Lines and penalty of the factor.
    factored: (Vec<bool>, f64),
    rho: f64,
    u: Vec<f64>,
    anchor: Vec<f64>,
    y: Vec<f64>,
    /// `A u - b`.
    over: Vec<f64>,
    /// `P u + q`.
    pull: Vec<f64>,
    steps: u32,
}

impl<'a> Climb<'a> {
    fn new(program: &'a Program) -> Option<Self> {
        let equalities = program.equalities.iter().map(|(t, v)| (&t[..], *v));
        let rows = program.rows.iter().map(|r: &Row| (&r.terms[..], r.limit));
        let lines: Vec<(&[(usize, f64)], f64)> = equalities.chain(rows).collect();
        let n = program.variables;
        let mut triplets = TriMat::new((n, n));
        for (v, (i, j)) in &program.quadratic {
            triplets.add_triplet(i, j, *v);
        }
        (0..n).for_each(|i| triplets.add_triplet(i, i, PROXIMAL));
        for (terms, _) in &lines {
            pairs(terms).for_each(|(i, j, _)| triplets.add_triplet(i, j, 0.0));
        }
        let fixed: CsMat<f64> = triplets.to_csc();
        let place = |(i, j, _)| fixed.nnz_index(i, j).map(|at| at.0);
        let products = lines
            .iter()
            .map(|(terms, _)| pairs(terms).map(place).collect());
        let u = vec![0.0; n];
        Some(Self {
            products: products.collect::<Option<_>>()?,
            factor: Factor::of_pattern(&fixed)?,
            factored: (Vec::new(), 0.0),
            fixed,
            rho: SOFTEST,
            anchor: u.clone(),
            y: vec![0.0; lines.len()],
            over: lines.iter().map(|(_, limit)| -limit).collect(),
            pull: program.linear.clone(),
            equalities: program.equalities.len(),
            lines,
            u,
            program,
            steps: 0,
        })
    }

    fn start_at(&mut self, near: &SolvedBlock) {
        self.u.clone_from(&near.u);
        self.y[..self.equalities].copy_from_slice(&near.y);
        self.y[self.equalities..][..near.z.len()].copy_from_slice(&near.z);
        self.rho = AGAIN;
        self.measure();
    }

    /// `r` of a line that presses, or 0.
    fn pressing(&self, i: usize) -> f64 {
        let r = self.over[i] + self.y[i] / self.rho;
        if i < self.equalities { r } else { r.max(0.0) }
    }

    /// The gradient of `phi` but with these multipliers, `rho r` being its own.
    fn gradient(&self, multiplier: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut gradient = self.pull.clone();
        for (g, (u, u0)) in gradient.iter_mut().zip(self.u.iter().zip(&self.anchor)) {
            *g += PROXIMAL * (u - u0);
        }
        for (i, (terms, _)) in self.lines.iter().enumerate() {
            let y = multiplier(i);
            if y != 0.0 {
                terms.iter().for_each(|(j, v)| gradient[*j] += y * v);
            }
        }
        gradient
    }

    /// Newton steps until no entry of the gradient is above `loose`; nothing if there were too many.
    fn descend(&mut self, loose: f64) -> Option<()> {
        loop {
            let gradient = self.gradient(|i| self.rho * self.pressing(i));
            let slope = largest(&gradient);
            if slope <= loose {
                return Some(());
            }
            if self.steps == STEPS {
                return None;
            }
            self.steps += 1;
            let same = self.factorise()?;
            let mut way: Vec<f64> = gradient.iter().map(|g| -g).collect();
            self.factor.solve(&mut way);
            self.walk(&way);
            // With the same rows the step was exact, and what is left is rounding.
            if same && slope <= 100.0 * FLAT {
                return Some(());
            }
        }
    }

    /// Factorises for the lines that press now; whether they are those of the last factor.
    fn factorise(&mut self) -> Option<bool> {
        let pressing: Vec<bool> = (0..self.lines.len())
            .map(|i| i < self.equalities || self.pressing(i) > 0.0)
            .collect();
        if self.factored.0 == pressing && self.factored.1 == self.rho {
            return Some(true);
        }
        let mut values = self.fixed.clone();
        let data = values.data_mut();
        let lines = self.lines.iter().zip(&self.products).zip(&pressing);
        for ((line, places), _) in lines.filter(|(_, presses)| **presses) {
            for ((_, _, product), at) in pairs(line.0).zip(places) {
                data[*at] += self.rho * product;
            }
        }
        self.factor.factorise_again(&values)?;
        self.factored = (pressing, self.rho);
        Some(false)
    }

    /// As far along `way` as `phi` falls.
    fn walk(&mut self, way: &[f64]) {
        let along = |terms: &[(usize, f64)]| terms.iter().map(|(j, v)| v * way[*j]).sum::<f64>();
        let rise: Vec<f64> = self.lines.iter().map(|(terms, _)| along(terms)).collect();
        let bend = times(&self.program.quadratic, way);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let apart = self.u.iter().zip(&self.anchor).map(|(u, u0)| u - u0);
        let drawn: f64 = apart.zip(way).map(|(d, w)| d * w).sum();
        // The slope of `phi` along the way is `fall + stiff t`, plus what each line adds beyond its own turn.
        let mut fall = dot(&self.pull, way) + PROXIMAL * drawn;
        let mut stiff = dot(&bend, way) + PROXIMAL * dot(way, way);
        // Positive numbers are ordered as their bits are.
        let mut turns: Vec<Reverse<(u64, usize)>> = Vec::new();
        for (i, a) in rise.iter().enumerate() {
            let r = self.over[i] + self.y[i] / self.rho;
            if i < self.equalities || r > 0.0 || (r == 0.0 && *a > 0.0) {
                fall += self.rho * r * a;
                stiff += self.rho * a * a;
            }
            let turn = -r / a;
            if i >= self.equalities && *a != 0.0 && turn > 0.0 {
                turns.push(Reverse((turn.to_bits(), i)));
            }
        }
        let mut t = -fall / stiff;
        let mut turns = BinaryHeap::from(turns);
        while let Some(Reverse((_, i))) = turns.pop().filter(|at| f64::from_bits(at.0.0) < t) {
            // A line begins to press where it rises, and lets go where it falls.
            let (r, a) = (self.over[i] + self.y[i] / self.rho, rise[i]);
            let sign = a.signum();
            fall += sign * self.rho * r * a;
            stiff += sign * self.rho * a * a;
            t = -fall / stiff;
        }
        let add = |to: &mut [f64], by: &[f64]| to.iter_mut().zip(by).for_each(|(x, d)| *x += t * d);
        add(&mut self.u, way);
        add(&mut self.pull, &bend);
        add(&mut self.over, &rise);
    }

    /// Better multipliers; whether what they grew by looks like a proof that the rows contradict each other (Farkas): a sum of lines in
    /// which all unknowns vanish and which wants less than nothing.
    fn take_multipliers(&mut self) -> bool {
        let all = 0..self.lines.len();
        let better: Vec<f64> = all.map(|i| self.rho * self.pressing(i)).collect();
        let (mut sum, mut wanted, mut most) = (vec![0.0; self.u.len()], 0.0, 0.0f64);
        for ((terms, limit), (new, old)) in self.lines.iter().zip(better.iter().zip(&self.y)) {
            let grown = new - old;
            terms.iter().for_each(|(j, v)| sum[*j] += v * grown);
            wanted += limit * grown;
            most = most.max(grown.abs());
        }
        let left = largest(&sum);
        self.y = better;
        self.measure();
        left < VANISHED * most && wanted < -VANISHED * most
    }

    /// What steps add up is found anew.
    fn measure(&mut self) {
        self.anchor.clone_from(&self.u);
        self.pull = times(&self.program.quadratic, &self.u);
        self.pull
            .iter_mut()
            .zip(&self.program.linear)
            .for_each(|(p, q)| *p += q);
        let at = |terms: &[(usize, f64)]| terms.iter().map(|(j, v)| v * self.u[*j]).sum::<f64>();
        self.over = self
            .lines
            .iter()
            .map(|(terms, limit)| at(terms) - limit)
            .collect();
    }

    /// By how much lines are broken at most.
    fn broken(&self) -> f64 {
        let by = |i: usize| {
            if i < self.equalities {
                self.over[i].abs()
            } else {
                self.over[i]
            }
        };
        (0..self.lines.len()).map(by).fold(0.0, f64::max)
    }

    /// The largest entry of `P u + q + A'y`, after multipliers were taken: `u_0` is `u` then.
    fn slope(&self) -> f64 {
        largest(&self.gradient(|i| self.y[i]))
    }

    fn proved(self) -> Option<SolvedBlock> {
        let (y, z) = self.y.split_at(self.equalities);
        let proved = optimality(self.program, &self.u, z, y).is_proof();
        proved.then(|| SolvedBlock {
            z: z.to_vec(),
            y: y.to_vec(),
            u: self.u,
            method: Method::AugmentedLagrangian,
            iterations: self.steps,
        })
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The upper triangle of the products of a line's terms with each other.
fn pairs(terms: &[(usize, f64)]) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    terms.iter().enumerate().flat_map(move |(k, (i, a))| {
        let rest = terms[k..].iter();
        rest.map(move |(j, b)| (*i.min(j), *i.max(j), a * b))
    })
}
