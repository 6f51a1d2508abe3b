//! Models: which files are shown, where they stand, which of their vertices are special, and how many of them there are.
//!
//! Takes the scene's `models`; gives [`Model`]s, later with what their files hold.
//!
//! `model` is the list, `placing` where a model stands (also for meshes that are supports), `marks` its regions, `detail` how it is
//! made smaller.

mod detail;
mod marks;
mod model;
pub(crate) mod placing;

pub(crate) use model::{Model, load, lower, models};
