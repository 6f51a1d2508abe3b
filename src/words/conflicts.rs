//! What rays found amiss at the finished forest, in words.

use super::carrier::or_mended;
use crate::certify::conflicts::{Disturbance, Sighted, Trouble};
use crate::diag::Diagnostic;

/// Warnings of what is listed. `carrier` is what [supports are called](super::carrier::carrier).
pub fn warnings(view: &str, found: &Sighted, carrier: &str) -> Vec<Diagnostic> {
    let told = |d: &Disturbance| {
        let support = d.support.as_deref().unwrap_or("nothing known");
        let [x, y, z] = d.place_mm;
        let what = match (d.trouble, &d.with_view) {
            (Trouble::Missing, _) => format!("misses its relief on {support}"),
            (_, Some(other)) => {
                format!("has the relief of view \"{other}\" on {support} before its own")
            }
            (_, None) => format!("has {support} before its relief"),
        };
        let told = Diagnostic::warning(format!(
            "view \"{view}\" {what} over {:.1} square arc-minutes, mostly near ({x:.1}, {y:.1}, {z:.1}) mm",
            d.arcmin2
        ))
        .help(format!("move {carrier}s apart there, or make their layers thinner"));
        or_mended(told, carrier)
    };
    found.disturbances.iter().map(told).collect()
}
