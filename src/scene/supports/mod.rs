//! What carries reliefs: pillars on a base, and bodies; with their depth layers.
//!
//! Takes the scene's `pillars`, `base`, `supports` and `depth`; gives [`Support`](crate::support::Support)s.
//!
//! `pillars` puts entries up at their `places`, with `cross_section`s and `depths`; `bases` is the base under them; `standing` is what
//! both are until they become solids. `bodies` are all other supports, one file a form. `shapes` are outlines in plan.

pub mod bases;
pub mod bodies;
pub mod cross_section;
pub mod depths;
pub mod pillars;
mod places;
pub mod shapes;
mod standing;

pub use places::Spot;
pub use standing::{BasePlate, Standing};
