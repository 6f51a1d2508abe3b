//! The planner: from models and eyes to pillars.
//!
//! Takes views and a [`Brief`]; gives a layout in which every ray of every eye to its models meets a pillar of its own first and
//! nothing stands in its way, or says which limit binds. Deterministic for a seed and a number of tries, whatever the thread count.

mod brief;
pub mod convex;
mod finish;
mod forecast;
mod limits;
mod moves;
mod repair;
mod search;
mod skyline;
mod start;
mod subject;
mod survey;

pub use brief::{Adjustment, Brief, Care, Freedom, Matters, Pillar, Region, Shape};
pub use limits::{foot, posed};
pub use skyline::{Run, Shadow, entry};
pub use start::{Clash, Start, Stuck, start};
pub use subject::Subject;
pub use survey::{Fault, Kind, Survey};

use crate::bvh::Bvh;
use crate::diag::Diagnostic;
use crate::view::View;
use finish::{Outcome, finished};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use search::{Aim, Chain, Layout, Pose, Problem, follow};
use start::owned;
use subject::Rays;

/// Rays of an outlook that the search looks with: many columns, as pillars are upright; with 24 of them it found layouts that hid
/// models from those columns only, eight degrees better than the truth.
const RAYS: Rays = Rays {
    columns: 144,
    rows: 7,
};
/// Chains of the search: each as long as they can be, so few.
const CHAINS: u64 = 2;
/// Share of the tries spent on layouts at other tolerances, for the trade-off, and these tolerances: shares of the chosen layout's up to 1,
/// from there to 2 on the way to that of the first layout.
const ASIDE: f64 = 0.25;
const OTHERS: [f64; 5] = [0.5, 0.75, 1.3, 1.6, 1.9];
/// Heat at which those begin, and mending: near what there is.
const WARM: f64 = 0.6;
/// Share of the tries, and their least number, that go into a layout without faults where the construction fails.
const FOUNDING: f64 = 0.4;
const LEAST_FOUNDING: u64 = 8000;
/// Tries of mending for each pillar, and at most.
const MENDING: u64 = 3000;
/// Poses of a view's models that are tried, where models may change.
const POSES: usize = 8;

/// What a layout is worth to one view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worth {
    /// Share of the models' width that meets a pillar of the view's own.
    pub coverage: f64,
    /// Faults in which this view has a part: conflicts and contested surface.
    pub conflicts: usize,
    /// Pillars of its own that it sees.
    pub pillars: usize,
    /// Forecast mean error of the normals, degrees, from eyes turned by the brief's angle.
    pub hidden_deg: f64,
    /// Forecast angle at which half of the likeness is lost; none if it never is.
    pub half_likeness_deg: Option<f64>,
    /// How far the eye may move sideways before a cut opens by two arc-minutes, millimetres: with reliefs in the middle of their
    /// layers, and wherever they lie.
    pub tolerance_mm: [f64; 2],
}

/// A layout that the search held, for pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Candidates tried until then.
    pub tries: u64,
    pub pillars: Vec<Pillar>,
    /// Index: view; the first stretch is on pillar `Run::pillar`.
    pub runs: Vec<Vec<Run>>,
    pub faults: Vec<Fault>,
    /// Places of faults in plan, and what they are.
    pub marks: Vec<(DVec2, String)>,
    /// Least forecast error of any view, degrees, and least tolerance (guaranteed) of any, millimetres.
    pub hidden_deg: f64,
    pub tolerance_mm: f64,
}

/// A point of the trade-off: the best forecast found at this tolerance or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trade {
    pub tolerance_mm: f64,
    pub hidden_deg: f64,
    pub chosen: bool,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All tries were made.
    Tries,
    /// Nothing better was found for long.
    Converged,
    /// It was told to stop: another run may end elsewhere.
    Stopped,
}

/// A pillar that was moved, put up or taken away to mend a layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Index into the given pillars; none if it is new.
    pub given: Option<usize>,
    /// Where it stands now; none if it is taken away.
    pub to: Option<DVec2>,
}

/// A finished plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Given pillars that stay first, in their order, then those of each view from its left to its right.
    pub pillars: Vec<Pillar>,
    /// Height of each.
    pub heights: Vec<f64>,
    /// Index: view.
    pub adjustments: Vec<Adjustment>,
    pub worth: Vec<Worth>,
    /// Convex sight regions of the start, one polygon a view (millimetres); empty if the search had to begin without.
    pub regions: Vec<Vec<DVec2>>,
    /// From the start to the layout chosen, rising `tries`: the first and the last are what `before` and `after` show.
    pub frames: Vec<Frame>,
    /// Rising tolerance.
    pub trade: Vec<Trade>,
    pub tries: u64,
    pub ended: Ended,
    /// What was done to given pillars; only when a layout is mended.
    pub changes: Vec<Change>,
}

/// How a caller follows a search and ends it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Stage and share of the planning done, 0 to 1. From any thread.
    pub progress: &'a (dyn Fn(&str, f64) + Sync),
    /// Whether to end with what there is.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Finds a layout.
///
/// # Errors
/// Which limits bind, and the nearest changes with which there is a layout.
pub fn plan(views: &[View], brief: &Brief, watch: Watch) -> Result<Planned, Vec<Diagnostic>> {
    (watch.progress)("eyes and models", 0.0);
    let prepared = prepared(views, brief);
    let problem = Problem {
        brief,
        poses: &prepared,
        aim: Aim::Hide,
    };
    let poses = vec![0; views.len()];
    let begun = start(&problem.subjects(&poses), brief);
    let mut chains: Vec<Chain> = Vec::new();
    let mut layout = problem.layout(begun.pillars.clone(), poses);
    let (mut spent, mut left) = (0, brief.tries);
    if !layout.is_sound() {
        let tries = LEAST_FOUNDING.max((FOUNDING * brief.tries as f64) as u64);
        let sound = Problem {
            aim: Aim::Sound,
            ..problem
        };
        // Its energy is another.
        let from = sound.layout(layout.pillars, layout.poses);
        let founded = best_of(
            &sound,
            &from,
            tries,
            1.0,
            watch,
            ("first layout", [0.05, 0.35]),
        );
        spent = founded.tries;
        left = left.saturating_sub(spent);
        layout = problem.layout(founded.best.pillars.clone(), founded.best.poses.clone());
        if !layout.is_sound() {
            return Err(limits::explained(
                views,
                brief,
                &begun,
                &layout.survey.faults,
            ));
        }
        chains.push(founded);
    }
    let first = layout.clone();
    let mut others = Vec::new();
    if left > 0 && !chains.iter().any(|c| c.stopped) {
        let tries = ((1.0 - ASIDE) * left as f64) as u64;
        let mut main = best_of(
            &problem,
            &layout,
            tries,
            1.0,
            watch,
            ("layouts", [0.35, 0.85]),
        );
        main.way.iter_mut().for_each(|w| w.0 += spent);
        layout = main.best.clone();
        chains.push(main);
        others = aside(&problem, [&first, &layout], left - tries, watch);
    }
    let outcome = Outcome {
        views,
        problem: &problem,
        start: begun,
        layout,
        chains,
        aside: others,
    };
    Ok(finished(outcome))
}

/// Mends a layout: the given pillars, none of which is better, with the fewest changes.
///
/// # Errors
/// What could not be mended, and the nearest changes with which there is a layout.
pub fn repair(views: &[View], brief: &Brief, watch: Watch) -> Result<Planned, Vec<Diagnostic>> {
    (watch.progress)("eyes and models", 0.0);
    let prepared = prepared(views, brief);
    let problem = Problem {
        brief,
        poses: &prepared,
        aim: Aim::Mend,
    };
    let poses = vec![0; views.len()];
    let pillars = owned(&problem.subjects(&poses), brief);
    let given = problem.layout(pillars, poses);
    let tries = brief.tries.min(MENDING * (1 + brief.given.len() as u64));
    let begun = Start {
        pillars: given.pillars.clone(),
        ..Start::default()
    };
    let (layout, chains) = if given.is_sound() {
        (given, Vec::new())
    } else {
        let chain = best_of(
            &problem,
            &given,
            tries,
            WARM,
            watch,
            ("mending", [0.05, 0.8]),
        );
        if !chain.best.is_sound() {
            return Err(limits::explained(
                views,
                brief,
                &begun,
                &chain.best.survey.faults,
            ));
        }
        (repair::pruned(&problem, chain.best.clone()), vec![chain])
    };
    let outcome = Outcome {
        views,
        problem: &problem,
        start: begun,
        layout,
        chains,
        aside: Vec::new(),
    };
    Ok(finished(outcome))
}

/// Prepares all views, with their models in several poses if they may change.
fn prepared(views: &[View], brief: &Brief) -> Vec<Vec<Pose>> {
    let pose = |view: &View, adjustment: Adjustment| {
        let view = posed(view, &adjustment);
        let target = view.target();
        let bvh = Bvh::new(&target);
        let subject = Subject::new(&view, &target, &bvh);
        let outlooks = subject.outlooks(&target, &bvh, [brief.hidden_from_deg, 0.0], RAYS);
        Pose {
            adjustment,
            subject,
            outlooks,
        }
    };
    let of_view = |(number, view): (usize, &View)| {
        let mut rng = Pcg64Mcg::seed_from_u64(brief.seed ^ (number as u64 + 1) << 32);
        let adjustments = poses(&brief.freedom, &mut rng);
        adjustments.into_iter().map(|a| pose(view, a)).collect()
    };
    let numbered: Vec<(usize, &View)> = views.iter().enumerate().collect();
    numbered.into_par_iter().map(of_view).collect()
}

/// The models as they are and, if they may change, at random within the limits.
fn poses(freedom: &Freedom, rng: &mut Pcg64Mcg) -> Vec<Adjustment> {
    let mut list = vec![Adjustment::NONE];
    if *freedom != Freedom::NONE {
        let mut random = |most: f64| {
            if most > 0.0 {
                rng.random_range(-most..most)
            } else {
                0.0
            }
        };
        // Rounded as they are written down.
        let rounded = |x: f64| (x * 1e4).round() / 1e4;
        list.extend((1..POSES).map(|_| Adjustment {
            turn: rounded(random(freedom.turn.to_degrees())).to_radians(),
            scale: rounded(random(freedom.scale.ln()).exp()),
            shift: DVec2::new(
                rounded(random(freedom.shift)),
                rounded(random(freedom.shift)),
            ),
        }));
    }
    list
}

/// The best of [`CHAINS`] chains from one layout, with the tries of all.
fn best_of(
    problem: &Problem,
    from: &Layout,
    tries: u64,
    heat: f64,
    watch: Watch,
    (stage, shares): (&str, [f64; 2]),
) -> Chain {
    let each = tries / CHAINS;
    let chains: Vec<Chain> = (0..CHAINS)
        .into_par_iter()
        .map(|stream| {
            problem.anneal(
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
fn together(chains: Vec<Chain>) -> Chain {
    let tries = chains.iter().map(|c| c.tries).sum();
    let stopped = chains.iter().any(|c| c.stopped);
    let converged = chains.iter().all(|c| c.converged);
    let mut trade = Vec::new();
    chains
        .iter()
        .for_each(|c| trade.extend(c.trade.iter().flatten().map(|t| Some(*t))));
    let better = |a: Chain, b: Chain| {
        let worse = (!b.best.is_sound(), b.best.energy) < (!a.best.is_sound(), a.best.energy);
        if worse { b } else { a }
    };
    let best = chains
        .into_iter()
        .reduce(better)
        .expect("at least one chain");
    Chain {
        trade,
        tries,
        converged,
        stopped,
        ..best
    }
}

/// Short searches at other tolerances: from the chosen layout at lower ones, from the first one, which has room for more, at higher ones.
fn aside(problem: &Problem, [first, chosen]: [&Layout; 2], tries: u64, watch: Watch) -> Vec<Chain> {
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
        let mut brief = problem.brief.clone();
        brief.tolerance_mm.iter_mut().for_each(|t| *t = floor);
        // Only the tolerance's floor counts, not its growth.
        brief.matters.tolerance = 0.0;
        let other = Problem {
            brief: &brief,
            ..*problem
        };
        let begun = other.layout(from.pillars.clone(), from.poses.clone());
        let watch = follow(watch, "trade-off", [0.85, 0.98], each);
        other.anneal(begun, CHAINS + k as u64, each, WARM, &watch)
    };
    OTHERS.into_par_iter().enumerate().map(chain).collect()
}
