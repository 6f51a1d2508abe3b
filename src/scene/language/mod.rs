//! The scene language: what may be written ([`raw`]), what that means for people ([`schema`]), and texts in it.

pub(crate) mod quality;
pub(crate) mod raw;
pub(crate) mod schema;
pub(crate) mod starter;
pub(crate) mod template;
mod units;
