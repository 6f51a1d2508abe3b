//! Segments and triangles in space: distances, and the points that are nearest. Millimetres.

use glam::DVec3;

/// Square to a triangle, towards where its corners run counter-clockwise; as long as twice its area.
pub fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// A normal on the side that a ray meets: turned if it points along the ray.
pub fn against(normal: DVec3, ray: DVec3) -> DVec3 {
    if normal.dot(ray) > 0.0 {
        -normal
    } else {
        normal
    }
}

/// Above its longest side; 0 for corners at one place.
pub fn height(triangle: [DVec3; 3]) -> f64 {
    let [a, b, c] = triangle;
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest == 0.0 {
        0.0
    } else {
        area_vector(triangle).length() / longest
    }
}

/// From a point to a segment.
pub fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    p.distance(a + share_on_segment(p, a, b) * (b - a))
}

/// Where on a segment the point nearest to `p` is, 0 to 1.
pub fn share_on_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    if square == 0.0 {
        return 0.0;
    }
    ((p - a).dot(along) / square).clamp(0.0, 1.0)
}

/// From a point to the plane of a triangle; `None` if its foot lies outside of that.
pub fn distance_within(p: DVec3, triangle: [DVec3; 3]) -> Option<f64> {
    let [a, b, c] = triangle;
    let normal = area_vector(triangle);
    let inside = |u: DVec3, v: DVec3| (v - u).cross(p - u).dot(normal) >= 0.0;
    (inside(a, b) && inside(b, c) && inside(c, a))
        .then(|| (p - a).dot(normal.normalize_or_zero()).abs())
}

/// From a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
pub fn distance_to_triangle(p: DVec3, triangle: [DVec3; 3]) -> f64 {
    let [a, b, c] = triangle;
    let to_sides = || {
        distance_to_segment(p, a, b)
            .min(distance_to_segment(p, b, c))
            .min(distance_to_segment(p, c, a))
    };
    distance_within(p, triangle).unwrap_or_else(to_sides)
}

/// Of two segments the points nearest to each other (Ericson, Real-Time Collision Detection, 5.1.9).
pub fn nearest_points([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> [DVec3; 2] {
    let (d, e, w) = (q - p, s - r, p - r);
    let (dd, ee, de) = (d.length_squared(), e.length_squared(), d.dot(e));
    let square = dd * ee - de * de;
    let t = if square > 0.0 {
        ((de * e.dot(w) - ee * d.dot(w)) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let on_other = r.lerp(s, share_on_segment(p.lerp(q, t), r, s));
    [p.lerp(q, share_on_segment(on_other, p, q)), on_other]
}
