//! What a kind of relief asks of the optimisation besides its bounds.

use super::ordering::Orders;

/// Which faces count in the normal energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TakingPart {
    /// Those that are seen: nothing else is built.
    Seen,
    /// All, hidden ones a little.
    All,
}

/// Which conditions have rows from the start, apart from bounds that follow from no others. All others get rows once they are broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstRows {
    /// The nearest orders too: many of them bind.
    NearestOrders,
    /// No others: where few orders bind and rows between front and back of a mesh are dear. Then the nearest orders are added first.
    BoundsAlone,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Keeping {
    pub faces: TakingPart,
    pub orders: Orders,
    pub first: FirstRows,
    /// The unit of all unknowns in log depth is the bounds' typical width, but no less than this.
    pub least_unit: f64,
}

impl Keeping {
    /// Of a surface of which only what is seen is built.
    pub fn seen(orders: Orders) -> Self {
        Self {
            faces: TakingPart::Seen,
            orders,
            first: FirstRows::NearestOrders,
            least_unit: 0.0,
        }
    }
}
