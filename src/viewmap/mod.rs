//! The view map: what one eye sees, and on which support, as a planar arrangement of its image.
//!
//! Takes the image plane of an eye, the mesh it is to see and the supports with their ray casters.
//! Gives a triangulation of the image in which every cell lies in one model face (the front-most, or none) and on one
//! support (the first hit, or none), with solid angles. Promises: cells are counter-clockwise, share their points,
//! do not overlap and cover a rectangle around the model; no cell is thinner than [`THINNEST_MM`] at the model's distance
//! except where the triangulation cannot give way. Does *not* promise anything about depth, but knows where a layer lies on a ray, and
//! what it does before facets that the eye looks along ([`steep`]).
//!
//! The edges of every face that is seen at all and the seen parts of the supports' outlines (and edges, where a layer follows
//! their surface, so that every cell lies on one of its planes) are constraints of a
//! constrained Delaunay triangulation (`spade`, split at crossings). Labels come from one ray a cell; a cell that
//! sticks out of the face its ray met proves that a face is missing, which is then found, added, and the map rebuilt.

mod arrange;
mod field;
mod image;
mod map;
mod outline;
mod seen;
mod steep;
mod target;
mod thin;

pub use arrange::GRIDS;
pub use field::SupportField;
pub use image::Image;
pub use map::{Cell, ViewMap, ViewMapError};
pub use seen::{THINNEST_MM, view_map};
pub use target::Target;
