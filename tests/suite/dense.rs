//! Dense rays from an eye by rasterising triangles: slow to be exact, quick to be dense, and nothing of the program in it.

use glam::{DVec2, DVec3};
use pillarforest::index::FaceId;
use pillarforest::mesh::TriMesh;
use pillarforest::support::{Datum, Support, SupportKind};

/// Triangles nearer to the eye's plane than this are cut there, millimetres.
const NEAR: f64 = 1e-3;

/// A square raster of rays; a ray is `eye + depth * direction(q)`, and `depth` runs along `forward`.
pub(crate) struct Raster {
    pub eye: DVec3,
    frame: [DVec3; 3],
    pub side: usize,
    corner: DVec2,
    step: DVec2,
}

/// First hit of each ray: its depth (infinite without) and whose triangle it was.
#[derive(Clone)]
pub(crate) struct Hits {
    pub depth: Vec<f64>,
    pub owner: Vec<u32>,
}

impl Raster {
    /// `side` x `side` rays over everything of a mesh; none lies on its outermost points.
    pub(crate) fn over(eye: DVec3, look_at: DVec3, mesh: &TriMesh, side: usize) -> Self {
        let forward = (look_at - eye).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let mut raster = Self {
            eye,
            frame: [right, right.cross(forward), forward],
            side,
            corner: DVec2::ZERO,
            step: DVec2::ONE,
        };
        let images = mesh.vertices.iter().map(|v| {
            let p = raster.turned(*v);
            p.truncate() / p.z
        });
        let (lo, hi) = images.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), q| {
            (lo.min(q), hi.max(q))
        });
        raster.corner = lo;
        raster.step = (hi - lo) / side as f64;
        raster
    }

    /// Coordinates right, up and forward of the eye.
    fn turned(&self, p: DVec3) -> DVec3 {
        let d = p - self.eye;
        DVec3::from_array(self.frame.map(|axis| axis.dot(d)))
    }

    pub(crate) fn count(&self) -> usize {
        self.side * self.side
    }

    fn image(&self, ray: usize) -> DVec2 {
        let at = DVec2::new((ray % self.side) as f64, (ray / self.side) as f64);
        self.corner + (at + DVec2::new(0.5, 0.5)) * self.step
    }

    pub(crate) fn direction(&self, ray: usize) -> DVec3 {
        let q = self.image(ray);
        let [right, up, forward] = self.frame;
        q.x * right + q.y * up + forward
    }

    /// Solid angle a ray stands for, steradians.
    pub(crate) fn weight(&self, ray: usize) -> f64 {
        self.step.x * self.step.y * (1.0 + self.image(ray).length_squared()).powf(-1.5)
    }

    /// First hits with some meshes, each with an owner.
    pub(crate) fn cast<'a>(&self, meshes: impl IntoIterator<Item = (u32, &'a TriMesh)>) -> Hits {
        let mut hits = self.nothing();
        for (owner, mesh) in meshes {
            for face in FaceId::all(mesh.faces.len()) {
                self.draw_face(mesh, face, owner, &mut hits);
            }
        }
        hits
    }

    /// First hits with the faces of a mesh, each its own owner.
    pub(crate) fn cast_faces(&self, mesh: &TriMesh) -> Hits {
        let mut hits = self.nothing();
        for face in FaceId::all(mesh.faces.len()) {
            self.draw_face(mesh, face, face.0, &mut hits);
        }
        hits
    }

    /// Depth at which a ray meets the plane of a face.
    pub(crate) fn plane_depth(&self, mesh: &TriMesh, face: u32, ray: usize) -> f64 {
        let [a, b, c] = mesh.corners(FaceId(face));
        let normal = (b - a).cross(c - a);
        normal.dot(a - self.eye) / normal.dot(self.direction(ray))
    }

    fn nothing(&self) -> Hits {
        Hits {
            depth: vec![f64::INFINITY; self.count()],
            owner: vec![u32::MAX; self.count()],
        }
    }

    fn draw_face(&self, mesh: &TriMesh, face: FaceId, owner: u32, hits: &mut Hits) {
        let front = cut(&mesh.corners(face).map(|p| self.turned(p)));
        for k in 1..front.len().saturating_sub(1) {
            self.draw([front[0], front[k], front[k + 1]], owner, hits);
        }
    }

    fn draw(&self, corners: [DVec3; 3], owner: u32, hits: &mut Hits) {
        let [a, b, c] = corners.map(|p| p.truncate() / p.z);
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            return;
        }
        let place = |q: DVec2| (q - self.corner) / self.step - 0.5;
        let lo = place(a.min(b).min(c)).ceil().max(DVec2::ZERO);
        let hi = place(a.max(b).max(c)).floor();
        let last = hi.min(DVec2::splat(self.side as f64 - 1.0));
        if lo.x > last.x || lo.y > last.y {
            return;
        }
        let inverse = corners.map(|p| 1.0 / p.z);
        for row in lo.y as usize..=last.y as usize {
            for column in lo.x as usize..=last.x as usize {
                let ray = row * self.side + column;
                let q = self.image(ray);
                let beta = [
                    (b - q).perp_dot(c - q) / area,
                    (c - q).perp_dot(a - q) / area,
                    (a - q).perp_dot(b - q) / area,
                ];
                if beta.iter().any(|x| *x < 0.0) {
                    continue;
                }
                let depth = 1.0 / (0..3).map(|k| beta[k] * inverse[k]).sum::<f64>();
                if depth < hits.depth[ray] {
                    (hits.depth[ray], hits.owner[ray]) = (depth, owner);
                }
            }
        }
    }
}

/// The part of a triangle in front of the eye, as a polygon.
fn cut(corners: &[DVec3; 3]) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(4);
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        if p.z >= NEAR {
            kept.push(p);
        }
        if (p.z >= NEAR) != (q.z >= NEAR) {
            kept.push(p.lerp(q, (NEAR - p.z) / (q.z - p.z)));
        }
    }
    kept
}

/// Depths a layer allows on a ray, from the language's own words: a slab about the upright plane through the axis that faces
/// the eye, or the surface scaled about the eye. `None` for what carries nothing.
pub(crate) fn allowed(
    support: &Support,
    eye: DVec3,
    direction: DVec3,
    surface: f64,
) -> Option<(f64, f64)> {
    let layer = support.layer?;
    let SupportKind::Pillar { axis, .. } = support.kind else {
        return None;
    };
    let way = axis - eye.truncate();
    let distance = way.length();
    let speed = direction.truncate().dot(way / distance);
    Some(match layer.datum() {
        Datum::Plane => (
            (distance - layer.front) / speed,
            (distance + layer.back()) / speed,
        ),
        Datum::Surface => (
            surface * (1.0 - layer.front / distance),
            surface * (1.0 + layer.back() / distance),
        ),
    })
}
