//! What the printable formats are made of.

use crate::mesh::Solid;

/// A solid that becomes an object of its own in a file.
#[derive(Clone, Debug)]
pub struct Part<'a> {
    /// Shown by slicers and viewers; any text.
    pub name: String,
    /// sRGB.
    pub colour: [u8; 3],
    pub solid: &'a Solid,
}
