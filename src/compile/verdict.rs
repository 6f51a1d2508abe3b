//! The verdict: what of all that a build promises does not hold.

use crate::certify::printability::PrintCheck;
use crate::diag::Diagnostic;
use crate::report::{CertificateReport, NOTHING_MM, OPTIMAL, Report};
use crate::scene::Scene;

/// Everything that does not hold, besides what of the models does not reach its viewer (`unseen`).
pub fn failures(scene: &Scene, report: &Report, unseen: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let promised = [
        scene.relief.energy().ordering(),
        scene.relief.keeps_sheets_apart(),
    ];
    let mut failures: Vec<Diagnostic> = unseen.into_iter().map(Diagnostic::into_error).collect();
    for view in &report.views {
        if let Some(certificate) = &view.certificate {
            of_view(&view.name, certificate, promised, &mut failures);
        }
    }
    if let Some(solid) = report.solid.as_ref().filter(|s| s.parts > 1) {
        failures.push(
            Diagnostic::error(format!(
                "the forest comes apart into {} pieces",
                solid.parts
            ))
            .help("a pillar that stands outside the base, or no base at all, leaves pieces loose"),
        );
    }
    failures.extend(report.print.iter().filter(|c| !c.ok).map(print_failure));
    failures
}

fn print_failure(check: &PrintCheck) -> Diagnostic {
    let PrintCheck {
        check: name,
        place: [x, y, z],
        value_mm,
        limit_mm,
        ..
    } = check;
    let text = format!(
        "print check `{name}`: {value_mm:.2} mm at ({x:.1}, {y:.1}, {z:.1}) mm, and the limit is {limit_mm:.2} mm"
    );
    let failure = Diagnostic::error(text);
    if check.note.is_empty() {
        failure
    } else {
        failure.help(check.note.clone())
    }
}

fn of_view(
    name: &str,
    found: &CertificateReport,
    [ordered, sheets_apart]: [bool; 2],
    failures: &mut Vec<Diagnostic>,
) {
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
        !sheets_apart || crossing == 0,
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
        "move pillars of different views apart",
    );
}
