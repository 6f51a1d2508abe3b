//! What holds of a layout and what does not: coverage, conflicts, gaps, eye tolerance, exactly and in plan.
//!
//! Takes subjects and pillars. Gives every fault with its size in millimetres, so that a search can walk towards a layout without
//! faults, and the rates at which cuts open. A layout without faults has, in plan, coverage 1 and conflicts 0: every ray to a
//! model meets a pillar of its own view first, with an overlap behind every cut; no other view's relief stands in it, nor any solid
//! nearer to another than the gap. Vertically, all rays meet their pillars below the top and above the base.

use super::brief::{Brief, Pillar, Shape};
use super::skyline::{Run, Shadow, runs};
use super::subject::Subject;
use crate::geom::{gap, parallax, to_segment};
use crate::steps::UNSEEN_RAD;
use crate::support::Datum;
use glam::DVec2;

/// Room between a relief and other views' sight lines, millimetres: what reliefs lap behind pillars, thrice.
const SIGHT_ROOM_MM: f64 = 0.12;
/// Thickness behind a layer's back that is relief too, at most; see [`Slab::backing`](crate::support::Slab::backing).
const BACKING_MM: f64 = 0.8;

/// Where a pillar's relief may lie, seen from its owner: offsets of planes behind the axis plane, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets {
    pub near: f64,
    /// Of the layer, and with the backing.
    pub back: f64,
    pub far: f64,
    /// Middle of the layer.
    pub middle: f64,
}

impl Offsets {
    pub fn new(shape: &Shape) -> Self {
        let layer = shape.layer;
        let near = match layer.datum {
            Datum::AxisPlane => -layer.front,
            Datum::Surface => -layer.front - shape.reach,
        };
        Self {
            near,
            back: layer.back,
            far: layer.back + BACKING_MM,
            middle: (near + layer.back) / 2.0,
        }
    }
}

/// What can be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A part of the models meets no pillar.
    Uncovered,
    /// A part of the models meets another view's pillar.
    Foreign,
    /// Overlap is missing behind a cut or an outline.
    Loose,
    /// A strip is too narrow.
    Narrow,
    /// What stays of a pillar behind another is too thin.
    Fin,
    /// Rays pass above a pillar's top or below its foot.
    Ends,
    /// A relief stands in sight lines of another view.
    Sight,
    /// Room is missing between solids.
    Tight,
    /// A pillar sticks out of the region.
    Outside,
    /// A cut opens faster than the tolerance allows.
    Open,
    /// Too many pillars, or too few.
    Count,
}

/// A fault; see [`Kind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    pub kind: Kind,
    /// The view that suffers.
    pub view: Option<usize>,
    /// The pillars that have a part in it.
    pub pillars: [Option<usize>; 2],
    /// How much is wrong: widths, depths and gaps as such, the rest as far as it would have to move.
    pub mm: f64,
    pub at: DVec2,
}

/// A layout seen from all eyes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Index: view, then pillar.
    pub shadows: Vec<Vec<Shadow>>,
    /// Index: view.
    pub runs: Vec<Vec<Run>>,
    pub faults: Vec<Fault>,
    /// Fastest opening of any cut, radians per millimetre that the eye moves sideways: with reliefs in the middle of their
    /// layers, and at their worst places. Index: view.
    pub rates: Vec<[f64; 2]>,
}

impl Survey {
    /// Surveys a layout. `brief` gives shapes, region, gap and limits.
    pub fn new(subjects: &[&Subject], brief: &Brief, pillars: &[Pillar]) -> Self {
        let shadow = |s: &Subject, p: &Pillar| Shadow::new(s, p, &brief.shapes[p.shape]);
        let of = |s: &&Subject| pillars.iter().map(|p| shadow(s, p)).collect();
        Self::with_shadows(subjects, brief, pillars, subjects.iter().map(of).collect())
    }

    /// The same where the shadows are known.
    pub fn with_shadows(
        subjects: &[&Subject],
        brief: &Brief,
        pillars: &[Pillar],
        shadows: Vec<Vec<Shadow>>,
    ) -> Self {
        let mut found = Self {
            shadows,
            ..Self::default()
        };
        for (view, subject) in subjects.iter().enumerate() {
            let shadows = &found.shadows[view];
            let runs = runs(subject, pillars, &brief.shapes, shadows);
            let eye = OfView {
                subject,
                view,
                brief,
                pillars,
                shadows,
            };
            eye.look(&runs, &mut found.faults);
            let rates = eye.rates(&runs);
            found
                .faults
                .extend(eye.open(rates[1], brief.tolerance_mm[view]));
            found.rates.push(rates);
            found.runs.push(runs);
        }
        let pieces = found.pieces(subjects, &brief.shapes, pillars);
        found.in_sight(subjects, pillars, &pieces);
        tight(brief, pillars, &pieces, &mut found.faults);
        placed(brief, pillars, &mut found.faults);
        found
    }

    /// How much is wrong in all, millimetres; 0 if nothing is.
    pub fn wrong(&self) -> f64 {
        self.faults.iter().map(|f| f.mm).sum()
    }

    /// Guaranteed eye tolerance of a view, millimetres.
    pub fn tolerance(&self, view: usize) -> f64 {
        UNSEEN_RAD / self.rates[view][1].max(f64::MIN_POSITIVE)
    }

    /// Least of all views.
    pub fn least_tolerance(&self) -> f64 {
        (0..self.rates.len())
            .map(|v| self.tolerance(v))
            .fold(f64::INFINITY, f64::min)
    }
}

/// One eye and what stands before it.
struct OfView<'a> {
    subject: &'a Subject,
    view: usize,
    brief: &'a Brief,
    pillars: &'a [Pillar],
    shadows: &'a [Shadow],
}

impl OfView<'_> {
    /// Faults of what the eye meets.
    fn look(&self, runs: &[Run], faults: &mut Vec<Fault>) {
        for (k, run) in runs.iter().enumerate() {
            let Some(i) = run.pillar else {
                let distance = (self.subject.middle.truncate() - self.subject.o).length();
                let mm = (run.to - run.from) * distance + self.brief.care.overlap;
                self.note(faults, Kind::Uncovered, [None, None], mm, (run, distance));
                continue;
            };
            let shadow = &self.shadows[i];
            let place = (run, shadow.distance);
            let width = (run.to - run.from) * shadow.distance;
            if self.pillars[i].owner != Some(self.view) {
                self.note(
                    faults,
                    Kind::Foreign,
                    [Some(i), None],
                    width + self.brief.care.overlap,
                    place,
                );
                continue;
            }
            self.note(
                faults,
                Kind::Narrow,
                [Some(i), None],
                self.brief.care.narrowest - width,
                place,
            );
            self.note(
                faults,
                Kind::Ends,
                [Some(i), None],
                self.beyond_ends(run, i),
                place,
            );
            let left = k
                .checked_sub(1)
                .map(|p| &runs[p])
                .filter(|r| r.to == run.from);
            let right = runs.get(k + 1).filter(|r| r.from == run.to);
            let other = |next: Option<&Run>| next.and_then(|n| n.pillar);
            for (j, own, behind) in [
                (
                    other(left),
                    run.from - shadow.from,
                    self.reach_on(other(left), run.from, |s, at| s.to - at),
                ),
                (
                    other(right),
                    shadow.to - run.to,
                    self.reach_on(other(right), run.to, |s, at| at - s.from),
                ),
            ] {
                // One of the two reaches on behind the other. Cuts are met from both sides.
                let mm = self.brief.care.overlap - own.max(behind) * shadow.distance;
                let mm = if j.is_some() { mm / 2.0 } else { mm };
                self.note(faults, Kind::Loose, [Some(i), j], mm, place);
                let [thin, thick] = self.brief.care.fins;
                let width = own * shadow.distance;
                let mm = (width - thin).min(thick - width);
                self.note(
                    faults,
                    Kind::Fin,
                    [Some(i), j],
                    if j.is_some() { mm } else { 0.0 },
                    place,
                );
            }
        }
    }

    /// How far the pillar on the other side of a cut reaches over to this one; at an outline, how far any of the view's own
    /// pillars that stand across it reaches beyond, by the negative of `over`.
    fn reach_on(&self, next: Option<usize>, at: f64, over: impl Fn(&Shadow, f64) -> f64) -> f64 {
        if let Some(j) = next {
            return over(&self.shadows[j], at);
        }
        let own = self
            .pillars
            .iter()
            .zip(self.shadows)
            .filter(|(p, _)| p.owner == Some(self.view));
        let across = own.filter(|(_, s)| s.from <= at && at <= s.to);
        across
            .map(|(_, s)| (s.to - s.from) - over(s, at))
            .fold(0.0, f64::max)
    }

    fn note(
        &self,
        faults: &mut Vec<Fault>,
        kind: Kind,
        pillars: [Option<usize>; 2],
        mm: f64,
        (run, distance): (&Run, f64),
    ) {
        if mm > 0.0 {
            let at = self.subject.point((run.from + run.to) / 2.0, distance);
            faults.push(Fault {
                kind,
                view: Some(self.view),
                pillars,
                mm,
                at,
            });
        }
    }

    fn beyond_ends(&self, run: &Run, i: usize) -> f64 {
        let (shadow, shape) = (&self.shadows[i], &self.brief.shapes[self.pillars[i].shape]);
        let [near, far] = reach_of(shadow, shape);
        self.subject.beyond_ends(run.from, run.to, near, far, shape)
    }

    /// See [`Survey::rates`].
    fn rates(&self, runs: &[Run]) -> [f64; 2] {
        let mut worst = [0.0f64; 2];
        for pair in runs.windows(2).filter(|p| p[0].to == p[1].from) {
            let [Some(i), Some(j)] = [pair[0].pillar, pair[1].pillar] else {
                continue;
            };
            let [a, b] = [i, j].map(|k| {
                let shadow = &self.shadows[k];
                let offsets = Offsets::new(&self.brief.shapes[self.pillars[k].shape]);
                let slant = (pair[0].to - shadow.middle).cos();
                [offsets.middle, offsets.near, offsets.back].map(|o| (shadow.distance + o) / slant)
            });
            worst[0] = worst[0].max(parallax(a[0], b[0]).abs());
            worst[1] = worst[1].max(parallax(a[1], b[2])).max(parallax(b[1], a[2]));
        }
        worst
    }

    /// The fault of cuts that open faster than the tolerance allows: how far the farther piece would have to come nearer.
    fn open(&self, rate: f64, tolerance_mm: f64) -> Option<Fault> {
        let allowed = UNSEEN_RAD / tolerance_mm;
        let away = (self.subject.middle.truncate() - self.subject.o).length();
        (tolerance_mm > 0.0 && rate > allowed).then(|| Fault {
            kind: Kind::Open,
            view: Some(self.view),
            pillars: [None, None],
            mm: (rate - allowed) * away * away,
            at: self.subject.middle.truncate(),
        })
    }
}

/// Horizontal distances between which rays meet a pillar or its relief.
pub fn reach_of(shadow: &Shadow, shape: &Shape) -> [f64; 2] {
    let offsets = Offsets::new(shape);
    let near = shadow.distance + offsets.near.min(-shape.reach);
    let far = (shadow.distance + offsets.far) / (shadow.to - shadow.middle).min(1.0).cos();
    [near, far]
}

/// The room in plan that the relief of one run may fill.
#[derive(Clone, Copy, Debug)]
struct Piece {
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
    fn pieces(&self, subjects: &[&Subject], shapes: &[Shape], pillars: &[Pillar]) -> Vec<Piece> {
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
    fn in_sight(&mut self, subjects: &[&Subject], pillars: &[Pillar], pieces: &[Piece]) {
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
fn tight(brief: &Brief, pillars: &[Pillar], pieces: &[Piece], faults: &mut Vec<Fault>) {
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
fn placed(brief: &Brief, pillars: &[Pillar], faults: &mut Vec<Fault>) {
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
