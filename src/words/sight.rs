//! Why nothing of a view's models can appear.

use crate::diag::Diagnostic;
use crate::groups::{Bound, ThinSupport};
use crate::index::SupportId;
use crate::kinds::MustBeCut;
use crate::mimic::{RowKind, SolveError};
use crate::sight::{Elsewhere, Sight, Unseen};
use crate::support::Support;
use crate::viewmap::ViewMapError;
use crate::words::carrier::carrier;
use crate::words::coverage::beside_sight;
use glam::DVec2;

/// Why a view has no sight.
pub fn unseen(view: &str, supports: &[Support], found: &Unseen) -> Vec<Diagnostic> {
    let failed = |text: &str| Diagnostic::error(format!("view \"{view}\": {text}"));
    match found {
        Unseen::Image(ViewMapError::Triangulation(q)) => {
            let text = format!("{} {}", ViewMapError::Triangulation(*q), towards(*q));
            let several = match supports.iter().filter(|s| s.layer.is_some()).count() {
                1 => "parts of its models",
                _ => "supports, or parts of its models,",
            };
            vec![failed(&text).help(format!("{several} that lie on each other there: move them apart, or leave one of them out"))]
        }
        Unseen::Image(error) => vec![failed(&error.to_string())],
        Unseen::Beside(support, angle) => vec![Diagnostic::error(format!(
            "view \"{view}\": a face of its models that {} carries reaches {:.0} degrees beside it as the eye sees them, and beyond 90 degrees no relief can lie",
            supports[*support].name,
            angle.to_degrees()
        ))
        .help("make the models smaller, or move the eye away; or subdivide the faces of the model, so that each lies on its supports")],
        Unseen::Thin(thin) => thin.iter().map(|t| too_thin(view, supports, t)).collect(),
        Unseen::NotCarried(aside) => vec![not_carried(view, supports, aside)],
    }
}

/// Models of which nothing that is seen has bounds.
pub fn all_free(view: &str, supports: &[Support]) -> Diagnostic {
    Diagnostic::error(format!(
        "view \"{view}\": all that is seen of its models is free, so nothing holds it to its {}",
        carrier(supports)
    ))
    .help("leave a part of them out of the `regions` with `free: true`: it is that part that lies in the layer")
}

fn not_carried(view: &str, supports: &[Support], found: &[(SupportId, Elsewhere)]) -> Diagnostic {
    let carrier = carrier(supports);
    let told = Diagnostic::error(format!(
        "view \"{view}\": no {carrier} stands behind or in its models, so nothing of them can appear"
    ));
    // Without a sign of zero.
    let rounded = |x: f64| (100.0 * x).round() / 100.0 + 0.0;
    let help = |(support, aside): &(SupportId, Elsewhere)| {
        let name = &supports[*support].name;
        match aside {
            Elsewhere::BehindEye => format!("{name} stands behind the eye: move one of them"),
            Elsewhere::FacesAway(way) => format!(
                "{name} turns its back to the eye: `facing: ({:.2}, {:.2})` turns it round",
                rounded(way.x),
                rounded(way.y)
            ),
            Elsewhere::BesideModels => format!("{name} stands beside the models"),
        }
    };
    let known = found
        .iter()
        .filter(|(_, aside)| *aside != Elsewhere::BesideModels);
    // Three say as much as a thousand.
    let told = known.take(3).fold(told, |told, one| told.help(help(one)));
    match told.help.is_empty() {
        true => told.help(format!(
            "move the models before a {carrier} as the eye sees them, or a {carrier} behind them"
        )),
        false => told,
    }
}

/// A support that a layer leaves too thin.
pub fn too_thin(view: &str, supports: &[Support], found: &ThinSupport) -> Diagnostic {
    let support = &supports[found.support];
    let (back, core) = support.layer.map_or((0.0, 0.0), |l| (l.back(), l.core));
    let ThinSupport { behind_mm, .. } = found;
    Diagnostic::error(format!(
        "{} leaves {behind_mm:.2} mm behind its layer as seen from view \"{view}\", but the minimum core is {core:.2} mm",
        support.name
    ))
    .help(format!(
        "lower the layer's back from {back:.2} to {:.2} mm, or make the {} thicker",
        back - core + behind_mm,
        support.kind_name()
    ))
}

/// Why a mesh cannot stay whole.
pub fn split(view: &str, supports: &[Support], found: MustBeCut) -> Diagnostic {
    let name = |s: SupportId| &supports[s].name;
    match found {
        MustBeCut::Supports([one, other]) => Diagnostic::error(format!(
            "view \"{view}\": its models lie before {} and {}, but a whole mesh has one support",
            name(one),
            name(other)
        ))
        .help("one support behind all of them, or `relief: HeightField`, which cuts the surface"),
        MustBeCut::Parts(support) => Diagnostic::error(format!(
            "view \"{view}\": {} has several parts behind its models, but a whole mesh is not cut at their edges",
            name(support)
        ))
        .help("a plate or a wave, or `relief: HeightField`, which cuts the surface"),
    }
}

/// Free parts that nothing holds to the supports they are seen before.
pub fn unheld(sight: &Sight, on: &[SupportId]) -> Diagnostic {
    let supports = sight.image.field.supports;
    let names: Vec<&str> = on.iter().map(|s| supports[*s].name.as_str()).collect();
    Diagnostic::warning(format!(
        "view \"{}\": parts of its models that are seen before {} are wholly free, so nothing holds them there",
        sight.name(),
        names.join(", ")
    ))
    .help("free less of the model, so that each of its parts begins in the layer of the support that it stands on")
}

/// Why there are no depths: the support and the bounds in conflict, or where the solver did not get on.
pub fn unsolved(sight: &Sight, error: &SolveError) -> Diagnostic {
    let view = sight.name();
    let kind = match error {
        // Least scales keep a contradiction from being solved at the eye; they are no part of it.
        SolveError::Infeasible(rows) => rows.iter().find(|r| !matches!(r, RowKind::Scale(_))),
        SolveError::Unsolved { worst, .. } => worst.as_ref(),
    };
    let is_order = matches!(kind, Some(RowKind::Order(_) | RowKind::Step(_)));
    match (error, kind.and_then(|kind| bound(sight, *kind))) {
        (SolveError::Infeasible(_), Some((bound, limit))) => {
            let support = support_of(sight, bound);
            Diagnostic::error(format!(
                "view \"{view}\": {error}; the {limit} depth on {} contradicts its neighbours (allowed there: {:.5} to {:.5} of the model's depth)",
                support.name, bound.lower, bound.upper
            ))
            .help(format!(
                "let the surface tear (`energy: Normal(steps: Allowed())`), or give {} a thicker layer (`front`, `back`)",
                support.name
            ))
        }
        (SolveError::Infeasible(_), None) if is_order => Diagnostic::error(format!(
            "view \"{view}\": {error} and keep the depth order of the model's parts"
        ))
        .help(
            "let the surface tear (`energy: Normal(steps: Allowed())`), try `ordering: false` there, or thicker layers (`front`, `back`)",
        ),
        (SolveError::Unsolved { .. }, Some((bound, limit))) => {
            let support = support_of(sight, bound);
            let told = Diagnostic::error(format!(
                "view \"{view}\": {error}; farthest off is the {limit} depth on {}, {}",
                support.name,
                beside_sight_of(sight, bound)
            ))
            .fault()
            .help(format!("give {} a thicker layer (`front`, or less `core`), or the model fewer vertices (`detail: 5000`)", support.name));
            match support.layer.is_some_and(|l| l.goes_through()) {
                true => told.help("with `hits: (1, 2)` the layer bends with both sides of its wall; `hits: (1, 1)` with a `back` bends with one"),
                false => told,
            }
        }
        _ => Diagnostic::error(format!("view \"{view}\": {error}"))
            .fault()
            .help("thicker layers (`front`, `back`) make it easier, and supports that do not jump where the eye looks along them"),
    }
}

/// The bound that a row stands for, and which of its limits.
fn bound<'a>(sight: &'a Sight, kind: RowKind) -> Option<(&'a Bound, &'static str)> {
    let (number, limit) = match kind {
        RowKind::Near(b) => (b, "nearest"),
        RowKind::Far(b) => (b, "farthest"),
        RowKind::Order(_) | RowKind::Step(_) | RowKind::Scale(_) => return None,
    };
    let bound = sight.groups.bounds.get(number as usize)?;
    Some((bound, limit))
}

fn support_of<'a>(sight: &'a Sight, bound: &Bound) -> &'a Support {
    let support = sight.groups.groups[bound.group].support;
    &sight.image.field.supports[support]
}

/// Where an eye sees the bound, by the vertex with the largest share in it.
fn beside_sight_of(sight: &Sight, bound: &Bound) -> String {
    let terms = bound.anchor.terms().max_by(|a, b| a.1.total_cmp(&b.1));
    towards(terms.map_or(DVec2::ZERO, |(v, _)| sight.image.target.image[v]))
}

/// A point of the image as a direction.
fn towards(q: DVec2) -> String {
    let [right, up] = q.to_array().map(|tangent| tangent.atan().to_degrees());
    beside_sight(right, up)
}
