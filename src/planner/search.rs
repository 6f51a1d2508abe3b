//! The search: simulated annealing over layouts.
//!
//! Takes a problem and a layout to begin with, faults or not. Gives the best layout without faults that was met, those on
//! the way to it, and what camouflage was reached at which eye tolerance. A candidate differs from its predecessor in a pillar or two;
//! its faults are surveyed exactly, and the forecast is redone for the columns of rays that meet something changed.
//! Deterministic for a seed: chains know nothing of each other or of the time.

use super::brief::{Adjustment, Brief, Pillar};
use super::forecast::{Forest, Tally};
use super::moves::{Proposal, propose};
use super::skyline::Shadow;
use super::subject::{Outlook, Subject};
use super::survey::Survey;
use super::{Trade, Watch};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Score lost by a millimetre of fault, and by any fault at all: ten degrees of camouflage are worth a score of 1.
const WRONG_A_MM: f64 = 1.0;
const WRONG_AT_ALL: f64 = 0.05;
/// First and last temperature, in units of score; it falls with the square of the heat. At 0.25 most of a search on the reference forest
/// is spent on layouts full of faults, at 0.02 it stays near its start: both end a degree or two lower.
const HOT: f64 = 0.05;
const COLD: f64 = 1e-4;
/// Degrees and doublings over which the worst view counts most: sharper minima leave the search without direction.
const SOFT_DEG: f64 = 2.0;
const SOFT_DOUBLINGS: f64 = 0.3;
/// Degrees of hidden likeness worth a score of 1.
const DEGREES: f64 = 10.0;
/// Pillars worth a score of 1.
const PILLARS: f64 = 10.0;
/// Tolerances beyond this are as good as any, millimetres.
const AMPLE_MM: f64 = 100.0;
/// No normal is farther off than this, degrees.
const FARTHEST_OFF_DEG: f64 = 180.0;
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

/// A view with its models in one pose.
pub struct Pose {
    pub adjustment: Adjustment,
    pub subject: Subject,
    pub outlooks: Vec<Outlook>,
}

/// What is to be solved.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    pub brief: &'a Brief,
    /// Index: view, pose; the first pose is the scene's own.
    pub poses: &'a [Vec<Pose>],
    pub aim: Aim,
}

/// What makes a layout good once it is without faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// Nothing more: the search ends with the first such layout.
    Sound,
    /// What the brief says matters.
    Hide,
    /// Few changes of given pillars.
    Mend,
}

/// A layout with all that is known of it.
#[derive(Clone)]
pub struct Layout {
    pub pillars: Vec<Pillar>,
    /// Index: view.
    pub poses: Vec<usize>,
    pub survey: Survey,
    /// Index: view, outlook, column.
    tallies: Vec<Vec<Vec<Tally>>>,
    /// Forecast mean error of every view, degrees.
    pub hidden_deg: Vec<f64>,
    pub energy: f64,
}

impl Layout {
    pub fn is_sound(&self) -> bool {
        self.survey.faults.is_empty()
    }

    /// Least forecast of all views, degrees.
    pub fn least_hidden(&self) -> f64 {
        self.hidden_deg
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min)
    }
}

impl Problem<'_> {
    pub fn subjects(&self, poses: &[usize]) -> Vec<&Subject> {
        self.poses
            .iter()
            .zip(poses)
            .map(|(of_view, pose)| &of_view[*pose].subject)
            .collect()
    }

    /// Everything of a layout, from nothing.
    pub fn layout(&self, pillars: Vec<Pillar>, poses: Vec<usize>) -> Layout {
        let subjects = self.subjects(&poses);
        let survey = Survey::new(&subjects, self.brief, &pillars);
        let forest = Forest {
            subjects: &subjects,
            brief: self.brief,
            pillars: &pillars,
            survey: &survey,
        };
        let of_outlook = |o: &Outlook| o.columns.iter().map(|c| forest.column(o.eye, c)).collect();
        let of_view = |v: usize| {
            self.poses[v][poses[v]]
                .outlooks
                .iter()
                .map(of_outlook)
                .collect()
        };
        let tallies = match self.aim {
            Aim::Hide => (0..poses.len()).map(of_view).collect(),
            Aim::Sound | Aim::Mend => Vec::new(),
        };
        let mut layout = Layout {
            pillars,
            poses,
            survey,
            tallies,
            hidden_deg: Vec::new(),
            energy: 0.0,
        };
        layout.hidden_deg = hidden(&layout.tallies);
        layout.energy = self.energy(&layout);
        layout
    }

    /// The layout after a proposal; `None` if its energy is surely above `ceiling`.
    fn after(&self, old: &Layout, proposal: Proposal, ceiling: f64) -> Option<Layout> {
        let Proposal { pillars, poses } = proposal;
        if poses != old.poses {
            return Some(self.layout(pillars, poses));
        }
        let subjects = self.subjects(&poses);
        let same = |(i, p): (usize, &Pillar)| old.pillars.get(i) == Some(p);
        let changed: Vec<bool> = pillars.iter().enumerate().map(|p| !same(p)).collect();
        let mut shadows = old.survey.shadows.clone();
        for (of_view, subject) in shadows.iter_mut().zip(&subjects) {
            of_view.resize(pillars.len(), Shadow::default());
            for i in (0..pillars.len()).filter(|i| changed[*i]) {
                of_view[i] =
                    Shadow::new(subject, &pillars[i], &self.brief.shapes[pillars[i].shape]);
            }
        }
        let survey = Survey::with_shadows(&subjects, self.brief, &pillars, shadows);
        let mut layout = Layout {
            pillars,
            poses,
            survey,
            tallies: Vec::new(),
            hidden_deg: Vec::new(),
            energy: 0.0,
        };
        if self.aim == Aim::Hide {
            let dirty = self.dirty(old, &layout, &changed);
            layout.hidden_deg = bounds(&old.tallies, &dirty);
            if self.energy(&layout) > ceiling {
                return None;
            }
            layout.tallies = self.retold(old, &layout, &subjects, &dirty);
            layout.hidden_deg = hidden(&layout.tallies);
        }
        layout.energy = self.energy(&layout);
        Some(layout)
    }

    /// Columns, as view, outlook and column, whose rays meet something that has changed.
    fn dirty(&self, old: &Layout, new: &Layout, changed: &[bool]) -> Vec<[usize; 3]> {
        let mut places: Vec<(DVec2, f64)> = Vec::new();
        let reach = |p: &Pillar| self.brief.shapes[p.shape].reach;
        for (i, p) in new.pillars.iter().enumerate() {
            if changed[i] || !same_runs(old, new, i) {
                places.push((p.at, reach(p)));
            }
        }
        let before = old.pillars.iter().enumerate();
        let gone =
            before.filter(|(i, p)| new.pillars.get(*i) != Some(p) || !same_runs(old, new, *i));
        places.extend(gone.map(|(_, p)| (p.at, reach(p))));
        let mut dirty = Vec::new();
        for (v, of_view) in self.poses.iter().enumerate() {
            for (o, outlook) in of_view[new.poses[v]].outlooks.iter().enumerate() {
                let offsets: Vec<(DVec2, f64)> = places
                    .iter()
                    .map(|(at, r)| (*at - outlook.eye.truncate(), *r))
                    .collect();
                for (c, column) in outlook.columns.iter().enumerate() {
                    if offsets
                        .iter()
                        .any(|(at, r)| column.way.perp_dot(*at).abs() <= *r)
                    {
                        dirty.push([v, o, c]);
                    }
                }
            }
        }
        dirty
    }

    fn retold(
        &self,
        old: &Layout,
        new: &Layout,
        subjects: &[&Subject],
        dirty: &[[usize; 3]],
    ) -> Vec<Vec<Vec<Tally>>> {
        let mut tallies = old.tallies.clone();
        let (pillars, survey) = (&new.pillars, &new.survey);
        let forest = Forest {
            subjects,
            brief: self.brief,
            pillars,
            survey,
        };
        for [v, o, c] in dirty.iter().copied() {
            let outlook = &self.poses[v][new.poses[v]].outlooks[o];
            tallies[v][o][c] = forest.column(outlook.eye, &outlook.columns[c]);
        }
        tallies
    }

    /// What annealing lowers: faults, less the score.
    fn energy(&self, layout: &Layout) -> f64 {
        let wrong = layout.survey.wrong();
        let faults = WRONG_A_MM * wrong + if wrong > 0.0 { WRONG_AT_ALL } else { 0.0 };
        match self.aim {
            Aim::Sound => faults,
            Aim::Hide => faults - self.score(layout),
            Aim::Mend => {
                faults * super::repair::FIRST_SOUND
                    + super::repair::cost(self.brief, &layout.pillars)
            }
        }
    }

    /// What the brief's weights make of a layout: a view's likeness hidden by ten degrees more, an eye tolerance twice as large, ten
    /// pillars fewer or spaces between them all equal are worth one weight each. Of the views the worst counts most.
    pub fn score(&self, layout: &Layout) -> f64 {
        let matters = &self.brief.matters;
        let hidden = soft_least(layout.hidden_deg.iter().copied(), SOFT_DEG) / DEGREES;
        let views = 0..layout.survey.rates.len();
        let doublings = views.map(|v| layout.survey.tolerance(v).min(AMPLE_MM).log2());
        let spread = if matters.spread > 0.0 {
            unevenness(&layout.pillars)
        } else {
            0.0
        };
        matters.camouflage * hidden + matters.tolerance * soft_least(doublings, SOFT_DOUBLINGS)
            - matters.pillars * layout.pillars.len() as f64 / PILLARS
            - matters.spread * spread
    }

    /// Anneals for `tries` candidates from `heat` (0 to 1) down.
    pub fn anneal(
        &self,
        start: Layout,
        stream: u64,
        tries: u64,
        heat: f64,
        watch: &dyn Fn(u64) -> bool,
    ) -> Chain {
        let mut rng =
            Pcg64Mcg::seed_from_u64(self.brief.seed.wrapping_mul(GOLDEN).wrapping_add(stream));
        let mut chain = Chain::new(&start);
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
            let Some(proposal) = propose(self, &mut rng, &now, heat) else {
                continue;
            };
            // Metropolis: the threshold first, so that hopeless candidates are not looked at in full.
            let luck: f64 = rng.random_range(f64::MIN_POSITIVE..1.0);
            let ceiling = now.energy - temperature * luck.ln();
            let Some(next) = self.after(&now, proposal, ceiling) else {
                continue;
            };
            if next.energy <= ceiling {
                (now, moved) = (next, k);
                chain.note(k, &now, tries);
                if self.aim == Aim::Sound && now.is_sound() {
                    break;
                }
            }
        }
        chain.tries = k;
        chain.stopped = stopped;
        chain
    }
}

/// Odd, of random bits: seeds that follow each other give streams that do not.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// What a chain has found.
pub struct Chain {
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

impl Chain {
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

/// The stretches of bearings over which a pillar is seen by its owner.
fn runs_of(layout: &Layout, i: usize) -> impl Iterator<Item = (f64, f64)> {
    let pillar = layout.pillars.get(i);
    let runs = pillar
        .and_then(|p| p.owner)
        .map(|v| layout.survey.runs[v].iter());
    let own = runs
        .into_iter()
        .flatten()
        .filter(move |r| r.pillar == Some(i));
    own.map(|r| (r.from, r.to))
}

fn same_runs(a: &Layout, b: &Layout, i: usize) -> bool {
    runs_of(a, i).eq(runs_of(b, i))
}

fn hidden(tallies: &[Vec<Vec<Tally>>]) -> Vec<f64> {
    let of_view = |v: &Vec<Vec<Tally>>| v.iter().flatten().copied().sum::<Tally>().mean_error_deg();
    tallies.iter().map(of_view).collect()
}

/// More than the forecast of every view can become if the dirty columns change.
fn bounds(tallies: &[Vec<Vec<Tally>>], dirty: &[[usize; 3]]) -> Vec<f64> {
    let mut sums: Vec<Tally> = tallies
        .iter()
        .map(|v| v.iter().flatten().copied().sum())
        .collect();
    for [v, o, c] in dirty.iter().copied() {
        let tally = tallies[v][o][c];
        sums[v].error_deg += FARTHEST_OFF_DEG * tally.rays as f64 - tally.error_deg;
    }
    sums.iter().map(Tally::mean_error_deg).collect()
}

/// The mean of `exp(-value / softness)` taken back: between the least value and `softness ln n` above it.
fn soft_least(values: impl Iterator<Item = f64> + Clone, softness: f64) -> f64 {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let (sum, n) = values.fold((0.0, 0), |(sum, n), v| {
        (sum + (-(v - least) / softness).exp(), n + 1)
    });
    if n == 0 {
        0.0
    } else {
        least - softness * (sum / f64::from(n)).ln()
    }
}

/// Standard deviation over mean of every pillar's distance to its nearest neighbour: 0 if all are equal.
fn unevenness(pillars: &[Pillar]) -> f64 {
    let nearest = |i: usize| {
        let others = pillars.iter().enumerate().filter(move |(j, _)| *j != i);
        others
            .map(|(_, p)| p.at.distance(pillars[i].at))
            .fold(f64::INFINITY, f64::min)
    };
    if pillars.len() < 2 {
        return 0.0;
    }
    let all: Vec<f64> = (0..pillars.len()).map(nearest).collect();
    let n = all.len() as f64;
    let mean = all.iter().sum::<f64>() / n;
    (all.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt() / mean
}

/// Reports progress of several chains as one, and passes on when to stop.
pub fn follow<'a>(
    watch: Watch<'a>,
    stage: &'a str,
    [from, to]: [f64; 2],
    tries: u64,
) -> impl Fn(u64) -> bool + 'a {
    move |k| {
        (watch.progress)(stage, from + (to - from) * k as f64 / tries.max(1) as f64);
        (watch.stop)()
    }
}
