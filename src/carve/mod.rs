//! From reliefs to solids: supports are carved along the eyes' rays in front of the reliefs, and everything is united.
//!
//! Takes supports and what every view puts on them ([`Operand`]): the relief over its view map, or a mesh as it is. Gives the whole
//! forest, the bare part (base and pillars) and each view's reliefs as checked solids. Promises: closed, oriented, 2-manifold, free
//! of self-intersection, in f32.
//!
//! Booleans are in f64, and reliefs go into them without corners that their surfaces can spare. Results are rounded to f32 at the end,
//! with all that it takes ([`resolved`](crate::mesh::resolved)): nothing is tried a second time with other numbers. A mesh that is
//! built as it is may cross itself, so it is resolved before.
//!
//! Operands never share a wall. The carving reaches deeper than any relief, to half-way inside the relief's solid backing, and
//! is a hair narrower than the relief where the support goes on beside it (so the relief's edge is bedded in the support) but
//! wider where the support ends or is hidden. What of the support would be left standing beside it in less than a printed line goes
//! too: films between the carving and the support's own sides are what booleans and rounding fail on, and nobody can print them.

pub(crate) mod boolean;
mod brace;
mod forest;
mod hollow;
mod operand;
mod piece;
mod sound;
mod support;
mod unite;

pub use forest::{CarveError, Forest, Repairs};
pub use operand::Operand;
pub(crate) use sound::{CRUMB_MM3, sound};
pub use unite::carve;
