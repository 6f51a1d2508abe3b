//! Reliefs as height fields whose surface is torn along lines that the eye cannot see (see [`steps`](crate::steps)).
//!
//! - Conditions, order and bounds: on the cut mesh, with the height of every step; every piece has its own scale.
//! - Solid and certificate: as for a height field, over the map of the surface before it was cut.

use super::optimised::Optimised;
use crate::diagram::section::{Section, torn_section};
use crate::mimic::{Depths, NormalOptions, SolveError};
use crate::relief::{Relief, relief};
use crate::sight::Sight;
use crate::steps::{StepLine, StepOptions, StepSummary, Torn, torn};
use crate::surface::{Surface, torn_surface};

/// A view's torn surface after optimisation.
pub struct TornSurface<'a> {
    /// Before it was cut.
    sight: &'a Sight<'a>,
    torn: Torn<'a>,
    relief: Relief,
}

impl<'a> TornSurface<'a> {
    /// # Errors
    /// As [`depths`](crate::mimic::depths). Rows belong to the cut mesh: only the kind of failure is told.
    pub fn new(
        options: NormalOptions,
        steps: &StepOptions,
        sight: &'a Sight<'a>,
    ) -> Result<Self, SolveError> {
        let torn = torn(steps, options, sight).map_err(SolveError::without_rows)?;
        Ok(Self {
            relief: relief(&torn.sight, &torn.depths),
            sight,
            torn,
        })
    }
}

impl Optimised for TornSurface<'_> {
    fn sight(&self) -> &Sight<'_> {
        self.sight
    }

    fn depths(&self) -> &Depths {
        &self.torn.depths
    }

    fn relief(&self) -> &Relief {
        &self.relief
    }

    fn steps(&self) -> Option<(&[StepLine], &StepSummary)> {
        Some((&self.torn.lines, &self.torn.summary))
    }

    fn surface(&self) -> Surface {
        torn_surface(&self.torn)
    }

    fn section(&self) -> Section {
        torn_section(&self.torn, &self.relief, &self.sight.image.target.mesh)
    }
}
