//! The scene language: what may be written ([`raw`]), what that means for people ([`schema`]), and texts in it.

pub mod quality;
pub mod raw;
pub mod schema;
pub mod template;
mod units;
