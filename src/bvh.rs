//! Ray casting against triangle meshes: the only module that names `obvhs`.
//!
//! The tree and its traversal are f32 with boxes padded outwards; the triangle test is f64 and watertight
//! (Woop, Benthin & Wald 2013), so a ray through a shared edge or vertex hits one of the faces there. The f32 ray begins just before
//! the mesh: from an eye hundreds of metres away it would pass boxes by.

use crate::index::FaceId;
use crate::mesh::TriMesh;
use glam::{DVec3, Vec3A};
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder::build_bvh2, ray::Ray};
use std::time::Duration;

/// Where a ray meets a face: `origin + t * direction`, `t > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub face: FaceId,
    pub t: f64,
}

/// A mesh ready for rays. Deterministic: the same mesh gives the same answers whatever the thread count.
pub struct Bvh {
    tree: Bvh2,
    triangles: Vec<[DVec3; 3]>,
    /// A ball around the mesh, a little wide.
    centre: DVec3,
    radius: f64,
}

/// How much wider than its mesh a tree's ball is.
const WIDE: f64 = 1.01;

impl Bvh {
    pub fn new(mesh: &TriMesh) -> Self {
        let triangles: Vec<[DVec3; 3]> = FaceId::all(mesh.faces.len())
            .map(|f| mesh.corners(f))
            .collect();
        let (lo, hi) = mesh.bounds().unwrap_or_default();
        let pad = 1e-6 * ((hi - lo).length() + hi.abs().max(lo.abs()).length());
        let boxes: Vec<Aabb> = triangles.iter().map(|t| padded_box(t, pad)).collect();
        let tree = build_bvh2(
            &boxes,
            BvhBuildParams::fast_build(),
            &mut Duration::default(),
        );
        Self {
            tree,
            triangles,
            centre: (lo + hi) / 2.0,
            radius: WIDE * ((hi - lo).length() / 2.0 + pad),
        }
    }

    /// The ray from where it may first meet the mesh, and the parameter there.
    fn near_ray(&self, origin: DVec3, direction: DVec3) -> (Ray, f64) {
        let along = (self.centre - origin).dot(direction) - self.radius * direction.length();
        let start = (along / direction.length_squared()).max(0.0);
        let origin = origin + start * direction;
        let ray = Ray::new_inf(
            Vec3A::from(origin.as_vec3()),
            Vec3A::from(direction.as_vec3()),
        );
        (ray, start)
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
        accept: impl Fn(FaceId) -> bool,
    ) -> Option<Hit> {
        if self.triangles.is_empty() {
            return None;
        }
        let woop = WoopRay::new(origin, direction);
        let mut best: Option<Hit> = None;
        let mut nearest = obvhs::ray::RayHit::none();
        let (ray, start) = self.near_ray(origin, direction);
        self.tree.ray_traverse(ray, &mut nearest, |_, slot| {
            let face = FaceId(self.tree.primitive_indices[slot]);
            let Some(t) = woop.hit(&self.triangles[face]).filter(|_| accept(face)) else {
                return f32::INFINITY;
            };
            if best.is_none_or(|b| t < b.t || (t == b.t && face < b.face)) {
                best = Some(Hit { face, t });
            }
            // Rounded up well past f32 error, so that an equally near face is still visited.
            ((t - start) * (1.0 + 1e-6)) as f32
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
            .ray_traverse_anyhit(self.near_ray(origin, direction).0, |_, slot| {
                let face = FaceId(self.tree.primitive_indices[slot]);
                hits.extend(woop.hit(&self.triangles[face]).map(|t| Hit { face, t }));
            });
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
        hits
    }

    /// Whether anything lies on the ray before `t_max`. Stops at the first face found, near or far.
    pub fn blocked(&self, origin: DVec3, direction: DVec3, t_max: f64) -> bool {
        if self.triangles.is_empty() {
            return false;
        }
        let woop = WoopRay::new(origin, direction);
        let (mut ray, start) = self.near_ray(origin, direction);
        if t_max <= start {
            return false;
        }
        // Rounded up well past f32 error, as in `first_hit_where`.
        ray.tmax = ((t_max - start) * (1.0 + 1e-5)) as f32;
        let free = self.tree.ray_traverse_miss(ray, |_, slot| {
            let face = FaceId(self.tree.primitive_indices[slot]);
            let hit = woop.hit(&self.triangles[face]);
            // Any number below the ray's end counts as a hit, infinity never does.
            if hit.is_some_and(|t| t < t_max) {
                0.0
            } else {
                f32::INFINITY
            }
        });
        !free
    }
}

fn padded_box(triangle: &[DVec3; 3], pad: f64) -> Aabb {
    let lo = triangle[0].min(triangle[1]).min(triangle[2]) - pad;
    let hi = triangle[0].max(triangle[1]).max(triangle[2]) + pad;
    Aabb::new(Vec3A::from(lo.as_vec3()), Vec3A::from(hi.as_vec3()))
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

    #[inline]
    fn hit(&self, triangle: &[DVec3; 3]) -> Option<f64> {
        // Written out: this is the innermost loop of everything, and `map` over arrays is not always inlined.
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = triangle;
        let (a, b, c) = (*a - self.origin, *b - self.origin, *c - self.origin);
        let (az, bz, cz) = (a[kz], b[kz], c[kz]);
        let (ax, ay) = (a[kx] - self.shear.x * az, a[ky] - self.shear.y * az);
        let (bx, by) = (b[kx] - self.shear.x * bz, b[ky] - self.shear.y * bz);
        let (cx, cy) = (c[kx] - self.shear.x * cz, c[ky] - self.shear.y * cz);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let det = u + v + w;
        if det == 0.0 {
            return None;
        }
        let t = (u * az + v * bz + w * cz) * self.shear.z / det;
        (t > 0.0).then_some(t)
    }
}
