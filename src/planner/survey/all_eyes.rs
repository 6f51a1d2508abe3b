//! A layout seen from all eyes.

use super::eye::OfView;
use super::fault::Fault;
use super::room::{in_sight, parcels, placed, tight};
use crate::planner::brief::{Brief, Pillar};
use crate::planner::skyline::Skyline;
use crate::planner::subject::Subject;
use crate::steps::UNSEEN_RAD;

/// What is known of a layout from all eyes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Index: view.
    pub skylines: Vec<Skyline>,
    pub faults: Vec<Fault>,
    /// Fastest opening of any cut, radians per millimetre that the eye moves sideways: with reliefs in the middle of their
    /// layers, and at their worst places. Index: view.
    pub rates: Vec<[f64; 2]>,
}

impl Survey {
    /// Surveys a layout. `brief` gives shapes, region, gap and limits.
    pub fn new(subjects: &[&Subject], brief: &Brief, pillars: &[Pillar]) -> Self {
        let skyline = |s: &&Subject| Skyline::new(s, &brief.shapes, pillars);
        Self::of(
            subjects,
            brief,
            pillars,
            subjects.iter().map(skyline).collect(),
        )
    }

    /// The same after some pillars have changed, of this list or of the former one.
    pub fn after(
        &self,
        subjects: &[&Subject],
        brief: &Brief,
        pillars: &[Pillar],
        changed: &[usize],
    ) -> Self {
        let before = self.skylines.iter().zip(subjects);
        let after = before.map(|(old, s)| old.after(s, &brief.shapes, pillars, changed));
        Self::of(subjects, brief, pillars, after.collect())
    }

    fn of(
        subjects: &[&Subject],
        brief: &Brief,
        pillars: &[Pillar],
        skylines: Vec<Skyline>,
    ) -> Self {
        let mut found = Self {
            skylines,
            ..Self::default()
        };
        for (view, subject) in subjects.iter().enumerate() {
            let eye = OfView {
                subject,
                view,
                brief,
                pillars,
                skyline: &found.skylines[view],
            };
            eye.look(&mut found.faults);
            let rates = eye.rates();
            found
                .faults
                .extend(eye.open(rates[1], brief.tolerance_mm[view]));
            found.rates.push(rates);
        }
        let parcels = parcels(subjects, &brief.shapes, pillars, &found.skylines);
        in_sight(
            subjects,
            pillars,
            &found.skylines,
            &parcels,
            &mut found.faults,
        );
        tight(brief, pillars, &parcels, &mut found.faults);
        placed(brief, pillars, &mut found.faults);
        found
    }

    /// How much is wrong in all, millimetres; 0 if nothing is.
    pub fn wrong(&self) -> f64 {
        self.faults.iter().map(|f| f.mm).sum()
    }

    /// Guaranteed eye tolerance of a view, millimetres.
    pub fn tolerance(&self, view: usize) -> f64 {
        UNSEEN_RAD / self.rates[view][1].max(f64::MIN_POSITIVE)
    }

    /// Least of all views.
    pub fn least_tolerance(&self) -> f64 {
        (0..self.rates.len())
            .map(|v| self.tolerance(v))
            .fold(f64::INFINITY, f64::min)
    }
}
