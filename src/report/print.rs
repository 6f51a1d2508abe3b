//! What the report tells of printing: every check as measured, with its meaning in words.

use crate::certify::printability::PrintCheck;
use serde::{Deserialize, Serialize};

/// A question about printing and its answer; lengths in millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PrintReport {
    /// `wall`, `gap`, `overhang`, `slenderness`, `bed`, `part`, `cavity` or `core`.
    pub check: String,
    /// Where the value was measured.
    pub place: [f64; 3],
    pub value_mm: f64,
    /// What prints without loss.
    pub wanted_mm: f64,
    /// What fails.
    pub limit_mm: f64,
    /// Whether the value is on the right side of the limit.
    pub ok: bool,
    /// Extent and meaning, for people.
    pub note: String,
}

impl PrintReport {
    /// A check with its `note`.
    pub fn new(found: &PrintCheck, note: String) -> Self {
        Self {
            check: found.finding.name().to_owned(),
            place: found.place,
            value_mm: found.value_mm,
            wanted_mm: found.wanted_mm,
            limit_mm: found.limit_mm,
            ok: found.ok,
            note,
        }
    }
}
