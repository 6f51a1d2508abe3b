//! The verdict: what of all that a build promises does not hold.

use super::built::Built;
use super::certificates::Certificates;
use crate::diag::Diagnostic;
use crate::report::{CertificateReport, NOTHING_MM, OPTIMAL};
use crate::scene::Scene;
use crate::words::{self, carrier::carrier};

/// Everything that does not hold: of the models, of each view, of the forest as one, and of printing it.
pub(crate) fn failures(built: &Built, certificates: &Certificates) -> Vec<Diagnostic> {
    let scene = built.scene;
    let carrier = carrier(&scene.supports);
    let unseen = certificates.unseen.iter().cloned();
    let mut failures: Vec<Diagnostic> = unseen.map(Diagnostic::into_error).collect();
    for (view, certificate) in scene.views.iter().zip(&certificates.views) {
        of_view(scene, &view.name, certificate, &mut failures);
    }
    let parts = built.forest.whole.parts();
    if parts > 1 {
        failures.push(
            Diagnostic::error(format!("the forest comes apart into {parts} pieces")).help(format!(
                "a {carrier} that stands outside the base, or no base at all, leaves pieces loose"
            )),
        );
    }
    let print = certificates.print.iter().filter(|c| !c.ok);
    failures.extend(print.map(|c| words::print::failure(c, carrier)));
    failures
}

fn of_view(scene: &Scene, name: &str, found: &CertificateReport, failures: &mut Vec<Diagnostic>) {
    let ordered = scene.relief.energy().ordering();
    let mut fail = |holds: bool, text: String, help: &str| {
        if !holds {
            failures.push(Diagnostic::error(format!("view \"{name}\": {text}")).help(help));
        }
    };
    let outside = found.bound_violation_mm.max(found.clamp_mm);
    fail(
        outside <= NOTHING_MM,
        format!("its relief would leave the layer by {outside:.6} mm"),
        "thicker layers (`front`, `back`) leave the solver more room",
    );
    fail(
        !ordered || found.order_inversions == 0,
        format!(
            "farther parts of its models come before nearer ones in {} places",
            found.order_inversions
        ),
        "thicker layers (`front`, `back`) leave the solver more room; `ordering: false` in `energy` allows it",
    );
    let crossing = found.crossings.map_or(0, |c| c.self_intersections);
    fail(
        !scene.relief.keeps_sheets_apart() || crossing == 0,
        format!("its mesh crosses itself at {crossing} pairs of faces"),
        "`check` tells whether the models cross themselves already; finer or rounder meshes leave more room at their silhouettes",
    );
    let gap = found.proof.map_or(0.0, |p| p.worst());
    fail(
        gap <= OPTIMAL,
        format!(
            "its depths are not proved to be the best ones (residual {gap:.1e}, wanted {OPTIMAL:.0e})"
        ),
        "models with needle-thin faces make programs that cannot be solved exactly",
    );
    fail(
        found.contested_left_arcmin2 == 0.0,
        format!(
            "{:.1} square arc-minutes are still contested",
            found.contested_left_arcmin2
        ),
        &format!(
            "move {}s of different views apart",
            carrier(&scene.supports)
        ),
    );
}
