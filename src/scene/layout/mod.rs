//! Pillars that the program finds: what is wanted of them, and layout files, which hold those that were found.
//!
//! `auto` reads `Auto(...)` into a [`Brief`](crate::planner::Brief), with the numbers of `aims` and the `region` where pillars may
//! stand. `included` reads a layout file, `laid` writes one; both and the scenes made of plans hold numbers as `written`.

mod aims;
mod around;
pub(crate) mod auto;
pub(crate) mod included;
pub(crate) mod laid;
pub(crate) mod region;
mod written;

pub(crate) use around::Around;
pub(crate) use region::Room;
pub(crate) use written::as_written;
