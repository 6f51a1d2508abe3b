//! A relief as a closed solid: a height field over part of the view map, with walls along the eye's rays and a flat back.
//!
//! Depths may jump between neighbouring cells (occlusion contours, components): such steps become walls, unseen by the eye.
//! Two things would make the solid non-manifold, and are changed by filling in material, never by removing it:
//! around a point the depths must fall to one valley and rise again (else a wall edge would have four faces), and two sheets
//! must not swap order along a side (else a wall would cross itself). A region that touches itself in one point is pulled
//! apart there by a hundredth of a millimetre.

mod apart;
mod cells;
mod fill;
mod made;
mod walls;

pub use made::{Block, block};
