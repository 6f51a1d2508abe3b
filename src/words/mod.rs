//! What stages found, in words: the only place that turns the typed findings of geometry into messages for users.
//!
//! Takes what a stage returned. Gives [`Diagnostic`](crate::diag::Diagnostic)s: what was found, what was wanted, where, what to type.
//! One file for each stage that has something to tell. Whoever reads scene text words what is wrong with it there, at its place.

pub mod planner;
