//! What one view adds to the forest.

use crate::index::SupportId;
use crate::mesh::TriMesh;
use crate::relief::Relief;
use crate::sight::Sight;

/// See the module.
pub enum Operand<'a> {
    /// Reliefs over its map, bedded in what is carved out of their supports.
    Relief {
        sight: &'a Sight<'a>,
        relief: &'a Relief,
    },
    /// A closed mesh as it is, united with the one support it stands on. It may cross itself.
    Mesh {
        /// Of its view.
        name: &'a str,
        support: SupportId,
        mesh: &'a TriMesh,
    },
}

impl Operand<'_> {
    /// Of its view.
    pub fn name(&self) -> &str {
        match self {
            Self::Relief { sight, .. } => sight.name(),
            Self::Mesh { name, .. } => name,
        }
    }
}
