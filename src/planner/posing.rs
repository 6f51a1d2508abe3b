//! Views with their models changed, and all poses that a search may try.

use super::brief::{Adjustment, Brief, Freedom};
use super::subject::{Rays, Subject};
use super::task::Pose;
use crate::bvh::Bvh;
use crate::view::View;
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// Rays of an outlook that the search looks with: many columns, as pillars are upright; with 24 of them it found layouts that hid
/// models from those columns only, eight degrees better than the truth.
const RAYS: Rays = Rays {
    columns: 144,
    rows: 7,
};
/// Poses of a view's models that are tried, where models may change.
const POSES: usize = 8;

/// A view with its models changed.
pub fn posed(view: &View, adjustment: &Adjustment) -> View {
    let mut view = view.clone();
    if *adjustment != Adjustment::NONE {
        let matrix = adjustment.matrix(foot(&view));
        for model in &mut view.models {
            model.mesh = model.mesh.transformed(matrix);
            model.matrix = matrix * model.matrix;
        }
    }
    view
}

/// Middle of the underside of all models of a view.
pub fn foot(view: &View) -> glam::DVec3 {
    let bounds = view.models.iter().filter_map(|m| m.mesh.bounds());
    let all = bounds.reduce(|(l, h), (lo, hi)| (l.min(lo), h.max(hi)));
    all.map_or(view.look_at, |(lo, hi)| ((lo + hi) / 2.0).with_z(lo.z))
}

/// Prepares all views, with their models in several poses if they may change.
pub(crate) fn prepared(views: &[View], brief: &Brief) -> Vec<Vec<Pose>> {
    let pose = |view: &View, adjustment: Adjustment| {
        let view = posed(view, &adjustment);
        let target = view.target();
        let bvh = Bvh::new(&target);
        let subject = Subject::new(&view, &target, &bvh);
        let outlooks = subject.outlooks(&target, &bvh, [brief.hidden_from_deg, 0.0], RAYS);
        Pose {
            adjustment,
            subject,
            outlooks,
        }
    };
    let of_view = |(number, view): (usize, &View)| {
        let mut rng = Pcg64Mcg::seed_from_u64(brief.seed ^ (number as u64 + 1) << 32);
        let adjustments = poses(&brief.freedom, &mut rng);
        adjustments.into_iter().map(|a| pose(view, a)).collect()
    };
    let numbered: Vec<(usize, &View)> = views.iter().enumerate().collect();
    numbered.into_par_iter().map(of_view).collect()
}

/// The models as they are and, if they may change, at random within the limits.
fn poses(freedom: &Freedom, rng: &mut Pcg64Mcg) -> Vec<Adjustment> {
    let mut list = vec![Adjustment::NONE];
    if *freedom != Freedom::NONE {
        let mut random = |most: f64| {
            if most > 0.0 {
                rng.random_range(-most..most)
            } else {
                0.0
            }
        };
        // Rounded as they are written down.
        let rounded = |x: f64| (x * 1e4).round() / 1e4;
        list.extend((1..POSES).map(|_| Adjustment {
            turn: rounded(random(freedom.turn.to_degrees())).to_radians(),
            scale: rounded(random(freedom.scale.ln()).exp()),
            shift: DVec2::new(
                rounded(random(freedom.shift)),
                rounded(random(freedom.shift)),
            ),
        }));
    }
    list
}
