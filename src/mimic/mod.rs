//! The optimisation: depths along the eye's rays that keep the model's normals within hard bounds.
//!
//! Takes a target, its view map and groups. Gives a relative depth `s` for every vertex of the optimised mesh and a scale `mu`
//! for every group. Promises that `s / mu` obeys every bound and every depth order, at vertices and at points inside faces
//! alike (rows are added until it does, see `conditions`; where the solver fails to, the relief clamps and says by how much),
//! and that the optimum is proved by residuals measured on the result (`certificate`).
//!
//! Symbols (paper): eye `o`; `lambda0` distance of a vertex from the eye in the model, `lambda` in the result;
//! `s = lambda / lambda0` relative depth, `x = ln s`; `mu_g` scale of group `g`, `m_g = ln mu_g`; `w` vertex weights (Eq 13).

mod blocks;
mod certificate;
mod compress;
mod conditions;
mod conic;
mod curvature;
mod depths;
mod dual;
mod energy;
mod factor;
mod gradient;
mod interior;
mod iterated;
mod keeping;
mod lazily;
mod minimise;
mod normal;
mod opening;
mod ordering;
mod program;
mod sheets;
mod solve;
mod solving;
mod weighted;

pub use certificate::{Optimality, optimality};
pub use conditions::Condition;
pub use depths::Depths;
pub use dual::Dual;
pub use energy::{
    CurvatureForm, CurvatureOptions, Energy, FaceWeight, GradientOptions, NormalOptions,
};
pub use interior::Interior;
pub use iterated::{Ending, Iterated, Round};
pub use keeping::{FirstRows, Keeping, TakingPart};
pub use minimise::{depths, opened_depths, program_of};
pub use opening::{Opening, Step, Tie};
pub use ordering::{Order, Orders, TOGETHER_MM, orders};
pub use program::{Program, Row, RowKind};
pub use sheets::{sheet_orders, turned_sheets};
pub use solve::{Method, Solution, SolveError, Solved, SolvedBlock};
pub use solving::{solve, solve_by};
