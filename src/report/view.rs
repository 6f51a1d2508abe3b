//! What the report tells of one view.

use super::certificate::CertificateReport;
use crate::certify::without_minus_zero;
use crate::mimic::Iterated;
use crate::render::{LightLikeness, Likeness};
use crate::steps::StepSummary;
use crate::view::View;
use glam::DMat4;
use serde::{Deserialize, Serialize};

/// One view: what it was to show and what it shows. Figures of stages that did not run are left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewReport {
    pub name: String,
    /// Where the eye stands and what it looks at, millimetres; for an eye at infinity a far point stands.
    pub eye: [f64; 3],
    pub look_at: [f64; 3],
    /// Whether the eye is at infinity; then angles and movements are told as from 300 mm, where one reads.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
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

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelReport {
    /// As the scene names it.
    pub file: String,
    /// From the file's coordinates to millimetres: rows of a 4 x 4 matrix for column vectors.
    pub matrix: [[f64; 4]; 4],
}

/// Angles in degrees between the normals of target and forest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NormalError {
    pub mean: f64,
    pub median: f64,
    pub p90: f64,
}

/// The quadratic program of one view and what the solver reached.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProgramReport {
    pub variables: usize,
    pub rows: usize,
    /// Independent parts that were solved one by one.
    pub blocks: usize,
    /// `interior point` or `dual working set`.
    pub method: String,
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
    pub gauge: String,
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
            eye: without_minus_zero(view.eye),
            look_at: without_minus_zero(view.look_at),
            orthographic: view.orthographic,
            from: view.orthographic.then(|| without_minus_zero(view.from())),
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

fn rows(matrix: DMat4) -> [[f64; 4]; 4] {
    std::array::from_fn(|row| (matrix.row(row) + 0.0).to_array())
}
