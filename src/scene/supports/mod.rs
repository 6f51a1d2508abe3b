//! What carries reliefs: pillars on a base, and bodies; with their depth layers.
//!
//! Takes the scene's `pillars`, `base`, `supports` and `depth`; gives [`Support`](crate::support::Support)s.
//!
//! `pillars` puts entries up at their `places`, with `cross_section`s and `depths`; `bases` is the base under them; `standing` is what
//! both are until they become solids. `bodies` are all other supports, one file a form. `shapes` are outlines in plan.

pub(crate) mod bases;
pub(crate) mod bodies;
pub(crate) mod cross_section;
pub(crate) mod depths;
pub(crate) mod pillars;
mod places;
pub(crate) mod shapes;
mod standing;

pub(crate) use places::Spot;
pub(crate) use standing::{BasePlate, Standing};
