//! The report of a finished forest.

use super::Built;
use super::certificates::Certificates;
use super::pictures::Pictures;
use crate::diag::Diagnostic;
use crate::mimic::{Method, Solved};
use crate::report::{Check, ProgramReport, Report, SolidReport, ViewReport};

/// Gathers what every stage found; gives back what of the models does not reach its viewer.
pub fn report(
    built: &Built,
    pictures: &[Pictures],
    certificates: Certificates,
) -> (Report, Vec<Diagnostic>) {
    let stages = built.sights.iter().zip(built.shapes);
    let results = pictures.iter().zip(certificates.views);
    let views = stages
        .zip(results)
        .map(|((sight, shape), (drawn, certificate))| ViewReport {
            solid_angle_sr: Some(certificate.models.iter().map(|m| m.solid_angle_sr).sum()),
            certificate: Some(certificate),
            groups: Some(sight.groups.groups.len()),
            cells: Some(sight.image.map.cells.len()),
            steps: shape.steps().map(|s| *s.1),
            program: Some(program(&shape.depths().solved)),
            iterated: shape.depths().iterated.clone(),
            lights: drawn.lights.as_ref().map(|(figures, _)| figures.clone()),
            ..ViewReport::new(sight.image.view).with_likeness(&drawn.likeness)
        });
    let forest = &built.forest;
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
    let report = Report {
        scene: built.scene.title.clone(),
        views: views.collect(),
        solid: Some(SolidReport::new(&forest.whole, checks)),
        camouflage: certificates.camouflage,
        print: certificates.print,
        ..Report::default()
    };
    (report, certificates.unseen)
}

fn program(solved: &Solved) -> ProgramReport {
    ProgramReport {
        variables: solved.variables,
        rows: solved.rows,
        blocks: solved.blocks,
        method: match solved.method {
            Method::InteriorPoint => "interior point",
            Method::DualWorkingSet => "dual working set",
        },
        active_rows: solved.optimality.active,
        iterations: solved.iterations,
        objective: solved.optimality.objective,
        objective_first: solved.objective_first,
        rounds: solved.rounds,
        rows_added: solved.added,
        gauge: solved.gauge,
    }
}
