//! Kinds of relief: height fields, torn surfaces, whole meshes.
//!
//! Takes a view's [`Sight`](crate::sight::Sight). Gives it with the kind's bounds ([`ReliefKind::held`]) and afterwards what the kind
//! makes of it, as [`Optimised`]: depths, its way to a solid, its certificate. One file a kind; nothing else asks which it is.

mod crossings;
mod height_field;
mod hold;
mod kind;
mod optimised;
mod torn;
mod whole;

pub use crossings::{Crossings, crossings, moved};
pub use height_field::{HeightField, height_field_depths, height_field_program};
pub use hold::{Bounded, MustBeCut};
pub use kind::ReliefKind;
pub use optimised::Optimised;
pub use torn::TornSurface;
pub use whole::WholeMesh;
