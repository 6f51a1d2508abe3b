//! Room: reliefs in sight lines of other views, gaps between solids, the region.

use super::fault::{Fault, FaultKind};
use super::offsets::Offsets;
use crate::geom::{gap, to_segment};
use crate::planner::brief::{Brief, Pillar, Shape};
use crate::planner::skyline::Skyline;
use crate::planner::subject::Subject;
use glam::DVec2;

/// Room between a relief and other views' sight lines, millimetres: what reliefs lap behind pillars, thrice.
const SIGHT_ROOM_MM: f64 = 0.12;

/// The room in plan that the relief of one run may fill.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parcel {
    view: usize,
    pillar: usize,
    run: usize,
    /// Near side from first to last bearing, then the far side back: a convex quadrilateral, counter-clockwise.
    corners: [DVec2; 4],
    /// A circle around it.
    middle: DVec2,
    radius: f64,
}

/// The parcels of all runs on pillars of their own view.
pub(crate) fn parcels(
    subjects: &[&Subject],
    shapes: &[Shape],
    pillars: &[Pillar],
    skylines: &[Skyline],
) -> Vec<Parcel> {
    let mut parcels = Vec::new();
    for (view, skyline) in skylines.iter().enumerate() {
        let subject = subjects[view];
        for (run, r) in skyline.runs.iter().enumerate() {
            let Some(pillar) = r.obstacle.filter(|i| pillars[*i].owner == Some(view)) else {
                continue;
            };
            let shadow = &skyline.shadows[pillar];
            let offsets = Offsets::new(&shapes[pillars[pillar].shape]);
            let at = |bearing: f64, offset: f64| {
                subject.point(
                    bearing,
                    (shadow.distance + offset) / (bearing - shadow.middle).cos(),
                )
            };
            let corners = [
                at(r.from, offsets.near),
                at(r.from, offsets.far),
                at(r.to, offsets.far),
                at(r.to, offsets.near),
            ];
            let middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
            let radius = corners
                .iter()
                .map(|c| c.distance_squared(middle))
                .fold(0.0, f64::max)
                .sqrt();
            parcels.push(Parcel {
                view,
                pillar,
                run,
                corners,
                middle,
                radius,
            });
        }
    }
    parcels
}

/// Reliefs of one view that stand in sight lines of another.
pub(crate) fn in_sight(
    subjects: &[&Subject],
    pillars: &[Pillar],
    skylines: &[Skyline],
    parcels: &[Parcel],
    faults: &mut Vec<Fault>,
) {
    for own in parcels {
        let skyline = &skylines[own.view];
        let run = &skyline.runs[own.run];
        let subject = subjects[own.view];
        let [first, last] = [own.corners[1] - subject.o, own.corners[2] - subject.o];
        let ahead = (pillars[own.pillar].at - subject.o) / skyline.shadows[own.pillar].distance;
        let back = ahead.dot(first);
        let (one, other) = (subject.way(run.from), subject.way(run.to));
        for parcel in parcels
            .iter()
            .filter(|p| p.view != own.view && !skyline.passed[p.pillar])
        {
            let middle = parcel.middle - subject.o;
            let room = parcel.radius + SIGHT_ROOM_MM;
            if one.perp_dot(middle) < -room
                || middle.perp_dot(other) < -room
                || ahead.dot(middle) > back + room
            {
                continue;
            }
            let mm = shared_depth(
                subject.o,
                [one, other],
                (ahead, back),
                [first, last],
                &parcel.corners,
            ) + SIGHT_ROOM_MM;
            if mm > 0.0 {
                let kind = FaultKind::Sight;
                let pillars = [Some(own.pillar), Some(parcel.pillar)];
                faults.push(Fault {
                    kind,
                    view: Some(own.view),
                    pillars,
                    mm,
                    at: parcel.middle,
                });
            }
        }
    }
}

/// How deep a convex piece stands in the triangle of sight lines from `o` along the unit ways `sides` up to `back` along `ahead`, whose
/// far corners are `o + ends`: the least depth over their sides as separating axes; negative if they are apart.
fn shared_depth(
    o: DVec2,
    sides: [DVec2; 2],
    (ahead, back): (DVec2, f64),
    ends: [DVec2; 2],
    parcel: &[DVec2; 4],
) -> f64 {
    let deepest = |inward: &dyn Fn(DVec2) -> f64| {
        parcel
            .iter()
            .map(|c| inward(*c - o))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let of_triangle = deepest(&|p| sides[0].perp_dot(p))
        .min(deepest(&|p| p.perp_dot(sides[1])))
        .min(deepest(&|p| back - ahead.dot(p)));
    (0..4).fold(of_triangle, |least, k| {
        let (a, b) = (parcel[k], parcel[(k + 1) % 4]);
        let inward = (b - a).perp().normalize_or_zero();
        let of_side = [DVec2::ZERO, ends[0], ends[1]].map(|t| inward.dot(o + t - a));
        least.min(of_side[0].max(of_side[1]).max(of_side[2]))
    })
}

/// Room between bodies, and between reliefs and what is not their own pillar.
pub(crate) fn tight(
    brief: &Brief,
    pillars: &[Pillar],
    parcels: &[Parcel],
    faults: &mut Vec<Fault>,
) {
    let shapes = &brief.shapes;
    let mut note = |i: usize, j: usize, mm: f64, at: DVec2| {
        if mm > 0.0 {
            let (kind, pillars) = (FaultKind::Tight, [Some(i), Some(j)]);
            faults.push(Fault {
                kind,
                view: None,
                pillars,
                mm,
                at,
            });
        }
    };
    for (i, a) in pillars.iter().enumerate() {
        for (j, b) in pillars.iter().enumerate().skip(i + 1) {
            let reach = shapes[a.shape].reach + shapes[b.shape].reach + brief.gap;
            if (a.fixed && b.fixed) || a.at.distance_squared(b.at) >= reach * reach {
                continue;
            }
            let missing = if shapes[a.shape].round && shapes[b.shape].round {
                reach - a.at.distance(b.at)
            } else {
                brief.gap - gap(&body(a, shapes), &body(b, shapes))
            };
            note(i, j, missing, (a.at + b.at) / 2.0);
        }
    }
    let room = brief.care.reliefs;
    if room == 0.0 {
        return;
    }
    for (n, parcel) in parcels.iter().enumerate() {
        for (i, pillar) in pillars.iter().enumerate() {
            let shape = &shapes[pillar.shape];
            let reach = parcel.radius + shape.reach + room;
            if i == parcel.pillar || parcel.middle.distance_squared(pillar.at) > reach * reach {
                continue;
            }
            let apart = if shape.round {
                to_convex(&parcel.corners, pillar.at) - shape.reach
            } else {
                gap(&parcel.corners, &body(pillar, shapes))
            };
            note(parcel.pillar, i, room - apart, pillar.at);
        }
        for other in &parcels[n + 1..] {
            let reach = parcel.radius + other.radius + room;
            if other.pillar != parcel.pillar
                && parcel.middle.distance_squared(other.middle) < reach * reach
            {
                let mm = room - gap(&parcel.corners, &other.corners);
                note(
                    parcel.pillar,
                    other.pillar,
                    mm,
                    (parcel.middle + other.middle) / 2.0,
                );
            }
        }
    }
}

fn body(pillar: &Pillar, shapes: &[Shape]) -> Vec<DVec2> {
    shapes[pillar.shape]
        .profile
        .iter()
        .map(|p| pillar.at + *p)
        .collect()
}

/// Distance of a point from a convex counter-clockwise quadrilateral, 0 inside.
fn to_convex(corners: &[DVec2; 4], p: DVec2) -> f64 {
    let side = |k: usize| (corners[k], corners[(k + 1) % 4]);
    if (0..4).all(|k| (side(k).1 - side(k).0).perp_dot(p - corners[k]) >= 0.0) {
        return 0.0;
    }
    (0..4)
        .map(|k| to_segment(p, side(k).0, side(k).1))
        .fold(f64::INFINITY, f64::min)
}

/// Faults of places and numbers.
pub(crate) fn placed(brief: &Brief, pillars: &[Pillar], faults: &mut Vec<Fault>) {
    for (i, pillar) in pillars.iter().enumerate().filter(|(_, p)| !p.fixed) {
        let mm = brief
            .region
            .outside(pillar.at, brief.shapes[pillar.shape].reach);
        if mm > 0.0 {
            let (kind, pillars) = (FaultKind::Outside, [Some(i), None]);
            faults.push(Fault {
                kind,
                view: None,
                pillars,
                mm,
                at: pillar.at,
            });
        }
    }
    let ([fewest, most], n) = (brief.count, pillars.len());
    let beyond = fewest.saturating_sub(n).max(n.saturating_sub(most));
    if beyond > 0 {
        let at = brief.region.middle();
        let (kind, mm) = (FaultKind::Count, beyond as f64);
        faults.push(Fault {
            kind,
            view: None,
            pillars: [None, None],
            mm,
            at,
        });
    }
}
