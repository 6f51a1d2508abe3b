//! A layout that is right by construction: convex sight regions that do not meet.
//!
//! Every view's models are hidden from its eye by a row of pillars, as near to the eye as the region lets them stand, whose shadows
//! tile the models' bearings. The hull of the eye and its row holds all sight lines the view uses and all its solids. Where the
//! hulls of all views are apart, nothing of one view stands in the sight of another, whatever the number of eyes and wherever they
//! are: coverage is 1, and there is no conflict. The widest strips between the hulls bound the *sight regions*: each holds its eye,
//! is convex, and in it the view's pillars may stand at any depth.
//!
//! Where hulls meet it is not said that no layout exists: pillars may cross into each other's regions. But the strips then tell
//! what is in the way and by how much.

use super::brief::{Brief, Pillar, rounded};
use super::convex::{Parting, clipped, part};
use super::subject::Subject;
use super::survey::{Fault, FaultKind, Survey, reach_of};
use crate::geom::hull;
use crate::horizon::{Run, Shadow};
use glam::DVec2;

/// Steps in which a pillar is pushed away from its eye until it has room, millimetres.
const STEP_MM: f64 = 0.5;
/// Overlaps are laid out with this share more than is needed, so that rounding leaves them.
const AMPLE: f64 = 1.1;
/// By how much a row begins before the models, millimetres, until its last strip is not too narrow.
const LEADS_MM: [f64; 6] = [0.0, 0.7, 1.4, 2.1, 2.8, 3.5];
/// Sight regions are drawn up to this many times the distance of the farthest eye.
const AROUND: f64 = 2.0;

/// Why a view has no row.
#[derive(Clone, Debug, PartialEq)]
pub struct Stuck {
    pub view: usize,
    /// Where no pillar finds a place, and what is the matter with the best place.
    pub at: DVec2,
    pub fault: Fault,
}

/// Two views whose hulls meet, and by how much, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clash {
    pub views: [usize; 2],
    pub mm: f64,
}

/// See the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Given ones first.
    pub pillars: Vec<Pillar>,
    /// Sight regions, index: view; empty if hulls meet.
    pub regions: Vec<Vec<DVec2>>,
    pub stuck: Vec<Stuck>,
    pub clashes: Vec<Clash>,
}

impl Start {
    /// Whether every view has its row, and no two are in each other's way.
    pub fn is_clear(&self) -> bool {
        self.stuck.is_empty() && self.clashes.is_empty()
    }
}

/// Constructs the rows of all views.
pub fn start(subjects: &[&Subject], brief: &Brief) -> Start {
    let mut start = Start {
        pillars: owned(subjects, brief),
        ..Start::default()
    };
    let given = start.pillars.clone();
    let mut hulls = Vec::new();
    for (view, subject) in subjects.iter().enumerate() {
        let row = row(subject, view, brief, &given);
        start.stuck.extend(row.stuck);
        hulls.push(hull_of(subject, brief, &row.pillars));
        start.pillars.extend(row.pillars);
    }
    let mut partings: Vec<(usize, usize, Parting)> = Vec::new();
    for b in 0..hulls.len() {
        for a in 0..b {
            let parting = part(&hulls[a], &hulls[b]);
            if parting.room < brief.gap {
                let mm = brief.gap - parting.room;
                start.clashes.push(Clash { views: [a, b], mm });
            }
            partings.push((a, b, parting));
        }
    }
    if start.is_clear() {
        start.regions = regions(subjects, &partings);
    }
    start
}

/// The given pillars, each with the view that sees most of it.
pub(crate) fn owned(subjects: &[&Subject], brief: &Brief) -> Vec<Pillar> {
    let mut pillars = brief.given.clone();
    let survey = Survey::new(subjects, brief, &pillars);
    for (i, pillar) in pillars.iter_mut().enumerate() {
        pillar.given = Some(i);
        let seen = |v: usize| -> f64 {
            let skyline = &survey.skylines[v];
            skyline.runs_on(i).map(Run::width).sum::<f64>() * skyline.shadows[i].distance
        };
        let most = (0..subjects.len())
            .map(|v| (seen(v), v))
            .filter(|s| s.0 > 0.0);
        let most = most.reduce(|best, s| if s.0 > best.0 { s } else { best });
        pillar.owner = most.map(|m| m.1);
    }
    pillars
}

/// The row of one view, as far as it got.
#[derive(Default)]
struct Palisade {
    pillars: Vec<Pillar>,
    stuck: Option<Stuck>,
}

/// Of the rows with [`LEADS_MM`] the whole one that stands nearest to its eye; or else the one that got farthest.
fn row(subject: &Subject, view: usize, brief: &Brief, given: &[Pillar]) -> Palisade {
    let rows = LEADS_MM
        .iter()
        .map(|lead| row_from(subject, view, brief, given, *lead));
    let depth = |row: &Palisade| {
        let distances = row.pillars.iter().map(|p| p.at.distance(subject.o));
        match row.stuck {
            None => (false, distances.fold(0.0, f64::max)),
            Some(_) => (true, -(row.pillars.len() as f64)),
        }
    };
    rows.reduce(|best, row| {
        let better = depth(&row)
            .0
            .cmp(&depth(&best).0)
            .then(depth(&row).1.total_cmp(&depth(&best).1));
        if better.is_lt() { row } else { best }
    })
    .unwrap_or_default()
}

/// A row that begins `lead` millimetres before the models do.
fn row_from(
    subject: &Subject,
    view: usize,
    brief: &Brief,
    given: &[Pillar],
    lead: f64,
) -> Palisade {
    let mut row = Palisade::default();
    let distance = brief.region.middle().distance(subject.o);
    for [a, b] in subject.spans.iter().copied() {
        let mut covered = a - lead / distance;
        loop {
            let (pillar, shadow) = match next(subject, view, brief, given, &row.pillars, covered) {
                Ok(found) => found,
                Err(fault) => {
                    let stuck = Stuck {
                        view,
                        at: fault.at,
                        fault,
                    };
                    return Palisade {
                        stuck: Some(stuck),
                        ..row
                    };
                }
            };
            row.pillars.push(pillar);
            covered = shadow.to;
            if covered >= b + AMPLE * brief.care.overlap / shadow.distance {
                break;
            }
        }
    }
    row
}

/// The nearest place where a pillar goes on covering at the bearing `covered`.
fn next(
    subject: &Subject,
    view: usize,
    brief: &Brief,
    given: &[Pillar],
    row: &[Pillar],
    covered: f64,
) -> Result<(Pillar, Shadow), Fault> {
    let corners = brief.region.outline().iter().map(|p| p.distance(subject.o));
    let far = corners.fold(0.0, f64::max);
    let near = if brief.region.contains(subject.o) {
        0.0
    } else {
        brief.region.to_outline(subject.o)
    };
    let mut best: Option<Fault> = None;
    for shape in 0..brief.allowed {
        let reach = brief.shapes[shape].reach;
        let from = near.max(reach) + reach;
        let steps = ((far - from) / STEP_MM).max(0.0) as usize;
        for step in 0..=steps {
            let distance = from + STEP_MM * step as f64;
            let pillar = covering(subject, view, brief, shape, covered, [from, distance]);
            let fault = worst_fault(subject, view, brief, given, row, pillar);
            match fault {
                None => {
                    let shadow = subject.shadow(&pillar, &brief.shapes[shape]);
                    return Ok((pillar, shadow));
                }
                Some(fault) if best.is_none_or(|b| misfit(&fault) < misfit(&b)) => {
                    best = Some(fault);
                }
                Some(_) => {}
            }
        }
    }
    let nowhere = Fault {
        kind: FaultKind::Outside,
        view: Some(view),
        pillars: [None, None],
        mm: 0.0,
        at: subject.point(covered, near),
    };
    Err(best.unwrap_or(nowhere))
}

/// How little a place fits: outside of the region is told of only if no place is inside.
fn misfit(fault: &Fault) -> (bool, f64) {
    (fault.kind == FaultKind::Outside, fault.mm)
}

/// The pillar at this distance whose shadow begins before `covered`, by an overlap that is enough on pillars at `nearest` too.
fn covering(
    subject: &Subject,
    view: usize,
    brief: &Brief,
    shape: usize,
    covered: f64,
    [nearest, distance]: [f64; 2],
) -> Pillar {
    let mut pillar = Pillar {
        at: subject.point(covered, distance),
        shape,
        owner: Some(view),
        fixed: false,
        given: None,
    };
    // A profile that is no circle changes its shadow a little as it goes round the eye.
    for _ in 0..2 {
        let shadow = subject.shadow(&pillar, &brief.shapes[shape]);
        let from = covered - AMPLE * brief.care.overlap / nearest;
        pillar.at = rounded(subject.point(shadow.middle + from - shadow.from, distance));
    }
    pillar
}

/// The largest fault of a new pillar among those of its view and the given ones; `None` if it may stand there.
fn worst_fault(
    subject: &Subject,
    view: usize,
    brief: &Brief,
    given: &[Pillar],
    row: &[Pillar],
    pillar: Pillar,
) -> Option<Fault> {
    let outside = brief
        .region
        .outside(pillar.at, brief.shapes[pillar.shape].reach);
    if outside > 0.0 {
        return Some(Fault {
            kind: FaultKind::Outside,
            view: Some(view),
            pillars: [None, None],
            mm: outside,
            at: pillar.at,
        });
    }
    let mut pillars: Vec<Pillar> = given.to_vec();
    pillars.extend(row);
    pillars.push(pillar);
    for p in &mut pillars {
        // A survey of one view: its number is 0, and nobody else has any.
        p.owner = (p.owner == Some(view)).then_some(0);
    }
    let alone = Brief {
        tolerance_mm: vec![brief.tolerance_mm[view]],
        count: [0, usize::MAX],
        ..brief.clone()
    };
    let survey = Survey::new(&[subject], &alone, &pillars);
    let counts = |f: &&Fault| {
        matches!(
            f.kind,
            FaultKind::Fin
                | FaultKind::Tight
                | FaultKind::Ends
                | FaultKind::Open
                | FaultKind::Narrow
        )
    };
    survey
        .faults
        .iter()
        .filter(counts)
        .copied()
        .reduce(|worst, f| if f.mm > worst.mm { f } else { worst })
}

/// The hull of an eye with its pillars, their reliefs and half the gap around them.
fn hull_of(subject: &Subject, brief: &Brief, pillars: &[Pillar]) -> Vec<DVec2> {
    let mut points = vec![subject.o];
    for pillar in pillars {
        let shape = &brief.shapes[pillar.shape];
        let [near, _] = reach_of(&subject.shadow(pillar, shape), shape);
        let distance = pillar.at.distance(subject.o);
        let toward = (subject.o - pillar.at) / distance;
        for p in &shape.profile {
            let at = pillar.at + *p;
            points.push(at);
            // The relief in front is no wider than the body.
            points.push(at + (distance - near - shape.reach).max(0.0) * toward);
        }
    }
    hull(points)
}

/// What the strips between all pairs leave to each view.
fn regions(subjects: &[&Subject], partings: &[(usize, usize, Parting)]) -> Vec<Vec<DVec2>> {
    let far = subjects.iter().map(|s| s.o.length()).fold(1.0, f64::max) * AROUND;
    let square = [(-far, -far), (far, -far), (far, far), (-far, far)].map(DVec2::from);
    let region = |view: usize| {
        partings.iter().fold(square.to_vec(), |polygon, (a, b, p)| {
            if *a == view {
                clipped(&polygon, p.normal, p.offset)
            } else if *b == view {
                clipped(&polygon, -p.normal, -p.offset)
            } else {
                polygon
            }
        })
    };
    (0..subjects.len()).map(region).collect()
}
