//! Pillars that the program finds: what is wanted of them, and layout files, which hold those that were found.
//!
//! `auto` reads `Auto(...)` into a [`Brief`](crate::planner::Brief), with the numbers of `aims` and the `region` where pillars may
//! stand. `included` reads a layout file, `laid` writes one; both and the scenes made of plans hold numbers as `written`.

mod aims;
mod around;
pub mod auto;
pub mod included;
pub mod laid;
pub mod region;
mod written;

pub use around::Around;
pub use region::Room;
pub use written::as_written;
