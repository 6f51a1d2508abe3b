//! Reliefs: the optimised surface cut at the view map's lines and scaled back onto its supports.
//!
//! Takes depths and groups. Gives, for every cell of the view map that carries a relief, the depth of its three corners:
//! the model's face there, scaled by `s`, divided by the group's `mu` (never multiplied), clamped to the layer. Because
//! `1/lambda` is affine over a cell, corners inside a flat layer keep the whole cell inside. The largest clamp is reported.
//! Corners that a free vertex has a share in have no layer and stay where the optimum put them, even outside of what a solid
//! over the support can hold.
//! A height field over the view map cannot overlap itself as the eye sees it; `block` makes it a closed solid.

mod block;
mod scaled_back;

pub use block::{Block, block};
pub use scaled_back::{Relief, relief};
