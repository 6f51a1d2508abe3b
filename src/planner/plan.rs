//! From views and a brief to a plan: a layout without faults first, the best one near it then.

use super::brief::Brief;
use super::finish::{Harvest, finished};
use super::limits::{NoLayout, binding};
use super::planned::Planned;
use super::posing::prepared;
use super::search::{ASIDE, Annealed, aside, best_of};
use super::start::start;
use super::task::{Aim, Layout, Task};
use super::watch::Watch;
use crate::view::View;

/// Share of the tries, and their least number, that go into a layout without faults where the construction fails.
const FOUNDING: f64 = 0.4;
const LEAST_FOUNDING: u64 = 8000;

/// Finds a layout.
///
/// # Errors
/// Which limits bind, and the nearest changes with which there is a layout.
pub fn plan(views: &[View], brief: &Brief, watch: Watch) -> Result<Planned, NoLayout> {
    (watch.progress)("eyes and models", 0.0);
    let prepared = prepared(views, brief);
    let task = Task {
        brief,
        poses: &prepared,
        aim: Aim::Hide,
    };
    let poses = vec![0; views.len()];
    let begun = start(&task.subjects(&poses), brief);
    let mut chains: Vec<Annealed> = Vec::new();
    let mut first = task.layout(begun.pillars.clone(), poses);
    if !first.is_sound() {
        let founded = founded(&task, first, watch);
        let best = &founded.best;
        first = task.layout(best.pillars.clone(), best.poses.clone());
        if !first.is_sound() {
            return Err(binding(views, brief, begun, first.survey.faults));
        }
        chains.push(founded);
    }
    let spent = chains.iter().map(|c| c.tries).sum();
    let left = brief.tries.saturating_sub(spent);
    let (mut layout, mut others) = (first.clone(), Vec::new());
    if left > 0 && !chains.iter().any(|c| c.stopped) {
        let tries = ((1.0 - ASIDE) * left as f64) as u64;
        let stage = ("layouts", [0.35, 0.85]);
        let mut main = best_of(&task, &first, tries, 1.0, watch, stage);
        main.way.iter_mut().for_each(|w| w.0 += spent);
        layout = main.best.clone();
        chains.push(main);
        others = aside(&task, [&first, &layout], left - tries, watch);
    }
    Ok(finished(Harvest {
        views,
        task: &task,
        start: begun,
        layout,
        chains,
        aside: others,
    }))
}

/// A search for nothing but a layout without faults, from one that has some.
fn founded(task: &Task, from: Layout, watch: Watch) -> Annealed {
    let tries = LEAST_FOUNDING.max((FOUNDING * task.brief.tries as f64) as u64);
    let sound = Task {
        aim: Aim::Sound,
        ..*task
    };
    // Its energy is another.
    let from = sound.layout(from.pillars, from.poses);
    let stage = ("first layout", [0.05, 0.35]);
    best_of(&sound, &from, tries, 1.0, watch, stage)
}
