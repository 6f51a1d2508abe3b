//! A mesh that casts shadows, what rays meet on it, and what suns and skies do there: the light of [`lights`](crate::render::lights),
//! whose symbols these are.

use crate::bvh::Bvh;
use crate::geom::ImagePlane;
use crate::index::FaceId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};

/// Shadow rays start this far off the surface, along its normal and along the ray, millimetres: above what rounding moves a
/// hit (1e-10 mm), below the smallest step anybody prints. Without it facets would shade themselves.
const HAIR_MM: f64 = 1e-3;

/// Brightness in full shadow, and what full light adds.
pub const DARK: f64 = 30.0;
pub const SPAN: f64 = 217.0;

/// The shade that reads as 255: where there is no forest at all.
pub const PAPER: f64 = (255.0 - DARK) / SPAN;

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Meet {
    pub face: FaceId,
    pub place: DVec3,
    /// Unit, of the facet, on the side that the ray meets; zero if it has none.
    pub normal: DVec3,
}

/// What a light does at a place: the shade is `free * open`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Term {
    /// Shade if nothing cast a shadow.
    pub free: f64,
    /// Share of that light that arrives; 1 or 0 for a sun and the flash, 1 where there is no light to be kept off.
    pub open: f64,
}

impl Term {
    pub fn shade(&self) -> f64 {
        self.free * self.open
    }

    pub fn in_cast_shadow(&self) -> bool {
        self.free > 0.0 && self.open == 0.0
    }
}

/// A mesh that casts shadows on itself.
#[derive(Clone, Copy)]
pub struct Caster<'a> {
    pub mesh: &'a TriMesh,
    pub bvh: &'a Bvh,
}

impl<'a> Caster<'a> {
    /// `bvh` is the mesh's.
    pub fn new(mesh: &'a TriMesh, bvh: &'a Bvh) -> Self {
        Self { mesh, bvh }
    }

    /// Where a ray from `eye` meets the mesh first.
    pub fn meet(&self, eye: DVec3, direction: DVec3) -> Option<Meet> {
        let hit = self.bvh.first_hit(eye, direction)?;
        Some(Meet {
            face: hit.face,
            place: eye + hit.t * direction,
            normal: self.mesh.normal_against(hit.face, direction),
        })
    }

    /// The light of a sun in direction `l` (unit).
    pub fn sunlight(&self, meet: &Meet, l: DVec3) -> Term {
        let free = meet.normal.dot(l).max(0.0);
        let open = free == 0.0 || !self.blocked(meet, l, f64::INFINITY);
        Term {
            free,
            open: f64::from(u8::from(open)),
        }
    }

    /// The light of an overcast sky given by [`sky`].
    pub fn skylight(&self, meet: &Meet, sky: &[DVec3]) -> Term {
        let (mut all, mut got) = (0.0, 0.0);
        for w in sky {
            let facing = meet.normal.dot(*w);
            if facing > 0.0 {
                all += facing;
                got += if self.blocked(meet, *w, f64::INFINITY) {
                    0.0
                } else {
                    facing
                };
            }
        }
        Term {
            free: free_skylight(meet.normal),
            open: if all > 0.0 { got / all } else { 1.0 },
        }
    }

    /// `1 - V`, for a direction on the outer side of the facet and a light so far away.
    pub fn blocked(&self, meet: &Meet, w: DVec3, distance: f64) -> bool {
        let origin = meet.place + HAIR_MM * (meet.normal + w);
        self.bvh.blocked(origin, w, distance)
    }
}

/// Unit vector towards the sun that stands `elevation_deg` above the horizon, 45 degrees to the left or to the right of the eye.
pub fn sun(plane: &ImagePlane, elevation_deg: f64, left: bool) -> DVec3 {
    let to_eye = plane.right.cross(DVec3::Z);
    let aside = if left { -plane.right } else { plane.right };
    let level = (to_eye + aside) * std::f64::consts::FRAC_1_SQRT_2;
    let (sin, cos) = elevation_deg.to_radians().sin_cos();
    cos * level + sin * DVec3::Z
}

/// `n` directions that stand for equal parts of the upper hemisphere: a spiral by the golden angle, at the middles of zones of
/// equal area.
pub fn sky(n: usize) -> Vec<DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let direction = |k: usize| {
        let z = (k as f64 + 0.5) / n as f64;
        let level = DVec2::from_angle(golden_angle * k as f64) * (1.0 - z * z).sqrt();
        level.extend(z)
    };
    (0..n).map(direction).collect()
}

/// Light of an overcast sky on a surface with nothing around it.
pub fn free_skylight(normal: DVec3) -> f64 {
    (1.0 + normal.z) / 2.0
}
