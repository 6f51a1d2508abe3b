//! Files: reading meshes from people's files, and writing ours.
//!
//! Writers take solids and give bytes; they touch no file and no clock, and the same input gives the same bytes.
//! Printable formats take a [`crate::mesh::Solid`], so a mesh with a hole cannot be exported by mistake; only a
//! [`crate::surface::Surface`], which is for other programs, may have any.

mod colours;
mod columns;
mod glb;
pub mod inspect;
pub mod markup;
pub mod read;
mod read_3mf;
mod read_obj;
mod read_ply;
mod read_stl;
mod stl;
mod surface;
mod text;
mod threemf;
mod xml_3mf;

pub use glb::{Camera, Lens, write_glb};
pub use inspect::{Inspection, inspect};
pub use read::{Model, load_model, load_original, read_mesh};
pub use stl::write_stl;
pub use surface::{write_surface_obj, write_surface_ply};
pub use threemf::{Metadata, ZipTime, write_3mf};

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
