//! Places as certificates give them.

use glam::DVec3;

/// Coordinates of which none is -0, which JSON would show.
pub fn without_minus_zero(p: DVec3) -> [f64; 3] {
    (p + 0.0).to_array()
}
