//! What of the models nothing carries, in words.

use super::carrier::or_mended;
use crate::certify::coverage::{Cause, CauseShare, Coverage, Gap};
use crate::diag::Diagnostic;

/// Smaller shares of the models would be told as 0.00 %.
const LEAST_SHARE: f64 = 0.5e-4;

/// What is worth telling of a view's gaps: one warning for each cause. `carrier` is what [supports are
/// called](super::carrier::carrier).
pub fn warnings(view: &str, found: &Coverage, carrier: &str) -> Vec<Diagnostic> {
    let causes = found.by_cause();
    let told = causes.iter().filter(|c| c.share >= LEAST_SHARE);
    told.map(|c| warning(view, c, carrier)).collect()
}

/// The warning of all gaps of one cause, with the largest.
fn warning(view: &str, cause: &CauseShare, carrier: &str) -> Diagnostic {
    let gap = cause.largest;
    let (reason, help) = reason_and_help(gap, carrier);
    let told = Diagnostic::warning(format!(
        "view \"{view}\" misses {:.2} % of its models, mostly {}: {reason}",
        100.0 * cause.share,
        beside_sight(gap.right_deg, gap.up_deg),
    ))
    .help(help);
    match gap.cause {
        Cause::Infeasible => told,
        _ => or_mended(told, carrier),
    }
}

/// A direction by its angles, degrees, right of and above an eye's line of sight.
pub(super) fn beside_sight(right: f64, up: f64) -> String {
    let side = |angle: f64, less: &str, more: &str| {
        format!(
            "{:.1} degrees {}",
            angle.abs(),
            if angle < 0.0 { less } else { more }
        )
    };
    format!(
        "{} and {} its line of sight",
        side(right, "left of", "right of"),
        side(up, "below", "above")
    )
}

fn reason_and_help(gap: &Gap, carrier: &str) -> (String, String) {
    let support = gap.support.as_deref().unwrap_or_default();
    match gap.cause {
        Cause::NoPillar => (
            format!("no {carrier} stands there"),
            format!("add a {carrier} there, or move the models"),
        ),
        Cause::PillarTooShort => (
            format!(
                "{support} is too short by {:.2} mm",
                gap.wanted_mm.unwrap_or(0.0)
            ),
            format!("raise {support} (`height`), or lower the models"),
        ),
        Cause::OtherView => (
            format!(
                "view \"{}\" needs {support}",
                gap.view.as_deref().unwrap_or_default()
            ),
            format!(
                "move {carrier}s or models apart; `contested` says who gets what two views want"
            ),
        ),
        Cause::Hidden => (
            format!("it meets {support}, which carries nothing for it"),
            format!("put a {carrier} before it, or move the models"),
        ),
        Cause::Infeasible => (
            format!("no sound relief could be made on {support}"),
            "thicker layers (`front`, `back`) make it easier".to_owned(),
        ),
    }
}
