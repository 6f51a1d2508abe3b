//! The report of a finished forest.

use super::built::Built;
use super::certificates::Certificates;
use super::pictures::Pictures;
use crate::ladder::{Ladder, short};
use crate::mimic::{Method, Solved};
use crate::report::{
    CertificateReport, PrintReport, ProgramReport, Report, SolidReport, ViewReport,
};
use crate::words::{self, carrier::carrier};

/// Gathers what every stage found; `split` are the ladders of a forest in pieces.
pub(crate) fn report(
    built: &Built,
    pictures: &[Pictures],
    certificates: Certificates,
    split: Vec<Ladder>,
) -> Report {
    let carrier = carrier(&built.scene.supports);
    let print = certificates.print.iter();
    Report {
        scene: built.scene.title.clone(),
        views: views(built, pictures, certificates.views),
        solid: Some(SolidReport::of_forest(&built.forest)),
        camouflage: certificates.camouflage,
        print: print
            .map(|c| PrintReport::new(c, words::print::note(c, carrier)))
            .collect(),
        ladders: short(ladders(built, split)),
        ..Report::default()
    }
}

/// The ladders of view maps, and of a forest in pieces.
fn ladders(built: &Built, split: Vec<Ladder>) -> Vec<Ladder> {
    let maps = built.sights.iter().map(|s| s.image.ladder());
    maps.chain(split).collect()
}

fn views(
    built: &Built,
    pictures: &[Pictures],
    certificates: Vec<CertificateReport>,
) -> Vec<ViewReport> {
    let stages = built.sights.iter().zip(&built.shapes);
    let results = pictures.iter().zip(certificates);
    stages
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
        })
        .collect()
}

fn program(solved: &Solved) -> ProgramReport {
    ProgramReport {
        variables: solved.variables,
        rows: solved.rows,
        blocks: solved.blocks,
        method: match solved.method {
            Method::InteriorPoint => "interior point",
            Method::DualWorkingSet => "dual working set",
            Method::WarmInterior => "interior point on the normal equations",
        }
        .to_owned(),
        active_rows: solved.optimality.active,
        iterations: solved.iterations,
        objective: solved.optimality.objective,
        objective_first: solved.objective_first,
        rounds: solved.rounds,
        rows_added: solved.added,
        gauge: solved.gauge.to_owned(),
    }
}
