//! Contests settled before solving, and what every viewer is promised afterwards.

use super::built::Built;
use super::elsewhere::{camouflages, confirmed_tolerance};
use super::print::print_checks;
use super::sight::Sight;
use crate::certify::camouflage::Camouflage;
use crate::certify::conflicts::{Finished, sighted};
use crate::certify::layer::{bound_violation_mm, order_inversions, reach_mm, whole_violation_mm};
use crate::certify::printability::PrintCheck;
use crate::contest::{Claim, Contest, contested, settle};
use crate::diag::Diagnostic;
use crate::mimic::{Optimality, Solved};
use crate::report::{CertificateReport, ModelShare, Proof};
use crate::scene::Scene;
use crate::viewmap::SupportField;
use crate::words::{self, carrier::carrier};
use glam::DVec3;
use rayon::prelude::*;

/// Contests of the views, and what is left in conflict after settling them.
pub struct Settled {
    contests: Vec<Vec<Contest>>,
    left_arcmin2: Vec<f64>,
}

/// Gives contested surface to one owner each.
///
/// # Errors
/// If the scene wants contests to be errors, or a view is left without any surface.
pub fn settled(
    scene: &Scene,
    sights: &mut [Sight],
    field: &SupportField,
) -> Result<Settled, Vec<Diagnostic>> {
    let claims: Vec<Claim> = sights.iter().map(Sight::claim).collect();
    let settlement = settle(&claims, field, scene.contested)?;
    let contested_whole = sights.iter().zip(&settlement.lost);
    let errors: Vec<Diagnostic> = contested_whole
        .filter(|(sight, lost)| sight.groups.whole && !lost.is_empty())
        .map(|(sight, _)| indivisible(&sight.view.name))
        .collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let unchanged = settlement.lost.iter().all(Vec::is_empty);
    let lost = sights.iter_mut().zip(settlement.lost);
    let errors: Vec<Diagnostic> = lost
        .filter_map(|(sight, lost)| sight.give_up(lost, field).err())
        .collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let left_arcmin2 = if unchanged {
        vec![0.0; sights.len()]
    } else {
        let claims: Vec<Claim> = sights.iter().map(Sight::claim).collect();
        contested(&claims, field)
    };
    Ok(Settled {
        contests: settlement.contests,
        left_arcmin2,
    })
}

fn indivisible(view: &str) -> Diagnostic {
    Diagnostic::error(format!(
        "view \"{view}\" would have to give up surface to another view, but its meshes stay whole"
    ))
    .help("move supports or models of different views apart, or `relief: HeightField`")
}

/// What is promised of a finished forest.
pub struct Certificates {
    pub views: Vec<CertificateReport>,
    pub camouflage: Vec<Camouflage>,
    pub print: Vec<PrintCheck>,
    /// What of the models does not reach its viewer, in words.
    pub unseen: Vec<Diagnostic>,
}

/// The certificates of a finished forest, of which `pieces` go on the bed one by one, if it is to come in pieces.
pub fn certificates(built: &Built, settled: &Settled, pieces: &[(String, DVec3)]) -> Certificates {
    let names = built.scene.views.iter().map(|v| v.name.as_str()).collect();
    let finished = Finished::new(&built.forest, &built.bvh, built.field, names);
    let (views, unseen): (Vec<_>, Vec<_>) = (0..built.sights.len())
        .into_par_iter()
        .map(|v| certificate(built, settled, v, &finished))
        .unzip();
    Certificates {
        views,
        camouflage: camouflages(built),
        print: print_checks(built, pieces),
        unseen: unseen.concat(),
    }
}

/// The certificate of one view, and warnings of what does not reach it.
fn certificate(
    built: &Built,
    settled: &Settled,
    v: usize,
    finished: &Finished,
) -> (CertificateReport, Vec<Diagnostic>) {
    let (sight, shape) = (&built.sights[v], &built.shapes[v]);
    let (relief, given_up) = (&shape.relief, &built.forest.given_up[v]);
    let coverage = sight.coverage(built.scene, built.field, given_up);
    let sighted = sighted(&sight.seen(), v, relief, given_up, finished);
    let turned = order_inversions(&sight.map, &sight.target, relief);
    let whole = coverage.solid_angle_sr();
    let share = |lost: f64, of: f64| if of > 0.0 { lost / of } else { 0.0 };
    let models = coverage.models.iter().zip(&sighted.lost_sr);
    let (name, carrier) = (&sight.view.name, carrier(&built.scene.supports));
    let mut unseen = words::coverage::warnings(name, &coverage, carrier);
    unseen.extend(words::conflicts::warnings(name, &sighted, carrier));
    let (front, back) = reach_mm(&sight.map, built.field, &sight.groups, relief);
    let certificate = CertificateReport {
        relief_front_mm: front,
        relief_back_mm: back,
        bound_violation_mm: if sight.groups.whole {
            whole_violation_mm(&sight.target, sight.view.eye, &sight.groups, &shape.depths)
        } else {
            bound_violation_mm(&sight.map, built.field, &sight.groups, relief)
        },
        clamp_mm: relief.clamp_mm,
        order_inversions: match shape.crossings.filter(|_| sight.groups.whole) {
            Some(crossings) => crossings.order_inversions,
            None => turned + shape.depths.solved.broken,
        },
        crossings: shape.crossings,
        proof: proof(&shape.depths.solved),
        not_an_optimum: shape.depths.solved.not_an_optimum.map(str::to_owned),
        coverage: coverage.share(),
        reaching: coverage.share() - share(sighted.lost_sr.iter().sum(), whole),
        models: models
            .map(|(model, lost)| ModelShare {
                name: model.name.clone(),
                solid_angle_sr: model.solid_angle_sr,
                coverage: share(model.carried_sr, model.solid_angle_sr),
                reaching: share(model.carried_sr - lost, model.solid_angle_sr),
            })
            .collect(),
        gaps: coverage.gaps,
        small_gaps: coverage.small_gaps,
        small_gaps_arcmin2: coverage.small_gaps_arcmin2,
        contests: settled.contests[v].clone(),
        contested_left_arcmin2: settled.left_arcmin2[v],
        conflicts: sighted.disturbances,
        small_conflicts_arcmin2: sighted.small_arcmin2,
        filled_arcmin2: sighted.filled_arcmin2,
        rays: sighted.rays,
        tolerance: confirmed_tolerance(built, sight, relief),
    };
    (certificate, unseen)
}

/// What proves that depths are an optimum, if they are meant to be one.
fn proof(solved: &Solved) -> Option<Proof> {
    let Optimality {
        gap,
        primal_residual,
        dual_residual,
        ..
    } = solved.optimality;
    solved.not_an_optimum.is_none().then_some(Proof {
        duality_gap_rel: gap,
        primal_residual,
        dual_residual,
    })
}
