//! Settles all conflicts by a rule.

use super::claims::{Claim, Contender, Meeting, claims, in_way, meetings};
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
    settled.lost = losses(sights, &claims, &meetings, &turn);
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
        cells.extend(side.iter().flat_map(|side| &meeting.cells[*side]));
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
fn losses(
    sights: &[Sight],
    claims: &[Claim],
    meetings: &[Meeting],
    turn: &[usize],
) -> Vec<Vec<Loss>> {
    let mut lost: Vec<Vec<Loss>> = vec![Vec::new(); sights.len()];
    let mut met: Vec<Vec<(&Meeting, usize)>> = vec![Vec::new(); claims.len()];
    for meeting in meetings {
        (0..2).for_each(|side| met[meeting.claims[side]].push((meeting, side)));
    }
    let mut order: Vec<usize> = (0..claims.len()).collect();
    order.sort_by_key(|p| turn[*p]);
    for p in order {
        // Rising; the earliest meeting that takes a cell is named as its owner.
        let mut own: Vec<Loss> = Vec::new();
        for &(meeting, side) in &met[p] {
            let other = meeting.claims[1 - side];
            if turn[other] > turn[p] {
                continue;
            }
            let Claim { view, support, .. } = claims[other];
            let taken = taken(sights, claims, (meeting, side), &own, &lost[view]);
            own.extend(taken.into_iter().map(|cell| Loss {
                cell,
                owner: view,
                support,
            }));
            own.sort_by_key(|l| l.cell);
        }
        let all = &mut lost[claims[p].view];
        all.extend(own);
        all.sort_by_key(|l| l.cell);
    }
    lost
}

/// The cells of one side of a meeting, but for those that are `lost` already, that are in the way of cells that the other side kept;
/// `gone` are those that its view did not keep.
fn taken(
    sights: &[Sight],
    claims: &[Claim],
    (meeting, side): (&Meeting, usize),
    lost: &[Loss],
    gone: &[Loss],
) -> Vec<CellId> {
    let among = |losses: &[Loss], c: CellId| losses.binary_search_by_key(&c, |l| l.cell).is_ok();
    let [own, others] = [side, 1 - side].map(|s| &meeting.cells[s]);
    let left = own.iter().copied().filter(|c| !among(lost, *c));
    if others.iter().all(|c| !among(gone, *c)) {
        return left.collect();
    }
    let [own_claim, other_claim] = [side, 1 - side].map(|s| &claims[meeting.claims[s]]);
    let sides = [
        Contender::of(own_claim, own, |c| !among(lost, c)),
        Contender::of(other_claim, others, |c| !among(gone, c)),
    ];
    in_way(sights, sides).map_or(Vec::new(), |[own, _]| own)
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
    let cells = &meeting.cells[side];
    let Sight { image, .. } = &sights[own.view];
    let supports = image.field.supports;
    Contest {
        with_view: sights[other.view].name().to_owned(),
        support: supports[own.support].name.clone(),
        with_support: supports[other.support].name.clone(),
        arcmin2: arcmin2(sights, own, cells),
        place_mm: place(sights, own, cells),
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
