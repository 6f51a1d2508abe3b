//! What a scene's supports are called.

use crate::support::Support;

/// "pillar" in a forest of pillars, "support" where anything else carries reliefs too.
pub fn carrier(supports: &[Support]) -> &'static str {
    match supports.iter().any(Support::is_body) {
        true => "support",
        false => "pillar",
    }
}
