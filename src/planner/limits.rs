//! Why a layout cannot be, by how much, and the nearest change with which it can.

use super::brief::{Adjustment, Brief};
use super::posing::posed;
use super::start::{Clash, Start, Stuck, start};
use super::subject::Subject;
use super::survey::Fault;
use crate::view::View;

/// Halvings of the interval in which the least change lies: to a hundredth or so.
const HALVINGS: usize = 6;
/// The most that is offered: factors on models, region and pillars.
const SMALLEST_MODELS: f64 = 0.25;
const LARGEST_REGION: f64 = 4.0;
const THINNEST_PILLARS: f64 = 0.4;

/// There is no layout as far as the planner knows. Indices are views.
#[derive(Clone, Debug, PartialEq)]
pub struct NoLayout {
    /// What the construction met.
    pub stuck: Vec<Stuck>,
    pub clashes: Vec<Clash>,
    /// What is still wrong with the best layout that the search met.
    pub faults: Vec<Fault>,
    /// Of the pillars allowed, millimetres.
    pub tallest: f64,
    pub remedies: Remedies,
}

/// Nearest factors, with nothing else changed, on the size of all models, the width of the region and the thickness of pillars with
/// which there is a layout by construction; none where even the most that is offered does not do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Remedies {
    pub models: Option<f64>,
    pub region: Option<f64>,
    pub pillars: Option<f64>,
}

/// What binds. `views` are as the scene has them, `faults` those of the best layout met.
pub(crate) fn binding(views: &[View], brief: &Brief, start: Start, faults: Vec<Fault>) -> NoLayout {
    let tops = brief.shapes.iter().map(|s| s.heights[1]);
    NoLayout {
        stuck: start.stuck,
        clashes: start.clashes,
        faults,
        tallest: tops.fold(0.0, f64::max),
        remedies: remedies(views, brief),
    }
}

/// The nearest changes with which the construction succeeds.
fn remedies(views: &[View], brief: &Brief) -> Remedies {
    let subjects = |scale: f64| -> Vec<Subject> {
        let of_view = |v: &View| {
            let v = posed(
                v,
                &Adjustment {
                    scale,
                    ..Adjustment::NONE
                },
            );
            Subject::in_plan(&v, &v.target())
        };
        views.iter().map(of_view).collect()
    };
    let clear = |subjects: &[Subject], brief: &Brief| {
        let all: Vec<&Subject> = subjects.iter().collect();
        start(&all, brief).is_clear()
    };
    let own = subjects(1.0);
    let models = nearest(SMALLEST_MODELS, |scale| clear(&subjects(scale), brief));
    let region = nearest(LARGEST_REGION, |factor| {
        let region = brief.region.scaled(factor);
        clear(
            &own,
            &Brief {
                region,
                ..brief.clone()
            },
        )
    });
    let pillars = nearest(THINNEST_PILLARS, |factor| {
        clear(&own, &with_pillars(brief, factor))
    });
    Remedies {
        models,
        region,
        pillars,
    }
}

/// The factor nearest to 1 on the way to `most` that works; none if not even `most` does.
fn nearest(most: f64, works: impl Fn(f64) -> bool) -> Option<f64> {
    works(most).then_some(())?;
    let (mut bad, mut good) = (1.0, most);
    for _ in 0..HALVINGS {
        let middle = (bad + good) / 2.0;
        if works(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Some(good)
}

/// Pillars and their layers scaled.
fn with_pillars(brief: &Brief, factor: f64) -> Brief {
    let mut brief = brief.clone();
    for shape in brief.shapes.iter_mut().take(brief.allowed) {
        shape.profile.iter_mut().for_each(|p| *p *= factor);
        shape.reach *= factor;
        let layer = shape.layer;
        shape.layer = layer.resized(layer.front, layer.back() * factor, layer.core * factor);
    }
    brief
}
