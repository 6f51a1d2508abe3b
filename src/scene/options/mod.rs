//! How a scene is built: energy, steps, relief, printer, output.
//!
//! Each file takes its own fields of the scene and gives the options of the stage that they are for.

pub mod energy;
pub mod printing;
pub mod steps;
pub mod whole;
