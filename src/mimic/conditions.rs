//! Bounds (paper Eq 11) and depth orders (Eq 12) as they are on every ray, and their tangents.
//!
//! On the ray of an anchor the relative depth is the harmonic mean `tau = 1 / sum of w_k / s_k`: `1/lambda` is affine on a
//! face, not `lambda`. Every condition has the form
//!
//! ```text
//! ln (tau_plus / mu_plus) - ln (tau_minus / mu_minus) <= limit
//! ```
//!
//! with one side missing for bounds. `ln tau` is concave in `x = ln s`, and `tau` is concave and homogeneous in `s`. So a tangent
//! to the `plus` side, wherever it touches, keeps the condition safe; the `minus` side makes a convex set whose tangents only
//! enclose it. Rows begin with tangents at a surface near the result; where the solution still breaks a condition its tangents
//! there are added and the program is solved again, until none is broken (Kelley 1960 for the `minus` side; for the `plus` side
//! the tangents are those of the convex-concave procedure).

use super::keeping::{FirstRows, Keeping};
use super::ordering::Order;
use super::program::RowKind;
use crate::groups::{Anchor, Groups};
use crate::index::{GroupId, VertexId};

/// Orders of sheets that hardly part in the model hold to this share of their limit: less than the gap they keep in the result.
const ORDER_SHARE: f64 = 0.01;

/// A point of the surface and the group whose scale applies to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnGroup {
    pub anchor: Anchor,
    pub group: GroupId,
}

/// See the module; at least one side is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    pub kind: RowKind,
    pub plus: Option<OnGroup>,
    pub minus: Option<OnGroup>,
    pub limit: f64,
}

impl Condition {
    /// By how much depths break the condition, in log depth; negative inside.
    pub fn excess(&self, s: &[f64], mu: &[f64]) -> f64 {
        let log = |side: OnGroup| (side.anchor.relative_depth(s) / mu[side.group]).ln();
        self.plus.map_or(0.0, log) - self.minus.map_or(0.0, log) - self.limit
    }

    /// Whether depths break the condition by more than `tolerance`, or of an order by more than a share of what it allows.
    pub fn is_broken(&self, s: &[f64], mu: &[f64], tolerance: f64) -> bool {
        let tolerance = match self.kind {
            RowKind::Order(_) => tolerance.min(ORDER_SHARE * self.limit),
            _ => tolerance,
        };
        self.excess(s, mu) > tolerance
    }

    /// The same condition, harder by `margin` (log depth), but never by more than half of what an order allows: sheets that
    /// meet have no room for it.
    pub fn tightened(self, margin: f64) -> Self {
        let most = match self.kind {
            RowKind::Order(_) => self.limit / 2.0,
            _ => margin,
        };
        Self {
            limit: self.limit - margin.min(most),
            ..self
        }
    }

    /// The two groups of an order between groups.
    pub fn between_groups(&self) -> Option<[GroupId; 2]> {
        let groups = [self.plus?.group, self.minus?.group];
        (groups[0] != groups[1]).then_some(groups)
    }
}

/// All conditions, and how many of them come first.
#[derive(Clone, Debug)]
pub(crate) struct Conditions {
    pub all: Vec<Condition>,
    /// So many are worth a row from the start, as [`FirstRows`] says.
    pub rows: usize,
    /// So many are looked at before the rest is, while any of them is broken: those of `rows`, and the nearest orders.
    pub urgent: usize,
    /// Rounds of adding rows after which what is left is clamped.
    pub rounds: u32,
}

/// Rounds where the nearest orders have rows from the start: ten were the most so far, of a plate of 80,000 vertices.
const ROUNDS: u32 = 24;
/// Rounds where all orders are added as they break.
const ROUNDS_OF_ORDERS: u32 = 40;

/// See [`Conditions`].
pub(crate) fn all(groups: &Groups, keeping: &Keeping) -> Conditions {
    let bounds = bounds(groups);
    let conditions: Vec<Condition> = orders(&keeping.orders.all).collect();
    let is_first = |c: &Condition| match c.kind {
        RowKind::Near(b) | RowKind::Far(b) => (b as usize) < groups.needed,
        RowKind::Order(_) | RowKind::Step(_) | RowKind::Scale(_) => false,
    };
    let (needed, follow): (Vec<Condition>, Vec<Condition>) = bounds.partition(is_first);
    let (nearest, others) = conditions.split_at(keeping.orders.nearest);
    let first = [&needed, nearest].concat();
    let (rows, urgent, rounds) = match keeping.first {
        FirstRows::NearestOrders => (first.len(), 0, ROUNDS),
        FirstRows::BoundsAlone => (needed.len(), first.len(), ROUNDS_OF_ORDERS),
    };
    Conditions {
        all: [&first, &follow, others].concat(),
        rows,
        urgent,
        rounds,
    }
}

/// The conditions of all bounds: far and near in turn. Those without a near limit have only a far one.
fn bounds(groups: &Groups) -> impl Iterator<Item = Condition> {
    groups.bounds.iter().enumerate().flat_map(|(i, bound)| {
        let side = Some(OnGroup {
            anchor: bound.anchor,
            group: bound.group,
        });
        let far = Condition {
            kind: RowKind::Far(i as u32),
            plus: side,
            minus: None,
            limit: bound.upper.ln(),
        };
        let near = Condition {
            kind: RowKind::Near(i as u32),
            plus: None,
            minus: side,
            limit: -bound.lower.ln(),
        };
        [Some(far), (bound.lower > 0.0).then_some(near)]
            .into_iter()
            .flatten()
    })
}

fn orders(orders: &[Order]) -> impl Iterator<Item = Condition> {
    orders.iter().enumerate().map(|(i, order)| Condition {
        kind: RowKind::Order(i as u32),
        plus: Some(OnGroup {
            anchor: order.front,
            group: order.front_group,
        }),
        minus: Some(OnGroup {
            anchor: order.back,
            group: order.back_group,
        }),
        limit: -order.ratio.ln(),
    })
}

/// The tangent of `ln tau` at the depths `s`, as `sum of coefficient * x + constant`: its coefficients have the sum 1.
pub(crate) fn log_tangent(anchor: &Anchor, s: &[f64]) -> (Vec<(VertexId, f64)>, f64) {
    let tau = anchor.relative_depth(s);
    let terms: Vec<(VertexId, f64)> = anchor.terms().map(|(v, w)| (v, w * tau / s[v])).collect();
    let at: f64 = terms.iter().map(|(v, p)| p * s[*v].ln()).sum();
    (terms, tau.ln() - at)
}

/// The tangent of `tau` at the depths `s`, as `sum of coefficient * s`: it passes through 0.
pub(crate) fn plain_tangent(anchor: &Anchor, s: &[f64]) -> Vec<(VertexId, f64)> {
    let tau = anchor.relative_depth(s);
    let terms = anchor.terms();
    terms
        .map(|(v, w)| (v, w * (tau / s[v]) * (tau / s[v])))
        .collect()
}
