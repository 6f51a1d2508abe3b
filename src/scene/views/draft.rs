//! Views as a scene writes them, before their models are placed.

use super::eye::{Eye, Stand, stand};
use crate::scene::defaults;
use crate::scene::language::raw::RawView;
use crate::scene::models::Model;
use crate::scene::text::names;
use crate::scene::text::{Field, List, Reader, Span, error_at, nearest, printable};
use glam::DVec3;

/// A view before its models are placed.
pub(crate) struct Draft {
    pub name: String,
    pub stand: Stand,
    pub eye_span: Span,
    pub look_at: Option<(DVec3, Span)>,
    pub models: Vec<(String, Span)>,
    pub colour: [u8; 3],
}

impl Draft {
    /// From where it is seen, for checks.
    pub(crate) fn eye(&self) -> Eye {
        Eye {
            view: self.name.clone(),
            stand: self.stand,
            span: self.eye_span.clone(),
        }
    }
}

/// The views as written, each with what can be said of it before models are loaded.
pub(crate) fn drafts(
    reader: &mut Reader,
    field: &Field<List<RawView>>,
    scene_span: &Span,
    models: Option<&[Model]>,
) -> Vec<Draft> {
    let Some((list, span)) = reader.required(field, "views", "the scene", scene_span) else {
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
