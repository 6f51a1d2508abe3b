//! An interior point on the normal equations, for programs of which many rows bind, and which takes more rows on its way.
//!
//! Mehrotra's predictor and corrector (1992). With slacks `s` of the rows, multipliers `z` of rows and `y` of equalities, a step solves
//!
//! ```text
//! (P + A'DA + eps I) du = ...,   D = 1 / (s / z + delta) of rows, 1 / delta of equalities
//! ```
//!
//! so one sparsity pattern serves all steps. It is no larger than that of `P` where rows tie only unknowns that `P` ties already. `delta`
//! and `eps` are the proximal terms of Schwan et al. (PIQP, 2023). They bound `D` and keep the matrix positive definite; they move with
//! the iterate, so the optimum is that of the program itself.
//!
//! An optimum lies on its bounds, and an interior point restarts badly from there. So the solver keeps an iterate some way off, at the
//! barrier [`RESTART`]: it goes on from that iterate when rows are added, and goes on to the optimum only if it is asked to.

use super::certificate::optimality;
use super::program::{Program, times};
use super::solve::{Method, SolvedBlock};
use super::weighted::{Terms, Weighted};

/// Steps to an iterate at most. The programs of the tests and benches take 15 to 40; rows that contradict each other would take any number.
const STEPS: u32 = 80;
/// Mean product of slacks and multipliers at the iterate from which the solver goes on with more rows. A plate of 80,000 vertices takes
/// 13 s at 1e-6, 15 s at 1e-5 and 21 s at 1e-3, where other rows are broken than at the optimum; below 1e-7 new rows leave steps no room.
const RESTART: f64 = 1e-6;
/// Least slack of a row that is added.
const ROOM: f64 = 1e-2;
/// Gap, relative to an objective above 1e-5, and residuals at the end. A relief that fits its layer has an objective of 0: with a gap of
/// 1e-7 it is off the model by 0.3 %.
const GAP: f64 = 1e-7;
const HELD: f64 = 1e-9;
const FLAT: f64 = 1e-8;
/// A multiplier this large is that of a row that contradicts others: they then grow to `1 / delta` in some five steps, where rows are
/// springs. Multipliers of programs with an optimum are below 1 on the bundled scenes.
const CONTRADICTING: f64 = 1e6;
/// Shares of a corrector that are tried.
const CORRECTORS: u32 = 4;
/// Share of the way to the next bound that a step goes.
const SHORT: f64 = 0.995;
/// `delta` of rows and equalities. At 1e-9 the last matrices of an imp with free limbs are not definite in double precision, at 1e-6 it
/// takes a fifth more steps; reliefs on plates take the same steps from 1e-11 to 1e-6.
const GIVING: f64 = 3e-8;
const GIVING_EQUAL: f64 = 1e-8;

/// See the module.
pub struct Interior {
    matrix: Weighted,
    restart: Iterate,
    /// Of all solves.
    steps: u32,
}

#[derive(Clone)]
struct Iterate {
    u: Vec<f64>,
    /// Multipliers of equalities.
    y: Vec<f64>,
    /// Slacks and multipliers of rows.
    s: Vec<f64>,
    z: Vec<f64>,
}

/// What is left to do at an iterate.
struct Residuals {
    /// Of the program.
    objective: f64,
    /// `P u + q + A'z + E'y`, `A u + s - b`, `E u - e`.
    dual: Vec<f64>,
    rows: Vec<f64>,
    equalities: Vec<f64>,
}

/// A step in all unknowns.
type NewtonStep = Iterate;

impl Interior {
    /// Nothing solved yet; nothing at all if memory runs out.
    pub fn new(program: &Program) -> Option<Self> {
        let limits = program.rows.iter().map(|r| r.limit.max(1.0));
        Some(Self {
            matrix: Weighted::new(program)?,
            restart: Iterate {
                u: vec![0.0; program.variables],
                y: vec![0.0; program.equalities.len()],
                s: limits.collect(),
                z: vec![1.0; program.rows.len()],
            },
            steps: 0,
        })
    }

    /// The optimum of the program, to whose end rows may have been added since the last time; unless `exact`, the iterate at the barrier
    /// [`RESTART`]. Nothing if that is not reached, as where rows contradict each other.
    pub fn solve(&mut self, program: &Program, exact: bool) -> Option<SolvedBlock> {
        self.take_in(program)?;
        let mut at = self.restart.clone();
        self.go(program, &mut at, RESTART, Iterate::is_at_restart)?;
        self.restart = at.clone();
        if exact {
            self.go(program, &mut at, 0.0, Iterate::is_optimal)?;
            if !optimality(program, &at.u, &at.z, &at.y).is_proof() {
                return None;
            }
        }
        Some(SolvedBlock {
            u: at.u,
            z: at.z,
            y: at.y,
            method: Method::WarmInterior,
            iterations: self.steps,
        })
    }

    fn take_in(&mut self, program: &Program) -> Option<()> {
        let Iterate { u, s, z, .. } = &mut self.restart;
        let old = s.len();
        if old == program.rows.len() {
            return Some(());
        }
        if !self.matrix.take_in(program) {
            self.matrix = Weighted::new(program)?;
        }
        let mean = mean(s, z).max(RESTART);
        for row in &program.rows[old..] {
            let room = (row.limit - sum(&row.terms, u)).abs().max(ROOM);
            s.push(room);
            z.push(mean / room);
        }
        Some(())
    }

    fn go(
        &mut self,
        program: &Program,
        at: &mut Iterate,
        least: f64,
        done: impl Fn(&Iterate, &Residuals) -> bool,
    ) -> Option<()> {
        for _ in 0..STEPS {
            let residuals = at.residuals(program);
            if done(at, &residuals) {
                return Some(());
            }
            if at.z.iter().any(|z| *z > CONTRADICTING) {
                return None;
            }
            self.steps += 1;
            let step = self.step(program, at, &residuals, least)?;
            let t = (SHORT * at.reach(&step)).min(1.0);
            at.add(&step, t);
        }
        None
    }

    /// Predictor and corrector with one factor.
    fn step(
        &mut self,
        program: &Program,
        at: &Iterate,
        residuals: &Residuals,
        least: f64,
    ) -> Option<NewtonStep> {
        let Iterate { s, z, .. } = at;
        let equal = program.equalities.iter().map(|_| 1.0 / GIVING_EQUAL);
        let of_rows = s.iter().zip(z).map(|(s, z)| 1.0 / (s / z + GIVING));
        let weights: Vec<f64> = equal.chain(of_rows).collect();
        self.matrix.factorise(program, &weights)?;
        let products: Vec<f64> = s.iter().zip(z).map(|(s, z)| s * z).collect();
        let wanted: Vec<f64> = products.iter().map(|p| -p).collect();
        let first = self.newton(program, at, residuals, &weights, &wanted);
        let t = at.reach(&first).min(1.0);
        let mut ahead = at.clone();
        ahead.add(&first, t);
        let mean = mean(s, z);
        let centre = (mean * (ahead.mean() / mean).powi(3)).max(least);
        let bent = first.s.iter().zip(&first.z).map(|(ds, dz)| ds * dz);
        let wanted: Vec<f64> = products
            .iter()
            .zip(bent)
            .map(|(p, bent)| centre - p - bent)
            .collect();
        let second = self.newton(program, at, residuals, &weights, &wanted);
        let step = at.furthest(first, &second);
        step.u.iter().all(|d| d.is_finite()).then_some(step)
    }

    /// The step in which products of slacks and multipliers grow by `wanted`, to first order, and residuals vanish.
    fn newton(
        &self,
        program: &Program,
        at: &Iterate,
        residuals: &Residuals,
        weights: &[f64],
        wanted: &[f64],
    ) -> NewtonStep {
        let Iterate { s, z, .. } = at;
        let count = program.equalities.len();
        let of_rows = (0..s.len()).map(|i| residuals.rows[i] + wanted[i] / z[i]);
        let forces: Vec<f64> = residuals
            .equalities
            .iter()
            .copied()
            .chain(of_rows)
            .collect();
        let mut u: Vec<f64> = residuals.dual.iter().map(|d| -d).collect();
        for ((terms, f), d) in program.lines().zip(&forces).zip(weights) {
            terms.iter().for_each(|(j, v)| u[*j] -= v * d * f);
        }
        self.matrix.solve(&mut u);
        let lines = program.lines().zip(&forces).zip(weights);
        let mut y: Vec<f64> = lines
            .map(|((terms, f), d)| d * (sum(terms, &u) + f))
            .collect();
        let dz = y.split_off(count);
        let ds = (0..s.len()).map(|i| (wanted[i] - s[i] * dz[i]) / z[i]);
        NewtonStep {
            s: ds.collect(),
            z: dz,
            u,
            y,
        }
    }
}

impl Iterate {
    fn residuals(&self, program: &Program) -> Residuals {
        let mut dual = times(&program.quadratic, &self.u);
        let mut objective = 0.0;
        for ((d, q), u) in dual.iter_mut().zip(&program.linear).zip(&self.u) {
            objective += u * (*d / 2.0 + q);
            *d += q;
        }
        let multipliers = self.y.iter().chain(&self.z);
        for (terms, m) in program.lines().zip(multipliers) {
            terms.iter().for_each(|(j, v)| dual[*j] += v * m);
        }
        let rows = program.rows.iter().zip(&self.s);
        let equalities = program.equalities.iter();
        Residuals {
            objective,
            dual,
            rows: rows
                .map(|(row, s)| sum(&row.terms, &self.u) + s - row.limit)
                .collect(),
            equalities: equalities
                .map(|(terms, value)| sum(terms, &self.u) - value)
                .collect(),
        }
    }

    fn is_at_restart(&self, residuals: &Residuals) -> bool {
        self.mean() <= 2.0 * RESTART && residuals.broken() <= RESTART
    }

    fn is_optimal(&self, residuals: &Residuals) -> bool {
        let gap: f64 = self.s.iter().zip(&self.z).map(|(s, z)| s * z).sum();
        residuals.broken() <= HELD
            && largest(&residuals.dual) <= FLAT
            && gap <= GAP * residuals.objective.abs().max(1e-5)
    }

    fn mean(&self) -> f64 {
        mean(&self.s, &self.z)
    }

    /// How much of a step keeps slacks and multipliers from becoming negative.
    fn reach(&self, step: &NewtonStep) -> f64 {
        let room = |x: &[f64], d: &[f64]| {
            let falling = x.iter().zip(d).filter(|(_, d)| **d < 0.0);
            falling.map(|(x, d)| -x / d).fold(f64::INFINITY, f64::min)
        };
        room(&self.s, &step.s).min(room(&self.z, &step.z))
    }

    /// Of the steps from `first` to `second` the one that goes furthest. Where the corrector is much too long the whole of it leads in
    /// circles (Colombo & Gondzio 2008).
    fn furthest(&self, first: NewtonStep, second: &NewtonStep) -> NewtonStep {
        let mixed = |share: f64| {
            let mix = |a: &[f64], b: &[f64]| -> Vec<f64> {
                let pairs = a.iter().zip(b);
                pairs.map(|(a, b)| a + share * (b - a)).collect()
            };
            NewtonStep {
                u: mix(&first.u, &second.u),
                y: mix(&first.y, &second.y),
                s: mix(&first.s, &second.s),
                z: mix(&first.z, &second.z),
            }
        };
        let tries = (1..=CORRECTORS)
            .rev()
            .map(|k| mixed(f64::from(k) / f64::from(CORRECTORS)));
        let reached = tries.map(|step| (self.reach(&step).min(1.0), step));
        let best = reached.reduce(|best, next| if next.0 > best.0 { next } else { best });
        best.map_or(first, |(_, step)| step)
    }

    fn add(&mut self, step: &NewtonStep, t: f64) {
        let add = |x: &mut [f64], d: &[f64]| {
            x.iter_mut().zip(d).for_each(|(x, d)| *x += t * d);
        };
        add(&mut self.u, &step.u);
        add(&mut self.y, &step.y);
        add(&mut self.s, &step.s);
        add(&mut self.z, &step.z);
    }
}

impl Residuals {
    /// By how much rows with their slacks, and equalities, are off at most.
    fn broken(&self) -> f64 {
        largest(&self.rows).max(largest(&self.equalities))
    }
}

fn mean(s: &[f64], z: &[f64]) -> f64 {
    s.iter().zip(z).map(|(s, z)| s * z).sum::<f64>() / s.len().max(1) as f64
}

fn sum(terms: &Terms, x: &[f64]) -> f64 {
    terms.iter().map(|(j, v)| v * x[*j]).sum()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}
