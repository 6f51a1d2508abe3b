//! What readers give.

use crate::mesh::{Attributes, TriMesh};

/// One body of a file, in place, millimetres if the format says so.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMesh {
    /// Empty where the format has no names.
    pub name: String,
    pub mesh: TriMesh,
    /// Of `mesh`; 3MF and STL have none that are read.
    pub attributes: Attributes,
}
