//! The tear functional and its descent by fusion moves.

use super::min_cut::BinaryEnergy;
use super::patches::{Patch, PatchId, Patches, Seam, mixed};
use crate::index::indices;
use crate::mesh::DisjointSets;
use rayon::prelude::*;

/// Log depths (of an eye at infinity: `focal` times these) nearer than this are the same: a millionth of a millimetre.
const SAME: f64 = 1e-8;
/// Levels of constant depth tried within one layer's width. At 4 the lines of the reference forest are 5 to 8 % longer, at 24 they
/// are 1 to 5 % shorter for four times the work.
const LEVELS: f64 = 12.0;
/// Sweeps over all levels at most: six are the most so far.
const SWEEPS: usize = 12;
/// A sweep that gains less than this share is the last. At 0 one more is needed to see that nothing changes, at 1e-2 some views end a
/// fiftieth higher; at 1e-3 the most that was lost is 0.6 %.
const LITTLE: f64 = 1e-3;
/// A level may lie outside what a patch allows by this share of the layer; corners are then drawn in and the patch tilts.
const DRAWN_IN: f64 = 0.15;
/// A move must gain at least this, square degrees times square millimetres: nothing anybody could see.
const GAIN: f64 = 1e-3;
/// What overstepping a bound by a whole layer costs, times the seen area, in square degrees: more than any tilt.
const OVERSTEP: f64 = 1e5;
/// What a millimetre of contour in the wrong depth order costs, in the same units.
const DISORDER: f64 = 1e5;

/// What a millimetre of tear costs whose front piece is a knife, in the same units.
const KNIFE: f64 = 1e5;

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

indices! {
    /// A patch of one support, counted from its first.
    OwnPatch
    /// A seam between patches of one support.
    OwnSeam
}

/// What the corners of patches might become.
type LevelProposal = (OwnPatch, [f64; 3]);

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
    /// Seams of every patch.
    incident: Vec<Vec<OwnSeam>>,
}

impl<'a> Functional<'a> {
    /// `range` must hold all patches of a support: seams lead nowhere else.
    pub(crate) fn new(patches: &'a Patches, prices: Prices, range: std::ops::Range<usize>) -> Self {
        let first = |at: usize| patches.seams.partition_point(|s| s.patches[0].at() < at);
        let seams = &patches.seams[first(range.start)..first(range.end)];
        let mut incident = vec![Vec::new(); range.len()];
        for (n, s) in OwnSeam::all(seams.len()).zip(seams) {
            for p in s.patches {
                incident[p.at() - range.start].push(n);
            }
        }
        Self {
            patches,
            prices,
            range,
            seams,
            incident,
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
            sets.join(a.0, b.0);
        }
        sets.numbers().1
    }

    /// Patches that are `wanted`, by piece and neighbourhood.
    pub(crate) fn regions(&self, pieces: &[u32], wanted: &[bool]) -> Vec<Vec<OwnPatch>> {
        let mut sets = DisjointSets::new(self.range.len());
        for s in self.seams {
            let [a, b] = self.local(s);
            if wanted[a] && wanted[b] && pieces[a] == pieces[b] {
                sets.join(a.0, b.0);
            }
        }
        let mut members: Vec<(u32, OwnPatch)> = OwnPatch::all(wanted.len())
            .filter(|i| wanted[*i])
            .map(|i| (sets.root(i.0), i))
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
        region: &[OwnPatch],
        but: &[bool],
    ) -> bool {
        let own = field[region[0]];
        let mut levels: Vec<f64> = region
            .iter()
            .flat_map(|i| self.incident(*i))
            .map(|n| &self.seams[*n])
            .filter(|s| s.hangs_together())
            .flat_map(|s| self.local(s))
            .filter(|j| !but[*j])
            .map(|j| field[j].iter().sum::<f64>() / 3.0)
            .filter(|y| (y - own[0]).abs() > self.same())
            .collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup_by(|a, b| (*a - *b).abs() <= self.same());
        let old: Vec<[f64; 3]> = region.iter().map(|i| field[*i]).collect();
        let set = |field: &mut PatchDepths, level: f64| {
            for i in region {
                field[*i] = self.patch(*i).drawn_in(level);
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
            None => region.iter().zip(old).for_each(|(i, y)| field[*i] = y),
        }
        best.is_some()
    }

    fn patch(&self, i: OwnPatch) -> &Patch {
        &self.patches.patches[self.range.start + i.at()]
    }

    /// Tilt and overstepped bounds of one patch.
    fn unary(&self, i: OwnPatch, y: &[f64; 3]) -> f64 {
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
            let height = step.abs();
            if height <= self.same() {
                0.0
            } else if height > highest + self.same() {
                f64::INFINITY
            } else {
                let in_front = usize::from(step > 0.0);
                let knife = if height > s.free[in_front] {
                    KNIFE
                } else {
                    0.0
                };
                off * (self.prices.length + self.prices.height * height / self.patches.width)
                    + knife
            }
        };
        s.length_mm * (end(0) + end(1)) / 2.0
    }

    /// The whole value.
    fn value(&self, field: &[[f64; 3]]) -> f64 {
        let unary: f64 = self.own_patches().map(|i| self.unary(i, &field[i])).sum();
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

    /// A patch of the support among its own.
    pub(crate) fn own(&self, p: PatchId) -> OwnPatch {
        OwnPatch::new(p.at() - self.range.start)
    }

    fn own_patches(&self) -> impl Iterator<Item = OwnPatch> + use<> {
        OwnPatch::all(self.range.len())
    }

    fn local(&self, s: &Seam) -> [OwnPatch; 2] {
        s.patches.map(|p| self.own(p))
    }

    fn incident(&self, i: OwnPatch) -> &[OwnSeam] {
        &self.incident[i]
    }

    /// The part of a proposal that lowers the functional most, over all choices of its patches at once. `variable` is room for
    /// one number a patch, all `None`, and is left so.
    fn best_part(
        &self,
        field: &PatchDepths,
        proposal: &[LevelProposal],
        variable: &mut [Option<usize>],
    ) -> Vec<LevelProposal> {
        let differs =
            |(i, y): &&LevelProposal| (0..3).any(|k| (y[k] - field[*i][k]).abs() > self.same());
        let members: Vec<LevelProposal> = proposal.iter().filter(differs).copied().collect();
        for (v, (i, _)) in members.iter().enumerate() {
            variable[*i] = Some(v);
        }
        let mut energy = BinaryEnergy::new(members.len());
        for (v, (i, y)) in members.iter().enumerate() {
            energy.unary(v, self.unary(*i, &field[*i]), self.unary(*i, y));
            for n in self.incident(*i) {
                self.add_seam(&mut energy, *n, field, &members, variable, v);
            }
        }
        members.iter().for_each(|(i, _)| variable[*i] = None);
        let taken = energy.minimise();
        let chosen = members.into_iter().zip(taken);
        chosen.filter_map(|(m, take)| take.then_some(m)).collect()
    }

    /// Takes a move if it gains; gives the patches that changed.
    fn take(&self, field: &mut PatchDepths, mut wanted: Vec<LevelProposal>) -> Vec<OwnPatch> {
        let ids: Vec<OwnPatch> = wanted.iter().map(|c| c.0).collect();
        let before = self.share(&ids, field);
        let swap = |field: &mut PatchDepths, wanted: &mut [LevelProposal]| {
            wanted
                .iter_mut()
                .for_each(|(i, y)| std::mem::swap(&mut field[*i], y));
        };
        swap(field, &mut wanted);
        // Ties that rounding decides would go to and fro for ever.
        if self.share(&ids, field) < before - GAIN {
            ids
        } else {
            swap(field, &mut wanted);
            Vec::new()
        }
    }

    /// What some patches and all their seams cost.
    fn share(&self, members: &[OwnPatch], field: &PatchDepths) -> f64 {
        let mut seams: Vec<OwnSeam> = members
            .iter()
            .flat_map(|i| self.incident(*i))
            .copied()
            .collect();
        seams.sort_unstable();
        seams.dedup();
        let own: f64 = members.iter().map(|i| self.unary(*i, &field[*i])).sum();
        let between: f64 = seams
            .iter()
            .map(|n| {
                let s = &self.seams[*n];
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
        n: OwnSeam,
        field: &PatchDepths,
        members: &[LevelProposal],
        variable: &[Option<usize>],
        v: usize,
    ) {
        let s = &self.seams[n];
        let [a, b] = self.local(s);
        let (old_a, old_b) = (&field[a], &field[b]);
        let old = || self.seam(s, old_a, old_b);
        match [variable[a], variable[b]] {
            [None, _] => energy.unary(v, old(), self.seam(s, old_a, &members[v].1)),
            [_, None] => energy.unary(v, old(), self.seam(s, &members[v].1, old_b)),
            [Some(i), Some(j)] if v == i.max(j) => {
                let (new_a, new_b) = (&members[i].1, &members[j].1);
                let cost = [
                    old(),
                    self.seam(s, old_a, new_b),
                    self.seam(s, new_a, old_b),
                    self.seam(s, new_a, new_b),
                ];
                energy.pair(i, j, cost);
            }
            [Some(_), Some(_)] => {}
        }
    }

    /// Every level with the patches it may be proposed to: a constant, drawn in to the layer at corners.
    fn levels(&self) -> Vec<Vec<LevelProposal>> {
        let margin = DRAWN_IN * self.patches.width;
        let spacing = self.patches.width / LEVELS;
        let reach = |i: OwnPatch| {
            let (lo, hi) = self.patch(i).even;
            (lo.min(hi) - margin, lo.max(hi) + margin)
        };
        let lo = self
            .own_patches()
            .map(|i| reach(i).0)
            .fold(f64::INFINITY, f64::min);
        let hi = self
            .own_patches()
            .map(|i| reach(i).1)
            .fold(f64::NEG_INFINITY, f64::max);
        let count = ((hi - lo) / spacing).clamp(0.0, 5000.0) as usize + 1;
        let mut levels = vec![Vec::new(); count];
        for i in self.own_patches() {
            let (first, last) = reach(i);
            let p = self.patch(i);
            let first = ((first - lo) / spacing).ceil().max(0.0) as usize;
            let last = (((last - lo) / spacing).floor() as usize).min(count - 1);
            for (k, members) in levels.iter_mut().enumerate().take(last + 1).skip(first) {
                let level = lo + spacing * k as f64;
                let even = p.even.0 <= level && level <= p.even.1;
                let y = if even { [level; 3] } else { p.drawn_in(level) };
                members.push((i, y));
            }
        }
        levels
    }

    /// Sweeps all levels over the field until little is gained. A level is tried again only if something changed within its
    /// reach since it was last tried. Two levels so far apart that no patch has both are tried side by side, and the farther one's move is
    /// dropped if it gains nothing any more once the nearer one's is taken. With more than two at once depths grow from more places than
    /// one, and an agamograph ended at 1.7 degrees instead of 1.0.
    pub(crate) fn descend(&self, field: &mut PatchDepths) {
        let levels = self.levels();
        let apart = self
            .levels_of_one_patch(&levels)
            .max(levels.len().div_ceil(2));
        // The move at which each patch last changed, and at which each level was last tried.
        let mut changed_at = vec![0u32; self.range.len()];
        let mut tried_at = vec![0u32; levels.len()];
        let (mut now, mut value) = (1, f64::INFINITY);
        for sweep in 0..SWEEPS {
            for first in 0..apart.min(levels.len()) {
                let near = |i: OwnPatch, tried: u32| {
                    let seams = self.incident(i).iter();
                    let mut patches = seams.flat_map(|n| self.local(&self.seams[*n]));
                    patches.any(|j| changed_at[j] > tried)
                };
                let open =
                    |k: &usize| sweep == 0 || levels[*k].iter().any(|m| near(m.0, tried_at[*k]));
                let tried: Vec<usize> = (first..levels.len()).step_by(apart).filter(open).collect();
                let room = || vec![None; self.range.len()];
                let best = |variable: &mut Vec<Option<usize>>, k: &usize| {
                    self.best_part(field, &levels[*k], variable)
                };
                let moves: Vec<Vec<LevelProposal>> =
                    tried.par_iter().map_init(room, best).collect();
                now += 1;
                tried.iter().for_each(|k| tried_at[*k] = now);
                for wanted in moves {
                    now += 1;
                    let changed = self.take(field, wanted);
                    changed.iter().for_each(|i| changed_at[*i] = now);
                }
            }
            let before = std::mem::replace(&mut value, self.value(field));
            if before - value <= LITTLE * value {
                return;
            }
        }
    }

    /// At how many levels a patch is at most.
    fn levels_of_one_patch(&self, levels: &[Vec<LevelProposal>]) -> usize {
        let mut count = vec![0; self.range.len()];
        let members = levels.iter().flatten();
        members.for_each(|(i, _)| count[*i] += 1);
        count.into_iter().max().unwrap_or(0).max(1)
    }
}

#[cfg(test)]
mod tests;
