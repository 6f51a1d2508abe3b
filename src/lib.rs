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
pub mod mimic;
pub mod formats;
pub mod scene;
pub mod compile;
