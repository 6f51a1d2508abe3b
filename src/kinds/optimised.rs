//! What every kind of relief makes of a view.

use super::crossings::Crossings;
use crate::carve::Operand;
use crate::certify::layer::{bound_violation_mm, order_inversions};
use crate::diagram::section::{Section, section};
use crate::mimic::Depths;
use crate::relief::Relief;
use crate::sight::Sight;
use crate::steps::{StepLine, StepSummary};
use crate::surface::{Surface, surface};

/// One view after optimisation, cut and scaled back. What is said here holds for a height field; other kinds say what differs.
pub trait Optimised: Send + Sync {
    /// Before the surface was cut.
    fn sight(&self) -> &Sight<'_>;

    fn depths(&self) -> &Depths;

    /// What is seen of it, as depths over the view map.
    fn relief(&self) -> &Relief;

    /// Its way to a solid.
    fn operand(&self) -> Operand<'_> {
        Operand::Relief {
            sight: self.sight(),
            relief: self.relief(),
        }
    }

    /// How far it leaves its bounds, millimetres along the ray.
    fn bound_violation_mm(&self) -> f64 {
        bound_violation_mm(self.sight(), self.relief())
    }

    /// Places where its sheets are not in the model's depth order.
    fn order_inversions(&self) -> usize {
        order_inversions(self.sight(), self.relief()) + self.depths().solved.broken
    }

    /// What crosses in the mesh before it is cut, if the whole mesh was optimised.
    fn crossings(&self) -> Option<Crossings> {
        None
    }

    /// Where it was torn, if it might be.
    fn steps(&self) -> Option<(&[StepLine], &StepSummary)> {
        None
    }

    /// Before it is cut and scaled back, for other programs.
    fn surface(&self) -> Surface {
        surface(self.sight(), self.depths())
    }

    /// Its groups cut open.
    fn section(&self) -> Section {
        section(self.sight(), self.depths(), self.relief())
    }
}
