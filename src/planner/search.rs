//! The search: simulated annealing over layouts.
//!
//! Takes a task and a layout to begin with, faults or not. Gives the best layout without faults that was met, those on
//! the way to it, and what camouflage was reached at which eye tolerance.
//! Deterministic for a seed: chains know nothing of each other or of the time.

use super::moves::propose;
use super::planned::Trade;
use super::task::{AMPLE_MM, Aim, Layout, Task};
use super::watch::{Watch, follow};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// Chains of the search: each as long as they can be, so few.
const CHAINS: u64 = 2;
/// Share of the tries spent on layouts at other tolerances, for the trade-off, and these tolerances: shares of the chosen layout's
/// up to 1, from there to 2 on the way to that of the first layout.
pub(crate) const ASIDE: f64 = 0.25;
const OTHERS: [f64; 5] = [0.5, 0.75, 1.3, 1.6, 1.9];
/// Heat at which those begin, and mending: near what there is.
pub(crate) const WARM: f64 = 0.6;
/// First and last temperature, in units of score; it falls with the square of the heat. At 0.25 most of a search on the reference
/// forest is spent on layouts full of faults, at 0.02 it stays near its start: both end a degree or two lower.
const HOT: f64 = 0.05;
const COLD: f64 = 1e-4;
/// How often a chain looks whether it is to stop, and how long it goes on without heat then, in tries.
const LOOK: u64 = 64;
const QUENCH: u64 = 2000;
/// A chain has converged if such a share of its tries changed nothing, or, below this temperature, gave nothing better by this much:
/// a hundredth of a degree.
const COOL: f64 = 2e-3;
const PATIENCE: f64 = 0.05;
const BETTER: f64 = 1e-3;
/// Most layouts on the way that a chain keeps.
const KEPT: u64 = 22;
/// Bins of tolerance for the trade-off: an eighth of a doubling from a tenth of a millimetre on.
const BINS: usize = 80;
/// Odd, of random bits: seeds that follow each other give streams that do not.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// What a chain has found.
pub(crate) struct Annealed {
    /// The best layout without faults; or else the one with least energy.
    pub best: Layout,
    /// Tries until then and layout, at regular steps.
    pub way: Vec<(u64, Layout)>,
    /// Best forecast at the tolerances met, by bins.
    pub trade: Vec<Option<Trade>>,
    pub tries: u64,
    /// Ended before all tries were made: as nothing better came, or as it was told to.
    pub converged: bool,
    pub stopped: bool,
}

impl Annealed {
    fn new(start: &Layout) -> Self {
        let mut chain = Self {
            best: start.clone(),
            way: vec![(0, start.clone())],
            trade: vec![None; BINS],
            tries: 0,
            converged: false,
            stopped: false,
        };
        chain.trade(start);
        chain
    }

    fn note(&mut self, k: u64, now: &Layout, tries: u64) {
        self.trade(now);
        let better = (!now.is_sound(), now.energy) < (!self.best.is_sound(), self.best.energy);
        if better {
            self.best = now.clone();
        }
        if k >= self.way.last().map_or(0, |w| w.0) + tries.div_ceil(KEPT) {
            self.way.push((k, now.clone()));
        }
    }

    fn trade(&mut self, layout: &Layout) {
        if !layout.is_sound() || layout.hidden_deg.is_empty() {
            return;
        }
        let (tolerance_mm, hidden_deg) = (layout.survey.least_tolerance(), layout.least_hidden());
        let bin = 8.0 * (tolerance_mm.min(AMPLE_MM) / 0.1).log2();
        let best = &mut self.trade[(bin.max(0.0) as usize).min(BINS - 1)];
        if best.is_none_or(|b| b.hidden_deg < hidden_deg) {
            *best = Some(Trade {
                tolerance_mm,
                hidden_deg,
                chosen: false,
            });
        }
    }
}

/// The best of [`CHAINS`] chains from one layout, with the tries of all.
pub(crate) fn best_of(
    task: &Task,
    from: &Layout,
    tries: u64,
    heat: f64,
    watch: Watch,
    (stage, shares): (&str, [f64; 2]),
) -> Annealed {
    let each = tries / CHAINS;
    let chains: Vec<Annealed> = (0..CHAINS)
        .into_par_iter()
        .map(|stream| {
            anneal(
                task,
                from.clone(),
                stream,
                each,
                heat,
                &follow(watch, stage, shares, each),
            )
        })
        .collect();
    together(chains)
}

/// The chain with the best layout, which learns what the others found.
fn together(chains: Vec<Annealed>) -> Annealed {
    let tries = chains.iter().map(|c| c.tries).sum();
    let stopped = chains.iter().any(|c| c.stopped);
    let converged = chains.iter().all(|c| c.converged);
    let mut trade = Vec::new();
    chains
        .iter()
        .for_each(|c| trade.extend(c.trade.iter().flatten().map(|t| Some(*t))));
    let better = |a: Annealed, b: Annealed| {
        let worse = (!b.best.is_sound(), b.best.energy) < (!a.best.is_sound(), a.best.energy);
        if worse { b } else { a }
    };
    let best = chains
        .into_iter()
        .reduce(better)
        .expect("at least one chain");
    Annealed {
        trade,
        tries,
        converged,
        stopped,
        ..best
    }
}

/// Short searches at other tolerances: from the chosen layout at lower ones, from the first one, which has room for more, at higher
/// ones.
pub(crate) fn aside(
    task: &Task,
    [first, chosen]: [&Layout; 2],
    tries: u64,
    watch: Watch,
) -> Vec<Annealed> {
    let each = tries / OTHERS.len() as u64;
    let (low, high) = (
        chosen.survey.least_tolerance(),
        first.survey.least_tolerance(),
    );
    let chain = |(k, place): (usize, f64)| {
        let (from, floor) = if place < 1.0 {
            (chosen, place * low)
        } else {
            (first, low * (high / low).max(1.0).powf(place - 1.0))
        };
        let mut brief = task.brief.clone();
        brief.tolerance_mm.iter_mut().for_each(|t| *t = floor);
        // Only the tolerance's floor counts, not its growth.
        brief.matters.tolerance = 0.0;
        let other = Task {
            brief: &brief,
            ..*task
        };
        let begun = other.layout(from.pillars.clone(), from.poses.clone());
        let watch = follow(watch, "trade-off", [0.85, 0.98], each);
        anneal(&other, begun, CHAINS + k as u64, each, WARM, &watch)
    };
    OTHERS.into_par_iter().enumerate().map(chain).collect()
}

/// Anneals for `tries` candidates from `heat` (0 to 1) down.
fn anneal(
    task: &Task,
    start: Layout,
    stream: u64,
    tries: u64,
    heat: f64,
    watch: &dyn Fn(u64) -> bool,
) -> Annealed {
    let mut rng =
        Pcg64Mcg::seed_from_u64(task.brief.seed.wrapping_mul(GOLDEN).wrapping_add(stream));
    let mut chain = Annealed::new(&start);
    let mut now = start;
    let (mut stopped, mut end, mut k) = (false, tries, 0);
    let patience = ((PATIENCE * tries as f64) as u64).max(QUENCH);
    let (mut low, mut since, mut moved) = (f64::INFINITY, 0, 0);
    while k < end {
        if !stopped && k % LOOK == 0 && watch(k) {
            (stopped, end) = (true, tries.min(k + QUENCH));
        }
        let heat = if stopped {
            0.0
        } else {
            heat * (1.0 - k as f64 / tries as f64)
        };
        let temperature = HOT * heat * heat + COLD;
        if temperature > COOL || chain.best.energy < low - BETTER {
            (low, since) = (chain.best.energy, k);
        }
        if !stopped && k - since.min(moved) > patience {
            chain.converged = true;
            break;
        }
        k += 1;
        let Some(proposal) = propose(task, &mut rng, &now, heat) else {
            continue;
        };
        // Metropolis: the threshold first, so that hopeless candidates are not looked at in full.
        let luck: f64 = rng.random_range(f64::MIN_POSITIVE..1.0);
        let ceiling = now.energy - temperature * luck.ln();
        let Some(next) = task.after(&now, proposal, ceiling) else {
            continue;
        };
        if next.energy <= ceiling {
            (now, moved) = (next, k);
            chain.note(k, &now, tries);
            if task.aim == Aim::Sound && now.is_sound() {
                break;
            }
        }
    }
    chain.tries = k;
    chain.stopped = stopped;
    chain
}
