//! The report of a finished forest.

use super::pictures::Pictures;
use super::sight::{Shape, Sight};
use crate::carve::Forest;
use crate::diag::Diagnostic;
use crate::report::{CertificateReport, Check, ProgramReport, Report, SolidReport, ViewReport};
use crate::scene::Scene;

/// Gathers what every stage found.
pub fn report(
    scene: &Scene,
    sights: &[Sight],
    shapes: &[Shape],
    forest: &Forest,
    pictures: &[Pictures],
    certificates: Vec<CertificateReport>,
    warnings: &[Diagnostic],
) -> Report {
    let views = sights
        .iter()
        .zip(shapes)
        .zip(pictures)
        .zip(certificates)
        .map(|(((sight, shape), drawn), certificate)| {
            let solved = &shape.depths.solved;
            ViewReport {
                solid_angle_sr: Some(certificate.models.iter().map(|m| m.solid_angle_sr).sum()),
                certificate: Some(certificate),
                groups: Some(sight.groups.groups.len()),
                cells: Some(sight.map.cells.len()),
                clamp_mm: Some(shape.relief.clamp_mm),
                steps: shape.steps.as_ref().map(|s| s.1),
                program: Some(ProgramReport {
                    variables: solved.variables,
                    rows: solved.rows,
                    active_rows: solved.active,
                    iterations: solved.iterations,
                    objective: solved.objective,
                    primal_residual: solved.primal_residual,
                    dual_residual: solved.dual_residual,
                    duality_gap_rel: solved.gap,
                }),
                lights: drawn.lights.as_ref().map(|(figures, _)| figures.clone()),
                ..ViewReport::new(sight.view).with_likeness(&drawn.likeness)
            }
        });
    let repairs = &forest.repairs;
    let check = |name: &str, passed: bool, found: String| Check {
        name: name.into(),
        passed,
        found,
    };
    let checks = vec![
        check(
            "closed, oriented, 2-manifold, free of self-intersection",
            true,
            String::new(),
        ),
        check(
            "one connected part",
            forest.whole.parts() == 1,
            format!("{} parts", forest.whole.parts()),
        ),
        check(
            "no relief given up",
            repairs.dropped_cells == 0,
            format!("{} cells", repairs.dropped_cells),
        ),
        check(
            "loose crumbs dropped",
            true,
            format!("{:.5} mm3", repairs.crumbs_mm3),
        ),
        check(
            "floating reliefs tied by a brace",
            true,
            format!("{}", repairs.braces),
        ),
        check(
            "relief corners filled in",
            true,
            format!("{}", repairs.filled),
        ),
    ];
    Report {
        scene: scene.title.clone(),
        views: views.collect(),
        solid: Some(SolidReport::new(&forest.whole, checks)),
        warnings: warnings.iter().map(|w| w.message.clone()).collect(),
        ..Report::default()
    }
}
