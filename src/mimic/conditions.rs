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

use super::ordering::{Order, Orders};
use super::program::RowKind;
use crate::groups::{Anchor, Groups};

/// A point of the surface and the group whose scale applies to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    pub anchor: Anchor,
    pub group: u32,
}

/// See the module; at least one side is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    pub kind: RowKind,
    pub plus: Option<Side>,
    pub minus: Option<Side>,
    pub limit: f64,
}

impl Condition {
    /// By how much depths break the condition, in log depth; negative inside.
    pub fn excess(&self, s: &[f64], mu: &[f64]) -> f64 {
        let log = |side: Side| (side.anchor.relative_depth(s) / mu[side.group as usize]).ln();
        self.plus.map_or(0.0, log) - self.minus.map_or(0.0, log) - self.limit
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
    pub fn between_groups(&self) -> Option<[u32; 2]> {
        let groups = [self.plus?.group, self.minus?.group];
        (groups[0] != groups[1]).then_some(groups)
    }
}

/// All conditions, and how many of them come first because they are worth a row from the start: bounds that do not follow
/// from others, and the nearest orders.
pub fn all(groups: &Groups, orders: &Orders) -> (Vec<Condition>, usize) {
    let bounds: Vec<Condition> = bounds(groups).collect();
    let conditions: Vec<Condition> = self::orders(&orders.all).collect();
    let (needed, follow) = bounds.split_at(2 * groups.needed);
    let (nearest, others) = conditions.split_at(orders.nearest);
    let first = [needed, nearest].concat();
    let rows = first.len();
    ([&first, follow, others].concat(), rows)
}

/// The conditions of all bounds: far and near in turn.
fn bounds(groups: &Groups) -> impl Iterator<Item = Condition> {
    groups.bounds.iter().enumerate().flat_map(|(i, bound)| {
        let side = Some(Side {
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
        [far, near]
    })
}

fn orders(orders: &[Order]) -> impl Iterator<Item = Condition> {
    orders.iter().enumerate().map(|(i, order)| Condition {
        kind: RowKind::Order(i as u32),
        plus: Some(Side {
            anchor: order.front,
            group: order.front_group,
        }),
        minus: Some(Side {
            anchor: order.back,
            group: order.back_group,
        }),
        limit: -order.ratio.ln(),
    })
}

/// The tangent of `ln tau` at the depths `s`, as `sum of coefficient * x + constant`: its coefficients have the sum 1.
pub fn log_tangent(anchor: &Anchor, s: &[f64]) -> (Vec<(usize, f64)>, f64) {
    let tau = anchor.relative_depth(s);
    let terms: Vec<(usize, f64)> = anchor.terms().map(|(v, w)| (v, w * tau / s[v])).collect();
    let at: f64 = terms.iter().map(|(v, p)| p * s[*v].ln()).sum();
    (terms, tau.ln() - at)
}

/// The tangent of `tau` at the depths `s`, as `sum of coefficient * s`: it passes through 0.
pub fn plain_tangent(anchor: &Anchor, s: &[f64]) -> Vec<(usize, f64)> {
    let tau = anchor.relative_depth(s);
    let terms = anchor.terms();
    terms
        .map(|(v, w)| (v, w * (tau / s[v]) * (tau / s[v])))
        .collect()
}
