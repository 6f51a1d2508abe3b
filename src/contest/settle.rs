//! Settles all conflicts by a rule.

use super::claims::{Claim, Meeting, claims, meetings};
use crate::geom::SQUARE_ARCMIN;
use crate::index::CellId;
use crate::sight::{Loss, Sight};
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

/// A conflict where contests are errors: the first view's, with what it meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispute {
    pub view: String,
    pub found: Contest,
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
/// Claims (one view's cells on one support) are served in turn: by view with `First`; by falling contested solid angle, then by
/// view, with `Largest`. Each loses exactly the cells that are in conflict with cells kept before.
///
/// # Errors
/// With `Error`, one for each pair of views and supports in conflict.
pub fn settle(sights: &[Sight], rule: Contested) -> Result<Settlement, Vec<Dispute>> {
    let mut settled = Settlement {
        contests: vec![Vec::new(); sights.len()],
        lost: vec![Vec::new(); sights.len()],
    };
    if sights.len() < 2 {
        return Ok(settled);
    }
    let claims = claims(sights);
    let meetings = meetings(sights, &claims);
    if rule == Contested::Error && !meetings.is_empty() {
        let errors = meetings.iter().map(|m| refusal(sights, &claims, m));
        return Err(errors.collect());
    }
    let turn = turns(sights, &claims, &meetings, rule);
    settled.lost = losses(sights.len(), &claims, &meetings, &turn);
    for meeting in &meetings {
        let loser = meeting.claims[usize::from(turn[meeting.claims[0]] < turn[meeting.claims[1]])];
        let lost_by = sights[claims[loser].view].name();
        for side in 0..2 {
            let view = claims[meeting.claims[side]].view;
            let contest = contest(sights, &claims, meeting, side, lost_by);
            settled.contests[view].push(contest);
        }
    }
    Ok(settled)
}

/// Solid angle in square arc-minutes of each view's cells that are in conflict with another view's: 0 once settled.
pub fn contested(sights: &[Sight]) -> Vec<f64> {
    let claims = claims(sights);
    let meetings = meetings(sights, &claims);
    let mut sums = vec![0.0; sights.len()];
    for (p, claim) in claims.iter().enumerate() {
        sums[claim.view] += contested_arcmin2(sights, &claims, &meetings, p);
    }
    sums
}

/// When each claim is served.
fn turns(sights: &[Sight], claims: &[Claim], meetings: &[Meeting], rule: Contested) -> Vec<usize> {
    let mut order: Vec<usize> = (0..claims.len()).collect();
    if rule == Contested::Largest {
        let size: Vec<f64> = order
            .iter()
            .map(|p| contested_arcmin2(sights, claims, meetings, *p))
            .collect();
        // Stable: equal ones stay in the order of views and supports.
        order.sort_by(|a, b| size[*b].total_cmp(&size[*a]));
    }
    let mut turn = vec![0; claims.len()];
    for (i, claim) in order.into_iter().enumerate() {
        turn[claim] = i;
    }
    turn
}

/// The cells of side `side` of a meeting, rising.
fn cells_of(meeting: &Meeting, side: usize) -> Vec<CellId> {
    let mut cells: Vec<CellId> = meeting.pairs.iter().map(|p| p[side]).collect();
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// Solid angle of a claim's cells that are in any conflict.
fn contested_arcmin2(
    sights: &[Sight],
    claims: &[Claim],
    meetings: &[Meeting],
    claim: usize,
) -> f64 {
    let mut cells = Vec::new();
    for meeting in meetings {
        let side = meeting.claims.iter().position(|p| *p == claim);
        cells.extend(side.iter().flat_map(|side| cells_of(meeting, *side)));
    }
    cells.sort_unstable();
    cells.dedup();
    arcmin2(sights, &claims[claim], &cells)
}

fn arcmin2(sights: &[Sight], claim: &Claim, cells: &[CellId]) -> f64 {
    let map = &sights[claim.view].image.map;
    let sr: f64 = cells.iter().map(|c| map.solid_angle(*c)).sum();
    sr * SQUARE_ARCMIN
}

/// Serves all claims in turn.
fn losses(views: usize, claims: &[Claim], meetings: &[Meeting], turn: &[usize]) -> Vec<Vec<Loss>> {
    let mut lost: Vec<Vec<Loss>> = vec![Vec::new(); views];
    let mut order: Vec<usize> = (0..claims.len()).collect();
    order.sort_by_key(|p| turn[*p]);
    for p in order {
        let mut own: Vec<Loss> = Vec::new();
        for meeting in meetings {
            let Some(side) = meeting.claims.iter().position(|x| *x == p) else {
                continue;
            };
            let other = meeting.claims[1 - side];
            if turn[other] > turn[p] {
                continue;
            }
            let Claim { view, support, .. } = claims[other];
            let kept = |cell: CellId| {
                let gone = &lost[view];
                gone.binary_search_by_key(&cell, |l| l.cell).is_err()
            };
            let taken = meeting.pairs.iter().filter(|pair| kept(pair[1 - side]));
            own.extend(taken.map(|pair| Loss {
                cell: pair[side],
                owner: view,
                support,
            }));
        }
        let all = &mut lost[claims[p].view];
        all.extend(own);
        // Stable: the earliest pair of claims that takes a cell is named as its owner.
        all.sort_by_key(|l| l.cell);
        all.dedup_by_key(|l| l.cell);
    }
    lost
}

fn contest(
    sights: &[Sight],
    claims: &[Claim],
    meeting: &Meeting,
    side: usize,
    lost_by: &str,
) -> Contest {
    let own = &claims[meeting.claims[side]];
    let other = &claims[meeting.claims[1 - side]];
    let cells = cells_of(meeting, side);
    let Sight { image, .. } = &sights[own.view];
    let supports = image.field.supports;
    Contest {
        with_view: sights[other.view].name().to_owned(),
        support: supports[own.support].name.clone(),
        with_support: supports[other.support].name.clone(),
        arcmin2: arcmin2(sights, own, &cells),
        place_mm: place(sights, own, &cells),
        lost_by: lost_by.to_owned(),
    }
}

/// The axis plane's point in the largest cell.
fn place(sights: &[Sight], claim: &Claim, cells: &[CellId]) -> [f64; 3] {
    let Sight { image, groups, .. } = &sights[claim.view];
    let map = &image.map;
    let largest = cells.iter().copied().max_by(|a, b| {
        let size = |c: CellId| map.solid_angle(c);
        size(*a).total_cmp(&size(*b)).then(b.cmp(a))
    });
    let (Some(cell), Some(slab)) = (largest, groups.slabs[claim.support]) else {
        return [0.0; 3];
    };
    let q = map.points_mean(map.cells[cell].corners);
    let z = slab.plane(map.plane.direction(q), 0.0);
    (map.plane.point(q, z) + 0.0).to_array()
}

/// A conflict that nobody is to win.
fn refusal(sights: &[Sight], claims: &[Claim], meeting: &Meeting) -> Dispute {
    Dispute {
        view: sights[claims[meeting.claims[0]].view].name().to_owned(),
        found: contest(sights, claims, meeting, 0, ""),
    }
}
