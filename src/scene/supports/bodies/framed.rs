//! Closed meshes in a frame of their own: x to the right, y up, z out of the face, the origin in the middle of the face's lower edge.

use crate::mesh::TriMesh;
use crate::scene::language::raw::RawDepth;
use crate::scene::supports::shapes;
use crate::scene::text::Field;
use glam::{DMat4, DVec2, DVec3};

/// A mesh in a frame of its own, and what is said of it.
pub(crate) struct FramedMesh<'a> {
    pub name: String,
    pub mesh: TriMesh,
    pub frame: DMat4,
    /// Whether its face is the plane z = 0 of the frame.
    pub flat: bool,
    /// Radians: edges sharper than this part its surface, if any do.
    pub crease: Option<f64>,
    pub depth: &'a Field<RawDepth>,
}

impl<'a> FramedMesh<'a> {
    /// Neither flat nor in parts.
    pub(crate) fn plain(
        name: String,
        mesh: TriMesh,
        frame: DMat4,
        depth: &'a Field<RawDepth>,
    ) -> Self {
        Self {
            name,
            mesh,
            frame,
            flat: false,
            crease: None,
            depth,
        }
    }
}

/// A prism over an outline in (x, z), counter-clockwise seen from above, from y = 0 to `height`.
pub(crate) fn upright(outline: &[DVec2], height: f64) -> TriMesh {
    // Seen from above, x to the right and z towards the viewer are left-handed.
    let mut mirrored: Vec<DVec2> = outline
        .iter()
        .rev()
        .map(|p| DVec2::new(p.x, -p.y))
        .collect();
    mirrored.dedup();
    let standing = shapes::prism(&mirrored, 0.0, height);
    moved(&standing, |p| DVec3::new(p.x, p.z, -p.y))
}

/// The mesh with every vertex moved.
pub(crate) fn moved(mesh: &TriMesh, by: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh {
        vertices: mesh.vertices.iter().map(|p| by(*p)).collect(),
        faces: mesh.faces.clone(),
    }
}
