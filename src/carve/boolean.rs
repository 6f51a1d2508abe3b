//! Boolean operations on closed meshes: the only module that names `manifold-rust`.

use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};
use manifold_rust::linalg::{Vec2, Vec3};
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64};
use rayon::prelude::*;

/// A solid the library has accepted. Operations keep f64 coordinates.
#[derive(Clone)]
pub struct Boolean(Manifold);

/// What the library says of an operand it refuses.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the boolean library refused a solid: {0}")]
pub struct BooleanError(String);

impl Boolean {
    /// # Errors
    /// If the mesh is not a closed oriented manifold.
    pub fn new(mesh: &TriMesh) -> Result<Self, BooleanError> {
        Self::checked(Manifold::from_mesh_gl64(&MeshGL64 {
            num_prop: 3,
            vert_properties: mesh.vertices.iter().flat_map(DVec3::to_array).collect(),
            tri_verts: mesh
                .faces
                .iter()
                .flatten()
                .map(|v| u64::from(v.0))
                .collect(),
            ..MeshGL64::default()
        }))
    }

    /// A prism over simple rings (outer ones counter-clockwise, holes clockwise) whose points `(x, y)` at height `z` (0 or 1)
    /// are then moved by `place`, which must keep orientation. Empty for no rings.
    pub fn prism(
        rings: &[Vec<[f64; 2]>],
        place: impl Fn(DVec2, f64) -> DVec3,
    ) -> Result<Self, BooleanError> {
        if rings.is_empty() {
            return Ok(Self(Manifold::empty()));
        }
        let polygons = rings
            .iter()
            .map(|ring| ring.iter().map(|p| Vec2::new(p[0], p[1])).collect())
            .collect();
        Self::checked(
            Manifold::extrude(&polygons, 1.0, 0, 0.0, Vec2::new(1.0, 1.0)).warp(|v| {
                let p = place(DVec2::new(v.x, v.y), v.z);
                *v = Vec3::new(p.x, p.y, p.z);
            }),
        )
    }

    /// The convex hull of points.
    pub fn hull(points: &[DVec3]) -> Result<Self, BooleanError> {
        let points: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect();
        Self::checked(Manifold::hull(&points))
    }

    /// The union of all parts, in pairs, pairs of pairs and so on: the order is fixed, whatever the thread count.
    pub fn union(mut parts: Vec<Self>) -> Result<Self, BooleanError> {
        while parts.len() > 1 {
            parts = parts
                .par_chunks(2)
                .map(|pair| {
                    if let [a, b] = pair {
                        a.plus(b)
                    } else {
                        Ok(pair[0].clone())
                    }
                })
                .collect::<Result<_, _>>()?;
        }
        Ok(parts.pop().unwrap_or_else(|| Self(Manifold::empty())))
    }

    pub fn plus(&self, other: &Self) -> Result<Self, BooleanError> {
        Self::checked(self.0.union(&other.0))
    }

    pub fn minus(&self, other: &Self) -> Result<Self, BooleanError> {
        Self::checked(self.0.difference(&other.0))
    }

    /// What both have in common.
    pub fn common(&self, other: &Self) -> Result<Self, BooleanError> {
        Self::checked(self.0.intersection(&other.0))
    }

    /// A box with sides along the axes.
    pub fn cuboid(lo: DVec3, hi: DVec3) -> Result<Self, BooleanError> {
        let ring = vec![[lo.x, lo.y], [hi.x, lo.y], [hi.x, hi.y], [lo.x, hi.y]];
        Self::upright(&[ring], lo.z, hi.z)
    }

    /// A prism over rings as in [`Self::prism`], from `bottom` to `top`.
    pub fn upright(rings: &[Vec<[f64; 2]>], bottom: f64, top: f64) -> Result<Self, BooleanError> {
        Self::prism(rings, |p, z| p.extend(if z < 0.5 { bottom } else { top }))
    }

    pub fn moved(&self, by: DVec3) -> Result<Self, BooleanError> {
        Self::checked(self.0.translate(Vec3::new(by.x, by.y, by.z)))
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Cubic millimetres.
    pub fn volume(&self) -> f64 {
        self.0.volume()
    }

    /// Parts that do not touch, largest first.
    pub fn parts(&self) -> Vec<Self> {
        let mut parts: Vec<Self> = self.0.decompose().into_iter().map(Self).collect();
        parts.sort_by(|a, b| b.volume().total_cmp(&a.volume()));
        parts
    }

    /// Without parts smaller than `limit`; and the volume dropped. Cubic millimetres.
    pub fn without_crumbs(&self, limit: f64) -> (Self, f64) {
        let (crumbs, kept): (Vec<Self>, Vec<Self>) =
            self.parts().into_iter().partition(|p| p.volume() < limit);
        if crumbs.is_empty() {
            return (self.clone(), 0.0);
        }
        let kept: Vec<Manifold> = kept.into_iter().map(|p| p.0).collect();
        (
            Self(Manifold::compose(&kept)),
            crumbs.iter().map(Self::volume).sum(),
        )
    }

    pub fn mesh(&self) -> TriMesh {
        let mesh = self.0.get_mesh_gl64(-1);
        let vertices = (0..mesh.num_vert())
            .map(|v| DVec3::from_array(mesh.get_vert_pos(v)))
            .collect();
        let faces = (0..mesh.num_tri()).map(|t| mesh.get_tri_verts(t).map(|v| v as u32));
        TriMesh::new(vertices, faces)
    }

    fn checked(solid: Manifold) -> Result<Self, BooleanError> {
        match solid.status() {
            Error::NoError => Ok(Self(solid)),
            error => Err(BooleanError(error.to_str().into())),
        }
    }
}
