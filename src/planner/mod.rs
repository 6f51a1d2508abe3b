//! The planner: from models and eyes to pillars.
//!
//! Takes views and a [`Brief`]; gives a layout in which every ray of every eye to its models meets a pillar of its own first and
//! nothing stands in its way, or says which limit binds. Deterministic for a seed and a number of tries, whatever the thread count.

mod brief;
mod contours;
pub mod convex;
mod finish;
mod forecast;
mod limits;
mod moves;
mod plan;
mod planned;
mod posing;
mod repair;
mod search;
mod skyline;
mod start;
mod subject;
mod survey;
mod task;
mod watch;

pub use brief::{Adjustment, Brief, Care, Freedom, Matters, Pillar, Plates, Region, Shape};
pub use limits::{NoLayout, Remedies};
pub use plan::plan;
pub use planned::{Change, Ended, Frame, Planned, Trade, Worth};
pub use posing::{foot, posed};
pub use repair::repair;
pub use skyline::Skyline;
pub use start::{Clash, Start, Stuck, start};
pub use subject::Subject;
pub use survey::{Fault, FaultKind, Survey};
pub use watch::Watch;
