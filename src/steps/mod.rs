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
//! ```
//!
//! with the price `p` of a millimetre of tear, a rebate `1 - c_e` of up to a half along creases and `W` the layer's width: the
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
mod patches;
mod thin;

pub use lines::{StepLine, StepSummary};

use crate::groups::{Groups, with_bounds};
use crate::mimic::{Depths, NormalOptions, SolveError, opened_depths};
use crate::viewmap::{SupportField, Target, ViewMap};
use cut::cut;
use fusion::{Field, Functional, Prices, pressed};
use lines::lines;
use patches::{Patch, Patches};
use rayon::prelude::*;

/// An opening that nobody sees, radians: two arc-minutes.
pub const UNSEEN_RAD: f64 = 2.0 / 60.0 * std::f64::consts::PI / 180.0;
/// Rebate along the sharpest creases: they are lines of the model already.
const CREASE_REBATE: f64 = 0.5;
/// How the price grows while there are more tears than wanted, and how often at most: the last is beyond any surface's worth.
const PRICE_GROWTH: f64 = 4.0;
const PRICE_ROUNDS: usize = 12;

/// Where pieces may lie anywhere in a part of the layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefer {
    /// As small steps as possible: the eye may move farther before they open.
    Tolerance,
    /// As large steps as possible: from elsewhere the pieces fit together less.
    Camouflage,
}

/// What every step must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Smallest step, millimetres of depth.
    pub least_mm: f64,
    /// Largest step, millimetres of depth.
    pub highest_mm: Option<f64>,
    /// How far the eye may move sideways before a step opens by more than [`UNSEEN_RAD`], millimetres.
    pub tolerance_mm: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOptions {
    pub limits: StepLimits,
    /// Largest number of tear lines in a view.
    pub most: Option<u32>,
    /// What a millimetre of tear line weighs: square millimetres tilted by one degree.
    pub price: f64,
    /// Strips between tears narrower than this are given to a neighbour, millimetres at the model.
    pub narrowest_mm: f64,
    pub prefer: Prefer,
}

/// A torn surface: the results of the stages before the relief, on the cut mesh.
pub struct Torn {
    pub target: Target,
    pub map: ViewMap,
    pub groups: Groups,
    pub depths: Depths,
    /// The uncut target's vertex at every vertex, and its face at every face.
    pub vertices: Vec<u32>,
    pub faces: Vec<u32>,
    pub lines: Vec<StepLine>,
    pub summary: StepSummary,
}

/// Tears the surface and finds its depths.
///
/// # Errors
/// As [`depths`](crate::mimic::depths).
pub fn torn(
    steps: &StepOptions,
    options: NormalOptions,
    target: &Target,
    map: &ViewMap,
    field: &SupportField,
    groups: &Groups,
) -> Result<Torn, SolveError> {
    let patches = Patches::new(&steps.limits, target, map, field, groups);
    let mut price = steps.price;
    let mut rounds = 0;
    loop {
        let (y, absorbed) = tear(steps, options, price, target, map, &patches);
        let last = rounds == PRICE_ROUNDS;
        rounds += 1;
        price *= PRICE_GROWTH;
        let too_many = |lines: usize| !last && steps.most.is_some_and(|most| lines > most as usize);
        if too_many(lines::count(target, &patches, &y)) {
            continue;
        }
        let cut = cut(target, map, &patches, &y, steps.limits.least_mm);
        let opening = cut.opening(&patches, steps, &absorbed);
        let groups = with_bounds(groups, &cut.map, &cut.target, field);
        let orders = if options.ordering {
            &cut.orders[..]
        } else {
            &[]
        };
        let depths = opened_depths(options, &cut.target, &cut.map, &groups, orders, &opening);
        if !last && matches!(depths, Err(SolveError::Infeasible(_))) {
            // Limits that contradict each other: with fewer tears there are fewer of them.
            continue;
        }
        let depths = depths?;
        let given_away = patches.patches.iter().zip(&absorbed).filter(|(_, a)| **a);
        let absorbed_mm2 = given_away.map(|(p, _)| p.seen_mm2).sum();
        let (lines, summary) = lines(map, target, &patches, &cut.corners, &depths);
        // Solving may open a line that the field's corners did not show.
        if too_many(summary.lines) {
            continue;
        }
        return Ok(Torn {
            lines,
            summary: StepSummary {
                lowest_mm: cut.lowest_mm(&depths),
                absorbed_mm2,
                ..summary
            },
            target: cut.target,
            map: cut.map,
            vertices: cut.vertices,
            faces: patches.patches.iter().map(|p| p.face).collect(),
            groups,
            depths,
        });
    }
}

/// The tears at a price, support by support, and which patches were given away because they were too narrow.
fn tear(
    steps: &StepOptions,
    options: NormalOptions,
    price: f64,
    target: &Target,
    map: &ViewMap,
    patches: &Patches,
) -> (Field, Vec<bool>) {
    let prices = Prices {
        tilt: 1f64.to_radians().powi(-2),
        length: price,
        height: price / 2.0,
        crease: CREASE_REBATE,
        ordered: options.ordering,
    };
    let results: Vec<(Field, Vec<bool>)> = patches
        .by_support()
        .into_par_iter()
        .map(|(range, cells)| {
            let corners = |p: &Patch| target.mesh.faces[p.face as usize];
            let depth = |p: &Patch| corners(p).map(|v| target.depth[v as usize]);
            let mut y = pressed(&patches.patches[range.clone()], depth);
            let functional = Functional::new(patches, prices, range);
            functional.descend(&mut y);
            let narrowest = steps.narrowest_mm;
            let absorbed = thin::absorb_thin(target, map, &functional, &cells, &mut y, narrowest);
            (y, absorbed)
        })
        .collect();
    let (fields, absorbed): (Vec<Field>, Vec<Vec<bool>>) = results.into_iter().unzip();
    (fields.concat(), absorbed.concat())
}
