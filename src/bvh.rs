//! Ray casting against triangle meshes: the only module that names `obvhs`.
//!
//! The tree and its traversal are f32 with boxes padded outwards; the triangle test is f64 and watertight
//! (Woop, Benthin & Wald 2013), so a ray through a shared edge or vertex hits one of the faces there.

use crate::mesh::TriMesh;
use glam::{DVec3, Vec3A};
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder::build_bvh2, ray::Ray};
use std::time::Duration;

/// Where a ray meets a face: `origin + t * direction`, `t > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub face: usize,
    pub t: f64,
}

/// A mesh ready for rays. Deterministic: the same mesh gives the same answers whatever the thread count.
pub struct Bvh {
    tree: Bvh2,
    triangles: Vec<[DVec3; 3]>,
}

impl Bvh {
    pub fn new(mesh: &TriMesh) -> Self {
        let triangles: Vec<[DVec3; 3]> = (0..mesh.faces.len()).map(|f| mesh.corners(f)).collect();
        let pad = mesh.bounds().map_or(0.0, |(lo, hi)| {
            1e-6 * ((hi - lo).length() + hi.abs().max(lo.abs()).length())
        });
        let boxes: Vec<Aabb> = triangles.iter().map(|t| padded_box(t, pad)).collect();
        let tree = build_bvh2(
            &boxes,
            BvhBuildParams::fast_build(),
            &mut Duration::default(),
        );
        Self { tree, triangles }
    }

    /// The nearest face on the ray; ties go to the lower face index.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        self.first_hit_where(origin, direction, |_| true)
    }

    /// The nearest face that `accept`s, by face index.
    pub fn first_hit_where(
        &self,
        origin: DVec3,
        direction: DVec3,
        accept: impl Fn(usize) -> bool,
    ) -> Option<Hit> {
        if self.triangles.is_empty() {
            return None;
        }
        let woop = WoopRay::new(origin, direction);
        let mut best: Option<Hit> = None;
        let mut nearest = obvhs::ray::RayHit::none();
        self.tree
            .ray_traverse(f32_ray(origin, direction), &mut nearest, |_, slot| {
                let face = self.tree.primitive_indices[slot] as usize;
                let Some(t) = woop.hit(&self.triangles[face]).filter(|_| accept(face)) else {
                    return f32::INFINITY;
                };
                if best.is_none_or(|b| t < b.t || (t == b.t && face < b.face)) {
                    best = Some(Hit { face, t });
                }
                // Rounded up well past f32 error, so that an equally near face is still visited.
                (t * (1.0 + 1e-6)) as f32
            });
        best
    }

    /// Every face on the ray, by rising `t`, then face index.
    pub fn all_hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        if self.triangles.is_empty() {
            return Vec::new();
        }
        let woop = WoopRay::new(origin, direction);
        let mut hits = Vec::new();
        self.tree
            .ray_traverse_anyhit(f32_ray(origin, direction), |_, slot| {
                let face = self.tree.primitive_indices[slot] as usize;
                hits.extend(woop.hit(&self.triangles[face]).map(|t| Hit { face, t }));
            });
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
        hits
    }

    /// Whether anything lies on the ray before `t_max`.
    pub fn blocked(&self, origin: DVec3, direction: DVec3, t_max: f64) -> bool {
        self.first_hit(origin, direction)
            .is_some_and(|h| h.t < t_max)
    }
}

fn padded_box(triangle: &[DVec3; 3], pad: f64) -> Aabb {
    let lo = triangle[0].min(triangle[1]).min(triangle[2]) - pad;
    let hi = triangle[0].max(triangle[1]).max(triangle[2]) + pad;
    Aabb::new(Vec3A::from(lo.as_vec3()), Vec3A::from(hi.as_vec3()))
}

fn f32_ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray::new_inf(
        Vec3A::from(origin.as_vec3()),
        Vec3A::from(direction.as_vec3()),
    )
}

/// A ray in the sheared frame of the watertight test: its direction is the largest axis.
struct WoopRay {
    origin: DVec3,
    axes: [usize; 3],
    shear: DVec3,
}

impl WoopRay {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let kz = direction.abs().max_position();
        let (mut kx, mut ky) = ((kz + 1) % 3, (kz + 2) % 3);
        if direction[kz] < 0.0 {
            std::mem::swap(&mut kx, &mut ky);
        }
        let shear = DVec3::new(
            direction[kx] / direction[kz],
            direction[ky] / direction[kz],
            1.0 / direction[kz],
        );
        Self {
            origin,
            axes: [kx, ky, kz],
            shear,
        }
    }

    fn hit(&self, triangle: &[DVec3; 3]) -> Option<f64> {
        let [kx, ky, kz] = self.axes;
        let p = triangle.map(|v| v - self.origin);
        let x = p.map(|v| v[kx] - self.shear.x * v[kz]);
        let y = p.map(|v| v[ky] - self.shear.y * v[kz]);
        let u = x[2] * y[1] - y[2] * x[1];
        let v = x[0] * y[2] - y[0] * x[2];
        let w = x[1] * y[0] - y[1] * x[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let det = u + v + w;
        if det == 0.0 {
            return None;
        }
        let t = (u * p[0][kz] + v * p[1][kz] + w * p[2][kz]) * self.shear.z / det;
        (t > 0.0).then_some(t)
    }
}
