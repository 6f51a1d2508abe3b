//! Why nothing of a view's models can appear.

use crate::diag::Diagnostic;
use crate::groups::ThinSupport;
use crate::index::SupportId;
use crate::kinds::MustBeCut;
use crate::mimic::{RowKind, SolveError};
use crate::sight::{Sight, Unseen};
use crate::support::Support;
use crate::words::carrier::carrier;

/// Why a view has no sight.
pub fn unseen(view: &str, supports: &[Support], found: &Unseen) -> Vec<Diagnostic> {
    let failed = |text: &str| vec![Diagnostic::error(format!("view \"{view}\": {text}"))];
    match found {
        Unseen::Image(error) => failed(&error.to_string()),
        Unseen::Thin(thin) => thin.iter().map(|t| too_thin(view, supports, t)).collect(),
        Unseen::NotCarried => failed(&format!(
            "no {} stands behind or in its models, so nothing of them can appear",
            carrier(supports)
        )),
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

/// Why there are no depths: the support and the bounds in conflict.
pub fn unsolved(sight: &Sight, error: &SolveError) -> Diagnostic {
    let (view, groups) = (sight.name(), &sight.groups);
    let worst = match error {
        SolveError::Infeasible(rows) => rows.first(),
        SolveError::Unsolved(_) => None,
    };
    let Some(kind) = worst else {
        return Diagnostic::error(format!("view \"{view}\": {error}"))
            .fault()
            .help("thicker layers (`front`, `back`) make it easier, and supports that do not jump where the eye looks along them");
    };
    let (bound, limit) = match kind {
        RowKind::Near(b) => (groups.bounds.get(*b as usize), "nearest"),
        RowKind::Far(b) => (groups.bounds.get(*b as usize), "farthest"),
        RowKind::Order(_) | RowKind::Step(_) => (None, ""),
    };
    let Some(bound) = bound else {
        return Diagnostic::error(format!(
            "view \"{view}\": {error} and keep the depth order of the model's parts"
        ))
        .help(
            "let the surface tear (`energy: Normal(steps: Allowed())`), try `ordering: false` there, or thicker layers (`front`, `back`)",
        );
    };
    let support = groups.groups[bound.group].support;
    let support = &sight.image.field.supports[support].name;
    Diagnostic::error(format!(
        "view \"{view}\": {error}; the {limit} depth on {support} contradicts its neighbours (allowed there: {:.5} to {:.5} of the model's depth)",
        bound.lower, bound.upper
    ))
    .help(format!(
        "let the surface tear (`energy: Normal(steps: Allowed())`), or give {support} a thicker layer (`front`, `back`)"
    ))
}
