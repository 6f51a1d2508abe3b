//! What a search is to solve, and everything that is known of one layout.
//!
//! A candidate differs from its predecessor in a pillar or two: its faults are surveyed exactly, with what the eyes meet followed
//! from the predecessor, and the forecast is redone for the columns of rays that meet something changed.

use super::brief::{Adjustment, Brief, Pillar};
use super::forecast::{Forecast, Tally};
use super::subject::{Outlook, Subject};
use super::survey::Survey;
use glam::DVec2;

/// Score lost by a millimetre of fault, and by any fault at all: ten degrees of camouflage are worth a score of 1.
const WRONG_A_MM: f64 = 1.0;
const WRONG_AT_ALL: f64 = 0.05;
/// Degrees and doublings over which the worst view counts most: sharper minima leave the search without direction.
const SOFT_DEG: f64 = 2.0;
const SOFT_DOUBLINGS: f64 = 0.3;
/// Degrees of hidden likeness worth a score of 1.
const DEGREES: f64 = 10.0;
/// Pillars worth a score of 1.
const PILLARS: f64 = 10.0;
/// Tolerances beyond this are as good as any, millimetres.
pub(crate) const AMPLE_MM: f64 = 100.0;
/// No normal is farther off than this, degrees.
const FARTHEST_OFF_DEG: f64 = 180.0;
/// Faults weigh this much more than changes.
const FIRST_SOUND: f64 = 10.0;
/// What a change costs: any at all, more if a pillar comes or goes, and every millimetre of the way.
const CHANGE: f64 = 1.0;
const COME_OR_GO: f64 = 0.5;
const A_MM: f64 = 0.02;

/// A view with its models in one pose.
pub(crate) struct Pose {
    pub adjustment: Adjustment,
    pub subject: Subject,
    pub outlooks: Vec<Outlook>,
}

/// What is to be solved.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    pub brief: &'a Brief,
    /// Index: view, pose; the first pose is the scene's own.
    pub poses: &'a [Vec<Pose>],
    pub aim: Aim,
}

/// What makes a layout good once it is without faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    /// Nothing more: the search ends with the first such layout.
    Sound,
    /// What the brief says matters.
    Hide,
    /// Few changes of given pillars.
    Mend,
}

/// A layout with all that is known of it.
#[derive(Clone)]
pub(crate) struct Layout {
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
    pub(crate) fn is_sound(&self) -> bool {
        self.survey.faults.is_empty()
    }

    /// Least forecast of all views, degrees.
    pub(crate) fn least_hidden(&self) -> f64 {
        self.hidden_deg
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min)
    }
}

impl Task<'_> {
    pub(crate) fn subjects(&self, poses: &[usize]) -> Vec<&Subject> {
        self.poses
            .iter()
            .zip(poses)
            .map(|(of_view, pose)| &of_view[*pose].subject)
            .collect()
    }

    /// Everything of a layout, from nothing.
    pub(crate) fn layout(&self, pillars: Vec<Pillar>, poses: Vec<usize>) -> Layout {
        let subjects = self.subjects(&poses);
        let survey = Survey::new(&subjects, self.brief, &pillars);
        let forest = Forecast {
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

    /// The layout of these pillars and poses, a few of which differ from the old one's; `None` if its energy is surely above `ceiling`.
    pub(crate) fn after(
        &self,
        old: &Layout,
        (pillars, poses): (Vec<Pillar>, Vec<usize>),
        ceiling: f64,
    ) -> Option<Layout> {
        if poses != old.poses {
            return Some(self.layout(pillars, poses));
        }
        let subjects = self.subjects(&poses);
        let same = |i: &usize| old.pillars.get(*i) == pillars.get(*i);
        let most = pillars.len().max(old.pillars.len());
        let changed: Vec<usize> = (0..most).filter(|i| !same(i)).collect();
        let survey = old.survey.after(&subjects, self.brief, &pillars, &changed);
        let mut layout = Layout {
            pillars,
            poses,
            survey,
            tallies: Vec::new(),
            hidden_deg: Vec::new(),
            energy: 0.0,
        };
        if self.aim == Aim::Hide {
            let dirty = self.dirty(old, &layout);
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
    fn dirty(&self, old: &Layout, new: &Layout) -> Vec<[usize; 3]> {
        let mut places: Vec<(DVec2, f64)> = Vec::new();
        let reach = |p: &Pillar| self.brief.shapes[p.shape].reach;
        for (one, other) in [(new, old), (old, new)] {
            let numbered = one.pillars.iter().enumerate();
            let gone = numbered
                .filter(|(i, p)| other.pillars.get(*i) != Some(p) || !same_runs(one, other, *i));
            places.extend(gone.map(|(_, p)| (p.at, reach(p))));
        }
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
        let forest = Forecast {
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
            Aim::Mend => faults * FIRST_SOUND + cost(self.brief, &layout.pillars),
        }
    }

    /// What the brief's weights make of a layout: a view's likeness hidden by ten degrees more, an eye tolerance twice as large, ten
    /// pillars fewer or spaces between them all equal are worth one weight each. Of the views the worst counts most.
    pub(crate) fn score(&self, layout: &Layout) -> f64 {
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
}

/// The stretches of bearings over which a pillar is seen by its owner.
fn runs_of(layout: &Layout, i: usize) -> impl Iterator<Item = (f64, f64)> {
    let owner = layout.pillars.get(i).and_then(|p| p.owner);
    let skyline = owner.map(|v| &layout.survey.skylines[v]);
    let own = skyline.into_iter().flat_map(move |s| s.runs_on(i));
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

/// How far a layout is from the given one.
fn cost(brief: &Brief, pillars: &[Pillar]) -> f64 {
    let kept = pillars.iter().filter(|p| p.given.is_some()).count();
    let gone = (brief.given.len() - kept) as f64;
    let of_pillar = |p: &Pillar| match p.given.map(|g| brief.given[g].at.distance(p.at)) {
        Some(0.0) => 0.0,
        Some(mm) => CHANGE + A_MM * mm,
        None => CHANGE + COME_OR_GO,
    };
    gone * (CHANGE + COME_OR_GO) + pillars.iter().map(of_pillar).sum::<f64>()
}
