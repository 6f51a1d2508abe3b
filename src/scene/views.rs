//! Views as a scene writes them: eyes, what they look at and which models they see.

use super::checks::{self, Eye, Stand};
use super::defaults;
use super::resolve::Model;
use crate::geom::FAR_MM;
use crate::planner::Adjustment;
use crate::scene::language::raw::{List, RawView};
use crate::scene::models::placing;
use crate::scene::text::document;
use crate::scene::text::names;
use crate::scene::text::reader::{Reader, Span, error_at, nearest, printable, short};
use crate::scene::text::spanned::Field;
use crate::view::{PlacedModel, View};
use glam::DVec3;

/// A view before its models are placed.
pub struct Draft {
    pub name: String,
    stand: Stand,
    eye_span: Span,
    look_at: Option<(DVec3, Span)>,
    models: Vec<(String, Span)>,
    colour: [u8; 3],
}

/// The views as written, each with what can be said of it before models are loaded.
pub fn drafts(
    reader: &mut Reader,
    field: &Field<List<RawView>>,
    whole: &Span,
    models: Option<&[Model]>,
) -> Vec<Draft> {
    let Some((list, span)) = reader.required(field, "views", "the scene", whole) else {
        return Vec::new();
    };
    if list.is_empty() || list.len() > defaults::MOST_VIEWS {
        let help = "a view is an eye and what it sees: (name: \"front\", eye: (0, -300, 60), models: [\"owl\"])";
        reader.problems.push(
            error_at(
                &span,
                format!(
                    "{} views; a scene has from 1 to {}",
                    list.len(),
                    defaults::MOST_VIEWS
                ),
            )
            .help(help),
        );
        return Vec::new();
    }
    let mut drafts: Vec<Draft> = Vec::new();
    for (index, item) in list.iter().enumerate() {
        let span = reader.span(item);
        let Some(raw) = reader.value(item) else {
            continue;
        };
        let Some(draft) = draft(reader, raw, &span, index, models) else {
            continue;
        };
        if let Some(clash) = drafts.iter().find_map(|d| clash(&d.name, &draft.name)) {
            let at = match &raw.name {
                Field::Given(name) => reader.span(name),
                Field::Missing => span,
            };
            reader.error(&at, clash);
        }
        drafts.push(draft);
    }
    drafts
}

/// Why two views may not have these names, if so: some file systems take capitals for small letters.
fn clash(first: &str, second: &str) -> Option<String> {
    let [a, b] = [first, second].map(str::to_lowercase);
    if a == b {
        Some(format!(
            "two views are named \"{second}\": their pictures would overwrite each other"
        ))
    } else if a == format!("{b}-lights") || b == format!("{a}-lights") {
        Some(format!(
            "views named \"{first}\" and \"{second}\" would overwrite each other's pictures"
        ))
    } else {
        None
    }
}

fn draft(
    reader: &mut Reader,
    raw: &RawView,
    span: &Span,
    index: usize,
    models: Option<&[Model]>,
) -> Option<Draft> {
    let name = reader.required(&raw.name, "name", &format!("view {}", index + 1), span);
    let name = name.and_then(|(n, at)| names::checked(reader, n, &at, "view"));
    let owner = format!("view \"{}\"", name.as_deref().unwrap_or("?"));
    let stand = stand(reader, raw, &owner, span);
    let look_at = reader
        .point_field(&raw.look_at, "look_at")
        .map(|(p, s)| (p.into(), s));
    let shown = reader
        .required(&raw.models, "models", &owner, span)
        .map(|(list, at)| shown(reader, list, &at, models));
    let colour = match reader.given(&raw.colour) {
        Some((text, at)) => colour(reader, text, &at),
        None => Some(defaults::PALETTE[index % defaults::PALETTE.len()]),
    };
    let (stand, eye_span) = stand?;
    Some(Draft {
        name: name?,
        stand,
        eye_span,
        look_at,
        models: shown?,
        colour: colour?,
    })
}

/// Where a view's eye is: exactly one of two fields says so.
fn stand(reader: &mut Reader, raw: &RawView, owner: &str, span: &Span) -> Option<(Stand, Span)> {
    let Field::Given(from) = &raw.from else {
        reader.need(&raw.eye, "eye", owner, span);
        let (eye, at) = reader.point_field(&raw.eye, "eye")?;
        return Some((Stand::At(eye.into()), at));
    };
    let from_span = reader.span(from);
    if !matches!(raw.eye, Field::Missing) {
        reader.problems.push(
            error_at(&from_span, format!("{owner} has both `eye` and `from`"))
                .label("an eye has a place or is at infinity")
                .help("keep `eye: (x, y, z)` for a place, or `from: (x, y, z)` for parallel rays from a direction"),
        );
        return None;
    }
    let from = DVec3::from(*reader.value(from)?);
    // A direction of any length, without unit; what is not finite has none.
    let Some(way) = (from / from.abs().max_element()).try_normalize() else {
        let text = format!(
            "`from` is ({}, {}, {}); it must point somewhere",
            from.x, from.y, from.z
        );
        reader.problems.push(
            error_at(&from_span, text)
                .help("it points from what is seen towards the eye: `from: (0, -1, 0.2)` is from the front and a little above"),
        );
        return None;
    };
    Some((Stand::Towards(way), from_span))
}

/// The models a view shows, each of which must exist and be named once.
fn shown(
    reader: &mut Reader,
    list: &List<String>,
    span: &Span,
    models: Option<&[Model]>,
) -> Vec<(String, Span)> {
    if list.is_empty() {
        reader.error(span, "a view shows at least one model");
    }
    let mut shown: Vec<(String, Span)> = Vec::new();
    for item in list.iter().take(defaults::MOST_MODELS) {
        let at = reader.span(item);
        let Some(name) = reader.value(item) else {
            continue;
        };
        let missing = models.is_some_and(|models| models.iter().all(|m| m.name != *name));
        if missing {
            let known: Vec<&str> = models
                .unwrap_or(&[])
                .iter()
                .map(|m| m.name.as_str())
                .collect();
            let guess = nearest(name, known.iter().copied())
                .map(|g| format!(", did you mean \"{g}\"?"))
                .unwrap_or_default();
            reader.problems.push(
                error_at(
                    &at,
                    format!("there is no model \"{}\"{guess}", printable(name)),
                )
                .help(format!("models of this scene: {}", known.join(", "))),
            );
        } else if shown.iter().any(|(n, _)| n == name) {
            reader.error(&at, format!("the view shows \"{}\" twice", printable(name)));
        }
        shown.push((name.clone(), at));
    }
    shown
}

/// `"#0072b2"`.
fn colour(reader: &mut Reader, text: &str, span: &Span) -> Option<[u8; 3]> {
    let digits = text
        .strip_prefix('#')
        .filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()));
    let Some(number) = digits.and_then(|d| u32::from_str_radix(d, 16).ok()) else {
        reader.problems.push(
            error_at(span, format!("`{}` is not a colour", printable(text)))
                .help("write red, green and blue as six hexadecimal digits: \"#0072b2\""),
        );
        return None;
    };
    let [_, r, g, b] = number.to_be_bytes();
    Some([r, g, b])
}

/// Where a view is seen from, for checks.
pub fn eye(draft: &Draft) -> Eye {
    Eye {
        view: draft.name.clone(),
        stand: draft.stand,
        span: draft.eye_span.clone(),
    }
}

/// Places a view's models and completes it; models that failed to load are left out (their errors are noted already).
pub fn view(
    reader: &mut Reader,
    draft: Draft,
    models: &[Model],
    adjusted: &Adjustment,
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
            .extend(placing::size_suspicion(name, &mesh, &model.span));
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
    if let Some(problem) = checks::direction(&draft.name, eye, look_at, &draft.eye_span)
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
