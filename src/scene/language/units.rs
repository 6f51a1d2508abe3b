//! Units of length.

use super::raw::RawUnit;

impl RawUnit {
    /// Millimetres per unit, and its name.
    pub(crate) fn measure(self) -> (f64, &'static str) {
        match self {
            Self::mm => (1.0, "mm"),
            Self::cm => (10.0, "cm"),
            Self::m => (1000.0, "m"),
            Self::inch => (25.4, "inch"),
        }
    }
}
