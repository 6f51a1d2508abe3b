//! Why there is no layout, and what is wrong with one, in words.

use crate::diag::Diagnostic;
use crate::planner::{Fault, FaultKind, Frame, NoLayout, Remedies, Stuck};
use crate::view::View;
use glam::DVec2;

/// Faults of one kind that are told of one by one.
const TOLD: usize = 6;

/// What binds, as errors; the first carries the changes that would do. Of faults is told only where the construction met nothing.
pub fn no_layout(views: &[View], found: &NoLayout) -> Vec<Diagnostic> {
    let name = |v: usize| views[v].name.as_str();
    let stuck = found.stuck.iter();
    let mut problems: Vec<Diagnostic> = stuck
        .map(|s| of_stuck(name(s.view), s, found.tallest))
        .collect();
    problems.extend(found.clashes.iter().take(TOLD).map(|c| {
        let [a, b] = c.views.map(name);
        Diagnostic::error(format!(
            "no layout found: views \"{a}\" and \"{b}\" need the same ground: their sight regions overlap by {:.1} mm",
            c.mm
        ))
    }));
    if problems.is_empty() {
        problems.extend(found.faults.iter().take(TOLD).map(|f| {
            Diagnostic::error(format!(
                "no layout found: the best one still has a fault: {}",
                fault(f, views)
            ))
        }));
    }
    if let Some(first) = problems.first_mut() {
        first.help.extend(remedies(&found.remedies));
    }
    problems
}

fn of_stuck(view: &str, stuck: &Stuck, tallest: f64) -> Diagnostic {
    let DVec2 { x, y } = stuck.at;
    let mm = stuck.fault.mm;
    let why = match stuck.fault.kind {
        FaultKind::Ends => format!("its sight lines pass {mm:.1} mm beyond the ends of pillars of {tallest} mm"),
        FaultKind::Open => "every cut to its neighbour would open before the eye has moved by the wanted `eye_tolerance`".into(),
        FaultKind::Narrow => format!("a strip would be {mm:.1} mm too narrow"),
        FaultKind::Tight => format!("there are {mm:.1} mm too little between it and its neighbours"),
        _ => format!("the region ends {mm:.1} mm too early"),
    };
    Diagnostic::error(format!(
        "no layout found: view \"{view}\" has no place for a pillar near ({x:.1}, {y:.1}): {why}"
    ))
}

/// One line each.
fn remedies(found: &Remedies) -> Vec<String> {
    let Remedies {
        models,
        region,
        pillars,
    } = found;
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

/// Places of a layout's faults in plan, and what they are: for pictures.
pub fn marks(views: &[View], frame: &Frame) -> Vec<(DVec2, String)> {
    let mark = |f: &Fault| (f.at, fault(f, views));
    frame.faults.iter().map(mark).collect()
}

/// What is wrong, in words.
pub fn fault(fault: &Fault, views: &[View]) -> String {
    let DVec2 { x, y } = fault.at;
    let mm = fault.mm;
    let view = fault
        .view
        .map_or(String::new(), |v| format!("view \"{}\" ", views[v].name));
    let what = match fault.kind {
        FaultKind::Uncovered => format!("meets no pillar over {mm:.1} mm"),
        FaultKind::Foreign => format!("meets another view's pillar over {mm:.1} mm"),
        FaultKind::Loose => format!("lacks {mm:.2} mm of overlap behind a cut"),
        FaultKind::Fin => "leaves too thin a rest of a pillar behind another".into(),
        FaultKind::Narrow => format!("has a strip {mm:.1} mm too narrow"),
        FaultKind::Ends => format!("looks {mm:.1} mm past the end of a pillar"),
        FaultKind::Sight => format!("has another view's relief {mm:.1} mm in its sight"),
        FaultKind::Tight => format!("two solids are {mm:.1} mm too close"),
        FaultKind::Outside => format!("a pillar sticks out of the region by {mm:.1} mm"),
        FaultKind::Open => "has a cut that opens too fast for the wanted eye tolerance".into(),
        FaultKind::Count => format!("{mm:.0} pillars too many or too few"),
    };
    format!("{view}{what} near ({x:.1}, {y:.1})")
}
