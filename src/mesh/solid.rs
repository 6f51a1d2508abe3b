//! Closed solids: the only thing that printable formats accept.

use crate::mesh::TriMesh;
use glam::DVec3;

/// What is wrong with a mesh that was to be a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect(pub String);

/// A closed, consistently oriented mesh with positive volume.
#[derive(Clone, Debug)]
pub struct Solid {
    mesh: TriMesh,
}

impl Solid {
    pub fn new(mesh: TriMesh) -> Result<Self, Vec<Defect>> {
        let mut edges: Vec<(u32, u32, bool)> =
            mesh.faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).map(|(a, b)| (a.min(b), a.max(b), a < b)).collect();
        edges.sort_unstable();
        let paired = edges.chunks(2).all(|p| p.len() == 2 && p[0].0 == p[1].0 && p[0].1 == p[1].1 && p[0].2 != p[1].2);
        if paired && mesh.volume() > 0.0 { Ok(Self { mesh }) } else { Err(vec![Defect("not closed".into())]) }
    }

    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    pub fn volume_mm3(&self) -> f64 {
        self.mesh.volume()
    }

    pub fn area_mm2(&self) -> f64 {
        self.mesh.area()
    }

    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.mesh.bounds().unwrap_or_default()
    }
}
