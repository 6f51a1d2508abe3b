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
mod dual;
mod gradient;
mod lazily;
mod normal;
mod ordering;
mod program;
mod sheets;
mod solve;

pub use certificate::{Optimality, optimality};
pub use conditions::Condition;
pub use curvature::{Ending, Iterated, Round};
pub use dual::Dual;
pub use ordering::{Order, Orders, TOGETHER_MM, orders};
pub use program::{Program, Row, RowKind};
pub use sheets::sheet_orders;
pub use solve::{Method, Solution, SolveError, Solved, solve};

use crate::groups::Groups;
use crate::viewmap::{Target, ViewMap};

/// What is minimised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Energy {
    /// Normals in log depth on the visible sub-mesh.
    Normal(NormalOptions),
    /// The paper's curvature energy (Eq 9 and 13) on the whole mesh.
    Curvature(CurvatureOptions),
    /// None: the model's depth mixed with that of the layer's middle (Cignoni et al. 1997; the baseline of the paper's Fig 10).
    Linear,
    /// None: gradients of depth attenuated and integrated anew (Weyrich et al. 2007; the paper's Fig 11), then as `Linear`.
    Gradient(GradientOptions),
}

impl Energy {
    /// Whether the depth order of the model's parts is kept on every ray, as a promise.
    pub fn ordering(&self) -> bool {
        match self {
            Self::Normal(o) => o.ordering,
            Self::Curvature(o) => o.ordering,
            Self::Linear | Self::Gradient(_) => false,
        }
    }
}

/// How faces count in [`Energy::Normal`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceWeight {
    /// By surface area (paper Eq 2).
    Area,
    /// By the solid angle the eye sees of it.
    SolidAngle,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalOptions {
    pub weight: FaceWeight,
    /// Keep the depth order of sheets that overlap in the image (paper Eq 12).
    pub ordering: bool,
    /// Rounds of reweighting, which gather the error in few faces: each solves again with every face's weight times
    /// `theta / tan^2 theta` of the last solution (iteratively reweighted least squares for the sum of `theta`).
    pub reweight: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureOptions {
    /// Weight `w` of hidden vertices (paper Eq 13), visible ones count 1.
    pub hidden_weight: f64,
    pub ordering: bool,
    /// With the term `lambda_i / lambda0_i` of Eq 7; without it (Fig 5) compressed parts are to have the model's Laplacians.
    pub scale_invariant: bool,
    /// Whether groups have scales `mu` (Eq 11); without them bounds are absolute (Eq 10).
    pub group_scales: bool,
    /// Keep the division by the mean curvature `H0_i` (Eq 7) that Eq 9 cancels (Fig 7).
    pub mean_curvature: bool,
    /// Most rounds with the Laplacian of the deformed surface (Eq 6, Fig 6); only if scale invariant.
    pub iterate: u32,
    pub form: CurvatureForm,
}

impl CurvatureOptions {
    /// As the paper's results are made: Eq 13 with the weights of Fig 9, orders of Eq 12.
    pub const PAPER: Self = Self {
        hidden_weight: 0.1,
        ordering: true,
        scale_invariant: true,
        group_scales: true,
        mean_curvature: false,
        iterate: 0,
        form: CurvatureForm::Quadratic,
    };
}

/// In what form the curvature energy's program is solved; the optimum is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvatureForm {
    /// As a quadratic program (Eq 14).
    Quadratic,
    /// With a second-order cone (appendix, Eq 17), which the paper's solver found faster.
    Conic,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientOptions {
    /// `alpha` of Weyrich's attenuation `log(1 + alpha g) / alpha` of slopes `g`; 0 leaves them as they are.
    pub compression: f64,
}

/// The optimised depths of one view.
#[derive(Clone, Debug)]
pub struct Depths {
    /// Relative depth of every target vertex; 1 where the vertex takes no part.
    pub s: Vec<f64>,
    /// Scale of every group; positive.
    pub mu: Vec<f64>,
    pub solved: Solved,
    /// How an iteration of the Laplacian went, if there was one.
    pub iterated: Option<Iterated>,
}

/// How far apart sheets of a whole mesh are to stay, millimetres: a thousand times what f32 resolves at 100 mm, and far below what
/// is printed.
const SHEETS_APART_MM: f64 = 0.01;

/// Finds the depths that minimise `energy` within the groups' bounds.
///
/// # Errors
/// If the program is infeasible or the solver gives up; the error names the row that stands in the way.
pub fn depths(
    energy: Energy,
    target: &Target,
    map: &ViewMap,
    groups: &Groups,
) -> Result<Depths, SolveError> {
    let orders = match (energy.ordering(), groups.whole) {
        (true, true) => sheet_orders(target, SHEETS_APART_MM),
        (true, false) => orders(target, map, groups),
        (false, _) => Orders::default(),
    };
    let conditions = conditions::all(groups, &orders);
    let found = match energy {
        Energy::Normal(options) => normal::depths(options, target, map, groups, &conditions, None),
        Energy::Curvature(options) => curvature::depths(options, target, map, groups, &conditions),
        Energy::Linear => {
            let shape = vec![1.0; target.mesh.vertices.len()];
            compress::compressed(&shape, target, groups, compress::LINEAR)
        }
        Energy::Gradient(options) => gradient::depths(options, target, map, groups),
    }?;
    Ok(if groups.whole {
        found.scaled_back()
    } else {
        found
    })
}

impl Depths {
    /// The same with the scale of the only group applied: a whole mesh has no others.
    fn scaled_back(self) -> Self {
        let mu = self.mu.first().copied().unwrap_or(1.0);
        Self {
            s: self.s.iter().map(|s| s / mu).collect(),
            mu: vec![1.0; self.mu.len()],
            ..self
        }
    }
}

/// A step between two vertices of a cut mesh that stand on one ray: `least <= x_far - x_near <= most`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    pub near: u32,
    pub far: u32,
    pub least: f64,
    pub most: f64,
}

/// Two points of a cut mesh on one ray that stay together although they share no vertices: weights of vertices, of which
/// the weighted sum of `x` is to vanish.
pub type Tie = Vec<(u32, f64)>;

/// What a cut mesh brings along: a surface near the optimum, and the steps to keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Log relief depth over the model's of every vertex; pieces that are free stay near it.
    pub start: Vec<f64>,
    /// Force on every vertex, positive away from the eye, relative to the mean diagonal of the quadratic form.
    pub push: Vec<f64>,
    pub steps: Vec<Step>,
    pub ties: Vec<Tie>,
    /// Factor of every face's weight.
    pub counts: Vec<f64>,
}

/// [`depths`] of a mesh cut at the outlines of supports, under [`Energy::Normal`]. Every piece has its own scale then, so that
/// those of the groups are 1.
///
/// # Errors
/// As [`depths`].
pub fn opened_depths(
    options: NormalOptions,
    target: &Target,
    map: &ViewMap,
    groups: &Groups,
    orders: &[Order],
    opening: &Opening,
) -> Result<Depths, SolveError> {
    let orders = Orders {
        all: orders.to_vec(),
        nearest: orders.len(),
    };
    let conditions = conditions::all(groups, &orders);
    normal::depths(options, target, map, groups, &conditions, Some(opening))
}

/// The solid angle seen of every face, steradians.
fn seen_solid_angles(target: &Target, map: &ViewMap) -> Vec<f64> {
    let mut seen = vec![0.0; target.mesh.faces.len()];
    for (c, cell) in map.cells.iter().enumerate() {
        if let Some(f) = cell.face {
            seen[f as usize] += map.solid_angle(c);
        }
    }
    seen
}

/// Of a whole mesh that only its outline holds, whose bounds are a tenth of a millimetre wide, the unit is a few millimetres all the
/// same.
const LEAST_UNIT: f64 = 0.01;

/// The median width of the bounds in log depth: the unit of all unknowns, so that the solver's tolerances mean the same in
/// every scene.
fn typical_width(groups: &Groups) -> f64 {
    let widths = groups.bounds.iter().map(|b| (b.upper / b.lower).ln());
    let mut widths: Vec<f64> = widths.filter(|w| w.is_finite()).collect();
    widths.sort_by(f64::total_cmp);
    let least = if groups.whole { LEAST_UNIT } else { 0.0 };
    widths
        .get(widths.len() / 2)
        .copied()
        .filter(|w| *w > 0.0)
        .map_or(1.0, |w| w.max(least))
}

/// The smallest scale that keeps a group within its upper bounds (the paper's choice among equal optima: as close to the
/// support as the layer allows), in closed form because a regulariser does not determine it to the last digits. Groups that
/// an order ties to another keep the scale `free` of the solution.
fn scales(
    groups: &Groups,
    conditions: &[Condition],
    s: &[f64],
    free: impl Fn(u32) -> f64,
) -> Vec<f64> {
    let mut mu = vec![f64::MIN_POSITIVE; groups.groups.len()];
    for bound in &groups.bounds {
        let slot = &mut mu[bound.group as usize];
        *slot = slot.max(bound.anchor.relative_depth(s) / bound.upper);
    }
    // A group of free vertices only has nothing to be scaled to.
    let unbounded = mu.iter_mut().filter(|mu| **mu == f64::MIN_POSITIVE);
    unbounded.for_each(|mu| *mu = 1.0);
    let tied = conditions.iter().filter_map(Condition::between_groups);
    tied.flatten().for_each(|g| mu[g as usize] = free(g));
    mu
}
