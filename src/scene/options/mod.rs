//! How a scene is built: energy, steps, relief, printer, output.

pub mod energy;
pub mod whole;
