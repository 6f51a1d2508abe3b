//! `pillarforest`: scenes of models, eyes and pillars become printable forests.
//!
//! (The crate doc is the architecture; it is completed as stages land.)
#![forbid(unsafe_code)]

pub mod diag;
pub mod geom;
pub mod mesh;
pub mod bvh;
pub mod support;
pub mod view;
pub mod viewmap;
pub mod groups;
pub mod laplacian;
pub mod mimic;
pub mod relief;
pub mod carve;
pub mod formats;
pub mod diagram;
pub mod render;
pub mod report;
pub mod scene;
pub mod compile;
