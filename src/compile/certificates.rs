//! Contests settled before solving, and what every viewer is promised afterwards.

use super::sight::{Shape, Sight};
use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::certify::conflicts::{Finished, Sighted, sighted};
use crate::certify::coverage::{Cause, Coverage};
use crate::contest::{Claim, Contest, contested, settle};
use crate::diag::Diagnostic;
use crate::report::{CertificateReport, ModelShare};
use crate::scene::Scene;
use crate::viewmap::SupportField;
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

/// The certificates of all views, and warnings of what only the finished forest shows.
pub fn certificates(
    scene: &Scene,
    field: &SupportField,
    sights: &[Sight],
    shapes: &[Shape],
    forest: &Forest,
    bvh: &Bvh,
    settled: Settled,
) -> (Vec<CertificateReport>, Vec<Diagnostic>) {
    let names = scene.views.iter().map(|v| v.name.as_str()).collect();
    let finished = Finished::new(forest, bvh, field, names);
    let found: Vec<(Coverage, Sighted)> = sights
        .par_iter()
        .enumerate()
        .map(|(v, sight)| {
            let given_up = &forest.given_up[v];
            let relief = &shapes[v].relief;
            (
                sight.coverage(scene, field, given_up),
                sighted(&sight.seen(), v, relief, given_up, &finished),
            )
        })
        .collect();
    let mut warnings = Vec::new();
    let mut reports = Vec::new();
    let settled = settled.contests.into_iter().zip(settled.left_arcmin2);
    for (((coverage, sighted), (contests, left)), sight) in
        found.into_iter().zip(settled).zip(sights)
    {
        // The other causes were told before solving.
        let mut infeasible = coverage.clone();
        infeasible.gaps.retain(|g| g.cause == Cause::Infeasible);
        warnings.extend(infeasible.warnings(&sight.view.name));
        warnings.extend(sighted.warnings(&sight.view.name));
        reports.push(certificate(coverage, sighted, contests, left));
    }
    (reports, warnings)
}

fn certificate(
    coverage: Coverage,
    sighted: Sighted,
    contests: Vec<Contest>,
    contested_left_arcmin2: f64,
) -> CertificateReport {
    let whole = coverage.solid_angle_sr();
    let share = |lost: f64, of: f64| if of > 0.0 { lost / of } else { 0.0 };
    let models = coverage.models.iter().zip(&sighted.lost_sr);
    CertificateReport {
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
        contests,
        contested_left_arcmin2,
        conflicts: sighted.disturbances,
        small_conflicts_arcmin2: sighted.small_arcmin2,
        filled_arcmin2: sighted.filled_arcmin2,
        rays: sighted.rays,
    }
}
