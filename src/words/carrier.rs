//! What a scene's supports are called.

use crate::support::Support;

const PILLAR: &str = "pillar";

/// "pillar" in a forest of pillars, "support" where anything else carries reliefs too.
pub fn carrier(supports: &[Support]) -> &'static str {
    match supports.iter().any(Support::is_body) {
        true => "support",
        false => PILLAR,
    }
}

/// What to type so that a layout is mended: layouts are of pillars.
pub(super) fn mending(carrier: &str) -> Option<&'static str> {
    (carrier == PILLAR).then_some(
        "`pillarforest repair` moves, adds and raises listed pillars until every view is whole",
    )
}
