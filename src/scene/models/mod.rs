//! Models: where they stand, which of their vertices are special, and how many of them there are.

pub mod detail;
pub mod marks;
pub mod placing;
