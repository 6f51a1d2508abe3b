//! Room: reliefs in sight lines of other views, gaps between solids, the region.

use super::{Fault, Kind, Offsets, Survey};
use crate::geom::{gap, to_segment};
use crate::planner::brief::{Brief, Pillar, Shape};
use crate::planner::subject::Subject;
use glam::DVec2;

/// Room between a relief and other views' sight lines, millimetres: what reliefs lap behind pillars, thrice.
const SIGHT_ROOM_MM: f64 = 0.12;

/// The room in plan that the relief of one run may fill.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    view: usize,
    pillar: usize,
    run: usize,
    /// Near side from first to last bearing, then the far side back: a convex quadrilateral, counter-clockwise.
    corners: [DVec2; 4],
    /// A circle around it.
    middle: DVec2,
    radius: f64,
}

impl Survey {
    pub(super) fn pieces(
        &self,
        subjects: &[&Subject],
        shapes: &[Shape],
        pillars: &[Pillar],
    ) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (view, runs) in self.runs.iter().enumerate() {
            let subject = subjects[view];
            for (run, r) in runs.iter().enumerate() {
                let Some(pillar) = r.pillar.filter(|i| pillars[*i].owner == Some(view)) else {
                    continue;
                };
                let shadow = &self.shadows[view][pillar];
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
                pieces.push(Piece {
                    view,
                    pillar,
                    run,
                    corners,
                    middle,
                    radius,
                });
            }
        }
        pieces
    }

    /// Reliefs of one view that stand in sight lines of another.
    pub(super) fn in_sight(&mut self, subjects: &[&Subject], pillars: &[Pillar], pieces: &[Piece]) {
        for own in pieces {
            let run = &self.runs[own.view][own.run];
            let subject = subjects[own.view];
            let [first, last] = [own.corners[1] - subject.o, own.corners[2] - subject.o];
            let ahead =
                (pillars[own.pillar].at - subject.o) / self.shadows[own.view][own.pillar].distance;
            let back = ahead.dot(first);
            let (one, other) = (subject.way(run.from), subject.way(run.to));
            for piece in pieces
                .iter()
                .filter(|p| p.view != own.view && !self.shadows[own.view][p.pillar].below)
            {
                let middle = piece.middle - subject.o;
                let room = piece.radius + SIGHT_ROOM_MM;
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
                    &piece.corners,
                ) + SIGHT_ROOM_MM;
                if mm > 0.0 {
                    let kind = Kind::Sight;
                    let pillars = [Some(own.pillar), Some(piece.pillar)];
                    self.faults.push(Fault {
                        kind,
                        view: Some(own.view),
                        pillars,
                        mm,
                        at: piece.middle,
                    });
                }
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
    piece: &[DVec2; 4],
) -> f64 {
    let deepest = |inward: &dyn Fn(DVec2) -> f64| {
        piece
            .iter()
            .map(|c| inward(*c - o))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let of_triangle = deepest(&|p| sides[0].perp_dot(p))
        .min(deepest(&|p| p.perp_dot(sides[1])))
        .min(deepest(&|p| back - ahead.dot(p)));
    (0..4).fold(of_triangle, |least, k| {
        let (a, b) = (piece[k], piece[(k + 1) % 4]);
        let inward = (b - a).perp().normalize_or_zero();
        let of_side = [DVec2::ZERO, ends[0], ends[1]].map(|t| inward.dot(o + t - a));
        least.min(of_side[0].max(of_side[1]).max(of_side[2]))
    })
}

/// Room between bodies, and between reliefs and what is not their own pillar.
pub fn tight(brief: &Brief, pillars: &[Pillar], pieces: &[Piece], faults: &mut Vec<Fault>) {
    let shapes = &brief.shapes;
    let mut note = |i: usize, j: usize, mm: f64, at: DVec2| {
        if mm > 0.0 {
            let (kind, pillars) = (Kind::Tight, [Some(i), Some(j)]);
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
    for (n, piece) in pieces.iter().enumerate() {
        for (i, pillar) in pillars.iter().enumerate() {
            let shape = &shapes[pillar.shape];
            let reach = piece.radius + shape.reach + room;
            if i == piece.pillar || piece.middle.distance_squared(pillar.at) > reach * reach {
                continue;
            }
            let apart = if shape.round {
                to_convex(&piece.corners, pillar.at) - shape.reach
            } else {
                gap(&piece.corners, &body(pillar, shapes))
            };
            note(piece.pillar, i, room - apart, pillar.at);
        }
        for other in &pieces[n + 1..] {
            let reach = piece.radius + other.radius + room;
            if other.pillar != piece.pillar
                && piece.middle.distance_squared(other.middle) < reach * reach
            {
                let mm = room - gap(&piece.corners, &other.corners);
                note(
                    piece.pillar,
                    other.pillar,
                    mm,
                    (piece.middle + other.middle) / 2.0,
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
pub fn placed(brief: &Brief, pillars: &[Pillar], faults: &mut Vec<Fault>) {
    for (i, pillar) in pillars.iter().enumerate().filter(|(_, p)| !p.fixed) {
        let mm = brief
            .region
            .outside(pillar.at, brief.shapes[pillar.shape].reach);
        if mm > 0.0 {
            let (kind, pillars) = (Kind::Outside, [Some(i), None]);
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
        let (kind, mm) = (Kind::Count, beyond as f64);
        faults.push(Fault {
            kind,
            view: None,
            pillars: [None, None],
            mm,
            at,
        });
    }
}
