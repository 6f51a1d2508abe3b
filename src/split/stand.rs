//! Bodies put on the bed as checked solids.

use crate::carve::boolean::Boolean;
use crate::carve::{CRUMB_MM3, CarveError, sound};
use crate::mesh::{Solid, TriMesh};
use glam::{DMat4, DVec3};

/// Lengths are cut down to multiples of this, millimetres: moving by them loses no digit of an f32.
const GRAIN_MM: f64 = 1.0 / 1024.0;
/// A place, millimetres, where coordinates are as coarse as anywhere up to 256 mm from the origin.
const FAR: DVec3 = DVec3::new(192.0, 192.0, 0.0);

/// Raises a body by `up` and checks it. It is rounded as it would be at [`FAR`], so that it can be moved about there exactly.
pub(crate) fn standing_on_zero(body: &Boolean, up: f64, name: &str) -> Result<Solid, CarveError> {
    let body = body.without_crumbs(CRUMB_MM3).0;
    let far = body.moved(FAR + up * DVec3::Z);
    let far = far.map_err(|source| CarveError::Boolean {
        place: name.into(),
        source,
    })?;
    let (solid, _) = sound(&far, name)?;
    Solid::new(moved(solid.mesh(), -FAR)).map_err(|defects| CarveError::Unsound {
        place: name.into(),
        defects,
    })
}

pub(crate) fn moved(mesh: &TriMesh, by: DVec3) -> TriMesh {
    mesh.transformed(DMat4::from_translation(by))
}

/// Cut down to a multiple of [`GRAIN_MM`].
pub(crate) fn grained(x: f64) -> f64 {
    (x / GRAIN_MM).floor() * GRAIN_MM
}
