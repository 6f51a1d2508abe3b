//! Reliefs as height fields over the view map, the surface in one piece until it is cut at outlines and scaled back.
//!
//! - Conditions and order: the nearest orders of what is seen have rows from the start; all orders hold.
//! - Bounds: those of the groups.
//! - Solid: every cell's depths over its support, which is carved out before them.
//! - Certificate: layers at all corners of all cells; order where sheets meet.
//!
//! Solid and certificate are what [`Optimised`] says of any kind that says nothing else.

use super::crossings::{Crossings, crossings, moved};
use super::optimised::Optimised;
use crate::mimic::{
    Depths, Energy, Keeping, Orders, Program, SolveError, depths, orders, program_of,
};
use crate::relief::{Relief, relief};
use crate::sight::Sight;

/// Depths of a surface in one piece.
///
/// # Errors
/// As [`depths`](crate::mimic::depths).
pub fn height_field_depths(energy: Energy, sight: &Sight) -> Result<Depths, SolveError> {
    depths(energy, sight, &keeping(energy, sight))
}

/// The program whose optimum those are.
///
/// # Errors
/// As [`depths`](crate::mimic::depths).
pub fn height_field_program(energy: Energy, sight: &Sight) -> Result<Option<Program>, SolveError> {
    program_of(energy, sight, &keeping(energy, sight))
}

fn keeping(energy: Energy, sight: &Sight) -> Keeping {
    Keeping::seen(if energy.ordering() {
        orders(sight)
    } else {
        Orders::default()
    })
}

/// A view's surface after optimisation.
pub struct HeightField<'a> {
    sight: &'a Sight<'a>,
    depths: Depths,
    relief: Relief,
    /// If the energy was that of the whole mesh.
    crossings: Option<Crossings>,
}

impl<'a> HeightField<'a> {
    /// # Errors
    /// As [`depths`].
    pub fn new(energy: Energy, sight: &'a Sight<'a>) -> Result<Self, SolveError> {
        let depths = height_field_depths(energy, sight)?;
        let crossed = || crossings(&sight.image, &moved(&sight.image, &depths), &depths);
        Ok(Self {
            relief: relief(sight, &depths),
            crossings: matches!(energy, Energy::Curvature(_)).then(crossed),
            sight,
            depths,
        })
    }
}

impl Optimised for HeightField<'_> {
    fn sight(&self) -> &Sight<'_> {
        self.sight
    }

    fn depths(&self) -> &Depths {
        &self.depths
    }

    fn relief(&self) -> &Relief {
        &self.relief
    }

    fn crossings(&self) -> Option<Crossings> {
        self.crossings
    }
}
