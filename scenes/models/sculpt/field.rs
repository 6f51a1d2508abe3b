//! Implicit surfaces: primitives, blends and reliefs from which the creatures are composed.
//!
//! Every field is a function of a point in millimetres that is negative inside, positive outside and changes by about
//! one per millimetre near the surface. Exactness is not promised: the mesher only needs the sign and a usable gradient.

use glam::{DMat3, DVec2, DVec3};

/// A field that can be evaluated from several threads.
pub(crate) type Field = dyn Fn(DVec3) -> f64 + Sync + Send;

/// Shorthand for a vector from three coordinates in millimetres.
pub(crate) const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The point with its x coordinate mirrored to the positive side: one description serves left and right.
pub(crate) fn mirror_x(p: DVec3) -> DVec3 {
    v(p.x.abs(), p.y, p.z)
}

/// The point with its y coordinate mirrored to the positive side.
pub(crate) fn mirror_y(p: DVec3) -> DVec3 {
    v(p.x, p.y.abs(), p.z)
}

/// Rotation about z by `degrees`, counter-clockwise from above.
pub(crate) fn turn(degrees: f64) -> DMat3 {
    DMat3::from_rotation_z(degrees.to_radians())
}

/// Ball of radius `r` about `c`.
pub(crate) fn ball(p: DVec3, c: DVec3, r: f64) -> f64 {
    p.distance(c) - r
}

/// Ellipsoid with semi-axes `r` about `c`; first-order distance.
pub(crate) fn ellipsoid(p: DVec3, c: DVec3, r: DVec3) -> f64 {
    let q = p - c;
    let outer = (q / r).length();
    let slope = (q / (r * r)).length();
    if slope < 1e-9 {
        return -r.min_element();
    }
    outer * (outer - 1.0) / slope
}

/// Ellipsoid whose axes are the columns of `axes`.
pub(crate) fn turned_ellipsoid(p: DVec3, c: DVec3, axes: DMat3, r: DVec3) -> f64 {
    ellipsoid(axes.transpose() * (p - c), DVec3::ZERO, r)
}

/// Right-handed axes whose x column points along `x` and whose z column leans towards `up`.
pub(crate) fn axes(x: DVec3, up: DVec3) -> DMat3 {
    let x = x.normalize();
    let y = up.cross(x).normalize();
    DMat3::from_cols(x, y, x.cross(y))
}

/// Cone from `a` to `b` with round ends of radii `ra` and `rb` (hull of two balls), exact.
pub(crate) fn cone(p: DVec3, a: DVec3, b: DVec3, ra: f64, rb: f64) -> f64 {
    let axis = b - a;
    let length = axis.length();
    let taper = (ra - rb) / length;
    // One ball inside the other: the larger one is all there is.
    if taper.abs() >= 1.0 {
        return if ra > rb {
            ball(p, a, ra)
        } else {
            ball(p, b, rb)
        };
    }
    let along = (p - a).dot(axis) / length;
    let off = ((p - a) - axis * (along / length)).length();
    // The slanted side touches both balls; points are assigned to the foot of their normal on the axis.
    let foot = along - off * taper / (1.0 - taper * taper).sqrt();
    if foot <= 0.0 {
        ball(p, a, ra)
    } else if foot >= length {
        ball(p, b, rb)
    } else {
        off * (1.0 - taper * taper).sqrt() + along * taper - ra
    }
}

/// Chain of cones through `(point, radius)` knots, blended over `k` at the joints.
pub(crate) fn tube(p: DVec3, knots: &[(DVec3, f64)], k: f64) -> f64 {
    let mut d = f64::INFINITY;
    for pair in knots.windows(2) {
        d = join(d, cone(p, pair[0].0, pair[1].0, pair[0].1, pair[1].1), k);
    }
    d
}

/// Ring of radius `big` and thickness `small` about `c` in the plane perpendicular to the unit vector `n`.
pub(crate) fn ring(p: DVec3, c: DVec3, n: DVec3, big: f64, small: f64) -> f64 {
    let q = p - c;
    let height = q.dot(n);
    let radial = (q - n * height).length() - big;
    radial.hypot(height) - small
}

/// Smooth union: as `min` where the fields differ by more than `k`, rounded in between.
pub(crate) fn join(a: f64, b: f64, k: f64) -> f64 {
    if !a.is_finite() {
        return b;
    }
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// Smooth intersection, the counterpart of [`join`].
pub(crate) fn meet(a: f64, b: f64, k: f64) -> f64 {
    -join(-a, -b, k)
}

/// Smooth difference: `a` without `b`.
pub(crate) fn carve(a: f64, b: f64, k: f64) -> f64 {
    meet(a, -b, k)
}

/// Hermite step from 0 at `lo` to 1 at `hi` (`lo > hi` steps down).
pub(crate) fn step(lo: f64, hi: f64, x: f64) -> f64 {
    let t = ((x - lo) / (hi - lo)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Bell of height 1 about `c` with standard width `w`.
pub(crate) fn bell(x: f64, c: f64, w: f64) -> f64 {
    (-((x - c) / w).powi(2)).exp()
}

/// Smooth value noise in -1..1 with features about one unit wide.
pub(crate) fn noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let t = p - cell;
    let t = t * t * (3.0 - 2.0 * t);
    let (i, j, k) = (cell.x as i64, cell.y as i64, cell.z as i64);
    let mut sum = 0.0;
    for corner in 0..8 {
        let (a, b, c) = (corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
        let weight = |bit: i64, x: f64| if bit == 1 { x } else { 1.0 - x };
        sum += weight(a, t.x) * weight(b, t.y) * weight(c, t.z) * scramble(i + a, j + b, k + c);
    }
    sum * 2.0 - 1.0
}

/// Fixed pseudo-random number in 0..1 for an integer cell.
pub(crate) fn scramble(i: i64, j: i64, k: i64) -> f64 {
    let mut h = (i as u64)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add((j as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
        .wrapping_add((k as u64).wrapping_mul(0x1656_67b1_9e37_79f9));
    h = (h ^ (h >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 29)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((h ^ (h >> 32)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Exact signed distance to a closed polygon in the plane.
pub(crate) fn polygon(p: DVec2, corners: &[DVec2]) -> f64 {
    let mut best = f64::INFINITY;
    let mut inside = false;
    let mut prev = corners[corners.len() - 1];
    for &here in corners {
        let edge = prev - here;
        let w = p - here;
        let off = w - edge * (w.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        best = best.min(off.length_squared());
        let above = (here.y > p.y) != (prev.y > p.y);
        if above && p.x < here.x + edge.x * (p.y - here.y) / edge.y {
            inside = !inside;
        }
        prev = here;
    }
    if inside { -best.sqrt() } else { best.sqrt() }
}

/// Value at `x` of the smooth curve through `(x, y)` knots with ascending x (monotone-safe Hermite, clamped ends).
pub(crate) fn curve(x: f64, knots: &[(f64, f64)]) -> f64 {
    let last = knots.len() - 1;
    if x <= knots[0].0 {
        return knots[0].1;
    }
    if x >= knots[last].0 {
        return knots[last].1;
    }
    let i = knots
        .iter()
        .rposition(|k| k.0 <= x)
        .unwrap_or(0)
        .min(last - 1);
    let slope = |j: usize| {
        let (a, b) = (knots[j.saturating_sub(1)], knots[(j + 1).min(last)]);
        (b.1 - a.1) / (b.0 - a.0)
    };
    let ((x0, y0), (x1, y1)) = (knots[i], knots[i + 1]);
    let h = x1 - x0;
    let t = (x - x0) / h;
    let (t2, t3) = (t * t, t * t * t);
    y0 * (2.0 * t3 - 3.0 * t2 + 1.0)
        + h * slope(i) * (t3 - 2.0 * t2 + t)
        + y1 * (3.0 * t2 - 2.0 * t3)
        + h * slope(i + 1) * (t3 - t2)
}

/// Gradient by four samples at the corners of a small tetrahedron.
pub(crate) fn gradient(f: &Field, p: DVec3) -> DVec3 {
    // 0.02 mm: below every relief detail, far above the rounding of coordinates of 100 mm.
    const H: f64 = 0.02;
    let corners = [
        v(1., -1., -1.),
        v(-1., -1., 1.),
        v(-1., 1., -1.),
        v(1., 1., 1.),
    ];
    let sum: DVec3 = corners.iter().map(|&c| c * f(p + c * H)).sum();
    sum / (4.0 * H)
}

/// Moves `p` onto the surface by Newton steps of at most `stride` mm each along the gradient.
pub(crate) fn settle(f: &Field, mut p: DVec3, steps: usize, stride: f64) -> DVec3 {
    for _ in 0..steps {
        let g = gradient(f, p);
        let g2 = g.length_squared();
        if g2 < 1e-6 {
            break;
        }
        p -= (g * (f(p) / g2)).clamp_length_max(stride);
    }
    p
}

/// First point of the surface on the ray from `from` along the unit vector `dir`, within 200 mm.
pub(crate) fn march(f: &Field, from: DVec3, dir: DVec3) -> Option<DVec3> {
    let mut t = 0.0;
    while t < 200.0 {
        let d = f(from + dir * t);
        if d < 1e-3 {
            return Some(from + dir * t);
        }
        // Half steps: fields overestimate the distance near flat ellipsoids.
        t += (d * 0.5).max(5e-4);
    }
    None
}
