//! What carries reliefs: pillars on a base, and bodies; with their depth layers.

pub mod bases;
pub mod bodies;
pub mod cross_section;
pub mod depths;
pub mod forms;
pub mod heights;
pub mod pillars;
pub mod places;
pub mod shapes;
