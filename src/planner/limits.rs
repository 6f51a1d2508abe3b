//! Why a layout cannot be, by how much, and the nearest change with which it can.

use super::brief::{Adjustment, Brief};
use super::start::{Start, Stuck, start};
use super::subject::Subject;
use super::survey::{Fault, Kind};
use crate::diag::Diagnostic;
use crate::view::View;
use glam::DVec2;

/// Halvings of the interval in which the least change lies: to a hundredth or so.
const HALVINGS: usize = 6;
/// The most that is offered: factors on models, region and pillars.
const SMALLEST_MODELS: f64 = 0.25;
const LARGEST_REGION: f64 = 4.0;
const THINNEST_PILLARS: f64 = 0.4;
/// Faults of one kind that are told of one by one.
const TOLD: usize = 6;

/// What binds, as errors; the first carries the changes that would do. `views` are as the scene has them.
pub fn explained(
    views: &[View],
    brief: &Brief,
    start: &Start,
    faults: &[Fault],
) -> Vec<Diagnostic> {
    let name = |v: usize| views[v].name.as_str();
    let mut problems: Vec<Diagnostic> = start
        .stuck
        .iter()
        .map(|s| of_stuck(name(s.view), s, brief))
        .collect();
    problems.extend(start.clashes.iter().take(TOLD).map(|c| {
        let [a, b] = c.views.map(name);
        Diagnostic::error(format!(
            "no layout found: views \"{a}\" and \"{b}\" need the same ground: their sight regions overlap by {:.1} mm",
            c.mm
        ))
    }));
    if problems.is_empty() {
        problems.extend(faults.iter().take(TOLD).map(|f| {
            Diagnostic::error(format!(
                "no layout found: the best one still has a fault: {}",
                text(f, views)
            ))
        }));
    }
    let help = changes(views, brief);
    if let Some(first) = problems.first_mut() {
        first.help.extend(help);
    }
    problems
}

fn of_stuck(view: &str, stuck: &Stuck, brief: &Brief) -> Diagnostic {
    let DVec2 { x, y } = stuck.at;
    let mm = stuck.fault.mm;
    let tallest = brief
        .shapes
        .iter()
        .map(|s| s.heights[1])
        .fold(0.0, f64::max);
    let why = match stuck.fault.kind {
        Kind::Ends => format!("its sight lines pass {mm:.1} mm beyond the ends of pillars of {tallest} mm"),
        Kind::Open => "every cut to its neighbour would open before the eye has moved by the wanted `eye_tolerance`".into(),
        Kind::Narrow => format!("a strip would be {mm:.1} mm too narrow"),
        Kind::Tight => format!("there are {mm:.1} mm too little between it and its neighbours"),
        _ => format!("the region ends {mm:.1} mm too early"),
    };
    Diagnostic::error(format!(
        "no layout found: view \"{view}\" has no place for a pillar near ({x:.1}, {y:.1}): {why}"
    ))
}

/// What is wrong, in words.
pub fn text(fault: &Fault, views: &[View]) -> String {
    let DVec2 { x, y } = fault.at;
    let mm = fault.mm;
    let view = fault
        .view
        .map_or(String::new(), |v| format!("view \"{}\" ", views[v].name));
    let what = match fault.kind {
        Kind::Uncovered => format!("meets no pillar over {mm:.1} mm"),
        Kind::Foreign => format!("meets another view's pillar over {mm:.1} mm"),
        Kind::Loose => format!("lacks {mm:.2} mm of overlap behind a cut"),
        Kind::Fin => "leaves too thin a rest of a pillar behind another".into(),
        Kind::Narrow => format!("has a strip {mm:.1} mm too narrow"),
        Kind::Ends => format!("looks {mm:.1} mm past the end of a pillar"),
        Kind::Sight => format!("has another view's relief {mm:.1} mm in its sight"),
        Kind::Tight => format!("two solids are {mm:.1} mm too close"),
        Kind::Outside => format!("a pillar sticks out of the region by {mm:.1} mm"),
        Kind::Open => "has a cut that opens too fast for the wanted eye tolerance".into(),
        Kind::Count => format!("{mm:.0} pillars too many or too few"),
    };
    format!("{view}{what} near ({x:.1}, {y:.1})")
}

/// The nearest changes with which the construction succeeds, one line each.
fn changes(views: &[View], brief: &Brief) -> Vec<String> {
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
    let mut help = Vec::new();
    help.extend(
        models.map(|f| format!("with all models at {f:.2} of their size there is a layout")),
    );
    help.extend(region.map(|f| format!("with a region {f:.2} times as wide there is a layout")));
    help.extend(pillars.map(|f| format!("with pillars {f:.2} times as thick there is a layout")));
    if help.is_empty() {
        help.push("move the eyes farther apart, or show fewer or smaller models".into());
    }
    help
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
    let whole = bounds.reduce(|(l, h), (lo, hi)| (l.min(lo), h.max(hi)));
    whole.map_or(view.look_at, |(lo, hi)| ((lo + hi) / 2.0).with_z(lo.z))
}
