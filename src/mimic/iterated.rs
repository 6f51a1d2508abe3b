//! How an iteration of the Laplacian went.

use serde::{Deserialize, Serialize};

/// How an iteration went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Iterated {
    /// Rounds allowed.
    pub allowed: u32,
    pub rounds: Vec<Round>,
    pub ending: Ending,
    /// The round whose surface is the result; 0 is the linearised problem.
    pub kept: usize,
    /// Mean turn of the linearised problem's seen faces, and of the result's.
    pub linearised_deg: f64,
    pub kept_deg: f64,
}

/// One round.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// Largest change of a seen vertex's relative depth, as a share of the layer's width.
    pub change: f64,
    /// Mean angle between the normals of seen faces and the model's, by solid angle.
    pub turned_deg: f64,
}

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The last change is below the tolerance.
    Converged,
    /// All rounds are used up.
    Unfinished,
    /// The surface ran away from the model's normals.
    Diverged,
    /// A round's program could not be solved, or its surface passes through the eye.
    Failed,
}
