//! Contests: surface that two views want, and reliefs that would stand in each other's sight lines.
//!
//! Takes every view's map and groups. Gives the cells that are in conflict, settles each conflict by a rule, and tells which
//! cells each view loses. Promises: of the cells that are kept no two are in conflict. Bare supports that stand before others
//! are no matter of this stage: the view map knows them.
//!
//! # What is tested
//!
//! Before depths are known, a relief on cell `b` of view B may lie anywhere between the near side of its layer and the solid
//! backing: a frustum of B's rays. View A sees its cell `a` if the rays from its eye through `a` are free down to the deepest
//! place its relief may have: a pyramid. The two are in conflict if pyramid and frustum share more than a contact, one way or
//! the other; both are convex, so a separating axis decides. Two views that want the same surface are a special case: each
//! volume stands in the other's sight. Over a flat layer this is exact; over a curved one each cell counts with its nearest and
//! its farthest depth.

mod claims;
mod frustum;
mod settle;

pub use frustum::{CONTACT_MM, Frustum};
pub use settle::{Contest, Contested, Dispute, Settlement, contested, settle};
