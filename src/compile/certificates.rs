//! Contests settled before solving, and what every viewer is promised afterwards.

use super::built::Built;
use super::elsewhere::{camouflages, confirmed_tolerance};
use super::print::print_checks;
use super::sight::{carried, give_up};
use crate::certify::camouflage::Camouflage;
use crate::certify::conflicts::{Finished, Sharpness, sighted};
use crate::certify::layer::{reach_mm, share_at_limit};
use crate::certify::printability::PrintCheck;
use crate::contest::{Contest, contested, settle};
use crate::diag::Diagnostic;
use crate::geom::nothing_mm;
use crate::index::ViewId;
use crate::mimic::{Optimality, Solved};
use crate::report::{CertificateReport, ModelShare, Proof};
use crate::scene::Scene;
use crate::sight::Sight;
use crate::words::{self, carrier::carrier};
use glam::DVec3;
use rayon::prelude::*;

/// Contests of the views, and what is left in conflict after settling them.
pub(crate) struct Settled {
    contests: Vec<Vec<Contest>>,
    left_arcmin2: Vec<f64>,
}

/// Gives contested surface to one owner each.
///
/// # Errors
/// If the scene wants contests to be errors, or a view is left without any surface.
pub(crate) fn settled<'a>(
    scene: &Scene,
    sights: Vec<Sight<'a>>,
) -> Result<(Vec<Sight<'a>>, Settled), Vec<Diagnostic>> {
    let settlement = settle(&sights, scene.contested).map_err(|refusals| {
        refusals
            .iter()
            .map(words::contest::refused)
            .collect::<Vec<_>>()
    })?;
    let unchanged = settlement.lost.iter().all(Vec::is_empty);
    let lost = sights.into_iter().zip(settlement.lost);
    let left = lost.map(|(sight, lost)| give_up(sight, lost, scene));
    let sights = all_of(left)?;
    let left_arcmin2 = if unchanged {
        vec![0.0; sights.len()]
    } else {
        contested(&sights)
    };
    let settled = Settled {
        contests: settlement.contests,
        left_arcmin2,
    };
    Ok((sights, settled))
}

/// All results, or all errors.
fn all_of<T>(
    results: impl Iterator<Item = Result<T, Diagnostic>>,
) -> Result<Vec<T>, Vec<Diagnostic>> {
    let (mut good, mut bad) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(value) => good.push(value),
            Err(error) => bad.push(error),
        }
    }
    if bad.is_empty() { Ok(good) } else { Err(bad) }
}

/// What is promised of a finished forest.
pub(crate) struct Certificates {
    pub views: Vec<CertificateReport>,
    pub camouflage: Vec<Camouflage>,
    pub print: Vec<PrintCheck>,
    /// What of the models does not reach its viewer, in words.
    pub unseen: Vec<Diagnostic>,
}

/// The certificates of a finished forest, of which `pieces` go on the bed one by one, if it is to come in pieces.
pub(crate) fn certificates(
    built: &Built,
    settled: &Settled,
    pieces: &[(String, DVec3)],
) -> Certificates {
    let names = built.scene.views.iter().map(|v| v.name.as_str()).collect();
    let sharpness = Sharpness {
        line: built.scene.making.line,
        seen: built.scene.seen_arcmin,
    };
    let finished = Finished::new(&built.forest, &built.bvh, built.field, names, sharpness);
    let of_views = || -> (Vec<_>, Vec<_>) {
        let views = (0..built.sights.len()).into_par_iter();
        let of_view = |v| certificate(built, settled, v, &finished);
        views.map(of_view).unzip()
    };
    let of_all = || rayon::join(|| camouflages(built), || print_checks(built, pieces));
    let ((views, unseen), (camouflage, print)) = rayon::join(of_views, of_all);
    Certificates {
        views,
        camouflage,
        print,
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
    let (relief, given_up) = (shape.relief(), &built.forest.given_up[v]);
    let coverage = carried(sight, built.scene, given_up);
    let sighted = sighted(sight, ViewId::new(v), relief, given_up, finished);
    let solved = &shape.depths().solved;
    let all_sr = coverage.solid_angle_sr();
    let share = |lost: f64, of: f64| if of > 0.0 { lost / of } else { 0.0 };
    let models = coverage.models.iter().zip(&sighted.lost_sr);
    let (name, carrier) = (sight.name(), carrier(&built.scene.supports));
    let mut unseen = words::coverage::warnings(name, &coverage, carrier);
    unseen.extend(words::conflicts::warnings(name, &sighted, carrier));
    let (front, back) = reach_mm(sight, relief);
    let certificate = CertificateReport {
        relief_front_mm: front,
        relief_back_mm: back,
        at_limit: share_at_limit(sight, relief),
        bound_violation_mm: shape.bound_violation_mm(),
        clamp_mm: relief.clamp_mm,
        nothing_mm: nothing_mm(distance(sight)),
        order_inversions: shape.order_inversions(),
        crossings: shape.crossings(),
        proof: proof(solved),
        not_an_optimum: solved.not_an_optimum.map(str::to_owned),
        coverage: coverage.share(),
        reaching: coverage.share() - share(sighted.lost_sr.iter().sum(), all_sr),
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

/// How far the models are from the eye along its forward axis, from the nearest to the farthest in the middle; as from the reading
/// distance for an eye at infinity. Millimetres.
fn distance(sight: &Sight) -> f64 {
    let depths = &sight.image.target.depth;
    let (lo, hi) = depths.iter().fold((f64::INFINITY, 0.0f64), |(lo, hi), z| {
        (lo.min(*z), hi.max(*z))
    });
    (lo + hi) / 2.0 / sight.image.map.plane.focal
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
