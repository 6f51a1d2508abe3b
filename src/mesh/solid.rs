//! Bodies that can be printed: the only thing printable formats accept.
//!
//! After this stage there are no holes, no edges of three or four faces, no touching or intersecting faces, no faces
//! without area, no inverted shells, and no coordinates that change when written as f32.

use crate::mesh::defects::{Defect, check, check_parted};
use crate::mesh::resolve::Resolved;
use crate::mesh::shells::ClosedSurface;
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::weld::{drop_unreferenced, rounded_to_f32, weld};
use glam::DVec3;

/// A closed, outward oriented, 2-manifold surface without self-intersections and with positive volume, whose
/// coordinates are exact f32 values in millimetres. It may consist of several parts and have cavities.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    mesh: TriMesh,
    parts: usize,
    cavities: usize,
    volume_mm3: f64,
}

impl Solid {
    /// Rounds the coordinates to f32, joins vertices that are equal then, leaves out vertices that no face uses, and
    /// checks the result. Faces are neither dropped nor turned.
    ///
    /// # Errors
    /// Every defect of the rounded mesh that keeps it from being a solid.
    pub fn new(mesh: TriMesh) -> Result<Self, Vec<Defect>> {
        let mut mesh = weld(&rounded_to_f32(&mesh), 0.0).mesh;
        drop_unreferenced(&mut mesh);
        match check(&mesh) {
            defects if defects.is_empty() => Ok(Self::of_sound(ClosedSurface::new(mesh))),
            defects => Err(defects),
        }
    }

    /// What [`resolved`](crate::mesh::resolved) gave, without hollows that nobody can reach and parts that lie in others. Checked for
    /// all but intersections, of which that just left none.
    ///
    /// # Errors
    /// Every defect that keeps it from being a solid.
    pub fn of_resolved(resolved: Resolved) -> Result<Self, Vec<Defect>> {
        let surface = resolved.surface.without_cavities();
        match check_parted(&surface) {
            defects if defects.is_empty() => Ok(Self::of_sound(surface)),
            defects => Err(defects),
        }
    }

    fn of_sound(surface: ClosedSurface) -> Self {
        let shells = surface.shells;
        let parts = shells.iter().filter(|s| s.volume > 0.0).count();
        Self {
            mesh: surface.mesh,
            parts,
            cavities: shells.len() - parts,
            volume_mm3: shells.iter().map(|s| s.volume).sum(),
        }
    }

    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// Cubic millimetres, cavities taken off.
    pub fn volume_mm3(&self) -> f64 {
        self.volume_mm3
    }

    /// Square millimetres, cavities included.
    pub fn area_mm2(&self) -> f64 {
        self.mesh.area()
    }

    /// Pieces that would come apart.
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// Hollows without a way out.
    pub fn cavities(&self) -> usize {
        self.cavities
    }

    /// Smallest and largest corner, millimetres.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.mesh.bounds().unwrap_or_default()
    }
}
