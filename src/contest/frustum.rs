//! Frusta of an eye's rays between two parallel planes, and whether two of them meet.
//!
//! Two convex bodies are apart exactly if some direction separates them, and for polyhedra the normals of their faces and the
//! cross products of their edges are directions enough (the separating axis theorem). The answer is exact but for rounding:
//! coordinates of 300 mm leave 1e-12 mm, a millionth of [`CONTACT_MM`], those of an eye at infinity 1e-9.

use glam::DVec3;

/// Bodies that overlap by no more than this in some direction only touch, millimetres: far above rounding, far below
/// anything that can be seen or printed.
pub const CONTACT_MM: f64 = 1e-6;

/// A frustum over up to four rays has two corners on each.
const MOST_RAYS: usize = 4;
/// Sines below this are parallel edges: their cross product is no direction.
const PARALLEL: f64 = 1e-12;

/// The convex body between two parallel planes and the planes through neighbouring rays of an eye.
#[derive(Clone, Copy, Debug)]
pub struct Frustum {
    points: [DVec3; 2 * MOST_RAYS],
    corners: usize,
    /// Of its faces, not normalised; one for both parallel planes.
    normals: [DVec3; MOST_RAYS + 1],
    /// Directions of its edges; one for the parallel edges of both planes.
    edges: [DVec3; 2 * MOST_RAYS],
    rays: usize,
}

impl Frustum {
    /// Over three or four `rays` of `eye` in order around a convex cone, where `near <= (p - eye) . normal <= far`.
    /// With `near` 0 it is a pyramid with its tip at the eye.
    pub fn new(eye: DVec3, rays: &[DVec3], normal: DVec3, near: f64, far: f64) -> Self {
        let n = rays.len().min(MOST_RAYS);
        let mut body = Self {
            points: [eye; 2 * MOST_RAYS],
            corners: 2 * n,
            normals: [normal; MOST_RAYS + 1],
            edges: [DVec3::ZERO; 2 * MOST_RAYS],
            rays: n,
        };
        for (k, ray) in rays[..n].iter().enumerate() {
            let unit = *ray / ray.dot(normal);
            body.points[k] = eye + far * unit;
            body.points[n + k] = eye + near * unit;
            // The next ray itself would leave few digits where both are nearly parallel.
            body.normals[k + 1] = ray.cross(rays[(k + 1) % n] - *ray);
            body.edges[k] = *ray;
        }
        for k in 0..n {
            body.edges[n + k] = body.points[(k + 1) % n] - body.points[k];
        }
        if near == 0.0 {
            body.corners = n + 1;
        }
        body
    }

    /// Its corners.
    pub fn points(&self) -> &[DVec3] {
        &self.points[..self.corners]
    }

    fn normals(&self) -> &[DVec3] {
        &self.normals[..=self.rays]
    }

    fn edges(&self) -> &[DVec3] {
        &self.edges[..2 * self.rays]
    }

    /// Whether they overlap by more than [`CONTACT_MM`] in every direction.
    pub fn meets(&self, other: &Self) -> bool {
        let apart = |axis: &DVec3| self.are_apart(other, *axis);
        let crossed = || {
            self.edges()
                .iter()
                .flat_map(|a| other.edges().iter().map(move |b| (a, b)))
        };
        !self.normals().iter().any(apart)
            && !other.normals().iter().any(apart)
            && !crossed().any(|(a, b)| {
                let axis = a.cross(*b);
                axis.length_squared()
                    > PARALLEL * PARALLEL * a.length_squared() * b.length_squared()
                    && apart(&axis)
            })
    }

    /// Whether the axis separates them.
    fn are_apart(&self, other: &Self, axis: DVec3) -> bool {
        let ((a, b), (c, d)) = (self.shadow(axis), other.shadow(axis));
        (b - c).min(d - a) <= CONTACT_MM * axis.length()
    }

    /// Smallest and largest coordinate along an axis.
    fn shadow(&self, axis: DVec3) -> (f64, f64) {
        self.points()
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| {
                let t = p.dot(axis);
                (lo.min(t), hi.max(t))
            })
    }
}
