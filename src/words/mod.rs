//! What stages found, in words: the only place that turns the typed findings of geometry into messages for users.
//!
//! Takes what a stage returned. Gives [`Diagnostic`](crate::diag::Diagnostic)s: what was found, what was wanted, where, what to type.
//! One file for each stage that has something to tell. Whoever reads scene text words what is wrong with it there, at its place.

pub mod carrier;
pub mod conflicts;
pub mod contest;
pub mod coverage;
pub mod effort;
pub mod gate;
pub mod iterated;
pub mod ladders;
pub mod likeness;
pub mod planner;
pub mod print;
pub mod sight;
pub mod solids;
pub mod split;
