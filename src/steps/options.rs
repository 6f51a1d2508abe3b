//! What tears may be like.

/// An opening that nobody sees, radians: two arc-minutes.
pub const UNSEEN_RAD: f64 = 2.0 / 60.0 * std::f64::consts::PI / 180.0;
/// Where pieces may lie anywhere in a part of the layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefer {
    /// As small steps as possible: the eye may move farther before they open.
    Tolerance,
    /// As large steps as possible: from elsewhere the pieces fit together less.
    Camouflage,
}

/// What every step must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Smallest step, millimetres of depth.
    pub least_mm: f64,
    /// Largest step, millimetres of depth.
    pub highest_mm: Option<f64>,
    /// How far the eye may move sideways before a step opens by more than [`UNSEEN_RAD`], millimetres.
    pub tolerance_mm: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOptions {
    pub limits: StepLimits,
    /// Largest number of tear lines in a view.
    pub most: Option<u32>,
    /// What a millimetre of tear line weighs: square millimetres tilted by one degree.
    pub price: f64,
    /// Strips between tears narrower than this are given to a neighbour, millimetres at the model.
    pub narrowest_mm: f64,
    pub prefer: Prefer,
}

/// How far a piece may be too thin to print behind its edge, millimetres: printing blunts so much, and nobody misses it.
pub(crate) const LIP_MM: f64 = 2.0;

impl StepOptions {
    /// A piece that stands before its neighbour must not fall off from the step by more millimetres per millimetre of the image
    /// than this. Steeper, it is a knife: for more than [`LIP_MM`] behind its edge it is narrower than what prints.
    pub(crate) fn steepest(&self) -> f64 {
        LIP_MM / self.narrowest_mm
    }
}
