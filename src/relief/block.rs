//! A relief as a closed solid: a height field over part of the view map, with walls along the eye's rays and a flat back.
//!
//! Depths may jump between neighbouring cells (occlusion contours, components): such steps become walls, unseen by the eye.
//! Two things would make the solid non-manifold, and are changed by filling in material, never by removing it:
//! around a point the depths must fall to one valley and rise again (else a wall edge would have four faces), and two sheets
//! must not swap order along a side (else a wall would cross itself). A region that touches itself in one point is pulled
//! apart there by a hundredth of a millimetre.

use crate::geom::{ImagePlane, orient, segment_crossing};
use crate::mesh::TriMesh;
use crate::viewmap::ViewMap;
use glam::DVec2;
use std::collections::{BTreeMap, BTreeSet};

/// Depths nearer than this at one point are one level, millimetres. Rounding leaves 1e-9, f32 files resolve 8e-6; steps
/// below a printer's reach but above this are kept because they are parts of steps that grow along a line.
const LEVEL_MM: f64 = 0.003;
/// How far a touching corner is pulled in, millimetres: five times the thinnest cell of a tidy view map.
const PULL_MM: f64 = 0.01;

/// Corners around a point on the edge must leave this much of a circle open, or the region overlaps itself there; radians.
const FULL_TURN: f64 = std::f64::consts::TAU - 0.01;

/// A closed, outward oriented solid and what was changed to make it one.
#[derive(Clone, Debug, Default)]
pub struct Block {
    pub mesh: TriMesh,
    /// Corners whose depth was filled in.
    pub filled: usize,
    /// Cells of the map given up because their corner could not be pulled apart, rising.
    pub dropped: Vec<u32>,
}

/// The solid over `cells` (rising indices) with corner depths `depth` (index: cell of the map) and a back at `back(cell, q)`, which
/// hardly differs between neighbouring cells at a point they share.
/// `hidden(cell, side)` tells whether the support of the cell goes on behind that side, hidden by a nearer one: there the relief
/// goes on by `lap_mm`. Reliefs of neighbouring pillars whose depths overlap would touch in a wall along the rays there; so they
/// truly overlap, unseen. Below 0.01 mm mending could not tell overlap from contact.
pub fn block(
    map: &ViewMap,
    cells: &[u32],
    depth: &[Option<[f64; 3]>],
    back: impl Fn(u32, DVec2) -> f64,
    hidden: impl Fn(u32, usize) -> bool,
    lap_mm: f64,
) -> Block {
    let mut kept: Vec<u32> = cells
        .iter()
        .copied()
        .filter(|c| depth[*c as usize].is_some())
        .collect();
    let mut dropped = Vec::new();
    loop {
        let mut field = Field::new(map, &kept, depth);
        let stuck = field.pull_apart(map, PULL_MM);
        if stuck.is_empty() {
            let filled = field.settle();
            field.lap(&hidden, lap_mm);
            dropped.sort_unstable();
            return Block {
                mesh: field.solid(map, back),
                filled,
                dropped,
            };
        }
        dropped.extend(&stuck);
        kept.retain(|c| stuck.binary_search(c).is_err());
    }
}

/// A corner of a local cell.
type Corner = (u32, u8);

/// The cells around a point that hang together through shared sides, counter-clockwise.
struct Fan {
    q: DVec2,
    corners: Vec<Corner>,
    /// Whether they close a full circle.
    closed: bool,
}

struct Field {
    plane: ImagePlane,
    /// Map indices of the local cells.
    cells: Vec<u32>,
    points: Vec<[u32; 3]>,
    depth: Vec<[f64; 3]>,
    neighbours: Vec<[Option<u32>; 3]>,
    fans: Vec<Fan>,
    fan_of: Vec<[u32; 3]>,
}

impl Field {
    fn new(map: &ViewMap, cells: &[u32], depth: &[Option<[f64; 3]>]) -> Self {
        let local = |c: u32| cells.binary_search(&c).ok().map(|i| i as u32);
        let neighbours = cells
            .iter()
            .map(|c| map.neighbours[*c as usize].map(|n| n.and_then(local)))
            .collect();
        let points: Vec<[u32; 3]> = cells
            .iter()
            .map(|c| map.cells[*c as usize].corners)
            .collect();
        let depth = cells
            .iter()
            .map(|c| depth[*c as usize].expect("only cells with depths are kept"))
            .collect();
        let fan_of = vec![[u32::MAX; 3]; cells.len()];
        let mut field = Self {
            plane: map.plane,
            cells: cells.to_vec(),
            points,
            depth,
            neighbours,
            fans: Vec::new(),
            fan_of,
        };
        field.gather_fans(map);
        field
    }

    /// The corner at the same point in the next cell counter-clockwise (`side` 2) or clockwise (`side` 0).
    fn turn(&self, (c, k): Corner, side: u8) -> Option<Corner> {
        let next = self.neighbours[c as usize][((k + side) % 3) as usize]?;
        let point = self.points[c as usize][k as usize];
        let k = self.points[next as usize]
            .iter()
            .position(|p| *p == point)?;
        Some((next, k as u8))
    }

    fn gather_fans(&mut self, map: &ViewMap) {
        for c in 0..self.cells.len() as u32 {
            for k in 0..3u8 {
                if self.fan_of[c as usize][k as usize] != u32::MAX {
                    continue;
                }
                let mut first = (c, k);
                while let Some(before) = self.turn(first, 0).filter(|b| *b != (c, k)) {
                    first = before;
                }
                let closed = self.turn(first, 0).is_some();
                let start = if closed { (c, k) } else { first };
                let mut corners = vec![start];
                while let Some(next) = self
                    .turn(corners[corners.len() - 1], 2)
                    .filter(|n| *n != start)
                {
                    corners.push(next);
                }
                let id = self.fans.len() as u32;
                corners
                    .iter()
                    .for_each(|(c, k)| self.fan_of[*c as usize][*k as usize] = id);
                let q = map.points[self.points[c as usize][k as usize] as usize];
                self.fans.push(Fan { q, corners, closed });
            }
        }
    }

    /// Moves all but the widest fan of each point a little inwards. Gives the map cells of fans that cannot move, rising.
    fn pull_apart(&mut self, map: &ViewMap, pull_mm: f64) -> Vec<u32> {
        let point_of =
            |fan: &Fan| self.points[fan.corners[0].0 as usize][fan.corners[0].1 as usize];
        let mut by_point: Vec<(u32, std::cmp::Reverse<usize>, usize)> = self
            .fans
            .iter()
            .enumerate()
            .map(|(i, f)| (point_of(f), std::cmp::Reverse(f.corners.len()), i))
            .collect();
        by_point.sort_unstable();
        let touching: Vec<usize> = by_point
            .chunk_by(|a, b| a.0 == b.0)
            .flat_map(|fans| fans[1..].iter().map(|f| f.2))
            .collect();
        let mut stuck = Vec::new();
        for f in touching {
            if !self.pull(map, f, pull_mm) {
                stuck.extend(
                    self.fans[f]
                        .corners
                        .iter()
                        .map(|(c, _)| self.cells[*c as usize]),
                );
            }
        }
        stuck.sort_unstable();
        stuck.dedup();
        stuck
    }

    fn pull(&mut self, map: &ViewMap, f: usize, pull_mm: f64) -> bool {
        let home = self.fans[f].q;
        let centre = |(c, _): &Corner| map.points_mean(self.points[*c as usize]);
        let inwards: DVec2 = self.fans[f]
            .corners
            .iter()
            .map(|c| (centre(c) - home).normalize_or_zero())
            .sum();
        self.shift(f, inwards, pull_mm)
    }

    /// Makes depths around every point and along every side fit for a manifold; gives the number of corners changed.
    fn settle(&mut self) -> usize {
        (0..self.fans.len()).for_each(|f| self.cluster_levels(f));
        let before = self.depth.clone();
        // Every change fills a corner up to a depth that another corner of its fan has: it ends, and in practice at once.
        loop {
            let mut changed = false;
            for f in 0..self.fans.len() {
                changed |= self.fill_pits(f);
            }
            for c in 0..self.cells.len() {
                changed |= self.uncross(c);
            }
            if !changed {
                return before
                    .iter()
                    .flatten()
                    .zip(self.depth.iter().flatten())
                    .filter(|(a, b)| a != b)
                    .count();
            }
        }
    }

    fn fan_depths(&self, f: usize) -> Vec<f64> {
        self.fans[f]
            .corners
            .iter()
            .map(|(c, k)| self.depth[*c as usize][*k as usize])
            .collect()
    }

    fn set_fan_depths(&mut self, f: usize, depths: &[f64]) -> bool {
        let mut changed = false;
        for (i, d) in depths.iter().enumerate() {
            let (c, k) = self.fans[f].corners[i];
            let slot = &mut self.depth[c as usize][k as usize];
            changed |= *slot != *d;
            *slot = *d;
        }
        changed
    }

    /// Makes nearly equal depths equal.
    fn cluster_levels(&mut self, f: usize) {
        let depths = self.fan_depths(f);
        let mut order: Vec<usize> = (0..depths.len()).collect();
        order.sort_by(|a, b| depths[*a].total_cmp(&depths[*b]));
        let mut result = depths.clone();
        for run in order.chunk_by(|a, b| depths[*b] - depths[*a] < LEVEL_MM) {
            let mean = run.iter().map(|i| depths[*i]).sum::<f64>() / run.len() as f64;
            run.iter().for_each(|i| result[*i] = mean);
        }
        self.set_fan_depths(f, &result);
    }

    /// Lowers depths so that, going round from the deepest (outside counts as deepest), they fall to one valley and rise again.
    fn fill_pits(&mut self, f: usize) -> bool {
        let mut depths = self.fan_depths(f);
        let n = depths.len();
        let by_depth = |a: &usize, b: &usize| depths[*a].total_cmp(&depths[*b]);
        let start = if self.fans[f].closed {
            (0..n).max_by(by_depth).unwrap_or(0)
        } else {
            0
        };
        let limit = if self.fans[f].closed {
            depths[start]
        } else {
            f64::INFINITY
        };
        depths.rotate_left(start);
        let valley = (0..n)
            .min_by(|a, b| depths[*a].total_cmp(&depths[*b]))
            .unwrap_or(0);
        let mut run = limit;
        for d in &mut depths[..valley] {
            run = run.min(*d);
            *d = run;
        }
        run = limit;
        for d in depths[valley..].iter_mut().rev() {
            run = run.min(*d);
            *d = run;
        }
        depths.rotate_right(start);
        self.set_fan_depths(f, &depths)
    }

    /// Joins two sheets that swap order along a side at the end where they are nearer.
    fn uncross(&mut self, c: usize) -> bool {
        let mut changed = false;
        for k in 0..3 {
            let Some(n) = self.neighbours[c][k].filter(|n| *n as usize > c) else {
                continue;
            };
            let n = n as usize;
            let [u, v] = [self.points[c][k], self.points[c][(k + 1) % 3]];
            let at = |p: u32| {
                self.points[n]
                    .iter()
                    .position(|x| *x == p)
                    .expect("neighbours share both points of a side")
            };
            let ends = [(k, at(u)), ((k + 1) % 3, at(v))];
            let gaps = ends.map(|(i, j)| self.depth[c][i] - self.depth[n][j]);
            if gaps[0] * gaps[1] < 0.0 {
                let (i, j) = if gaps[0].abs() < gaps[1].abs() {
                    ends[0]
                } else {
                    ends[1]
                };
                let near = self.depth[c][i].min(self.depth[n][j]);
                self.depth[c][i] = near;
                self.depth[n][j] = near;
                changed = true;
            }
        }
        changed
    }

    /// Moves the edge behind nearer supports outwards, as far as no cell turns over.
    fn lap(&mut self, hidden: &impl Fn(u32, usize) -> bool, lap_mm: f64) {
        let mut outwards: BTreeMap<u32, DVec2> = BTreeMap::new();
        for c in 0..self.cells.len() {
            for k in
                (0..3).filter(|k| self.neighbours[c][*k].is_none() && hidden(self.cells[c], *k))
            {
                let ends = [self.fan_of[c][k], self.fan_of[c][(k + 1) % 3]];
                let [u, v] = ends.map(|f| self.fans[f as usize].q);
                // Longer sides weigh more, so that kinks too small to see do not turn the direction.
                ends.iter()
                    .for_each(|f| *outwards.entry(*f).or_default() -= (v - u).perp());
            }
        }
        let mut homes: BTreeMap<u32, DVec2> = BTreeMap::new();
        for (f, direction) in outwards {
            let home = self.fans[f as usize].q;
            if self.shift(f as usize, direction, lap_mm) {
                homes.insert(f, home);
            }
        }
        self.send_home(homes);
    }

    /// Undoes moves until the region overlaps itself nowhere: at the latest when all are undone.
    fn send_home(&mut self, mut homes: BTreeMap<u32, DVec2>) {
        while !homes.is_empty() {
            let mut back = self.overlapping_fans(&homes);
            back.retain(|f| homes.contains_key(f));
            if back.is_empty() {
                return;
            }
            for f in back {
                if let Some(home) = homes.remove(&f) {
                    self.fans[f as usize].q = home;
                }
            }
        }
    }

    /// Fans of cells turned over, of sides that cross and of corners wound past a full circle, among those near moved ones.
    fn overlapping_fans(&self, moved: &BTreeMap<u32, DVec2>) -> BTreeSet<u32> {
        let q = |f: u32| self.fans[f as usize].q;
        let mut bad = BTreeSet::new();
        for fans in &self.fan_of {
            if fans.iter().any(|f| moved.contains_key(f))
                && orient(q(fans[0]), q(fans[1]), q(fans[2])) <= 0.0
            {
                bad.extend(fans);
            }
        }
        for (f, fan) in self.fans.iter().enumerate() {
            let around = || {
                fan.corners
                    .iter()
                    .flat_map(|(c, _)| self.fan_of[*c as usize])
            };
            if !fan.closed
                && around().any(|f| moved.contains_key(&f))
                && self.winding(f) > FULL_TURN
            {
                bad.extend(around());
            }
        }
        let border = self.border();
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

    /// The sides without a neighbour, as pairs of fans.
    fn border(&self) -> Vec<[u32; 2]> {
        let sides = (0..self.cells.len()).flat_map(|c| (0..3).map(move |k| (c, k)));
        sides
            .filter(|(c, k)| self.neighbours[*c][*k].is_none())
            .map(|(c, k)| [self.fan_of[c][k], self.fan_of[c][(k + 1) % 3]])
            .collect()
    }

    /// Sum of a fan's corner angles, radians.
    fn winding(&self, f: usize) -> f64 {
        let q = |f: u32| self.fans[f as usize].q;
        let angle = |&(c, k): &Corner| {
            let fans = self.fan_of[c as usize];
            let [a, b] = [1, 2].map(|j| q(fans[(k as usize + j) % 3]) - self.fans[f].q);
            a.angle_to(b).abs()
        };
        self.fans[f].corners.iter().map(angle).sum()
    }

    /// Moves a fan's ray `by` millimetres in the image, or half or a quarter of it, if no cell turns over.
    fn shift(&mut self, f: usize, direction: DVec2, by: f64) -> bool {
        let home = self.fans[f].q;
        let corners = &self.fans[f].corners;
        let (c, k) = corners[0];
        let length = by / self.plane.scale(self.depth[c as usize][k as usize]);
        for share in [1.0, 0.5, 0.25] {
            let moved = home + direction.normalize_or_zero() * length * share;
            let upright = |&(c, k): &Corner| {
                let [a, b] = [1, 2]
                    .map(|j| self.fans[self.fan_of[c as usize][((k + j) % 3) as usize] as usize].q);
                orient(moved, a, b) > 0.0
            };
            if moved != home && corners.iter().all(upright) {
                self.fans[f].q = moved;
                return true;
            }
        }
        false
    }

    fn solid(&self, map: &ViewMap, back: impl Fn(u32, DVec2) -> f64) -> TriMesh {
        let mut mesh = TriMesh::default();
        let columns: Vec<Column> = (0..self.fans.len())
            .map(|f| self.column(map, f, &back, &mut mesh))
            .collect();
        let column = |c: usize, k: usize| &columns[self.fan_of[c][k] as usize];
        for c in 0..self.cells.len() {
            mesh.faces
                .push([0, 1, 2].map(|k| column(c, k).at(self.depth[c][k])));
            mesh.faces.push([0, 2, 1].map(|k| column(c, k).back));
            for k in 0..3 {
                let (u, v) = (column(c, k), column(c, (k + 1) % 3));
                let (du, dv) = (self.depth[c][k], self.depth[c][(k + 1) % 3]);
                match self.neighbours[c][k] {
                    None => wall(&mut mesh.faces, &v.down(dv), &u.down(du)),
                    Some(n) if n as usize > c => {
                        let at = |f: u32| {
                            self.fan_of[n as usize]
                                .iter()
                                .position(|x| *x == f)
                                .expect("neighbours share both fans of a side")
                        };
                        let (eu, ev) = (
                            self.depth[n as usize][at(self.fan_of[c][k])],
                            self.depth[n as usize][at(self.fan_of[c][(k + 1) % 3])],
                        );
                        wall(&mut mesh.faces, &v.between(dv, ev), &u.between(du, eu));
                    }
                    Some(_) => {}
                }
            }
        }
        mesh
    }

    /// The middle one of what the cells around a point say: where two facets of a support meet, a thin cell may carry the wrong one.
    fn back_at(&self, f: usize, q: DVec2, back: &impl Fn(u32, DVec2) -> f64) -> f64 {
        let corners = self.fans[f].corners.iter();
        let mut depths: Vec<f64> = corners
            .map(|(c, _)| back(self.cells[*c as usize], q))
            .collect();
        depths.sort_by(f64::total_cmp);
        depths[depths.len() / 2]
    }

    /// Makes the vertices on one ray.
    fn column(
        &self,
        map: &ViewMap,
        f: usize,
        back: &impl Fn(u32, DVec2) -> f64,
        mesh: &mut TriMesh,
    ) -> Column {
        let q = self.fans[f].q;
        let mut levels = self.fan_depths(f);
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let mut vertex = |z: f64| {
            mesh.vertices.push(map.plane.point(q, z));
            mesh.vertices.len() as u32 - 1
        };
        let back = vertex(self.back_at(f, q, back));
        Column {
            levels: levels.into_iter().map(|z| (z, vertex(z))).collect(),
            back,
        }
    }
}

/// The vertices on one ray: levels from near to far, then the back.
struct Column {
    levels: Vec<(f64, u32)>,
    back: u32,
}

impl Column {
    fn at(&self, depth: f64) -> u32 {
        self.levels
            .iter()
            .find(|l| l.0 == depth)
            .expect("every depth of a fan is a level of its column")
            .1
    }

    /// From a depth to the back.
    fn down(&self, depth: f64) -> Vec<u32> {
        self.levels
            .iter()
            .filter(|l| l.0 >= depth)
            .map(|l| l.1)
            .chain([self.back])
            .collect()
    }

    /// From one depth to another, with the levels between.
    fn between(&self, from: f64, to: f64) -> Vec<u32> {
        let (lo, hi) = (from.min(to), from.max(to));
        let mut chain: Vec<u32> = self
            .levels
            .iter()
            .filter(|l| (lo..=hi).contains(&l.0))
            .map(|l| l.1)
            .collect();
        if from > to {
            chain.reverse();
        }
        chain
    }
}

/// Triangulates the wall between two chains that run from the cell's own depths to its neighbour's; `v` ends the cell's side.
fn wall(faces: &mut Vec<[u32; 3]>, v: &[u32], u: &[u32]) {
    let (mut i, mut j) = (0, 0);
    while i + 1 < u.len() || j + 1 < v.len() {
        // Advance the chain that lags behind, so that triangles stay as stout as the levels allow.
        let advance_u =
            j + 1 >= v.len() || (i + 1 < u.len() && (i + 1) * v.len() <= (j + 1) * u.len());
        if advance_u {
            faces.push([v[j], u[i], u[i + 1]]);
            i += 1;
        } else {
            faces.push([v[j], u[i], v[j + 1]]);
            j += 1;
        }
    }
}
