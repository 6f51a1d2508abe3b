//! Steps: the surface torn along lines that its eye cannot see.
//!
//! A step along the eye's rays is invisible from the eye. So the surface of one view may be torn into copies of parts of the
//! model, each at its own depth in the layer, and the normals stay right however thin the layer is.
//!
//! Takes a target with its view map and groups. Gives the same surface as a cut mesh ([`Torn`]): the target, map, groups and
//! depths that the later stages know, with a vertex for every bundle of face corners that stay together. Promises: bounds hold
//! at every corner of every cell as before, also at torn corners; sheets keep the model's depth order wherever they meet in the
//! image, to 0.02 mm; at every vertex of a tear the step is zero or at least [`StepLimits::least_mm`], and at most what the limits
//! say.
//!
//! # The problem
//!
//! Patches `i` are the parts of faces seen on one group, `y_i` the log of the relief's depth over the model's at a patch's
//! three corners, `omega_i` its seen area, `theta_i` the angle it is turned by (`tan theta_i = h_i |grad y_i|`, see
//! [`mimic`](crate::mimic)). Seams `e` are lines of length `l_e` in the image along which two patches of one support meet,
//! `[y]_e` the jump of `y` across one. Wanted, over all `y` that need not be continuous anywhere:
//!
//! ```text
//! min  sum over i of omega_i tan^2 theta_i / (1 degree)^2
//!    + sum over e of c_e l_e (p [ [y]_e != 0 ] + p/2 |[y]_e| / W)
//! s.t. lower <= y <= upper        at every corner of every cell (the layer),
//!      y_front - y_back <= gap    along contours, where the model itself is `gap` deep in log depth,
//!      |[y]_e| <= highest         (height of steps, tolerance of the eye)
//!      [y]_e >= 0 or <= 0        where the side in front would be a knife
//! ```
//!
//! A piece that falls off steeply from a tear and stands before the other side would be a knife: at its edge, and for
//! millimetres behind it, thinner than what prints. Along such seams one direction of the jump is not allowed.
//!
//! Here with the price `p` of a millimetre of tear, a rebate `1 - c_e` of up to a half along creases and `W` the layer's width: the
//! functional of Mumford & Shah (1989) with hard bounds. Outlines of supports and contours of the model cost nothing: the
//! relief steps there anyway, so that supports do not depend on each other.
//!
//! # The method
//!
//! 1. *Fusion moves* (Lempitsky et al. 2010; alpha expansion, Boykov et al. 2001): a constant level is proposed to all
//!    patches that the layer allows it for (drawn in to the layer at its rim); which of them take it is a minimum cut, because
//!    the cost of a jump is a metric. No other choice of patches lowers the functional more. Levels are swept until none
//!    helps. Constants suffice: in a layer much thinner than the model, tears are decided by where it leaves the layer, and
//!    tilting saves little. The sweeps begin with the model pressed into the layer, not with the layer's middle, where sheets
//!    that meet along contours are in each other's way.
//! 2. Strips between tears too narrow for the printer go to a neighbour (`thin`).
//! 3. The mesh is cut along the tears and [`mimic`](crate::mimic) solves the exact quadratic program on it, with the height
//!    and direction of every step as rows.
//!
//! Alpha expansion of a metric cost ends within twice the optimum. On 150 small sheets of triangles whose optimum over the
//! same levels is known (tests) the sum of all values was 1 % above it, with a contour across every sheet 5 to 11 %. With a limit
//! to the height of steps the cost is no metric any more: 18 to 20 %, with contours too 22 to 27 %.

mod cut;
mod fusion;
mod lines;
mod min_cut;
mod options;
mod patches;
mod tear;
mod thin;

pub(crate) use options::LIP_MM;

pub use lines::{StepLine, StepSummary};
pub use options::{Prefer, StepLimits, StepOptions, UNSEEN_RAD};
pub use tear::{Torn, torn};
