//! From what a search found to a plan: heights, what the layout is worth, the way to it.

use super::brief::Pillar;
use super::forecast::{Forecast, Tally};
use super::planned::{Change, Ended, Frame, Planned, Trade, Worth};
use super::posing::posed;
use super::search::Annealed;
use super::start::Start;
use super::subject::{Rays, Subject};
use super::survey::{FaultKind, reach_of};
use super::task::{Layout, Task};
use crate::bvh::Bvh;
use crate::horizon::Run;
use crate::steps::UNSEEN_RAD;
use crate::view::View;
use glam::DVec2;
use rayon::prelude::*;

/// Most frames of a plan.
const FRAMES: usize = 24;
/// Angles at which the likeness is forecast, and by how much eyes are raised there, degrees: as on finished forests.
const ANGLES_DEG: [f64; 14] = [
    0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 150.0,
];
const RAISED_DEG: [f64; 3] = [0.0, 15.0, -15.0];
/// Rays of those outlooks: other columns than those of the search, which knows its own too well.
const RAYS: Rays = Rays {
    columns: 128,
    rows: 20,
};

/// What a search came to.
pub(crate) struct Harvest<'a> {
    pub views: &'a [View],
    pub task: &'a Task<'a>,
    pub start: Start,
    pub layout: Layout,
    /// In the order of the search.
    pub chains: Vec<Annealed>,
    /// Those at other tolerances, which end elsewhere.
    pub aside: Vec<Annealed>,
}

pub(crate) fn finished(harvest: Harvest) -> Planned {
    let Harvest {
        views,
        task,
        start,
        layout,
        chains,
        aside,
    } = harvest;
    let layout = in_order(task, layout);
    let subjects = task.subjects(&layout.poses);
    let first = task.layout(start.pillars, vec![0; views.len()]);
    let worth = worth(views, task, &layout, &subjects);
    Planned {
        heights: (0..layout.pillars.len())
            .map(|i| height(task, &layout, &subjects, i))
            .collect(),
        adjustments: layout
            .poses
            .iter()
            .zip(task.poses)
            .map(|(p, of_view)| of_view[*p].adjustment)
            .collect(),
        worth,
        regions: start.regions,
        frames: frames(&first, &chains, &layout),
        trade: trade(chains.iter().chain(&aside), &layout),
        tries: chains.iter().chain(&aside).map(|c| c.tries).sum(),
        ended: ended(&chains, &aside),
        changes: changes(task, &layout),
        pillars: layout.pillars,
    }
}

/// Given pillars first, in their order, then those of each view from its left to its right.
fn in_order(task: &Task, layout: Layout) -> Layout {
    let mut order: Vec<usize> = (0..layout.pillars.len()).collect();
    let key = |i: usize| {
        let p = &layout.pillars[i];
        let bearing = p
            .owner
            .map_or(0.0, |v| layout.survey.skylines[v].shadows[i].middle);
        (p.given.unwrap_or(usize::MAX), p.owner, -bearing)
    };
    order.sort_by(|a, b| {
        let (a, b) = (key(*a), key(*b));
        (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
    });
    let pillars = order.iter().map(|i| layout.pillars[*i]).collect();
    task.layout(pillars, layout.poses)
}

/// As low as the shape allows and all rays to the models meet the pillar.
fn height(task: &Task, layout: &Layout, subjects: &[&Subject], i: usize) -> f64 {
    let pillar = &layout.pillars[i];
    let shape = &task.brief.shapes[pillar.shape];
    let [lowest, highest] = shape.heights;
    let Some(view) = pillar.owner else {
        return lowest;
    };
    let skyline = &layout.survey.skylines[view];
    let [near, far] = reach_of(&skyline.shadows[i], shape);
    let needed = skyline
        .runs_on(i)
        .map(|r| subjects[view].height_needed(r.from, r.to, near, far));
    // Rounded up, as it is written.
    ((needed.fold(lowest, f64::max) * 10.0).ceil() / 10.0).clamp(lowest, highest)
}

fn worth(views: &[View], task: &Task, layout: &Layout, subjects: &[&Subject]) -> Vec<Worth> {
    let of_view = |v: usize| {
        let runs = &layout.survey.skylines[v].runs;
        let width = |own: bool| -> f64 {
            let counted = runs.iter().filter(|r| {
                !own || r
                    .obstacle
                    .is_some_and(|i| layout.pillars[i].owner == Some(v))
            });
            counted.map(Run::width).sum()
        };
        let mut seen: Vec<usize> = runs.iter().filter_map(|r| r.obstacle).collect();
        seen.sort_unstable();
        seen.dedup();
        let conflicts = layout.survey.faults.iter().filter(|f| {
            f.view == Some(v) && matches!(f.kind, FaultKind::Foreign | FaultKind::Sight)
        });
        let (hidden_deg, half_likeness_deg) = likeness(&views[v], task, layout, subjects, v);
        Worth {
            coverage: if width(false) > 0.0 {
                width(true) / width(false)
            } else {
                1.0
            },
            conflicts: conflicts.count(),
            pillars: seen.len(),
            hidden_deg,
            half_likeness_deg,
            tolerance_mm: layout.survey.rates[v]
                .map(|rate| UNSEEN_RAD / rate.max(f64::MIN_POSITIVE)),
        }
    };
    (0..views.len()).into_par_iter().map(of_view).collect()
}

/// Forecast mean error at the brief's angle, and the angle at which half of the likeness is lost.
fn likeness(
    view: &View,
    task: &Task,
    layout: &Layout,
    subjects: &[&Subject],
    v: usize,
) -> (f64, Option<f64>) {
    let view = posed(view, &task.poses[v][layout.poses[v]].adjustment);
    let target = view.target();
    let bvh = Bvh::new(&target);
    let forest = Forecast {
        subjects,
        brief: task.brief,
        pillars: &layout.pillars,
        survey: &layout.survey,
    };
    let level = subjects[v].outlooks(&target, &bvh, [task.brief.hidden_from_deg, 0.0], RAYS);
    let hidden = level
        .iter()
        .map(|o| forest.seen(o))
        .sum::<Tally>()
        .mean_error_deg();
    let at = |deg: f64| {
        // The own eye has no ring around it.
        let raised = RAISED_DEG.iter().filter(|r| deg > 0.0 || **r == 0.0);
        let outlooks = raised.flat_map(|r| subjects[v].outlooks(&target, &bvh, [deg, *r], RAYS));
        let above = outlooks.filter(|o| o.eye.z > 0.0 || deg == 0.0);
        above
            .map(|o| forest.seen(&o).mean_agreement())
            .fold(0.0, f64::max)
    };
    let curve: Vec<(f64, f64)> = ANGLES_DEG.iter().map(|deg| (*deg, at(*deg))).collect();
    (hidden, crate::geom::half_angle(&curve))
}

fn frames(first: &Layout, chains: &[Annealed], last: &Layout) -> Vec<Frame> {
    let mut way: Vec<(u64, &Layout)> = vec![(0, first)];
    let searched: u64 = chains.iter().map(|c| c.tries).sum();
    for (tries, layout) in chains.iter().flat_map(|c| &c.way) {
        if *tries > way[way.len() - 1].0 {
            way.push((*tries, layout));
        }
    }
    let n = way.len();
    if n >= FRAMES {
        let kept = FRAMES - 1;
        way = (0..kept).map(|k| way[k * (n - 1) / (kept - 1)]).collect();
    }
    way.push((searched, last));
    way.into_iter()
        .map(|(tries, layout)| frame(tries, layout))
        .collect()
}

fn frame(tries: u64, layout: &Layout) -> Frame {
    Frame {
        tries,
        pillars: layout.pillars.clone(),
        runs: layout
            .survey
            .skylines
            .iter()
            .map(|s| s.runs.clone())
            .collect(),
        faults: layout.survey.faults.clone(),
        hidden_deg: if layout.hidden_deg.is_empty() {
            0.0
        } else {
            layout.least_hidden()
        },
        tolerance_mm: layout.survey.least_tolerance(),
    }
}

/// The best forecasts at every tolerance that no better one reaches too, and the chosen layout.
fn trade<'a>(chains: impl Iterator<Item = &'a Annealed>, layout: &Layout) -> Vec<Trade> {
    if layout.hidden_deg.is_empty() {
        return Vec::new();
    }
    let chosen = Trade {
        tolerance_mm: layout.survey.least_tolerance(),
        hidden_deg: layout.least_hidden(),
        chosen: true,
    };
    let mut all: Vec<Trade> = chains
        .flat_map(|c| c.trade.iter().flatten().copied())
        .collect();
    all.sort_by(|a, b| {
        b.tolerance_mm
            .total_cmp(&a.tolerance_mm)
            .then(b.hidden_deg.total_cmp(&a.hidden_deg))
    });
    let mut curve: Vec<Trade> = Vec::new();
    for point in all {
        if curve.last().is_none_or(|l| point.hidden_deg > l.hidden_deg)
            && point
                != (Trade {
                    chosen: false,
                    ..chosen
                })
        {
            curve.push(point);
        }
    }
    curve.push(chosen);
    curve.sort_by(|a, b| a.tolerance_mm.total_cmp(&b.tolerance_mm));
    curve
}

fn ended(chains: &[Annealed], aside: &[Annealed]) -> Ended {
    if chains.iter().chain(aside).any(|c| c.stopped) {
        Ended::Stopped
    } else if chains.iter().any(|c| c.converged) {
        Ended::Converged
    } else {
        Ended::Tries
    }
}

fn changes(task: &Task, layout: &Layout) -> Vec<Change> {
    let given = &task.brief.given;
    let of = |g: usize| {
        layout
            .pillars
            .iter()
            .find(|p| p.given == Some(g))
            .map(|p| p.at)
    };
    let mut changes: Vec<Change> = Vec::new();
    for (g, old) in given.iter().enumerate().filter(|(_, p)| !p.fixed) {
        let to: Option<DVec2> = of(g);
        if to != Some(old.at) {
            changes.push(Change { given: Some(g), to });
        }
    }
    if given.iter().any(|p| !p.fixed) {
        let fresh = layout
            .pillars
            .iter()
            .filter(|p: &&Pillar| p.given.is_none());
        changes.extend(fresh.map(|p| Change {
            given: None,
            to: Some(p.at),
        }));
    }
    changes
}
