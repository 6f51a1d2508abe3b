//! Which kind of relief a scene wants, and what becomes of a view under it.

use super::height_field::HeightField;
use super::hold::{Bounded, MustBeCut, held};
use super::optimised::Optimised;
use super::torn::TornSurface;
use super::whole::WholeMesh;
use crate::mimic::{Energy, NormalOptions, SolveError};
use crate::sight::Sight;
use crate::steps::StepOptions;

/// How surfaces become reliefs.
#[derive(Clone, Debug, PartialEq)]
pub enum ReliefKind {
    /// In one piece until they are cut at outlines.
    HeightField(Energy),
    /// Torn along lines that the eye cannot see.
    Torn(NormalOptions, StepOptions),
    /// Closed meshes as they are.
    Whole(Energy, Bounded),
}

impl ReliefKind {
    pub fn energy(&self) -> Energy {
        match self {
            Self::HeightField(energy) | Self::Whole(energy, _) => *energy,
            Self::Torn(options, _) => Energy::Normal(*options),
        }
    }

    /// Whether views may lose part of their surface to others: a mesh that is not cut may not.
    pub fn gives_way(&self) -> bool {
        !matches!(self, Self::Whole(..))
    }

    /// Whether nothing may cross in the mesh as it is built.
    pub fn keeps_sheets_apart(&self) -> bool {
        matches!(self, Self::Whole(energy, _) if energy.ordering())
    }

    /// A sight with the bounds of this kind.
    ///
    /// # Errors
    /// If its mesh is to stay whole, but would have to be cut.
    pub fn held<'a>(&self, sight: Sight<'a>) -> Result<Sight<'a>, MustBeCut> {
        match self {
            Self::HeightField(_) | Self::Torn(..) => Ok(sight),
            Self::Whole(_, bounded) => held(sight, *bounded),
        }
    }

    /// Optimises, cuts and scales back. A surface with free vertices stays in one piece: tears are found within a layer.
    ///
    /// # Errors
    /// If no surface lies within all bounds, or the solver gives up.
    pub fn optimised<'a>(
        &self,
        sight: &'a Sight<'a>,
    ) -> Result<Box<dyn Optimised + 'a>, SolveError> {
        Ok(match self {
            Self::Torn(options, steps) if sight.image.target.free.is_empty() => {
                Box::new(TornSurface::new(*options, steps, sight)?)
            }
            Self::HeightField(_) | Self::Torn(..) => {
                Box::new(HeightField::new(self.energy(), sight)?)
            }
            Self::Whole(energy, _) => Box::new(WholeMesh::new(*energy, sight)?),
        })
    }
}
