//! What one eye meets: pillars in their order, overlap behind cuts, how fast cuts open.

use super::fault::{Fault, FaultKind};
use super::offsets::{Offsets, reach_of};
use crate::geom::parallax;
use crate::horizon::{Run, Shadow};
use crate::planner::brief::{Brief, Pillar};
use crate::planner::skyline::Skyline;
use crate::planner::subject::Subject;
use crate::steps::UNSEEN_RAD;

/// One eye and what stands before it.
pub(crate) struct OfView<'a> {
    pub subject: &'a Subject,
    pub view: usize,
    pub brief: &'a Brief,
    pub pillars: &'a [Pillar],
    pub skyline: &'a Skyline,
}

impl OfView<'_> {
    /// Faults of what the eye meets.
    pub(crate) fn look(&self, faults: &mut Vec<Fault>) {
        let overlap = self.brief.care.overlap;
        for (k, run) in self.skyline.runs.iter().enumerate() {
            let Some(i) = run.obstacle else {
                let distance = (self.subject.middle.truncate() - self.subject.o).length();
                let mm = run.width() * distance + overlap;
                let place = (run, distance);
                self.note(faults, FaultKind::Uncovered, [None, None], mm, place);
                continue;
            };
            let distance = self.skyline.shadows[i].distance;
            let (width, place, own) = (run.width() * distance, (run, distance), [Some(i), None]);
            if self.pillars[i].owner != Some(self.view) {
                self.note(faults, FaultKind::Foreign, own, width + overlap, place);
                continue;
            }
            let mm = self.brief.care.narrowest - width;
            self.note(faults, FaultKind::Narrow, own, mm, place);
            let mm = self.beyond_ends(run, i);
            self.note(faults, FaultKind::Ends, own, mm, place);
            self.look_at_ends(k, i, faults);
            self.look_at_plates(k, i, faults);
        }
    }

    /// Faults where the run `k`, on the view's own pillar `i`, goes over to its neighbours or past the models' outline.
    fn look_at_ends(&self, k: usize, i: usize, faults: &mut Vec<Fault>) {
        let (run, shadow) = (&self.skyline.runs[k], &self.skyline.shadows[i]);
        let place = (run, shadow.distance);
        let [left, right] = self.neighbours(k);
        let behind_left = self.reach_on(left, run.from, |s, at| s.to - at);
        let behind_right = self.reach_on(right, run.to, |s, at| at - s.from);
        for (j, own, behind) in [
            (left, run.from - shadow.from, behind_left),
            (right, shadow.to - run.to, behind_right),
        ] {
            // One of the two reaches on behind the other. Cuts are met from both sides.
            let mm = self.brief.care.overlap - own.max(behind) * shadow.distance;
            let mm = if j.is_some() { mm / 2.0 } else { mm };
            self.note(faults, FaultKind::Loose, [Some(i), j], mm, place);
            let [thin, thick] = self.brief.care.fins;
            let width = own * shadow.distance;
            let mm = (width - thin).min(thick - width);
            let mm = if j.is_some() { mm } else { 0.0 };
            self.note(faults, FaultKind::Fin, [Some(i), j], mm, place);
        }
    }

    /// Faults where the models leave too thin a plate between an end of the run `k`, on the view's own pillar `i`, and a contour.
    fn look_at_plates(&self, k: usize, i: usize, faults: &mut Vec<Fault>) {
        let (run, plates) = (&self.skyline.runs[k], self.brief.care.plates);
        let offsets = Offsets::new(&self.brief.shapes[self.pillars[i].shape]);
        let distance = self.skyline.shadows[i].distance + offsets.near;
        let thinnest = plates.thinnest / distance;
        let contours = &self.subject.contours;
        let [left, right] = self.neighbours(k);
        for (next, end, strips) in [
            (left, run.from, contours.after(run.from, thinnest)),
            (right, run.to, contours.before(run.to, thinnest)),
        ] {
            let area = strips.height * distance * self.free_depth(i, end);
            if next.is_some() && area > plates.missed {
                let mm = (thinnest - strips.width) * distance;
                self.note(
                    faults,
                    FaultKind::Narrow,
                    [Some(i), next],
                    mm,
                    (run, distance),
                );
            }
        }
    }

    /// The pillars of the runs that the run `k` joins, at its first and its last bearing.
    fn neighbours(&self, k: usize) -> [Option<usize>; 2] {
        let runs = &self.skyline.runs;
        let left = k.checked_sub(1).map(|p| &runs[p]);
        let left = left.filter(|r| r.to == runs[k].from);
        let right = runs.get(k + 1).filter(|r| r.from == runs[k].to);
        [left, right].map(|r| r.and_then(|r| r.obstacle))
    }

    /// How much of the layer of pillar `i` lies before or behind its body at a bearing, millimetres: nothing holds a plate there.
    fn free_depth(&self, i: usize, bearing: f64) -> f64 {
        let (pillar, distance) = (&self.pillars[i], self.skyline.shadows[i].distance);
        let shape = &self.brief.shapes[pillar.shape];
        let offsets = Offsets::new(shape);
        let ray = self.subject.viewpoint().ray(bearing);
        let entry = shape.obstacle(pillar.at).entry(&ray);
        let before = entry.map_or(0.0, |e| (distance - e.distance).max(0.0));
        (-offsets.near - before).max(0.0) + (offsets.far - before).max(0.0)
    }

    /// How far the pillar on the other side of a cut reaches over to this one; at an outline, how far any of the view's own
    /// pillars that stand across it reaches beyond, by the negative of `over`.
    fn reach_on(&self, next: Option<usize>, at: f64, over: impl Fn(&Shadow, f64) -> f64) -> f64 {
        if let Some(j) = next {
            return over(&self.skyline.shadows[j], at);
        }
        let own = self
            .pillars
            .iter()
            .zip(&self.skyline.shadows)
            .filter(|(p, _)| p.owner == Some(self.view));
        let across = own.filter(|(_, s)| s.from <= at && at <= s.to);
        across
            .map(|(_, s)| (s.to - s.from) - over(s, at))
            .fold(0.0, f64::max)
    }

    fn note(
        &self,
        faults: &mut Vec<Fault>,
        kind: FaultKind,
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
        let (shadow, shape) = (
            &self.skyline.shadows[i],
            &self.brief.shapes[self.pillars[i].shape],
        );
        let [near, far] = reach_of(shadow, shape);
        self.subject.beyond_ends(run.from, run.to, near, far, shape)
    }

    /// See [`Survey::rates`](super::Survey::rates).
    pub(crate) fn rates(&self) -> [f64; 2] {
        let mut worst = [0.0f64; 2];
        let pairs = self.skyline.runs.windows(2);
        for pair in pairs.filter(|p| p[0].to == p[1].from) {
            let [Some(i), Some(j)] = [pair[0].obstacle, pair[1].obstacle] else {
                continue;
            };
            let [a, b] = [i, j].map(|k| {
                let shadow = &self.skyline.shadows[k];
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
    pub(crate) fn open(&self, rate: f64, tolerance_mm: f64) -> Option<Fault> {
        let allowed = UNSEEN_RAD / tolerance_mm;
        let away = (self.subject.middle.truncate() - self.subject.o).length();
        (tolerance_mm > 0.0 && rate > allowed).then(|| Fault {
            kind: FaultKind::Open,
            view: Some(self.view),
            pillars: [None, None],
            mm: (rate - allowed) * away * away,
            at: self.subject.middle.truncate(),
        })
    }
}
