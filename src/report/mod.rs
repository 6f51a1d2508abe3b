//! `report.json`, and [`html`] for people: what was built and how good it is.
//!
//! Every number has its unit in its name. The same scene gives the same bytes: times are not part of it.
//! The `views` list can be read back by any program that casts rays at the forest: it names each model's file and matrix.

pub mod html;

use crate::certify::camouflage::Camouflage;
use crate::certify::conflicts::Disturbance;
use crate::certify::coverage::Gap;
use crate::certify::printability::PrintCheck;
use crate::certify::tolerance::Tolerance;
use crate::contest::Contest;
use crate::diag::Diagnostic;
use crate::kinds::Crossings;
use crate::mesh::Solid;
use crate::mimic::Iterated;
use crate::render::{LightLikeness, Likeness};
use crate::steps::StepSummary;
use crate::view::View;
use glam::{DMat4, DVec3};
use serde::Serialize;

/// Lengths below this are none, millimetres: a thousandth of what f32 files resolve.
pub const NOTHING_MM: f64 = 1e-6;
/// Duality gaps and residuals of a program in its own units; solutions come out two to four digits below.
pub const OPTIMAL: f64 = 1e-6;

/// The whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    pub program: Program,
    /// Title of the scene.
    pub scene: String,
    /// Whether all holds that a build promises; else what does not.
    pub ok: bool,
    pub failures: Vec<String>,
    pub views: Vec<ViewReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid: Option<SolidReport>,
    /// What eyes elsewhere recognise, one for each view.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub camouflage: Vec<Camouflage>,
    /// Whether it can be printed; empty if nothing was built.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub print: Vec<PrintCheck>,
    pub warnings: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Program {
    pub name: String,
    pub version: String,
}

impl Default for Program {
    /// This one.
    fn default() -> Self {
        Self {
            name: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

/// One view: what it was to show and what it shows. Figures of stages that did not run are left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ViewReport {
    pub name: String,
    /// Where the eye stands and what it looks at, millimetres; for an eye at infinity a far point stands.
    pub eye: [f64; 3],
    pub look_at: [f64; 3],
    /// Whether the eye is at infinity; then angles and movements are told as from 300 mm, where one reads.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub orthographic: bool,
    /// Unit vector towards an eye at infinity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<[f64; 3]>,
    pub models: Vec<ModelReport>,
    /// Vertices and faces of the models together.
    pub vertices: usize,
    pub faces: usize,
    /// Solid angle of the models as the eye sees them, steradians.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid_angle_sr: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<CertificateReport>,
    /// Depth groups: connected patches of one model component on one support.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub groups: Option<usize>,
    /// Triangles of the view map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<usize>,
    /// Where the surface was torn into steps, if it might be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<StepSummary>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<ProgramReport>,
    /// How the rounds with the deformed surface's Laplacian went, if there were any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iterated: Option<Iterated>,
    /// Share of the rays at the models that meet the forest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hit_share: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_error_deg: Option<NormalError>,
    /// Rays that the last two figures rest on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rays: Option<usize>,
    /// How the view looks under suns, under an overcast sky and in a flash, shadows included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lights: Option<Vec<LightLikeness>>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ModelReport {
    /// As the scene names it.
    pub file: String,
    /// From the file's coordinates to millimetres: rows of a 4 x 4 matrix for column vectors.
    pub matrix: [[f64; 4]; 4],
}

/// What the viewer is promised, measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CertificateReport {
    /// How far the finished relief leaves its layer anywhere, and how far points had to be moved along their rays for that:
    /// millimetres.
    pub bound_violation_mm: f64,
    pub clamp_mm: f64,
    /// How far the relief comes before its datum and goes behind it, as its layer measures it: millimetres.
    pub relief_front_mm: f64,
    pub relief_back_mm: f64,
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
    pub not_an_optimum: Option<&'static str>,
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
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
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ModelShare {
    pub name: String,
    /// As the eye would see it if nothing else were there, steradians.
    pub solid_angle_sr: f64,
    /// What a support carries of it, and what of that rays met at the finished forest, as shares.
    pub coverage: f64,
    pub reaching: f64,
}

/// Angles in degrees between the normals of target and forest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct NormalError {
    pub mean: f64,
    pub median: f64,
    pub p90: f64,
}

/// The quadratic program of one view and what the solver reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ProgramReport {
    pub variables: usize,
    pub rows: usize,
    /// Independent parts that were solved one by one.
    pub blocks: usize,
    /// `interior point` or `dual working set`.
    pub method: &'static str,
    pub active_rows: usize,
    pub iterations: u32,
    /// Scaled so that the mean diagonal of the quadratic form is 1: comparable between runs of one scene only.
    pub objective: f64,
    /// How often the program was solved again because depths between vertices broke a bound or an order, with how many
    /// rows more, and the objective before.
    pub rounds: u32,
    pub rows_added: usize,
    pub objective_first: f64,
    /// What fixes the offsets that the energy leaves open.
    pub gauge: &'static str,
}

/// The finished forest.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SolidReport {
    pub triangles: usize,
    pub vertices: usize,
    pub volume_mm3: f64,
    pub area_mm2: f64,
    /// Pieces that would come apart.
    pub parts: usize,
    /// Hollows without a way out.
    pub cavities: usize,
    pub size_mm: [f64; 3],
    pub checks: Vec<Check>,
}

/// A question about the solid and its answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Check {
    pub name: String,
    pub passed: bool,
    /// What was found, with units.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub found: String,
}

impl Report {
    /// Adds what does not hold, and what is worth a warning.
    pub fn judge(&mut self, failures: &[Diagnostic], warnings: &[Diagnostic]) {
        let texts = |list: &[Diagnostic]| list.iter().map(|d| d.message.clone()).collect();
        self.ok = failures.is_empty();
        self.failures = texts(failures);
        self.warnings = texts(warnings);
    }

    /// The file's text, with a line break at its end.
    ///
    /// # Panics
    /// Never: all keys are texts. Numbers that are not finite become `null`.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report of plain values") + "\n"
    }
}

impl ViewReport {
    /// What is known before anything is built.
    pub fn new(view: &View) -> Self {
        let models = view
            .models
            .iter()
            .map(|m| ModelReport {
                file: m.file.clone(),
                matrix: rows(m.matrix),
            })
            .collect();
        Self {
            name: view.name.clone(),
            eye: tidy(view.eye),
            look_at: tidy(view.look_at),
            orthographic: view.orthographic,
            from: view.orthographic.then(|| tidy(view.from())),
            models,
            vertices: view.models.iter().map(|m| m.mesh.vertices.len()).sum(),
            faces: view.models.iter().map(|m| m.mesh.faces.len()).sum(),
            ..Self::default()
        }
    }

    /// Adds what the view's picture showed.
    pub fn with_likeness(mut self, likeness: &Likeness) -> Self {
        let Likeness {
            hit,
            mean_deg,
            median_deg,
            p90_deg,
            pixels,
        } = *likeness;
        self.hit_share = Some(hit);
        self.normal_error_deg = Some(NormalError {
            mean: mean_deg,
            median: median_deg,
            p90: p90_deg,
        });
        self.rays = Some(pixels);
        self
    }
}

impl SolidReport {
    /// Counts and measures of the forest, with the answers of further checks.
    pub fn new(solid: &Solid, checks: Vec<Check>) -> Self {
        let (lo, hi) = solid.bounds();
        Self {
            triangles: solid.mesh().faces.len(),
            vertices: solid.mesh().vertices.len(),
            volume_mm3: solid.volume_mm3(),
            area_mm2: solid.area_mm2(),
            parts: solid.parts(),
            cavities: solid.cavities(),
            size_mm: tidy(hi - lo),
            checks,
        }
    }
}

/// Without -0, which JSON would show.
fn tidy(p: DVec3) -> [f64; 3] {
    (p + 0.0).to_array()
}

fn rows(matrix: DMat4) -> [[f64; 4]; 4] {
    std::array::from_fn(|row| (matrix.row(row) + 0.0).to_array())
}
