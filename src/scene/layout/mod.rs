//! Pillars that a program finds: what is wanted of them, and layout files, which hold those that were found.

pub mod aims;
pub mod auto;
pub mod included;
pub mod laid;
pub mod region;
