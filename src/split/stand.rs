//! Bodies put on the bed as checked solids.

use super::pieces::PLACES;
use crate::carve::boolean::Boolean;
use crate::carve::{CRUMB_MM3, CarveError, sound};
use crate::mesh::{Solid, TriMesh};
use glam::{DMat4, DVec3};

/// Lengths are cut down to multiples of this, millimetres: moving by them loses no digit of an f32.
const GRAIN_MM: f64 = 1.0 / 1024.0;
/// A place, millimetres, where coordinates are as coarse as anywhere up to 256 mm from the origin.
const FAR: DVec3 = DVec3::new(192.0, 192.0, 0.0);
/// Pieces that do not come out sound there are tried again this little aside, millimetres: less than a step of f32.
const NUDGE: DVec3 = DVec3::new(3.1e-6, 4.7e-6, 0.0);

/// Raises a body by `up` and checks it; with the place ([`PLACES`]) at which it was sound. It is rounded as it would be at [`FAR`],
/// so that it can be moved about there exactly: a sliver that is sound near the origin may turn over where f32 is coarser.
pub(crate) fn standing_on_zero(
    body: &Boolean,
    up: f64,
    name: &str,
) -> Result<(Solid, usize), CarveError> {
    let body = body.without_crumbs(CRUMB_MM3).0;
    let at = |by: DVec3| {
        let put = body.moved(by + up * DVec3::Z);
        put.map_err(|source| CarveError::Boolean {
            place: name.into(),
            source,
        })
    };
    let last = PLACES - 1;
    for k in 0..last {
        let far = sound(&at(FAR + k as f64 * NUDGE)?, name);
        let back = far.map(|s| Solid::new(moved(s.solid.mesh(), -FAR)));
        if let Ok(Ok(solid)) = back {
            return Ok((solid, k));
        }
    }
    Ok((sound(&at(DVec3::ZERO)?, name)?.solid, last))
}

pub(crate) fn moved(mesh: &TriMesh, by: DVec3) -> TriMesh {
    mesh.transformed(DMat4::from_translation(by))
}

/// Cut down to a multiple of [`GRAIN_MM`].
pub(crate) fn grained(x: f64) -> f64 {
    (x / GRAIN_MM).floor() * GRAIN_MM
}
