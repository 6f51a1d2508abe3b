//! Supports that are no pillars: plates, strips, stairs, grooves, waves and meshes.
//!
//! Takes the scene's `supports`; gives [`Support`](crate::support::Support)s, each a closed mesh with a depth layer.
//!
//! A form of support is one file: its fields become a [`FramedMesh`](framed::FramedMesh) there. `list` asks the file of every entry's
//! form and makes supports of what it gives.

mod entry;
mod framed;
mod grammar;
mod groove;
mod heights;
mod image;
mod list;
mod mesh;
mod plates;
mod stairs;
mod wave;

pub(crate) use list::bodies;
