//! Programs of which few rows bind, by one factorisation and a small dual.
//!
//! The curvature energy's `P` knows nothing of bounds, and of its rows some hundred bind. So `P` is factorised once, and rows are taken
//! in hand where the last solution breaks them most; between those the program is the small one of [`contacts`], with `K = G P^-1 G'`.
//! Gives the optimum of a program or nothing: programs of which many rows bind, or contradict each other, are the interior
//! point's (`solve`).
//!
//! `P` alone is singular: it has a null direction for every component of the mesh, along which `s` is scaled, and scales `mu` have next
//! to no stiffness. Every such part of `P` is pinned: `Q = P + sigma e e'`, with one unknown `e` of each, is factorised in its
//! place, and
//! `n = sigma Q^-1 e` is the direction in which the part gives way (1 everywhere for a component). With amounts `t` of them as free
//! unknowns
//!
//! ```text
//! u = n t - Q^-1 (q + G'z),    S t + n'q + n'G'z = 0,    S = n'P n / n_e
//! ```
//!
//! holds for every `P`, singular or not. Equalities are rows whose multipliers have any sign. `K` has but the digits of the factor; so
//! residuals are measured on `u`, which is refined through differences, and fed back.

mod contacts;
mod pinned;

use super::certificate::optimality;
use super::factor::Half;
use super::program::Program;
use super::solve::{Method, SolvedBlock};
use contacts::Contacts;
use pinned::Pinned;
use rayon::prelude::*;

/// Rows are held to this, in units of the unknowns: a tenth of what they are tightened by (`lazily::MARGIN`). Solutions are
/// uncertain by 2e-8 at 50,000 vertices; at 1e-9 a skull went on for twelve rounds without getting better.
const HELD: f64 = 1e-7;
/// Most rows taken in hand at once: more make rounds fewer, but most of them idle.
const AT_ONCE: usize = 300;
/// So few broken rows are all taken in hand, not only the worst of their surroundings: that saves the last rounds, which find one
/// or two each.
const FEW: usize = 60;
/// Rows that bind from which it is given up if no end is in sight, for the interior point is sooner done with thousands: outlines that
/// are held at every vertex (2,600 rows of 60,000 unknowns: 15 s, and 8 s for the first 1,700 of them here).
const MANY: usize = 600;
/// Most rows that bind, and rows in hand.
const BINDING: usize = 1500;
const IN_HAND: usize = 6000;
/// Most parts that may give way. Each binds some four rows, and every step factorises between them: with 160 parts 0.8 s where the interior
/// point takes as long, with 450 to 600 it was given up after 6 to 10 s where the interior point takes 2.
const PARTS: usize = 250;
/// Most rounds of one solution.
const ROUNDS: u32 = 60;

/// A factorised program with the rows in hand; more rows may be added to the program at its end.
pub struct Dual {
    pinned: Pinned,
    contacts: Contacts,
    /// `Q^-1 q`.
    rest: Vec<f64>,
    /// `-Q^-1 (q + G'z)` of the last solution, where the next begins.
    bent: Vec<f64>,
    /// `n'q`.
    force: Vec<f64>,
    /// `L^-1 g` of rows in hand, equalities first.
    halves: Vec<Half>,
    /// Rows in hand after the equalities.
    in_hand: Vec<usize>,
    /// Of every row of the program, whether it is in hand.
    is_in_hand: Vec<bool>,
    rounds: u32,
}

impl Dual {
    /// Factorises a program; nothing if its form is indefinite or more than [`PARTS`] parts of it give way.
    pub fn new(program: &Program) -> Option<Self> {
        let pinned = Pinned::new(&program.quadratic, PARTS)?;
        let mut dual = Self {
            contacts: Contacts::new(pinned.stiffness.clone()),
            rest: pinned.solve(vec![0.0; program.variables], &program.linear),
            bent: vec![0.0; program.variables],
            force: pinned.along(&program.linear),
            pinned,
            halves: Vec::new(),
            in_hand: Vec::new(),
            is_in_hand: Vec::new(),
            rounds: 0,
        };
        let equalities = program.equalities.iter();
        let equalities: Vec<WeightedSum> = equalities
            .map(|(terms, value)| (&terms[..], *value))
            .collect();
        dual.take_in_hand(&equalities, true);
        Some(dual)
    }

    /// The optimum of the program, to which rows may have been added since the last time; nothing if it is not proved within
    /// the limits.
    pub fn solve(&mut self, program: &Program) -> Option<SolvedBlock> {
        self.is_in_hand.resize(program.rows.len(), false);
        for _ in 0..ROUNDS {
            self.rounds += 1;
            self.lend();
            if !self.contacts.solve() {
                return None;
            }
            let (u, z, y) = self.result(program);
            let off = self.feed_back(program, &u);
            let news = self.broken(program, &u);
            if news.is_empty() && off <= HELD {
                return self.proved(program, u, z, y);
            }
            let most = if news.len() == AT_ONCE { MANY } else { BINDING };
            if self.contacts.binding() > most || self.in_hand.len() + news.len() > IN_HAND {
                return None;
            }
            let lines = news
                .iter()
                .map(|r| (&program.rows[*r].terms[..], program.rows[*r].limit));
            self.take_in_hand(&lines.collect::<Vec<WeightedSum>>(), false);
            news.iter().for_each(|r| self.is_in_hand[*r] = true);
            self.in_hand.extend(news);
        }
        None
    }

    /// Lent stiffness draws to the last solution.
    fn lend(&mut self) {
        let (lent, t) = (&self.pinned.lent, &self.contacts.t);
        let forces = self.force.iter().zip(lent).zip(t);
        self.contacts.d = forces.map(|((f, l), t)| f - l * t).collect();
    }

    fn take_in_hand(&mut self, lines: &[WeightedSum], equal: bool) {
        let n = self.rest.len();
        let half = |work: &mut Vec<f64>, line: &WeightedSum| self.pinned.half(line.0, work);
        let halves = lines.par_iter().map_init(|| vec![0.0; n], half);
        let old = self.halves.len();
        let halves: Vec<Half> = halves.collect();
        self.halves.extend(halves);
        let products = |i: usize| {
            let row = &self.halves[i];
            self.halves[..=i].iter().map(|h| row.dot(h)).collect()
        };
        let products: Vec<Vec<f64>> = (old..self.halves.len())
            .into_par_iter()
            .map(products)
            .collect();
        for (k, line) in products.into_iter().zip(lines) {
            // u = -Q^-1 q without any multipliers.
            let c = -at(&(line.0, 0.0), &self.rest) - line.1;
            self.contacts
                .push(k, self.pinned.along_terms(line.0), c, equal);
        }
    }

    /// `u` and the multipliers of rows and equalities.
    fn result(&mut self, program: &Program) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let (y, held) = self.contacts.z.split_at(program.equalities.len());
        let mut z = vec![0.0; program.rows.len()];
        let mut force: Vec<f64> = program.linear.iter().map(|q| -q).collect();
        for ((terms, _), y) in program.equalities.iter().zip(y) {
            terms.iter().for_each(|(j, v)| force[*j] -= v * y);
        }
        for (r, value) in self.in_hand.iter().zip(held) {
            z[*r] = *value;
            let terms = &program.rows[*r].terms;
            terms.iter().for_each(|(j, v)| force[*j] -= v * value);
        }
        self.bent = self.pinned.solve(std::mem::take(&mut self.bent), &force);
        let mut u = self.bent.clone();
        let moved = self.pinned.moved(&self.contacts.t);
        u.iter_mut().zip(moved).for_each(|(u, m)| *u += m);
        (u, z, y.to_vec())
    }

    /// Tells the small program what residuals are in truth; the largest by which a row in hand is not as it should be.
    fn feed_back(&mut self, program: &Program, u: &[f64]) -> f64 {
        let equalities = program
            .equalities
            .iter()
            .map(|(terms, value)| at(&(terms, *value), u));
        let rows = self.in_hand.iter().map(|r| &program.rows[*r]);
        let rows = rows.map(|row| at(&(&row.terms, row.limit), u));
        let residuals: Vec<f64> = equalities.chain(rows).collect();
        self.contacts.correct(&residuals)
    }

    /// Rows that `u` breaks more than all others near them, worst first.
    fn broken(&self, program: &Program, u: &[f64]) -> Vec<usize> {
        let rows = program.rows.iter().enumerate();
        let broken = rows.filter(|(r, _)| !self.is_in_hand[*r]);
        let broken = broken.map(|(r, row)| (at(&(&row.terms, row.limit), u), r));
        let mut broken: Vec<(f64, usize)> = broken.filter(|b| b.0 > HELD).collect();
        broken.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        // Ranks instead of residuals, so that no two are alike.
        let mut least = vec![usize::MAX; u.len()];
        for (rank, (_, r)) in broken.iter().enumerate() {
            for (v, _) in &program.rows[*r].terms {
                least[*v] = least[*v].min(rank);
            }
        }
        let near = self.pinned.least_near(&least);
        let alone = |(rank, (_, r)): (usize, &(f64, usize))| {
            let best =
                broken.len() <= FEW || program.rows[*r].terms.iter().all(|(v, _)| near[*v] >= rank);
            best.then_some(*r)
        };
        let peaks = broken.iter().enumerate().filter_map(alone);
        peaks.take(AT_ONCE).collect()
    }

    fn proved(
        &self,
        program: &Program,
        u: Vec<f64>,
        z: Vec<f64>,
        y: Vec<f64>,
    ) -> Option<SolvedBlock> {
        let optimality = optimality(program, &u, &z, &y);
        optimality.is_proof().then_some(SolvedBlock {
            u,
            z,
            y,
            method: Method::DualWorkingSet,
            iterations: self.rounds,
        })
    }
}

/// Terms and limit of a row, or value of an equality.
type WeightedSum<'a> = (&'a [(usize, f64)], f64);

/// By how much a line is overstepped at `u`.
fn at(line: &WeightedSum, u: &[f64]) -> f64 {
    line.0.iter().map(|(j, v)| v * u[*j]).sum::<f64>() - line.1
}
