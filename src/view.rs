//! What one eye is to see.

use crate::mesh::TriMesh;
use glam::{DMat4, DVec3};

/// A model where it stands for one view.
#[derive(Clone, Debug)]
pub struct PlacedModel {
    /// The scene's name of the model, and its file as the scene writes it.
    pub name: String,
    pub file: String,
    /// From the file's coordinates to millimetres.
    pub matrix: DMat4,
    /// In place, millimetres.
    pub mesh: TriMesh,
}

/// An eye and the models it is to see.
#[derive(Clone, Debug)]
pub struct View {
    /// Unique, usable as a file name.
    pub name: String,
    pub eye: DVec3,
    pub look_at: DVec3,
    pub models: Vec<PlacedModel>,
    /// sRGB.
    pub colour: [u8; 3],
}

impl View {
    /// All models as one mesh, in place.
    pub fn target(&self) -> TriMesh {
        let mut all = TriMesh::default();
        self.models.iter().for_each(|m| all.append(&m.mesh));
        all
    }
}
