//! What one eye meets: pillars in their order, overlap behind cuts, how fast cuts open.

use super::{Fault, Kind, Offsets, reach_of};
use crate::geom::parallax;
use crate::planner::brief::{Brief, Pillar};
use crate::planner::skyline::{Run, Shadow};
use crate::planner::subject::Subject;
use crate::steps::UNSEEN_RAD;

/// One eye and what stands before it.
pub struct OfView<'a> {
    pub subject: &'a Subject,
    pub view: usize,
    pub brief: &'a Brief,
    pub pillars: &'a [Pillar],
    pub shadows: &'a [Shadow],
}

impl OfView<'_> {
    /// Faults of what the eye meets.
    pub fn look(&self, runs: &[Run], faults: &mut Vec<Fault>) {
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

    /// See [`Survey::rates`](super::Survey::rates).
    pub fn rates(&self, runs: &[Run]) -> [f64; 2] {
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
    pub fn open(&self, rate: f64, tolerance_mm: f64) -> Option<Fault> {
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
