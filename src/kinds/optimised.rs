//! What every kind of relief makes of a view.

use super::crossings::Crossings;
use crate::carve::Operand;
use crate::diagram::section::Section;
use crate::mimic::Depths;
use crate::relief::Relief;
use crate::steps::{StepLine, StepSummary};
use crate::surface::Surface;

/// One view after optimisation, cut and scaled back.
pub trait Optimised: Send + Sync {
    fn depths(&self) -> &Depths;

    /// What is seen of it, as depths over the view map.
    fn relief(&self) -> &Relief;

    /// Its way to a solid.
    fn operand(&self) -> Operand<'_>;

    /// How far it leaves its bounds, millimetres along the ray.
    fn bound_violation_mm(&self) -> f64;

    /// Places where its sheets are not in the model's depth order.
    fn order_inversions(&self) -> usize;

    /// What crosses in the mesh before it is cut, if the whole mesh was optimised.
    fn crossings(&self) -> Option<Crossings> {
        None
    }

    /// Where it was torn, if it might be.
    fn steps(&self) -> Option<(&[StepLine], &StepSummary)> {
        None
    }

    /// Before it is cut and scaled back, for other programs.
    fn surface(&self) -> Surface;

    /// Its groups cut open.
    fn section(&self) -> Section;
}
