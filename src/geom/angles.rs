//! Angles: of triangles, of rays that part, and along measured curves.

use glam::DVec3;

/// An arc-minute in radians.
pub const ARCMIN: f64 = std::f64::consts::PI / (180.0 * 60.0);
/// Square arc-minutes in a steradian.
pub const SQUARE_ARCMIN: f64 =
    (180.0 * 60.0 / std::f64::consts::PI) * (180.0 * 60.0 / std::f64::consts::PI);

/// Solid angle in steradians of the triangle `abc` seen from the origin, positive if it turns counter-clockwise as seen from there.
/// Van Oosterom & Strackee 1983.
pub fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let numerator = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    -2.0 * numerator.atan2(denominator)
}

/// How far two points on one ray of an eye, at distances `a` and `b` from it, part for each millimetre that the eye moves square to
/// the ray: radians per millimetre, to first order; positive if `a` is the nearer one.
pub fn parallax(a: f64, b: f64) -> f64 {
    1.0 / a - 1.0 / b
}

/// Where a curve of (angle, value), by rising angle, first falls to half of its first value, straight between its points; none if
/// it never does or begins at nothing.
pub fn half_angle(curve: &[(f64, f64)]) -> Option<f64> {
    let half = curve.first()?.1 / 2.0;
    let pair = curve.windows(2).find(|w| w[1].1 <= half)?;
    let [(a, above), (b, below)] = [pair[0], pair[1]];
    (half > 0.0).then(|| a + (b - a) * (above - half) / (above - below))
}
