//! Simulated annealing over layouts.

use super::brief::{Brief, Pillar};
use super::forecast::{self, Tally};
use super::skyline::Shadow;
use super::subject::{Outlook, Subject};
use super::survey::{Survey, complete, survey};
use crate::steps::UNSEEN_RAD;
use glam::DVec2;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A layout with all that is known of it.
#[derive(Clone)]
pub struct State {
    pub pillars: Vec<Pillar>,
    pub survey: Survey,
    /// Index: view, outlook, column.
    tallies: Vec<Vec<Vec<Tally>>>,
    /// Mean error of every view, degrees.
    pub hidden_deg: Vec<f64>,
    pub energy: f64,
}

pub struct Problem<'a> {
    pub subjects: &'a [Subject],
    pub brief: &'a Brief,
    pub outlooks: &'a [Vec<Outlook>],
}

impl Problem<'_> {
    pub fn state(&self, pillars: Vec<Pillar>) -> State {
        let survey = survey(self.subjects, self.brief, &pillars);
        let mut state = State {
            pillars,
            survey,
            tallies: Vec::new(),
            hidden_deg: Vec::new(),
            energy: 0.0,
        };
        for outlooks in self.outlooks {
            let of = |o: &Outlook| {
                o.columns
                    .iter()
                    .map(|c| {
                        forecast::tally(
                            self.subjects,
                            self.brief,
                            &state.pillars,
                            &state.survey,
                            o,
                            c,
                        )
                    })
                    .collect()
            };
            state.tallies.push(outlooks.iter().map(of).collect());
        }
        self.weigh(&mut state);
        state
    }

    fn weigh(&self, state: &mut State) {
        state.hidden_deg = state
            .tallies
            .iter()
            .map(|v| forecast::mean(v.iter().flatten().copied()))
            .collect();
        let m = &self.brief.matters;
        let hidden = soft_min(state.hidden_deg.iter().copied(), 2.0);
        let tolerance = soft_min(
            state
                .survey
                .rates
                .iter()
                .map(|r| (UNSEEN_RAD / r[1].max(1e-9)).min(100.0).log2()),
            0.3,
        );
        let score = m.camouflage * hidden / 10.0 + m.tolerance * tolerance
            - m.pillars * state.pillars.len() as f64 / 10.0;
        state.energy = 1.0 * state.survey.faults.sum() - score;
    }

    /// The layout after a change of some pillars' places (same number).
    fn moved(&self, old: &State, pillars: Vec<Pillar>) -> State {
        let n = pillars.len();
        if n != old.pillars.len() {
            return self.state(pillars);
        }
        let changed: Vec<bool> = (0..n).map(|i| pillars[i] != old.pillars[i]).collect();
        let mut found = Survey {
            shadows: old.survey.shadows.clone(),
            ..Survey::default()
        };
        for (v, s) in self.subjects.iter().enumerate() {
            for i in 0..n {
                if changed[i] {
                    found.shadows[v][i] =
                        Shadow::new(s, &pillars[i], &self.brief.shapes[pillars[i].shape]);
                }
            }
        }
        complete(self.subjects, self.brief, &pillars, &mut found);
        let mut state = State {
            pillars,
            survey: found,
            tallies: old.tallies.clone(),
            hidden_deg: Vec::new(),
            energy: 0.0,
        };
        // quick reject
        // Pillars whose look changed
        let dirty: Vec<usize> = (0..n)
            .filter(|i| {
                changed[*i] || {
                    let of = |s: &Survey| -> Vec<(f64, f64)> {
                        old.pillars[*i].owner.map_or(Vec::new(), |v| {
                            s.runs[v]
                                .iter()
                                .filter(|r| r.pillar == Some(*i))
                                .map(|r| (r.from, r.to))
                                .collect()
                        })
                    };
                    of(&old.survey) != of(&state.survey)
                }
            })
            .collect();
        for (v, outlooks) in self.outlooks.iter().enumerate() {
            for (k, o) in outlooks.iter().enumerate() {
                let eye = o.eye.truncate();
                for (c, column) in o.columns.iter().enumerate() {
                    let hit = |p: &Pillar| {
                        column.way.perp_dot(p.at - eye).abs() <= self.brief.shapes[p.shape].reach
                    };
                    if dirty
                        .iter()
                        .any(|i| hit(&old.pillars[*i]) || hit(&state.pillars[*i]))
                    {
                        state.tallies[v][k][c] = forecast::tally(
                            self.subjects,
                            self.brief,
                            &state.pillars,
                            &state.survey,
                            o,
                            column,
                        );
                    }
                }
            }
        }
        self.weigh(&mut state);
        state
    }

    fn propose(&self, rng: &mut Pcg64Mcg, state: &State, heat: f64) -> Vec<Pillar> {
        let mut pillars = state.pillars.clone();
        let n = pillars.len();
        let i = rng.random_range(0..n);
        let owner = pillars[i].owner.unwrap_or(0);
        let s = &self.subjects[owner];
        let ahead = (pillars[i].at - s.o).normalize_or_zero();
        let gauss =
            |rng: &mut Pcg64Mcg| (0..4).map(|_| rng.random_range(-1.0..1.0f64)).sum::<f64>() * 0.87;
        match rng.random_range(0..100) {
            0..35 => pillars[i].at += ahead * gauss(rng) * (1.0 + 12.0 * heat),
            35..60 => pillars[i].at += ahead.perp() * gauss(rng) * (0.3 + 2.0 * heat),
            60..70 => {
                // jump along the ray
                let d = (pillars[i].at - s.o).length() + rng.random_range(-60.0..60.0);
                pillars[i].at = s.o + ahead * d;
            }
            70..80 => {
                // swap depths with a neighbour of the same owner
                let j = rng.random_range(0..n);
                if j != i && pillars[j].owner == pillars[i].owner {
                    let (a, b) = (pillars[i].at - s.o, pillars[j].at - s.o);
                    pillars[i].at = s.o + a.normalize() * b.length();
                    pillars[j].at = s.o + b.normalize() * a.length();
                }
            }
            80..88 => {
                // whole view chain sideways
                let by = gauss(rng) * 0.004;
                for p in pillars.iter_mut().filter(|p| p.owner == Some(owner)) {
                    p.at = s.o + DVec2::from_angle(by).rotate(p.at - s.o);
                }
            }
            88..94 => {
                // insert
                let v = rng.random_range(0..self.subjects.len());
                let s = &self.subjects[v];
                let [a, b] = s.range();
                let at = s.point(
                    rng.random_range(a..b),
                    s.middle.truncate().distance(s.o) + rng.random_range(-70.0..70.0),
                );
                pillars.push(Pillar {
                    at,
                    shape: 0,
                    owner: Some(v),
                    fixed: false,
                });
            }
            _ => {
                pillars.remove(i);
            }
        }
        pillars
    }

    pub fn anneal(&self, start: State, seed: u64, tries: u64) -> (State, u64) {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut now = start;
        let mut best = now.clone();
        let mut accepted = 0;
        for k in 0..tries {
            let heat = 1.0 - k as f64 / tries as f64;
            let temperature = 0.25 * heat * heat + 1e-4;
            let pillars = self.propose(&mut rng, &now, heat);
            if pillars.is_empty() {
                continue;
            }
            let next = self.moved(&now, pillars);
            let drop = now.energy - next.energy;
            if drop >= 0.0 || rng.random_range(0.0..1.0f64) < (drop / temperature).exp() {
                now = next;
                accepted += 1;
                let better = (now.survey.faults.sum() <= 0.0, -now.energy)
                    > (best.survey.faults.sum() <= 0.0, -best.energy);
                if better {
                    best = now.clone();
                }
            }
        }
        (best, accepted)
    }
}

/// A smooth minimum: within `softness * ln n` below it.
fn soft_min(values: impl Iterator<Item = f64> + Clone, softness: f64) -> f64 {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let n = values.clone().count().max(1) as f64;
    let sum: f64 = values.map(|v| (-(v - least) / softness).exp()).sum();
    least - softness * (sum / n).ln()
}
