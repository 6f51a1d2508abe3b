//! What of every model reaches its viewer, and why the rest does not.
//!
//! Takes a view's map, groups and losses. Gives exact solid angles (sums over cells, each of which lies in one face and on one
//! support or none) and every gap: a connected region of the image with a model and one cause why nothing carries it.
//! Gaps of different causes meet at cells' sides: where no outline divides them, to within a cell. What no eye can make out, because it is
//! nowhere as wide as the scene's `seen`, is summed and not listed.

use super::point::without_minus_zero;
use crate::geom::rings::offset;
use crate::geom::{ARCMIN, SQUARE_ARCMIN};
use crate::groups::anchor;
use crate::index::{CellId, FaceId, SupportId, ViewId};
use crate::sight::Sight;
use crate::support::{Support, SupportKind};
use crate::viewmap::ViewMap;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Gaps below this share of the models are rounding at their outline: counted and summed, not listed.
pub const GAP_SHARE: f64 = 1e-6;

/// Why nothing shows the model in a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The rays pass no pillar at all.
    NoPillar,
    /// The rays pass over a pillar.
    PillarTooShort,
    /// Another view needs the place.
    OtherView,
    /// Something stands there that carries nothing for this view.
    Hidden,
    /// A support stands there, but no relief could be made on it.
    Infeasible,
}

/// A connected region of the image with one cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gap {
    /// Square arc-minutes.
    pub arcmin2: f64,
    /// The model's point near its middle, millimetres.
    pub place_mm: [f64; 3],
    /// Angles of that point right of and above the line of sight, degrees.
    pub right_deg: f64,
    pub up_deg: f64,
    pub cause: Cause,
    /// The pillar that is too short, the other view's support, the thing that hides, the support without relief.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support: Option<String>,
    /// The view that owns the place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// By how much the pillar would have to be higher, millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wanted_mm: Option<f64>,
}

/// One model's share.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelCoverage {
    pub name: String,
    /// What the eye would see of it, and what of that a support carries, steradians.
    pub solid_angle_sr: f64,
    pub carried_sr: f64,
}

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct Coverage {
    pub models: Vec<ModelCoverage>,
    /// By falling size.
    pub gaps: Vec<Gap>,
    /// Number and size of gaps too small or too narrow to list.
    pub small_gaps: usize,
    pub small_gaps_arcmin2: f64,
}

/// All gaps of one cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CauseShare<'a> {
    pub largest: &'a Gap,
    /// All of them together, as a share of the models.
    pub share: f64,
}

/// A cause with what it concerns, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Why {
    NoPillar,
    TooShort(SupportId),
    Owned { view: ViewId, support: SupportId },
    Hidden(SupportId),
    Infeasible(SupportId),
}

/// Coverage of a view; `views` are all views' names. `given_up` are cells (rising) that have a group but no relief in the
/// finished solid. Gaps narrower than `seen` arc-minutes are not listed.
pub fn coverage(sight: &Sight, views: &[&str], given_up: &[CellId], seen: f64) -> Coverage {
    let map = &sight.image.map;
    let all = || CellId::all(map.cells.len());
    let carried =
        |c: CellId| sight.groups.of_cell[c].is_some() && given_up.binary_search(&c).is_err();
    let why: Vec<Option<Why>> = all()
        .map(|c| {
            let gap = map.cells[c].face.is_some() && !carried(c);
            gap.then(|| reason(sight, c))
        })
        .collect();
    let models = sight.models().map(|(name, faces)| {
        let of_model = |c: &CellId| map.cells[*c].face.is_some_and(|f| faces.contains(&f));
        let cells: Vec<CellId> = all().filter(of_model).collect();
        let sum = |keep: &dyn Fn(CellId) -> bool| {
            let kept = cells.iter().filter(|c| keep(**c));
            kept.map(|c| map.solid_angle(*c)).sum()
        };
        ModelCoverage {
            name: name.to_owned(),
            solid_angle_sr: sum(&|_| true),
            carried_sr: sum(&carried),
        }
    });
    let mut found = Coverage {
        models: models.collect(),
        gaps: Vec::new(),
        small_gaps: 0,
        small_gaps_arcmin2: 0.0,
    };
    let least = GAP_SHARE * found.solid_angle_sr() * SQUARE_ARCMIN;
    for (why, cells) in regions(sight, &why) {
        let gap = gap(sight, views, why, &cells);
        if gap.arcmin2 < least || !is_as_wide_as(&sight.image.map, &cells, seen) {
            found.small_gaps += 1;
            found.small_gaps_arcmin2 += gap.arcmin2;
        } else {
            found.gaps.push(gap);
        }
    }
    // Stable: equal ones stay in the order of their cells.
    found.gaps.sort_by(|a, b| b.arcmin2.total_cmp(&a.arcmin2));
    found
}

impl Coverage {
    /// What the eye would see of all models, steradians.
    pub fn solid_angle_sr(&self) -> f64 {
        self.models.iter().map(|m| m.solid_angle_sr).sum()
    }

    /// Share of the models' solid angle that a support carries.
    pub fn share(&self) -> f64 {
        self.models.iter().map(|m| m.carried_sr).sum::<f64>() / self.solid_angle_sr()
    }

    /// The gaps cause by cause, in the order of [`Cause`].
    pub fn by_cause(&self) -> Vec<CauseShare<'_>> {
        let mut causes: Vec<Cause> = self.gaps.iter().map(|g| g.cause).collect();
        causes.sort_unstable();
        causes.dedup();
        let all = self.solid_angle_sr() * SQUARE_ARCMIN;
        let share = |cause: Cause| {
            let of_cause = || self.gaps.iter().filter(|g| g.cause == cause);
            Some(CauseShare {
                largest: of_cause().next()?,
                share: of_cause().map(|g| g.arcmin2).sum::<f64>() / all,
            })
        };
        causes.into_iter().filter_map(share).collect()
    }
}

/// Connected cells with the same reason, by their first cell.
fn regions(sight: &Sight, why: &[Option<Why>]) -> Vec<(Why, Vec<CellId>)> {
    let mut done = vec![false; why.len()];
    let mut found = Vec::new();
    for seed in CellId::all(why.len()) {
        let Some(reason) = why[seed].filter(|_| !done[seed]) else {
            continue;
        };
        let mut cells = vec![seed];
        done[seed] = true;
        let mut next = 0;
        while next < cells.len() {
            let around = sight.image.map.neighbours[cells[next]];
            next += 1;
            for n in around.into_iter().flatten() {
                if !done[n] && why[n] == Some(reason) {
                    done[n] = true;
                    cells.push(n);
                }
            }
        }
        found.push((reason, cells));
    }
    found
}

/// Whether a region of cells is anywhere as wide as `seen` arc-minutes: whether a disc of that width fits in.
pub(super) fn is_as_wide_as(map: &ViewMap, cells: &[CellId], seen: f64) -> bool {
    if seen <= 0.0 {
        return true;
    }
    // Across the way outwards, an angle takes as much more of the image's plane as the ray is longer than the forward axis.
    let ray = map
        .plane
        .direction(map.points_mean(map.cells[cells[0]].corners));
    let per_arcmin = ray.length() / ray.dot(map.plane.forward) * ARCMIN;
    let mut rising = cells.to_vec();
    rising.sort_unstable();
    let rings = map.outlines(&rising, 1.0 / per_arcmin);
    !offset(&rings, -seen / 2.0).is_empty()
}

/// Why nothing carries the model in a cell, judged at its centre.
fn reason(sight: &Sight, c: CellId) -> Why {
    if let Ok(i) = sight.lost.binary_search_by_key(&c, |l| l.cell) {
        let (view, support) = (sight.lost[i].owner, sight.lost[i].support);
        return Why::Owned { view, support };
    }
    let cell = &sight.image.map.cells[c];
    if let (Some(support), Some(_)) = (cell.support, sight.groups.of_cell[c]) {
        return Why::Infeasible(support);
    }
    let q = sight.image.map.points_mean(cell.corners);
    let mut short: Option<(f64, SupportId)> = None;
    let supports = sight.image.field.supports;
    for (s, support) in SupportId::all(supports.len()).zip(supports) {
        let carries = sight.groups.slabs[s].is_some();
        let height = missing_mm(sight, support, q, cell.support_depth).filter(|_| carries);
        if let Some(height) = height.filter(|h| short.is_none_or(|(least, _)| *h < least)) {
            short = Some((height, s));
        }
    }
    match (short, cell.support) {
        (Some((_, pillar)), _) => Why::TooShort(pillar),
        (None, Some(support)) => Why::Hidden(support),
        (None, None) => Why::NoPillar,
    }
}

/// By how much an upright support would have to be higher for the ray `q` to meet it before depth `until`; `None` if the ray
/// does not pass over it.
fn missing_mm(sight: &Sight, support: &Support, q: DVec2, until: f64) -> Option<f64> {
    let SupportKind::Pillar { profile, top, .. } = &support.kind else {
        return None;
    };
    let (eye, direction) = (
        sight.image.map.plane.eye,
        sight.image.map.plane.direction(q),
    );
    let (enter, leave) = chord(profile, eye, direction)?;
    let leave = leave.min(until);
    let lowest = eye.z + direction.z * if direction.z < 0.0 { leave } else { enter };
    (enter > 0.0 && enter < until && lowest > *top).then_some(lowest - top)
}

/// First and last parameter at which the ray, seen from above, meets the outline.
fn chord(profile: &[DVec2], eye: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let (eye, along) = (eye.truncate(), direction.truncate());
    let mut found: Option<(f64, f64)> = None;
    for (i, a) in profile.iter().enumerate() {
        let b = profile[(i + 1) % profile.len()];
        let (u, v) = (along.perp_dot(*a - eye), along.perp_dot(b - eye));
        if (u < 0.0) == (v < 0.0) {
            continue;
        }
        let t = (a.lerp(b, u / (u - v)) - eye).dot(along) / along.length_squared();
        found = Some(found.map_or((t, t), |(lo, hi)| (lo.min(t), hi.max(t))));
    }
    found
}

fn gap(sight: &Sight, views: &[&str], why: Why, cells: &[CellId]) -> Gap {
    let (map, supports) = (&sight.image.map, sight.image.field.supports);
    let size = |c: &CellId| map.solid_angle(*c);
    let centre = |c: &CellId| map.points_mean(map.cells[*c].corners);
    let area: f64 = cells.iter().map(size).sum();
    let mean = cells.iter().map(|c| size(c) * centre(c)).sum::<DVec2>() / area;
    // The cell nearest to the mean: the mean itself may lie outside of a bent gap.
    let middle = cells.iter().min_by(|a, b| {
        let from_mean = |c: &CellId| centre(c).distance_squared(mean);
        from_mean(a).total_cmp(&from_mean(b))
    });
    let middle = *middle.unwrap_or(&cells[0]);
    let q = centre(&middle);
    let face = map.cells[middle].face.unwrap_or(FaceId(0));
    let depth = anchor(&sight.image.target, face, q).1;
    let name = |s: SupportId| Some(supports[s].name.clone());
    let (cause, support) = match why {
        Why::NoPillar => (Cause::NoPillar, None),
        Why::TooShort(s) => (Cause::PillarTooShort, name(s)),
        Why::Owned { support, .. } => (Cause::OtherView, name(support)),
        Why::Hidden(s) => (Cause::Hidden, name(s)),
        Why::Infeasible(s) => (Cause::Infeasible, name(s)),
    };
    Gap {
        arcmin2: area * SQUARE_ARCMIN,
        place_mm: without_minus_zero(map.plane.point(q, depth)),
        right_deg: q.x.atan().to_degrees(),
        up_deg: q.y.atan().to_degrees(),
        cause,
        support,
        view: match why {
            Why::Owned { view, .. } => Some(views[view].to_owned()),
            _ => None,
        },
        wanted_mm: match why {
            Why::TooShort(s) => highest_missing(sight, &supports[s], cells),
            _ => None,
        },
    }
}

/// The most that is missing over the corners and centres of cells.
fn highest_missing(sight: &Sight, support: &Support, cells: &[CellId]) -> Option<f64> {
    let rays = cells.iter().flat_map(|c| {
        let cell = &sight.image.map.cells[*c];
        let [a, b, d] = sight.image.map.triangle(*c);
        [a, b, d, (a + b + d) / 3.0].map(|q| (q, cell.support_depth))
    });
    rays.filter_map(|(q, until)| missing_mm(sight, support, q, until))
        .max_by(f64::total_cmp)
}
