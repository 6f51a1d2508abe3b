//! Contests: surface that two views want, and reliefs that would stand in each other's sight lines.
//!
//! Takes every view's map and groups. Gives the cells that are in conflict, settles each conflict by a rule, and tells which
//! cells each view loses. Promises: of the cells that are kept no two are in conflict. Bare supports that stand before others
//! are no matter of this stage: the view map knows them.
//!
//! # What is tested
//!
//! Before depths are known, a relief on cell `b` of view B may lie anywhere between the near side of its layer and the solid
//! backing: a frustum of B's rays. View A sees its cell `a` if the rays from its eye through `a` are free down to the deepest
//! place its relief may have: a pyramid. The two are in conflict if pyramid and frustum share more than a contact, one way or
//! the other; both are convex, so a separating axis decides. Two views that want the same surface are a special case: each
//! volume stands in the other's sight. Over a flat layer this is exact; over a curved one each cell counts with its nearest and
//! its farthest depth.

mod claims;
mod frustum;

pub use claims::Claim;
pub use frustum::{CONTACT_MM, Frustum};

use crate::diag::Diagnostic;
use crate::geom::SQUARE_ARCMIN;
use crate::viewmap::SupportField;
use claims::{Meeting, Patch, meetings, patches};
use serde::{Deserialize, Serialize};

/// Who gets contested surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contested {
    /// The view that stands earlier in the scene.
    First,
    /// The view to which it is more, as a solid angle on that support.
    Largest,
    /// Nobody: contested surface is an error.
    Error,
}

/// Cells of one view on one support that are in conflict with those of another view on one support.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contest {
    pub with_view: String,
    pub support: String,
    pub with_support: String,
    /// Solid angle of this view's cells, square arc-minutes.
    pub arcmin2: f64,
    /// Middle of the layer in the largest of them, millimetres.
    pub place_mm: [f64; 3],
    /// The view that gave way.
    pub lost_by: String,
}

/// A cell that its view loses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loss {
    pub cell: u32,
    /// The view that owns the place, as an index.
    pub owner: u32,
    /// The owner's support there.
    pub support: u32,
}

/// How all conflicts were settled. Index: view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settlement {
    pub contests: Vec<Vec<Contest>>,
    /// By rising cell.
    pub lost: Vec<Vec<Loss>>,
}

/// Settles all conflicts by the rule.
///
/// Patches (one view's cells on one support) are served in turn: by view with `First`; by falling contested solid angle, then by
/// view, with `Largest`. Each loses exactly the cells that are in conflict with cells kept before.
///
/// # Errors
/// With `Error`, one for each pair of views and supports in conflict.
pub fn settle(
    claims: &[Claim],
    field: &SupportField,
    rule: Contested,
) -> Result<Settlement, Vec<Diagnostic>> {
    let mut settled = Settlement {
        contests: vec![Vec::new(); claims.len()],
        lost: vec![Vec::new(); claims.len()],
    };
    if claims.len() < 2 {
        return Ok(settled);
    }
    let patches = patches(claims, field);
    let meetings = meetings(claims, &patches);
    if rule == Contested::Error && !meetings.is_empty() {
        let errors = meetings.iter().map(|m| refusal(claims, field, &patches, m));
        return Err(errors.collect());
    }
    let turn = turns(claims, &patches, &meetings, rule);
    settled.lost = losses(claims.len(), &patches, &meetings, &turn);
    for meeting in &meetings {
        let loser =
            meeting.patches[usize::from(turn[meeting.patches[0]] < turn[meeting.patches[1]])];
        let lost_by = claims[patches[loser].view as usize].name;
        for side in 0..2 {
            let view = patches[meeting.patches[side]].view as usize;
            let contest = contest(claims, field, &patches, meeting, side, lost_by);
            settled.contests[view].push(contest);
        }
    }
    Ok(settled)
}

/// Solid angle in square arc-minutes of each view's cells that are in conflict with another view's: 0 once settled.
pub fn contested(claims: &[Claim], field: &SupportField) -> Vec<f64> {
    let patches = patches(claims, field);
    let meetings = meetings(claims, &patches);
    let mut sums = vec![0.0; claims.len()];
    for (p, patch) in patches.iter().enumerate() {
        sums[patch.view as usize] += contested_arcmin2(claims, &patches, &meetings, p);
    }
    sums
}

/// When each patch is served.
fn turns(claims: &[Claim], patches: &[Patch], meetings: &[Meeting], rule: Contested) -> Vec<usize> {
    let mut order: Vec<usize> = (0..patches.len()).collect();
    if rule == Contested::Largest {
        let size: Vec<f64> = order
            .iter()
            .map(|p| contested_arcmin2(claims, patches, meetings, *p))
            .collect();
        // Stable: equal ones stay in the order of views and supports.
        order.sort_by(|a, b| size[*b].total_cmp(&size[*a]));
    }
    let mut turn = vec![0; patches.len()];
    for (i, patch) in order.into_iter().enumerate() {
        turn[patch] = i;
    }
    turn
}

/// The cells of side `side` of a meeting, rising.
fn cells_of(meeting: &Meeting, side: usize) -> Vec<u32> {
    let mut cells: Vec<u32> = meeting.pairs.iter().map(|p| p[side]).collect();
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// Solid angle of a patch's cells that are in any conflict.
fn contested_arcmin2(
    claims: &[Claim],
    patches: &[Patch],
    meetings: &[Meeting],
    patch: usize,
) -> f64 {
    let mut cells = Vec::new();
    for meeting in meetings {
        let side = meeting.patches.iter().position(|p| *p == patch);
        cells.extend(side.iter().flat_map(|side| cells_of(meeting, *side)));
    }
    cells.sort_unstable();
    cells.dedup();
    arcmin2(claims, &patches[patch], &cells)
}

fn arcmin2(claims: &[Claim], patch: &Patch, cells: &[u32]) -> f64 {
    let map = claims[patch.view as usize].map;
    let sr: f64 = cells.iter().map(|c| map.solid_angle(*c as usize)).sum();
    sr * SQUARE_ARCMIN
}

/// Serves all patches in turn.
fn losses(views: usize, patches: &[Patch], meetings: &[Meeting], turn: &[usize]) -> Vec<Vec<Loss>> {
    let mut lost: Vec<Vec<Loss>> = vec![Vec::new(); views];
    let mut order: Vec<usize> = (0..patches.len()).collect();
    order.sort_by_key(|p| turn[*p]);
    for p in order {
        let mut own: Vec<Loss> = Vec::new();
        for meeting in meetings {
            let Some(side) = meeting.patches.iter().position(|x| *x == p) else {
                continue;
            };
            let other = meeting.patches[1 - side];
            if turn[other] > turn[p] {
                continue;
            }
            let Patch { view, support, .. } = patches[other];
            let kept = |cell: u32| {
                let gone = &lost[view as usize];
                gone.binary_search_by_key(&cell, |l| l.cell).is_err()
            };
            let taken = meeting.pairs.iter().filter(|pair| kept(pair[1 - side]));
            own.extend(taken.map(|pair| Loss {
                cell: pair[side],
                owner: view,
                support,
            }));
        }
        let all = &mut lost[patches[p].view as usize];
        all.extend(own);
        // Stable: the earliest patch pair that takes a cell is named as its owner.
        all.sort_by_key(|l| l.cell);
        all.dedup_by_key(|l| l.cell);
    }
    lost
}

fn contest(
    claims: &[Claim],
    field: &SupportField,
    patches: &[Patch],
    meeting: &Meeting,
    side: usize,
    lost_by: &str,
) -> Contest {
    let own = &patches[meeting.patches[side]];
    let other = &patches[meeting.patches[1 - side]];
    let cells = cells_of(meeting, side);
    Contest {
        with_view: claims[other.view as usize].name.to_owned(),
        support: field.supports[own.support as usize].name.clone(),
        with_support: field.supports[other.support as usize].name.clone(),
        arcmin2: arcmin2(claims, own, &cells),
        place_mm: place(claims, own, &cells),
        lost_by: lost_by.to_owned(),
    }
}

/// The axis plane's point in the largest cell.
fn place(claims: &[Claim], patch: &Patch, cells: &[u32]) -> [f64; 3] {
    let Claim { map, groups, .. } = claims[patch.view as usize];
    let largest = cells.iter().copied().max_by(|a, b| {
        let size = |c: u32| map.solid_angle(c as usize);
        size(*a).total_cmp(&size(*b)).then(b.cmp(a))
    });
    let (Some(cell), Some(slab)) = (largest, groups.slabs[patch.support as usize]) else {
        return [0.0; 3];
    };
    let q = map.points_mean(map.cells[cell as usize].corners);
    let z = slab.plane(map.plane.direction(q), 0.0);
    (map.plane.point(q, z) + 0.0).to_array()
}

/// The error that names a conflict.
fn refusal(
    claims: &[Claim],
    field: &SupportField,
    patches: &[Patch],
    meeting: &Meeting,
) -> Diagnostic {
    let found = contest(claims, field, patches, meeting, 0, "");
    let view = claims[patches[meeting.patches[0]].view as usize].name;
    let [x, y, z] = found.place_mm;
    let Contest {
        with_view,
        support,
        with_support,
        arcmin2,
        ..
    } = found;
    let what = if support == with_support {
        format!("views \"{view}\" and \"{with_view}\" both want {support}")
    } else {
        format!(
            "the reliefs of view \"{view}\" on {support} and of view \"{with_view}\" on {with_support} stand in each other's way"
        )
    };
    Diagnostic::error(format!(
        "{what}: {arcmin2:.1} square arc-minutes of \"{view}\", mostly near ({x:.1}, {y:.1}, {z:.1}) mm"
    ))
    .help("move a pillar or a model, or let one of them have it: `contested: First` or `contested: Largest`")
}
