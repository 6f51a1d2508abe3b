//! Views with their models in place.

use super::draft::Draft;
use super::eye::{Stand, direction};
use crate::geom::FAR_MM;
use crate::planner::Adjustment;
use crate::scene::models::{Model, placing};
use crate::scene::resolved::MakingWay;
use crate::scene::text::{Reader, document, error_at, short};
use crate::view::{PlacedModel, View};
use glam::DVec3;

/// Places a view's models and completes it; models that failed to load are left out (their errors are noted already).
pub(crate) fn view(
    reader: &mut Reader,
    draft: Draft,
    models: &[Model],
    adjusted: &Adjustment,
    way: MakingWay,
    upright: bool,
) -> View {
    let mut placed = Vec::new();
    for (name, _) in &draft.models {
        let Some(model) = models.iter().find(|m| m.name == *name) else {
            continue;
        };
        let Some(mesh) = &model.mesh else { continue };
        let matrix = match draft.stand {
            Stand::At(eye) => model.placing.matrix(mesh, model.unit, eye),
            Stand::Towards(from) => model.placing.facing(mesh, model.unit, from.truncate()),
        };
        let mesh = model.lowered.as_ref().unwrap_or(mesh).transformed(matrix);
        reader
            .problems
            .extend(placing::size_suspicion(name, &mesh, &model.span, way));
        placed.push(PlacedModel {
            name: name.clone(),
            file: model.file.clone(),
            matrix,
            mesh,
            original: model.original.clone(),
            marks: model.marks.clone(),
        });
    }
    let look_at = draft
        .look_at
        .as_ref()
        .map(|(p, _)| *p)
        .or_else(|| middle(&placed))
        .unwrap_or(DVec3::ZERO);
    placing::adjust(&mut placed, adjusted);
    let (eye, orthographic) = match draft.stand {
        Stand::At(eye) => (eye, false),
        Stand::Towards(from) => (look_at + FAR_MM * from, true),
    };
    check_sight(reader, (&draft, eye), look_at, &placed, upright);
    View {
        name: draft.name,
        eye,
        look_at,
        orthographic,
        models: placed,
        colour: draft.colour,
    }
}

fn middle(models: &[PlacedModel]) -> Option<DVec3> {
    placing::extent(models).map(|(lo, hi)| (lo + hi) / 2.0)
}

/// The eye must have a direction, not straight up or down where supports are `upright`, and every model must lie wholly in front of it.
/// Says nothing about an eye that is wrong already.
fn check_sight(
    reader: &mut Reader,
    (draft, eye): (&Draft, DVec3),
    look_at: DVec3,
    models: &[PlacedModel],
    upright: bool,
) {
    let known = reader
        .problems
        .iter()
        .any(|p| p.is_error() && document::start(p) == draft.eye_span.start);
    if known || models.is_empty() {
        return;
    }
    if let Some(problem) = direction(&draft.name, eye, look_at, &draft.eye_span)
        && (upright || matches!(draft.stand, Stand::At(_)))
    {
        reader.problems.push(problem);
        return;
    }
    let gaze = (look_at - eye).normalize();
    for model in models {
        let depths = model.mesh.vertices.iter().map(|v| (*v - eye).dot(gaze));
        if depths.fold(f64::INFINITY, f64::min) < 1.0 {
            let away = middle(std::slice::from_ref(model)).map_or(0.0, |m| eye.distance(m));
            reader.problems.push(
                error_at(&draft.eye_span, format!("model \"{}\" is not wholly in front of the eye of view \"{}\": its middle is {} mm away", model.name, draft.name, short(away)))
                    .help("move the eye back, or make the model smaller: `place: Fit(height: 60)`"),
            );
        }
    }
}
