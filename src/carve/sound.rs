//! Results of booleans as checked solids.

use super::boolean::Boolean;
use super::forest::CarveError;
use crate::mesh::{Resolving, Solid, TriMesh, resolved, without_spare_corners};

/// Loose crumbs smaller than this are dropped, cubic millimetres: a tenth of what a nozzle can lay down as a dot.
pub(crate) const CRUMB_MM3: f64 = 0.005;

/// Corners that the surface can spare within this are taken away, millimetres: a quarter of a thousandth of a printed line.
pub(super) const SPARE_MM: f64 = 1e-4;

/// Without corners that the surface can spare.
pub(super) fn spared(solid: &Boolean) -> TriMesh {
    without_spare_corners(solid.mesh(), SPARE_MM)
}

/// The result of booleans as a checked solid, and what that took.
///
/// # Errors
/// As [`sound_mesh`].
pub(crate) fn sound(solid: &Boolean, place: &str) -> Result<(Solid, Resolving), CarveError> {
    sound_mesh(&spared(solid), place)
}

/// The same of what is already without spare corners.
///
/// # Errors
/// If faces stay in each other's way.
pub(super) fn sound_mesh(mesh: &TriMesh, place: &str) -> Result<(Solid, Resolving), CarveError> {
    let made = resolved(mesh).map_err(|source| CarveError::Tangled {
        place: place.into(),
        source,
    })?;
    let took = made.took;
    let solid = Solid::of_resolved(made).map_err(|defects| CarveError::Unsound {
        place: place.into(),
        defects,
    })?;
    Ok((solid, took))
}
