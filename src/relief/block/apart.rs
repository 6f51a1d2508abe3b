//! Moves of fans in the image: apart where a block touches itself in a point, and outwards behind nearer supports.

use super::cells::{BlockCells, CellCorner, FanId};
use crate::geom::{orient, segment_crossing};
use crate::index::CellId;
use crate::viewmap::ViewMap;
use glam::DVec2;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// How far a touching corner is pulled in, millimetres: five times the thinnest cell of a tidy view map.
const PULL_MM: f64 = 0.01;

/// Corners around a point on the edge must leave this much of a circle open, or the region overlaps itself there; radians.
const FULL_TURN: f64 = std::f64::consts::TAU - 0.01;

/// Moves all but the widest fan of each point a little inwards. Gives the map cells of fans that cannot move, rising.
pub(crate) fn pull_apart(block: &mut BlockCells, map: &ViewMap) -> Vec<CellId> {
    let mut by_point: Vec<_> = FanId::all(block.fans.len())
        .map(|f| {
            let corners = &block.fans[f].corners;
            (block.point(corners[0]), Reverse(corners.len()), f)
        })
        .collect();
    by_point.sort_unstable();
    let touching: Vec<FanId> = by_point
        .chunk_by(|a, b| a.0 == b.0)
        .flat_map(|fans| fans[1..].iter().map(|f| f.2))
        .collect();
    let mut stuck = Vec::new();
    for f in touching {
        if !pull(block, map, f) {
            let corners = block.fans[f].corners.iter();
            stuck.extend(corners.map(|at| block.in_map[at.cell]));
        }
    }
    stuck.sort_unstable();
    stuck.dedup();
    stuck
}

fn pull(block: &mut BlockCells, map: &ViewMap, f: FanId) -> bool {
    let home = block.fans[f].q;
    let centre = |at: &CellCorner| map.points_mean(block.points_of(at.cell));
    let corners = block.fans[f].corners.iter();
    let inwards: DVec2 = corners
        .map(|at| (centre(at) - home).normalize_or_zero())
        .sum();
    shift(block, f, inwards, PULL_MM)
}

/// Moves the edge behind nearer supports outwards, as far as no cell turns over.
pub(crate) fn lap(block: &mut BlockCells, hidden: &impl Fn(CellId, usize) -> bool, lap_mm: f64) {
    let mut outwards: BTreeMap<FanId, DVec2> = BTreeMap::new();
    for side in block.sides() {
        if block.across(side).is_some() || !hidden(block.in_map[side.cell], side.k) {
            continue;
        }
        let ends = block.ends(side);
        let [u, v] = ends.map(|f| block.fans[f].q);
        // Longer sides weigh more, so that kinks too small to see do not turn the direction.
        ends.iter()
            .for_each(|f| *outwards.entry(*f).or_default() -= (v - u).perp());
    }
    let mut homes: BTreeMap<FanId, DVec2> = BTreeMap::new();
    for (f, direction) in outwards {
        let home = block.fans[f].q;
        if shift(block, f, direction, lap_mm) {
            homes.insert(f, home);
        }
    }
    send_home(block, homes);
}

/// Undoes moves until the region overlaps itself nowhere: at the latest when all are undone.
fn send_home(block: &mut BlockCells, mut homes: BTreeMap<FanId, DVec2>) {
    while !homes.is_empty() {
        let mut back = overlapping_fans(block, &homes);
        back.retain(|f| homes.contains_key(f));
        if back.is_empty() {
            return;
        }
        for f in back {
            if let Some(home) = homes.remove(&f) {
                block.fans[f].q = home;
            }
        }
    }
}

/// Fans of cells turned over, of sides that cross and of corners wound past a full circle, among those near moved ones.
fn overlapping_fans(block: &BlockCells, moved: &BTreeMap<FanId, DVec2>) -> BTreeSet<FanId> {
    let q = |f: FanId| block.fans[f].q;
    let mut bad = BTreeSet::new();
    for fans in &block.fan_of {
        if fans.iter().any(|f| moved.contains_key(f))
            && orient(q(fans[0]), q(fans[1]), q(fans[2])) <= 0.0
        {
            bad.extend(fans);
        }
    }
    for f in FanId::all(block.fans.len()) {
        let fan = &block.fans[f];
        let around = || fan.corners.iter().flat_map(|at| block.fan_of[at.cell]);
        if !fan.closed && around().any(|f| moved.contains_key(&f)) && winding(block, f) > FULL_TURN
        {
            bad.extend(around());
        }
    }
    let open = block.sides().filter(|s| block.across(*s).is_none());
    let border: Vec<[FanId; 2]> = open.map(|s| block.ends(s)).collect();
    for s in border
        .iter()
        .filter(|s| s.iter().any(|f| moved.contains_key(f)))
    {
        let (a, b) = (q(s[0]), q(s[1]));
        let (lo, hi) = (a.min(b), a.max(b));
        for t in border.iter().filter(|t| t.iter().all(|f| !s.contains(f))) {
            let (c, d) = (q(t[0]), q(t[1]));
            let apart = c.min(d).cmpgt(hi).any() || c.max(d).cmplt(lo).any();
            if !apart && segment_crossing(a, b, c, d).is_some() {
                bad.extend(s.iter().chain(t));
            }
        }
    }
    bad
}

/// Sum of a fan's corner angles, radians.
fn winding(block: &BlockCells, f: FanId) -> f64 {
    let angle = |at: &CellCorner| {
        let fans = block.fan_of[at.cell];
        let [a, b] = [1, 2].map(|j| block.fans[fans[(at.k + j) % 3]].q - block.fans[f].q);
        a.angle_to(b).abs()
    };
    block.fans[f].corners.iter().map(angle).sum()
}

/// Moves a fan's ray `by` millimetres in the image, or half or a quarter of it, if no cell turns over.
fn shift(block: &mut BlockCells, f: FanId, direction: DVec2, by: f64) -> bool {
    let home = block.fans[f].q;
    let corners = &block.fans[f].corners;
    let length = by / block.plane.scale(block.depth_at(corners[0]));
    for share in [1.0, 0.5, 0.25] {
        let moved = home + direction.normalize_or_zero() * length * share;
        let upright = |at: &CellCorner| {
            let fans = block.fan_of[at.cell];
            let [a, b] = [1, 2].map(|j| block.fans[fans[(at.k + j) % 3]].q);
            orient(moved, a, b) > 0.0
        };
        if moved != home && corners.iter().all(upright) {
            block.fans[f].q = moved;
            return true;
        }
    }
    false
}
