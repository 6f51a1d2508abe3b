//! Ray casting against triangle meshes: the only module that names `obvhs`.
//!
//! The tree and its traversal are f32 with boxes padded outwards; the triangle test is f64 and watertight
//! (Woop, Benthin & Wald 2013), so a ray through a shared edge or vertex hits one of the faces there. The f32 ray begins just before
//! the mesh: from an eye hundreds of metres away it would pass boxes by.
//!
//! `cargo bench --bench rays` counts rays a second. On the forest of `four-creatures` (267,000 triangles, one core of a cloud machine) 7.4 million
//! from an eye and 3.1 million towards a sky, with two children to a node 6.8 and 1.8; embree, in f32, 14.2 and 7.3. A slower build of the
//! tree gains nothing, and leaves of one face instead of three lose a seventh.

use crate::index::FaceId;
use crate::mesh::TriMesh;
use glam::{DVec3, Vec3A, Vec3Swizzles};
use obvhs::{BvhBuildParams, aabb::Aabb, cwbvh::CwBvh, cwbvh::builder::build_cwbvh, ray::Ray};
use std::time::Duration;

/// Where a ray meets a face: `origin + t * direction`, `t > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub face: FaceId,
    pub t: f64,
}

/// A mesh ready for rays. Deterministic: the same mesh gives the same answers whatever the thread count.
pub struct Bvh {
    tree: CwBvh,
    /// In the order of the tree's leaves, with their faces.
    triangles: Vec<[DVec3; 3]>,
    faces: Vec<FaceId>,
    /// A ball around the mesh, a little wide.
    centre: DVec3,
    radius: f64,
}

/// How much wider than its mesh a tree's ball is.
const WIDE: f64 = 1.01;

/// Parameter at which the tree's ray begins before the true one: the tree passes by boxes that end within 1e-4 of its beginning.
const BEFORE: f64 = 2e-4;

impl Bvh {
    pub fn new(mesh: &TriMesh) -> Self {
        let corners = FaceId::all(mesh.faces.len()).map(|f| mesh.corners(f));
        let (lo, hi) = mesh.bounds().unwrap_or_default();
        let pad = 1e-6 * ((hi - lo).length() + hi.abs().max(lo.abs()).length());
        let boxes: Vec<Aabb> = corners.map(|t| padded_box(&t, pad)).collect();
        let tree = build_cwbvh(
            &boxes,
            BvhBuildParams::fast_build(),
            &mut Duration::default(),
        );
        let faces: Vec<FaceId> = tree.primitive_indices.iter().map(|i| FaceId(*i)).collect();
        Self {
            triangles: faces.iter().map(|f| mesh.corners(*f)).collect(),
            faces,
            tree,
            centre: (lo + hi) / 2.0,
            radius: WIDE * ((hi - lo).length() / 2.0 + pad),
        }
    }

    /// The ray from where it may first meet the mesh, and the parameter there.
    fn near_ray(&self, origin: DVec3, direction: DVec3) -> (Ray, f64) {
        let along = (self.centre - origin).dot(direction) - self.radius * direction.length();
        let start = (along / direction.length_squared()).max(-BEFORE);
        let origin = origin + start * direction;
        let ray = Ray::new_inf(
            Vec3A::from(origin.as_vec3()),
            // The tree takes the sign of an inverse for that of its direction: they differ at -0.
            Vec3A::from(direction.as_vec3()) + Vec3A::ZERO,
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
            let hit = woop.hit(&self.triangles[slot]);
            let face = self.faces[slot];
            let Some(t) = hit.filter(|_| accept(face)) else {
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
                let hit = woop.hit(&self.triangles[slot]);
                hits.extend(hit.map(|t| Hit {
                    face: self.faces[slot],
                    t,
                }));
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
            let hit = woop.hit(&self.triangles[slot]);
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

/// A ray in the sheared frame of the watertight test: its direction is the largest axis. The test's sign is that of the axes' order and
/// nobody asks for it, so that there are three orders.
struct WoopRay {
    origin: DVec3,
    largest: LargestAxis,
    shear: DVec3,
}

/// The largest axis of a direction.
enum LargestAxis {
    X,
    Y,
    Z,
}

impl WoopRay {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let (largest, [x, y, z]) = match direction.abs().max_position() {
            0 => (LargestAxis::X, direction.yzx().to_array()),
            1 => (LargestAxis::Y, direction.zxy().to_array()),
            _ => (LargestAxis::Z, direction.to_array()),
        };
        Self {
            origin,
            largest,
            shear: DVec3::new(x / z, y / z, 1.0 / z),
        }
    }

    #[inline]
    fn hit(&self, [a, b, c]: &[DVec3; 3]) -> Option<f64> {
        // Axes by a branch that is the same for a whole ray: indexing by them would go through memory in the innermost loop of all.
        let (a, b, c) = (*a - self.origin, *b - self.origin, *c - self.origin);
        match self.largest {
            LargestAxis::X => self.hit_along_z(a.yzx(), b.yzx(), c.yzx()),
            LargestAxis::Y => self.hit_along_z(a.zxy(), b.zxy(), c.zxy()),
            LargestAxis::Z => self.hit_along_z(a, b, c),
        }
    }

    #[inline]
    fn hit_along_z(&self, a: DVec3, b: DVec3, c: DVec3) -> Option<f64> {
        let (ax, ay) = (a.x - self.shear.x * a.z, a.y - self.shear.y * a.z);
        let (bx, by) = (b.x - self.shear.x * b.z, b.y - self.shear.y * b.z);
        let (cx, cy) = (c.x - self.shear.x * c.z, c.y - self.shear.y * c.z);
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
        let t = (u * a.z + v * b.z + w * c.z) * self.shear.z / det;
        (t > 0.0).then_some(t)
    }
}
