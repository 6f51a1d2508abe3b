//! Mending: a layout without faults that differs least from the one given.
//!
//! A search first finds layouts without faults near the given one; then every change is taken back that can be, and what must move
//! moves only as far as it must.

use super::brief::{Brief, Pillar, rounded};
use super::finish::{Harvest, finished};
use super::limits::{NoLayout, binding};
use super::planned::Planned;
use super::posing::prepared;
use super::search::{WARM, best_of};
use super::start::{Start, owned};
use super::task::{Aim, Layout, Task};
use super::watch::Watch;
use crate::view::View;

/// Tries of mending for each pillar, and at most.
const MENDING: u64 = 3000;
/// Halvings of the way by which a pillar goes back.
const HALVINGS: usize = 12;

/// Mends a layout: the given pillars, none of which is better, with the fewest changes.
///
/// # Errors
/// What could not be mended, and the nearest changes with which there is a layout.
pub fn repair(views: &[View], brief: &Brief, watch: Watch) -> Result<Planned, NoLayout> {
    (watch.progress)("eyes and models", 0.0);
    let prepared = prepared(views, brief);
    let task = Task {
        brief,
        poses: &prepared,
        aim: Aim::Mend,
    };
    let poses = vec![0; views.len()];
    let pillars = owned(&task.subjects(&poses), brief);
    let given = task.layout(pillars, poses);
    let tries = brief.tries.min(MENDING * (1 + brief.given.len() as u64));
    let begun = Start {
        pillars: given.pillars.clone(),
        ..Start::default()
    };
    let (layout, chains) = if given.is_sound() {
        (given, Vec::new())
    } else {
        let chain = best_of(&task, &given, tries, WARM, watch, ("mending", [0.05, 0.8]));
        if !chain.best.is_sound() {
            return Err(binding(views, brief, begun, chain.best.survey.faults));
        }
        (pruned(&task, chain.best.clone()), vec![chain])
    };
    let harvest = Harvest {
        views,
        task: &task,
        start: begun,
        layout,
        chains,
        aside: Vec::new(),
    };
    Ok(finished(harvest))
}

/// Takes back every change that can be taken back, the shortest ways first, and then shortens what is left.
fn pruned(task: &Task, layout: Layout) -> Layout {
    let mut best = layout;
    for _ in 0..task.brief.given.len() + best.pillars.len() {
        let Some(next) = candidates(task, &best).into_iter().find_map(|pillars| {
            let next = task.layout(pillars, best.poses.clone());
            (next.is_sound() && next.energy < best.energy).then_some(next)
        }) else {
            break;
        };
        best = next;
    }
    shortened(task, best)
}

/// The layout with one change taken back, in the order of what that saves least... to most.
fn candidates(task: &Task, layout: &Layout) -> Vec<Vec<Pillar>> {
    let given = &task.brief.given;
    let mut list: Vec<(f64, Vec<Pillar>)> = Vec::new();
    for (i, pillar) in layout.pillars.iter().enumerate() {
        let mut pillars = layout.pillars.clone();
        match pillar.given.map(|g| given[g].at) {
            Some(at) if at == pillar.at => continue,
            Some(at) => {
                pillars[i].at = at;
                list.push((at.distance(pillar.at), pillars));
            }
            None => {
                pillars.swap_remove(i);
                list.push((0.0, pillars));
            }
        }
    }
    for (g, old) in given.iter().enumerate() {
        if layout.pillars.iter().all(|p| p.given != Some(g)) {
            for owner in 0..layout.poses.len() {
                let mut pillars = layout.pillars.clone();
                pillars.push(Pillar {
                    owner: Some(owner),
                    given: Some(g),
                    ..*old
                });
                list.push((0.0, pillars));
            }
        }
    }
    list.sort_by(|a, b| a.0.total_cmp(&b.0));
    list.into_iter().map(|l| l.1).collect()
}

/// Every moved pillar goes back towards its place as far as nothing is wrong.
fn shortened(task: &Task, layout: Layout) -> Layout {
    let mut best = layout;
    for i in 0..best.pillars.len() {
        let Some(home) = best.pillars[i].given.map(|g| task.brief.given[g].at) else {
            continue;
        };
        let away = best.pillars[i].at;
        let (mut back, mut out) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let share = (back + out) / 2.0;
            let mut pillars = best.pillars.clone();
            pillars[i].at = rounded(home.lerp(away, share));
            let next = task.layout(pillars, best.poses.clone());
            if next.is_sound() && next.energy <= best.energy {
                (out, best) = (share, next);
            } else {
                back = share;
            }
        }
    }
    best
}
