//! Mending: a layout without faults that differs least from the one given.
//!
//! A search first finds layouts without faults near the given one; then every change is taken back that can be, and what must move
//! moves only as far as it must.

use super::brief::{Brief, Pillar};
use super::moves::rounded;
use super::search::{Layout, Problem};

/// Faults weigh this much more than changes.
pub const FIRST_SOUND: f64 = 10.0;
/// What a change costs: any at all, more if a pillar comes or goes, and every millimetre of the way.
const CHANGE: f64 = 1.0;
const COME_OR_GO: f64 = 0.5;
const A_MM: f64 = 0.02;
/// Halvings of the way by which a pillar goes back.
const HALVINGS: usize = 12;

/// How far a layout is from the given one.
pub fn cost(brief: &Brief, pillars: &[Pillar]) -> f64 {
    let kept = pillars.iter().filter(|p| p.given.is_some()).count();
    let gone = (brief.given.len() - kept) as f64;
    let of_pillar = |p: &Pillar| match p.given.map(|g| brief.given[g].at.distance(p.at)) {
        Some(0.0) => 0.0,
        Some(mm) => CHANGE + A_MM * mm,
        None => CHANGE + COME_OR_GO,
    };
    gone * (CHANGE + COME_OR_GO) + pillars.iter().map(of_pillar).sum::<f64>()
}

/// Takes back every change that can be taken back, the shortest ways first, and then shortens what is left.
pub fn pruned(problem: &Problem, layout: Layout) -> Layout {
    let mut best = layout;
    for _ in 0..problem.brief.given.len() + best.pillars.len() {
        let Some(next) = candidates(problem, &best).into_iter().find_map(|pillars| {
            let next = problem.layout(pillars, best.poses.clone());
            (next.is_sound() && next.energy < best.energy).then_some(next)
        }) else {
            break;
        };
        best = next;
    }
    shortened(problem, best)
}

/// The layout with one change taken back, in the order of what that saves least... to most.
fn candidates(problem: &Problem, layout: &Layout) -> Vec<Vec<Pillar>> {
    let given = &problem.brief.given;
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
fn shortened(problem: &Problem, layout: Layout) -> Layout {
    let mut best = layout;
    for i in 0..best.pillars.len() {
        let Some(home) = best.pillars[i].given.map(|g| problem.brief.given[g].at) else {
            continue;
        };
        let away = best.pillars[i].at;
        let (mut back, mut out) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let share = (back + out) / 2.0;
            let mut pillars = best.pillars.clone();
            pillars[i].at = rounded(home.lerp(away, share));
            let next = problem.layout(pillars, best.poses.clone());
            if next.is_sound() && next.energy <= best.energy {
                (out, best) = (share, next);
            } else {
                back = share;
            }
        }
    }
    best
}
