//! What holds of a layout and what does not: coverage, conflicts, gaps, eye tolerance, exactly and in plan.
//!
//! Takes subjects and pillars. Gives every fault with its size in millimetres, so that a search can walk towards a layout without
//! faults, and the rates at which cuts open. A layout without faults has, in plan, coverage 1 and conflicts 0: every ray to a
//! model meets a pillar of its own view first, with an overlap behind every cut; no other view's relief stands in it, nor any solid
//! nearer to another than the gap. Vertically, all rays meet their pillars below the top and above the base.

mod all_eyes;
mod eye;
mod fault;
mod offsets;
mod room;

pub use all_eyes::Survey;
pub use fault::{Fault, FaultKind};
pub(crate) use offsets::{Offsets, reach_of};
