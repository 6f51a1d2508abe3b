//! Results of booleans as checked solids.

use super::boolean::Boolean;
use super::forest::CarveError;
use crate::ladder::Ladder;
use crate::mesh::{Mended, Solid, mend, without_cavities};

/// Loose crumbs smaller than this are dropped, cubic millimetres: a tenth of what a nozzle can lay down as a dot.
pub(crate) const CRUMB_MM3: f64 = 0.005;

/// Tolerances at which slivers are simplified away, millimetres: the first is fast but may cross long faces; then as it is, or more.
const TOLERANCES_MM: [f64; 3] = [1e-4, 0.0, 5e-4];

/// A checked solid, and which rungs of its ladders held.
pub(crate) struct Sound {
    pub solid: Solid,
    pub ladders: [Ladder; 2],
}

/// The result of booleans as a checked solid, simplified and mended.
///
/// # Errors
/// If no tolerance gives a sound one.
pub(crate) fn sound(solid: &Boolean, place: &str) -> Result<Sound, CarveError> {
    let mut defects = Vec::new();
    for (held, tolerance) in TOLERANCES_MM.into_iter().enumerate() {
        let mesh = solid.simplified(tolerance);
        // Vertices that move by the tolerance sweep no more than this: now and then simplifying loses whole pieces.
        let swept = tolerance * mesh.area();
        if tolerance > 0.0 && (mesh.volume() - solid.volume()).abs() > swept {
            continue;
        }
        let Mended { mesh, rung } = mend(&mesh);
        match Solid::new(without_cavities(mesh)) {
            Ok(solid) => {
                return Ok(Sound {
                    solid,
                    ladders: [
                        Ladder::new(
                            "tolerance of simplifying",
                            Some(place),
                            held,
                            TOLERANCES_MM.len(),
                        ),
                        Ladder::new(
                            "mending: height of slivers, then distance of faces",
                            Some(place),
                            rung,
                            Mended::RUNGS,
                        ),
                    ],
                });
            }
            Err(d) => defects = d,
        }
    }
    Err(CarveError::Unsound {
        place: place.into(),
        defects,
    })
}
