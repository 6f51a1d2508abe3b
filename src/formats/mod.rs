//! Files: reading meshes from people's files, and writing ours.
//!
//! Writers take solids and give bytes; they touch no file and no clock, and the same input gives the same bytes.
//! Printable formats take a [`crate::mesh::Solid`], so a mesh with a hole cannot be exported by mistake; only a
//! [`crate::surface::Surface`], which is for other programs, may have any.

#![warn(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

mod body;
mod channels;
mod colours;
mod flaws;
mod glb;
pub mod markup;
mod mesh_format;
mod narrow;
mod obj_check;
mod part;
mod read;
mod read_3mf;
mod read_obj;
mod read_off;
mod read_ply;
mod read_stl;
mod read_stl_text;
mod slicer_3mf;
mod sniff;
mod stl;
mod surface;
mod text;
mod threemf;
mod xml_3mf;

pub use body::NamedMesh;
pub use glb::{Camera, Lens, write_glb};
pub use mesh_format::MeshFormat;
pub use part::Part;
pub use read::{read_as_one, read_bodies, read_mesh};
pub use stl::write_stl;
pub use surface::{write_surface_obj, write_surface_ply};
pub use threemf::{Metadata, ZipTime, write_3mf};
