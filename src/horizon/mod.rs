//! Visibility in plan: which obstacle a viewpoint meets first at every bearing.
//!
//! Takes a [`Viewpoint`] (a place, or a direction from infinity), spans of its bearings, and [`Obstacle`]s: footprints that count as
//! endlessly high, known by their position in the caller's list. Gives the [`Horizon`]: the spans cut into [`Run`]s, each on one
//! obstacle or on none, with the angle of every obstacle and the share of all that is covered; and, for a single bearing, where its
//! ray enters what it meets and the outward normal there.
//!
//! The theorem behind it: between neighbouring *tangents*, bearings at which an obstacle begins or ends, the nearest obstacle does
//! not change. So one ray between each two of them tells all of it, exactly: no bearing is sampled, none is missed.
//!
//! Promises: a horizon that was [updated](Horizon::update) is equal, to the bit, to one built anew. Obstacles of zero width and
//! bearings right on a tangent count as neither side's.
//!
//! Does *not* promise: order among obstacles that overlap. Theirs may change between tangents, and the whole stretch then goes to
//! the one that is nearest in its middle. Its ends, and stretches without overlap, stay exact. Bodies that touch do not overlap.
//!
//! *Bearings* are radians from the direction ahead, counter-clockwise from above; of a viewpoint at infinity they are millimetres
//! across its rays, to the left. *Distances* are along rays, from the viewpoint or, at infinity, from the line across the origin: so
//! both are the limits of a far viewpoint's bearings times its distance, and distances less it.

mod live;
mod obstacle;
mod shadow;
mod viewpoint;

pub use live::{Horizon, Run};
pub use obstacle::{Footprint, Impact, Obstacle};
pub use shadow::Shadow;
pub use viewpoint::{Ray, Viewpoint, turn};
