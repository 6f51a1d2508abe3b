//! How a scene is built: energy, steps, relief, printer, output.
//!
//! Each file takes its own fields of the scene and gives the options of the stage that they are for.

pub(crate) mod energy;
pub(crate) mod printing;
pub(crate) mod steps;
pub(crate) mod whole;
