//! The scene language: what may be written ([`raw`]), what it means ([`schema`]), and texts in it.

pub mod quality;
pub mod raw;
pub mod schema;
pub mod template;
mod units;
