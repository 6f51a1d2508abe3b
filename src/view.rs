//! What one eye is to see.

use crate::geom::ImagePlane;
use crate::mesh::{Original, TriMesh};
use glam::{DMat4, DVec3};
use std::sync::Arc;

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
    /// What its file has; `None` for a model that comes from no file.
    pub original: Option<Arc<Original>>,
    /// What the scene says of its vertices.
    pub marks: Arc<Marks>,
}

impl PlacedModel {
    /// Its file, and how much of it is left if it was simplified.
    pub fn source(&self) -> String {
        let original = self.original.as_ref();
        match original.and_then(|o| o.lowered_from.as_ref()) {
            Some(from) => {
                let (left, all) = (self.mesh.faces.len(), from.mesh.faces.len());
                format!("{}; made from {left} of its {all} faces", self.file)
            }
            None => self.file.clone(),
        }
    }
}

/// What a scene says of the vertices of a mesh: each list is empty (nothing is said) or has an entry for every vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Factor on the vertex weight `w` of paper Eq 13; positive.
    pub weights: Vec<f64>,
    /// Whether the vertex has no depth bounds; in a mesh that stays whole none but the far side of its support.
    pub free: Vec<bool>,
}

impl Marks {
    /// The marks of several meshes appended, of which each has so many vertices.
    pub fn together<'a>(parts: impl Iterator<Item = (&'a Marks, usize)> + Clone) -> Self {
        fn joined<'a, T: Copy + 'a>(
            parts: impl Iterator<Item = (&'a [T], usize)> + Clone,
            nothing: T,
        ) -> Vec<T> {
            let mut all = Vec::new();
            if parts.clone().all(|(list, _)| list.is_empty()) {
                return all;
            }
            for (list, count) in parts {
                all.extend_from_slice(list);
                all.resize(all.len() + count - list.len(), nothing);
            }
            all
        }
        Self {
            weights: joined(parts.clone().map(|(m, n)| (&m.weights[..], n)), 1.0),
            free: joined(parts.map(|(m, n)| (&m.free[..], n)), false),
        }
    }
}

/// An eye and the models it is to see.
#[derive(Clone, Debug)]
pub struct View {
    /// Unique, usable as a file name.
    pub name: String,
    pub eye: DVec3,
    pub look_at: DVec3,
    /// Whether the eye stands for one at infinity, whose rays are parallel; then it is [`FAR_MM`](crate::geom::FAR_MM) away.
    pub orthographic: bool,
    pub models: Vec<PlacedModel>,
    /// sRGB.
    pub colour: [u8; 3],
}

impl View {
    /// The projection of its eye.
    pub fn plane(&self) -> ImagePlane {
        if self.orthographic {
            ImagePlane::from_afar(self.eye, self.look_at)
        } else {
            ImagePlane::looking_at(self.eye, self.look_at)
        }
    }

    /// Unit vector towards the eye.
    pub fn from(&self) -> DVec3 {
        (self.eye - self.look_at).normalize_or_zero()
    }

    /// All models as one mesh, in place.
    pub fn target(&self) -> TriMesh {
        let mut all = TriMesh::default();
        self.models.iter().for_each(|m| all.append(&m.mesh));
        all
    }

    /// The same with the models that were simplified as they were before: what pictures are to be compared with.
    pub fn whole_target(&self) -> TriMesh {
        let mut all = TriMesh::default();
        for model in &self.models {
            let original = model.original.as_ref();
            match original.and_then(|o| o.lowered_from.as_ref()) {
                Some(from) => all.append(&from.mesh.transformed(model.matrix)),
                None => all.append(&model.mesh),
            }
        }
        all
    }

    /// The marks of [`View::target`]'s vertices.
    pub fn marks(&self) -> Marks {
        let parts = self.models.iter();
        Marks::together(parts.map(|m| (&*m.marks, m.mesh.vertices.len())))
    }
}
