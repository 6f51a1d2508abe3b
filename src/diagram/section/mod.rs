//! Sections: how groups are scaled, cut open along one plane through the eye (paper Fig 8).
//!
//! Takes what the stages of a view give (of a torn surface: its own target, map, groups and depths), gives the numbers of a section
//! and, by [`sheet`](mod@sheet), a page with three panels. Nothing is drawn but these numbers.
//!
//! # The plane
//!
//! A plane through the eye is a line of its image: its rays lie in it, and over one cell of the view map every depth is a straight
//! line in it, so that both ends of a cell's stretch say all. The line is level or upright and lies where most groups are cut: of
//! [`LINES`] level ones the one that cuts most, of equals the one that cuts most of them; an upright one if it cuts
//! more groups (on stairs, whose treads are level). Groups count from [`LEAST_SHARE`] of the width on.
//!
//! Places in the plane are `(x, y)` in millimetres with the eye in the origin: `x` to the right (of an upright section: up), `y` away
//! from the eye.

mod chains;
mod found;
mod labels;
mod plane;
mod sheet;
mod slice;
mod values;
mod window;

pub use found::{section, torn_section};
pub use plane::SectionPlane;
pub use sheet::groups_sheet;
pub use slice::SlicedOutline;
pub use values::{CutGroup, Laid, Section, Stretch};
