//! Certificates: what a viewer and a printer are promised, measured on what was built.
//!
//! Each submodule takes results of earlier stages and gives figures with places; none changes what is built, and none
//! speaks to users: [`words`](crate::words) does.

pub mod camouflage;
pub mod conflicts;
pub mod coverage;
pub mod layer;
mod point;
pub mod printability;
pub mod tolerance;

pub use point::without_minus_zero;
