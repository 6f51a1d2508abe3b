//! What the viewer of one view is promised.

use crate::certify::conflicts::Disturbance;
use crate::certify::coverage::Gap;
use crate::certify::tolerance::Tolerance;
use crate::contest::Contest;
use crate::kinds::Crossings;
use serde::{Deserialize, Serialize};

/// Duality gaps and residuals of a program in its own units; solutions come out two to four digits below.
pub const OPTIMAL: f64 = 1e-6;

/// What the viewer is promised, measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CertificateReport {
    /// How far the finished relief leaves its layer anywhere, and how far points had to be moved along their rays for that:
    /// millimetres.
    pub bound_violation_mm: f64,
    pub clamp_mm: f64,
    /// What counts as nothing of both.
    pub nothing_mm: f64,
    /// How far the relief comes before its datum and goes behind it, as its layer measures it: millimetres.
    pub relief_front_mm: f64,
    pub relief_back_mm: f64,
    /// Share of the relief, by solid angle, that lies flat at a limit of its layer: what stood out there is cut off.
    #[serde(default)]
    pub at_limit: f64,
    /// Places where a farther sheet of the model comes before a nearer one.
    pub order_inversions: usize,
    /// What crosses in the optimised surface, hidden parts included, before it is cut; only where all of the mesh is optimised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossings: Option<Crossings>,
    /// Proof that the depths are the optimum of their program; none where they are not meant to be one.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub proof: Option<Proof>,
    /// What the depths are instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_an_optimum: Option<String>,
    /// Share of the models' solid angle at which the eye meets a support of its own.
    pub coverage: f64,
    /// The same without what rays found blocked or missing at the finished forest.
    pub reaching: f64,
    pub models: Vec<ModelShare>,
    /// Regions of the models that nothing carries, by falling size.
    pub gaps: Vec<Gap>,
    /// Gaps too small to list: rounding at outlines.
    pub small_gaps: usize,
    pub small_gaps_arcmin2: f64,
    /// Surface that another view wanted too, or that would have hidden the other's, and who gave way.
    pub contests: Vec<Contest>,
    /// What of the contested surface is still in conflict: none.
    pub contested_left_arcmin2: f64,
    /// What stands before reliefs in the finished forest, and reliefs that are not there.
    pub conflicts: Vec<Disturbance>,
    /// Conflicts too small to list: hairs at the edges of reliefs.
    pub small_conflicts_arcmin2: f64,
    /// Where the view's own relief is nearer than planned because corners at steps were filled in.
    pub filled_arcmin2: f64,
    /// Rays that the last figures rest on.
    pub rays: usize,
    /// How far the eye may move, and from where two eyes see one object.
    #[serde(flatten)]
    pub tolerance: Tolerance,
}

/// What proves an optimum, measured on the result (see `mimic::optimality`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Proof {
    pub duality_gap_rel: f64,
    pub primal_residual: f64,
    pub dual_residual: f64,
}

impl Proof {
    /// The largest of the three.
    pub fn worst(&self) -> f64 {
        (self.duality_gap_rel)
            .max(self.primal_residual)
            .max(self.dual_residual)
    }
}

/// What of one model reaches the viewer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelShare {
    pub name: String,
    /// As the eye would see it if nothing else were there, steradians.
    pub solid_angle_sr: f64,
    /// What a support carries of it, and what of that rays met at the finished forest, as shares.
    pub coverage: f64,
    pub reaching: f64,
}
