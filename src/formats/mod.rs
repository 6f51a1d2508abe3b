//! Files of meshes (placeholder until the real readers are merged).
mod read;
pub use read::{Inspection, inspect, read_mesh};
