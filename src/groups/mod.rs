//! Depth groups and depth bounds: which parts of the image may move on their own, and how far.
//!
//! Takes a view map, its target and the supports. Gives the groups (connected image regions of one part of a support and one mesh
//! component, each with a scale `mu_g` of its own, paper Eq 11) and for every point where the map's lines meet inside a group
//! the relative depths `s = lambda / lambda0` allowed there. Because `1/lambda` is affine on a face and on a plane, bounds at
//! all corners of all cells bound the relief everywhere: a layer is flat, or follows a surface that is flat in every cell.
//! Points that any free vertex has a share in have no bounds.

mod anchor;
mod bounds;
mod found;
mod group;

pub use anchor::{Anchor, anchor, vertex_anchor};
pub use found::{ThinSupport, groups, with_bounds, without};
pub(crate) use group::Carried;
pub use group::{Bound, Group, Groups};
