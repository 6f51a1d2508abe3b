//! What a scene's supports are called.

use crate::diag::Diagnostic;
use crate::support::Support;

pub(super) const PILLAR: &str = "pillar";

/// "pillar" in a forest of pillars, "support" where anything else carries reliefs too.
pub fn carrier(supports: &[Support]) -> &'static str {
    match supports.iter().any(Support::is_body) {
        true => "support",
        false => PILLAR,
    }
}

/// The same message with what to type so that a layout is mended: layouts are of pillars.
pub(super) fn or_mended(told: Diagnostic, carrier: &str) -> Diagnostic {
    match carrier {
        PILLAR => told.help(
            "`pillarforest repair` moves, adds and raises listed pillars until every view is whole",
        ),
        _ => told,
    }
}
