//! What a mesh that was cut along tears brings along.

use crate::index::VertexId;

/// A step between two vertices of a cut mesh that stand on one ray: `least <= x_far - x_near <= most`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    pub near: VertexId,
    pub far: VertexId,
    pub least: f64,
    pub most: f64,
}

/// Two points of a cut mesh on one ray that stay together although they share no vertices: weights of vertices, of which
/// the weighted sum of `x` is to vanish.
pub type Tie = Vec<(VertexId, f64)>;

/// What a cut mesh brings along: a surface near the optimum, and the steps to keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Log relief depth over the model's of every vertex; pieces that are free stay near it.
    pub start: Vec<f64>,
    /// Force on every vertex, positive away from the eye, relative to the mean diagonal of the quadratic form.
    pub push: Vec<f64>,
    pub steps: Vec<Step>,
    pub ties: Vec<Tie>,
    /// Factor of every face's weight.
    pub counts: Vec<f64>,
}
