//! Moves of the search: what a candidate layout changes.
//!
//! Lengths are scaled to the pillar's reach and to the region, so that a forest twice as large is searched alike. Places are rounded
//! to thousandths of a millimetre, as layouts are written down. While there are faults, every other move is about one of them.

use super::brief::{Pillar, rounded};
use super::survey::{Fault, FaultKind};
use super::task::{Aim, Layout, Task};
use glam::DVec2;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// A candidate: its pillars, and the pose of every view.
pub(crate) type Proposal = (Vec<Pillar>, Vec<usize>);

/// A bell curve of standard deviation 1 that ends at 3.5.
fn bell(rng: &mut Pcg64Mcg) -> f64 {
    (0..4).map(|_| rng.random_range(-1.0..1.0f64)).sum::<f64>() * 0.866
}

/// A random change of a layout; `None` if the chosen kind does not apply. Hotter (0 to 1), steps are longer.
pub(crate) fn propose(
    task: &Task,
    rng: &mut Pcg64Mcg,
    layout: &Layout,
    heat: f64,
) -> Option<Proposal> {
    let fault = (!layout.is_sound() && rng.random_range(0..2) == 0)
        .then(|| layout.survey.faults[rng.random_range(0..layout.survey.faults.len())]);
    let kind = match fault.map(|f| f.kind) {
        Some(FaultKind::Uncovered) => rng.random_range(60..94),
        Some(FaultKind::Count) => rng.random_range(88..98),
        Some(_) => rng.random_range(0..88),
        None => rng.random_range(0..100),
    };
    let (mut pillars, mut poses) = (layout.pillars.clone(), layout.poses.clone());
    match kind {
        0..88 => pillars = moved(task, rng, layout, fault, (kind, heat))?,
        88..94 => pillars.push(new_pillar(task, rng, layout, fault)),
        94..98 => {
            // The last one takes its index; fixed ones stand first and keep theirs.
            pillars.swap_remove(movable(&pillars, rng)?);
        }
        _ => {
            let view = rng.random_range(0..poses.len());
            let n = task.poses[view].len();
            poses[view] = (poses[view] + rng.random_range(1..n.max(2))) % n;
            (n > 1).then_some(())?;
        }
    }
    Some((pillars, poses))
}

/// The pillars with one of them moved or changed in its shape, or several of one view moved.
fn moved(
    task: &Task,
    rng: &mut Pcg64Mcg,
    layout: &Layout,
    fault: Option<Fault>,
    (kind, heat): (i32, f64),
) -> Option<Vec<Pillar>> {
    let (mut pillars, poses) = (layout.pillars.clone(), &layout.poses);
    let i = match fault.and_then(|f| f.pillars[rng.random_range(0..2)]) {
        Some(i) => (!pillars[i].fixed).then_some(i)?,
        None => movable(&pillars, rng)?,
    };
    let view = pillars[i]
        .owner
        .unwrap_or_else(|| rng.random_range(0..poses.len()));
    let o = task.poses[view][poses[view]].subject.o;
    let reach = task.brief.shapes[pillars[i].shape].reach;
    let ahead = (pillars[i].at - o).normalize_or(DVec2::X);
    match kind {
        0..30 => pillars[i].at += ahead * bell(rng) * reach * (0.25 + 3.0 * heat),
        30..50 => pillars[i].at += ahead.perp() * bell(rng) * reach * (0.08 + 0.5 * heat),
        50..60 => pillars[i].at += ahead * rng.random_range(-1.0..1.0) * size(task) * 0.4,
        60..70 => swap(&mut pillars, i, o, rng)?,
        70..78 => close_up(task, layout, &mut pillars, [i, view], rng),
        78..84 => {
            let by = bell(rng) * 0.5 * reach / o.distance(pillars[i].at);
            turn_all(&mut pillars, view, o, by);
        }
        _ if task.brief.allowed > 1 && task.aim == Aim::Hide => {
            pillars[i].shape = rng.random_range(0..task.brief.allowed);
        }
        _ => pillars[i].at += DVec2::new(bell(rng), bell(rng)) * reach * 0.05,
    }
    for (new, old) in pillars.iter_mut().zip(&layout.pillars) {
        if new != old {
            new.at = rounded(new.at);
        }
    }
    Some(pillars)
}

/// Diameter of the region's box, millimetres.
fn size(task: &Task) -> f64 {
    let (lo, hi) = task.brief.region.bounds();
    (hi - lo).length()
}

fn movable(pillars: &[Pillar], rng: &mut Pcg64Mcg) -> Option<usize> {
    let free = pillars.iter().filter(|p| !p.fixed).count();
    (free > 0).then_some(())?;
    let chosen = rng.random_range(0..free);
    (0..pillars.len())
        .filter(|i| !pillars[*i].fixed)
        .nth(chosen)
}

/// Somewhere in the sight of some view; where a view sees no pillar, if there is such a place.
fn new_pillar(task: &Task, rng: &mut Pcg64Mcg, layout: &Layout, fault: Option<Fault>) -> Pillar {
    let view = fault
        .and_then(|f| f.view)
        .unwrap_or_else(|| rng.random_range(0..layout.poses.len()));
    let subject = &task.poses[view][layout.poses[view]].subject;
    let [a, b] = match fault.filter(|f| f.kind == FaultKind::Uncovered) {
        Some(fault) => {
            let bearing = subject.bearing(fault.at);
            let reach = task.brief.shapes[0].reach / subject.o.distance(fault.at);
            [bearing - reach, bearing + reach]
        }
        None => subject.range(),
    };
    let distance =
        task.brief.region.middle().distance(subject.o) + rng.random_range(-0.5..0.5) * size(task);
    Pillar {
        at: rounded(subject.point(rng.random_range(a..b.max(a + 1e-9)), distance)),
        shape: rng.random_range(0..task.brief.allowed),
        owner: Some(view),
        fixed: false,
        given: None,
    }
}

/// Two pillars of one view exchange their distances from the eye.
fn swap(pillars: &mut [Pillar], i: usize, o: DVec2, rng: &mut Pcg64Mcg) -> Option<()> {
    let j = movable(pillars, rng)?;
    if j == i || pillars[i].owner != pillars[j].owner {
        return None;
    }
    let (a, b) = (pillars[i].at - o, pillars[j].at - o);
    pillars[i].at = o + a * (b.length() / a.length());
    pillars[j].at = o + b * (a.length() / b.length());
    Some(())
}

/// A pillar is drawn towards its neighbour in the image until it overlaps it by just what is wanted.
fn close_up(
    task: &Task,
    layout: &Layout,
    pillars: &mut [Pillar],
    [i, view]: [usize; 2],
    rng: &mut Pcg64Mcg,
) {
    let o = task.poses[view][layout.poses[view]].subject.o;
    let shadows = &layout.survey.skylines[view].shadows;
    let own = shadows[i];
    let left = rng.random_range(0..2) == 0;
    let beside = (0..pillars.len()).filter(|j| *j != i && pillars[*j].owner == Some(view));
    let nearest = beside
        .map(|j| {
            if left {
                shadows[j].from - own.to
            } else {
                own.from - shadows[j].to
            }
        })
        .filter(|gap| *gap > -(own.to - own.from))
        .fold(f64::INFINITY, f64::min);
    if nearest.is_finite() {
        let by = nearest + task.brief.care.overlap / own.distance;
        let turn = if left { by } else { -by };
        pillars[i].at = o + DVec2::from_angle(turn).rotate(pillars[i].at - o);
    }
}

/// All pillars of a view are turned about its eye.
fn turn_all(pillars: &mut [Pillar], view: usize, o: DVec2, by: f64) {
    for pillar in pillars
        .iter_mut()
        .filter(|p| p.owner == Some(view) && !p.fixed)
    {
        pillar.at = o + DVec2::from_angle(by).rotate(pillar.at - o);
    }
}
