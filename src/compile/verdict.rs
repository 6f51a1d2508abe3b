//! The verdict: what of all that a build promises does not hold, and what its maker should know.

use super::built::Built;
use super::certificates::Certificates;
use super::pictures::Pictures;
use crate::certify::printability::{PrintCheck, PrintFinding};
use crate::diag::Diagnostic;
use crate::kinds::Crossings;
use crate::report::{CertificateReport, OPTIMAL};
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
    let comes_apart = |c: &PrintCheck| matches!(c.finding, PrintFinding::Part { count: 1.. });
    if certificates.print.iter().any(comes_apart) {
        let parts = built.forest.whole.parts();
        failures.push(
            Diagnostic::error(format!("the forest comes apart into {parts} pieces")).help(format!(
                "a {carrier} that stands outside the base leaves pieces loose"
            )),
        );
    }
    failures.extend(of_making(built, certificates).filter(Diagnostic::is_error));
    failures
}

/// What does not hold and is a matter of the machine, and views that are not what they might be.
pub(crate) fn remarks(
    built: &Built,
    pictures: &[Pictures],
    certificates: &Certificates,
) -> Vec<Diagnostic> {
    let making = of_making(built, certificates).filter(|d| !d.is_error());
    let relief = &built.scene.relief;
    let of_view = |v: usize| {
        let name = &built.scene.views[v].name;
        let summary = built.shapes[v].steps().map(|(_, summary)| *summary);
        let given_up = summary.and_then(|s| words::likeness::tears_given_up(name, &s));
        let mean = pictures[v].likeness.mean_of_hits_deg();
        let far = words::likeness::far_off(name, mean, relief);
        let flat = words::likeness::plateau(name, certificates.views[v].at_limit, relief);
        [given_up, far, flat].into_iter().flatten()
    };
    let views = 0..built.scene.views.len();
    making.chain(views.flat_map(of_view)).collect()
}

fn of_making(built: &Built, certificates: &Certificates) -> impl Iterator<Item = Diagnostic> {
    let scene = built.scene;
    let (carrier, check) = (carrier(&scene.supports), scene.making.way.check());
    let broken = certificates.print.iter().filter(|c| !c.ok);
    broken.map(move |c| words::print::verdict(c, carrier, check))
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
        outside <= found.nothing_mm,
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
    // What crosses in the model is not this program's doing, and is resolved in the solid.
    let made = |c: Crossings| c.self_intersections.saturating_sub(c.in_model);
    let crossing = found.crossings.map_or(0, made);
    fail(
        !scene.relief.keeps_sheets_apart() || crossing == 0,
        format!("its mesh crosses itself at {crossing} more pairs of faces than its models do"),
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
