//! Files: reading meshes from people's files, and (printable formats, pictures of the result) writing ours.

pub mod inspect;
pub mod read;
mod read_3mf;
mod read_obj;
mod read_ply;
mod read_stl;
mod text;
mod xml_3mf;

pub use inspect::{Inspection, inspect};
pub use read::{load_model, read_mesh};
