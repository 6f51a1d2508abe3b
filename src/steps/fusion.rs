//! The tear functional and its descent by fusion moves.

use super::min_cut::BinaryEnergy;
use super::patches::{Patch, Patches, Seam, mixed};
use crate::mesh::DisjointSets;

/// Log depths (of an eye at infinity: `focal` times these) nearer than this are the same: a millionth of a millimetre.
const SAME: f64 = 1e-8;
/// Levels of constant depth tried within one layer's width. At 4 the lines of the reference forest are 5 to 8 % longer, at 24 they
/// are 1 to 5 % shorter for four times the work.
const LEVELS: f64 = 12.0;
/// Sweeps over all levels at most. Nearly everything happens in the first two; after the fourth nothing was seen to change.
const SWEEPS: usize = 8;
/// A level may lie outside what a patch allows by this share of the layer; corners are then drawn in and the patch tilts.
const DRAWN_IN: f64 = 0.15;
/// A move must gain at least this, square degrees times square millimetres: nothing anybody could see.
const GAIN: f64 = 1e-3;
/// What overstepping a bound by a whole layer costs, times the seen area, in square degrees: more than any tilt.
const OVERSTEP: f64 = 1e5;
/// What a millimetre of contour in the wrong depth order costs, in the same units.
const DISORDER: f64 = 1e5;

/// Prices of the functional; see the module `steps`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prices {
    /// Square degrees of a tilt by 1 radian (first order).
    pub tilt: f64,
    /// A millimetre of tear line, in square degrees times square millimetres.
    pub length: f64,
    /// A millimetre of tear line with a step as high as the layer, on top.
    pub height: f64,
    /// Share of the price that is let off along the sharpest creases, 0 to 1.
    pub crease: f64,
    /// Whether sheets keep their depth order along contours.
    pub ordered: bool,
}

/// Log relief depth over the model's at every corner of every patch.
pub(crate) type PatchDepths = Vec<[f64; 3]>;

/// Where descents begin: the model's depths (at the corners of a patch) pressed into the layer from front to back. Continuous,
/// within all bounds, and sheets stand apart in their order: from the layer's middle, where they would touch, neither can move
/// alone, and the sweeps end up to a quarter higher where there are contours, at double where steps are limited.
pub(crate) fn pressed(patches: &[Patch], depth: impl Fn(&Patch) -> [f64; 3]) -> PatchDepths {
    let all = || patches.iter().flat_map(&depth);
    let nearest = all().fold(f64::INFINITY, f64::min);
    let range = all().fold(0.0, f64::max) - nearest;
    let at = |p: &Patch| {
        let z = depth(p);
        [0, 1, 2].map(|k| {
            let (lo, hi) = p.room[k];
            let share = if range > 0.0 {
                (z[k] - nearest) / range
            } else {
                0.5
            };
            lo + share * (hi - lo)
        })
    };
    patches.iter().map(at).collect()
}

/// One support's share of the functional.
pub(crate) struct Functional<'a> {
    patches: &'a Patches,
    prices: Prices,
    /// Patches of the support.
    range: std::ops::Range<usize>,
    /// All seams between them.
    seams: &'a [Seam],
    /// Seams of patch `i`: `incident[starts[i]..starts[i + 1]]`.
    incident: Vec<u32>,
    starts: Vec<u32>,
}

impl<'a> Functional<'a> {
    /// `range` must hold all patches of a support: seams lead nowhere else.
    pub(crate) fn new(patches: &'a Patches, prices: Prices, range: std::ops::Range<usize>) -> Self {
        let first = |at: usize| patches.seams.partition_point(|s| s.patches[0].at() < at);
        let seams = &patches.seams[first(range.start)..first(range.end)];
        let local = |s: &Seam| s.patches.map(|p| p.at() - range.start);
        let mut starts = vec![0u32; range.len() + 1];
        seams
            .iter()
            .flat_map(local)
            .for_each(|p| starts[p + 1] += 1);
        (0..range.len()).for_each(|i| starts[i + 1] += starts[i]);
        let mut next = starts.clone();
        let mut incident = vec![0; 2 * seams.len()];
        for (n, s) in seams.iter().enumerate() {
            for p in local(s) {
                incident[next[p] as usize] = n as u32;
                next[p] += 1;
            }
        }
        Self {
            patches,
            prices,
            range,
            seams,
            incident,
            starts,
        }
    }

    /// Log depths nearer than this are the same.
    fn same(&self) -> f64 {
        SAME / self.patches.focal
    }

    pub(crate) fn patches(&self) -> &Patches {
        self.patches
    }

    /// The support's patches among all.
    pub(crate) fn range(&self) -> std::ops::Range<usize> {
        self.range.clone()
    }

    /// Whether the patches of a seam hang together along all of it.
    fn closed(&self, s: &Seam, field: &PatchDepths) -> bool {
        let [a, b] = self.local(s);
        s.hangs_together() && (0..2).all(|k| s.jump(k, &field[a], &field[b]).abs() <= self.same())
    }

    /// The piece of every patch: those that hang together.
    pub(crate) fn pieces(&self, field: &PatchDepths) -> Vec<u32> {
        let mut sets = DisjointSets::new(self.range.len());
        for s in self.seams.iter().filter(|s| self.closed(s, field)) {
            let [a, b] = self.local(s);
            sets.join(a as u32, b as u32);
        }
        sets.numbers().1
    }

    /// Patches that are `wanted`, by piece and neighbourhood.
    pub(crate) fn regions(&self, pieces: &[u32], wanted: &[bool]) -> Vec<Vec<u32>> {
        let mut sets = DisjointSets::new(self.range.len());
        for s in self.seams {
            let [a, b] = self.local(s);
            if wanted[a] && wanted[b] && pieces[a] == pieces[b] {
                sets.join(a as u32, b as u32);
            }
        }
        let mut members: Vec<(u32, u32)> = (0..wanted.len() as u32)
            .filter(|i| wanted[*i as usize])
            .map(|i| (sets.root(i), i))
            .collect();
        members.sort_unstable();
        members
            .chunk_by(|a, b| a.0 == b.0)
            .map(|c| c.iter().map(|m| m.1).collect())
            .collect()
    }

    /// Gives a region the level of the neighbour outside `but` that makes it cheapest, drawn in to the layer; whether it has one.
    pub(crate) fn join_cheapest(
        &self,
        field: &mut PatchDepths,
        region: &[u32],
        but: &[bool],
    ) -> bool {
        let own = field[region[0] as usize];
        let mut levels: Vec<f64> = region
            .iter()
            .flat_map(|i| self.incident(*i as usize))
            .map(|n| &self.seams[*n as usize])
            .filter(|s| s.hangs_together())
            .flat_map(|s| self.local(s))
            .filter(|j| !but[*j])
            .map(|j| field[j].iter().sum::<f64>() / 3.0)
            .filter(|y| (y - own[0]).abs() > self.same())
            .collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup_by(|a, b| (*a - *b).abs() <= self.same());
        let old: Vec<[f64; 3]> = region.iter().map(|i| field[*i as usize]).collect();
        let set = |field: &mut PatchDepths, level: f64| {
            for i in region {
                field[*i as usize] = self.patch(*i as usize).drawn_in(level);
            }
        };
        let mut best: Option<(f64, f64)> = None;
        for level in levels {
            set(field, level);
            let cost = self.share(region, field);
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, level));
            }
        }
        match best {
            Some((_, level)) => set(field, level),
            None => region
                .iter()
                .zip(old)
                .for_each(|(i, y)| field[*i as usize] = y),
        }
        best.is_some()
    }

    fn patch(&self, i: usize) -> &Patch {
        &self.patches.patches[self.range.start + i]
    }

    /// Tilt and overstepped bounds of one patch.
    fn unary(&self, i: usize, y: &[f64; 3]) -> f64 {
        let p = self.patch(i);
        let (lo, hi) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        if p.even.0 <= lo && hi <= p.even.1 && hi - lo <= self.same() {
            return 0.0;
        }
        let tilt: f64 = (0..3)
            .map(|k| p.tilt[k] * (y[(k + 1) % 3] - y[(k + 2) % 3]).powi(2))
            .sum();
        let over = p
            .points
            .iter()
            .map(|b| {
                let v = mixed(&b.weights, y);
                (v - b.upper).max(b.lower - v).max(0.0)
            })
            .fold(0.0, f64::max);
        let over = if over > self.same() {
            over / self.patches.width
        } else {
            0.0
        };
        self.prices.tilt * tilt + OVERSTEP * p.seen_mm2 * over
    }

    /// The cost of a seam between given corner depths.
    fn seam(&self, s: &Seam, a: &[f64; 3], b: &[f64; 3]) -> f64 {
        let off = 1.0 - self.prices.crease * (s.crease / std::f64::consts::FRAC_PI_2).min(1.0);
        let highest = s.highest;
        let end = |k: usize| {
            let (step, gap) = (s.jump(k, a, b), s.gaps[k]);
            if gap != 0.0 {
                let wrong = self.prices.ordered && (step - gap) * gap.signum() > self.same();
                return if wrong { DISORDER } else { 0.0 };
            }
            let step = step.abs();
            if step <= self.same() {
                0.0
            } else if step > highest + self.same() {
                f64::INFINITY
            } else {
                off * (self.prices.length + self.prices.height * step / self.patches.width)
            }
        };
        s.length_mm * (end(0) + end(1)) / 2.0
    }

    /// The whole value.
    #[cfg(test)]
    fn value(&self, field: &[[f64; 3]]) -> f64 {
        let unary: f64 = (0..self.range.len())
            .map(|i| self.unary(i, &field[i]))
            .sum();
        let seams: f64 = self
            .seams
            .iter()
            .map(|s| {
                let [a, b] = self.local(s);
                self.seam(s, &field[a], &field[b])
            })
            .sum();
        unary + seams
    }

    fn local(&self, s: &Seam) -> [usize; 2] {
        s.patches.map(|p| p.at() - self.range.start)
    }

    fn incident(&self, i: usize) -> &[u32] {
        &self.incident[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// Takes the proposal where that lowers the functional most, over all choices of its patches at once. Gives the patches
    /// that changed. `variable` is room for one number a patch, all `u32::MAX`, and is left so.
    fn fuse(
        &self,
        field: &mut PatchDepths,
        proposal: &[(u32, [f64; 3])],
        variable: &mut [u32],
    ) -> Vec<u32> {
        let differs = |(i, y): &&(u32, [f64; 3])| {
            (0..3).any(|k| (y[k] - field[*i as usize][k]).abs() > self.same())
        };
        let members: Vec<(u32, [f64; 3])> = proposal.iter().filter(differs).copied().collect();
        for (v, (i, _)) in members.iter().enumerate() {
            variable[*i as usize] = v as u32;
        }
        let mut energy = BinaryEnergy::new(members.len());
        for (v, (i, y)) in members.iter().enumerate() {
            let i = *i as usize;
            energy.unary(v, self.unary(i, &field[i]), self.unary(i, y));
            for n in self.incident(i) {
                self.add_seam(&mut energy, *n as usize, field, &members, variable, v);
            }
        }
        members
            .iter()
            .for_each(|(i, _)| variable[*i as usize] = u32::MAX);
        let taken = energy.minimise();
        let mut changed: Vec<(u32, [f64; 3])> = members
            .into_iter()
            .zip(taken)
            .filter_map(|(m, take)| take.then_some(m))
            .collect();
        let ids: Vec<u32> = changed.iter().map(|c| c.0).collect();
        let before = self.share(&ids, field);
        let swap = |field: &mut PatchDepths, changed: &mut [(u32, [f64; 3])]| {
            changed
                .iter_mut()
                .for_each(|(i, y)| std::mem::swap(&mut field[*i as usize], y));
        };
        swap(field, &mut changed);
        // Ties that rounding decides would go to and fro for ever.
        if self.share(&ids, field) < before - GAIN {
            ids
        } else {
            swap(field, &mut changed);
            Vec::new()
        }
    }

    /// What some patches and all their seams cost.
    fn share(&self, members: &[u32], field: &PatchDepths) -> f64 {
        let mut seams: Vec<u32> = members
            .iter()
            .flat_map(|i| self.incident(*i as usize))
            .copied()
            .collect();
        seams.sort_unstable();
        seams.dedup();
        let own: f64 = members
            .iter()
            .map(|i| self.unary(*i as usize, &field[*i as usize]))
            .sum();
        let between: f64 = seams
            .iter()
            .map(|n| {
                let s = &self.seams[*n as usize];
                let [a, b] = self.local(s);
                self.seam(s, &field[a], &field[b])
            })
            .sum();
        own + between
    }

    /// Adds a seam of variable `v`; one between two variables when its second comes.
    fn add_seam(
        &self,
        energy: &mut BinaryEnergy,
        n: usize,
        field: &PatchDepths,
        members: &[(u32, [f64; 3])],
        variable: &[u32],
        v: usize,
    ) {
        let s = &self.seams[n];
        let [a, b] = self.local(s);
        let [i, j] = [variable[a], variable[b]];
        let (old_a, old_b) = (&field[a], &field[b]);
        let old = self.seam(s, old_a, old_b);
        if i == u32::MAX {
            energy.unary(v, old, self.seam(s, old_a, &members[v].1));
        } else if j == u32::MAX {
            energy.unary(v, old, self.seam(s, &members[v].1, old_b));
        } else if v as u32 == i.max(j) {
            let (new_a, new_b) = (&members[i as usize].1, &members[j as usize].1);
            let cost = [
                old,
                self.seam(s, old_a, new_b),
                self.seam(s, new_a, old_b),
                self.seam(s, new_a, new_b),
            ];
            energy.pair(i as usize, j as usize, cost);
        }
    }

    /// Every level with the patches it may be proposed to: a constant, drawn in to the layer at corners.
    fn levels(&self) -> Vec<Vec<(u32, [f64; 3])>> {
        let margin = DRAWN_IN * self.patches.width;
        let spacing = self.patches.width / LEVELS;
        let reach = |i: usize| {
            let (lo, hi) = self.patch(i).even;
            (lo.min(hi) - margin, lo.max(hi) + margin)
        };
        let lo = (0..self.range.len())
            .map(|i| reach(i).0)
            .fold(f64::INFINITY, f64::min);
        let hi = (0..self.range.len())
            .map(|i| reach(i).1)
            .fold(f64::NEG_INFINITY, f64::max);
        let count = ((hi - lo) / spacing).clamp(0.0, 5000.0) as usize + 1;
        let mut levels = vec![Vec::new(); count];
        for i in 0..self.range.len() {
            let (first, last) = reach(i);
            let p = self.patch(i);
            let first = ((first - lo) / spacing).ceil().max(0.0) as usize;
            let last = (((last - lo) / spacing).floor() as usize).min(count - 1);
            for (k, members) in levels.iter_mut().enumerate().take(last + 1).skip(first) {
                let level = lo + spacing * k as f64;
                let even = p.even.0 <= level && level <= p.even.1;
                let y = if even { [level; 3] } else { p.drawn_in(level) };
                members.push((i as u32, y));
            }
        }
        levels
    }

    /// Sweeps all levels over the field until nothing changes. A level is tried again only if something changed within its
    /// reach since it was last tried.
    pub(crate) fn descend(&self, field: &mut PatchDepths) {
        let levels = self.levels();
        let mut variable = vec![u32::MAX; self.range.len()];
        // The move at which each patch last changed, and at which each level was last tried.
        let mut changed_at = vec![0u32; self.range.len()];
        let mut tried_at = vec![0u32; levels.len()];
        let mut now = 1;
        for sweep in 0..SWEEPS {
            let mut any = false;
            for (k, members) in levels.iter().enumerate() {
                let stale = |i: usize| changed_at[i] > tried_at[k];
                let near = |i: usize| {
                    self.incident(i)
                        .iter()
                        .flat_map(|n| self.local(&self.seams[*n as usize]))
                        .any(stale)
                };
                if sweep > 0 && !members.iter().any(|m| near(m.0 as usize)) {
                    continue;
                }
                now += 1;
                tried_at[k] = now;
                let changed = self.fuse(field, members, &mut variable);
                any |= !changed.is_empty();
                changed.iter().for_each(|i| changed_at[*i as usize] = now);
            }
            if !any {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests;
