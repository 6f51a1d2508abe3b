//! From scene text to a [`Scene`] in which nothing is left to decide.
//!
//! Takes text and a way to read the files it names; gives the scene or *all* of its problems in the order of the text.
//! After it: lengths are millimetres, names are unique and fit for files, numbers are finite and in range, meshes are
//! in place, pillars neither overlap nor float, eyes stand in the open.

use super::checks::{self, Eye, Stand};
use super::document::{self, Document};
use super::forest::{self, Around};
use super::placing::{self, Placing};
use super::raw::{List, RawModel, RawScene, RawView};
use super::reader::{Reader, Span, error_at, nearest, placed, printable, short, warning_at};
use super::spanned::Field;
use super::{defaults, detail, lexer, marks, names, options, whole};
use crate::diag::{Diagnostic, Severity, Warned};
use crate::geom::FAR_MM;
use crate::mesh::{Original, TriMesh};
use crate::planner::Adjustment;
use crate::scene::{Output, Scene};
use crate::view::{Marks, PlacedModel, View};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// Reads a file, a model or a layout, by the name the scene gives.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, Diagnostic>;

/// A model as the scene describes it.
struct Model {
    name: String,
    file: String,
    file_span: Span,
    /// Millimetres per unit of the file.
    unit: f64,
    placing: Placing,
    span: Span,
    regions: Vec<marks::Region>,
    /// The most vertices it may have.
    detail: Option<usize>,
    /// As the file has it: models are placed by this.
    mesh: Option<TriMesh>,
    /// In its place, if that has too many vertices.
    lowered: Option<TriMesh>,
    original: Option<Arc<Original>>,
    marks: Arc<Marks>,
}

/// A view before its models are placed.
struct Draft {
    name: String,
    stand: Stand,
    eye_span: Span,
    look_at: Option<(DVec3, Span)>,
    models: Vec<(String, Span)>,
    colour: [u8; 3],
}

/// What a scene is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Its pillars stand where they are, or are to be found.
    Build,
    /// Its pillars are a first draft: where they stand in each other's way is no mistake.
    Mend,
}

/// Reads and checks a whole scene. Places of problems are byte ranges of `text` after a byte order mark.
///
/// # Errors
/// Every problem found, warnings among them, at least one of them an error.
pub fn resolve(text: &str, read: ReadFile) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    resolve_for(text, read, Purpose::Build)
}

/// As [`resolve`], but pillars that the scene lists are the given ones of a [`Brief`](crate::planner::Brief), free to be moved:
/// those that overlap or stand beside the base are what is to be mended.
///
/// # Errors
/// As [`resolve`].
pub fn resolve_to_mend(text: &str, read: ReadFile) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    resolve_for(text, read, Purpose::Mend)
}

fn resolve_for(
    text: &str,
    read: ReadFile,
    purpose: Purpose,
) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (problems, scene) = document::read(text, |text| match parse(text) {
        Err(problems) => (problems, None),
        Ok(raw) => {
            let mut reader = Reader::new(text, SCENE);
            let scene = build(&mut reader, &raw, read, purpose);
            (reader.problems, scene)
        }
    });
    match scene {
        Some(value) if problems.iter().all(|d| d.severity == Severity::Warning) => Ok(Warned {
            value,
            warnings: problems,
        }),
        _ => Err(problems),
    }
}

/// What messages call the text.
const SCENE: &str = "scene";

/// Text to raw scene.
fn parse(text: &str) -> Result<RawScene, Vec<Diagnostic>> {
    Document::new(
        text,
        SCENE,
        "`pillarforest init` writes a scene to start from",
    )
    .map_err(|problem| vec![problem])?
    .parse(b'(')
}

fn build(reader: &mut Reader, raw: &RawScene, read: ReadFile, purpose: Purpose) -> Option<Scene> {
    let whole = lexer::trimmed(reader.text);
    if let Some((unit, _)) = reader.given(&raw.units) {
        (reader.unit, reader.unit_name) = placing::unit(*unit);
    }
    let title = title(reader, &raw.title);
    let mut models = models(reader, &raw.models, &whole);
    if let Some(most) = detail::detail(reader, &raw.detail) {
        let all = models.iter_mut().flatten();
        all.for_each(|m| m.detail = Some(m.detail.map_or(most, |own| own.min(most))));
    }
    let drafts = drafts(reader, &raw.views, &whole, models.as_deref());
    let printer = options::printer(reader, &raw.printer);
    let eyes: Vec<Eye> = drafts.iter().map(eye).collect();
    let around = Around {
        read,
        purpose,
        printer: &printer,
        views: drafts.iter().map(|d| d.name.as_str()).collect(),
        view_count: view_count(raw).unwrap_or(drafts.len()),
    };
    let forest = forest::forest(reader, raw, &whole, &around);
    let energy = options::energy(reader, &raw.energy);
    let steps = options::steps(reader, &raw.energy, forest.most_pillars(), &printer);
    let held = whole::whole(reader, raw);
    let contested = options::contested(reader, &raw.contested);
    let output = options::output(reader, &raw.output);
    forest.check(reader, &eyes, &around);
    whole::check_supports(reader, raw, held, forest.bodies());
    for model in models.iter_mut().flatten() {
        load(reader, model, read);
        if let (Some(_), Some(mesh)) = (held, &model.mesh) {
            whole::check_closed(reader, mesh, &model.name, &model.file_span);
        }
    }
    lower(reader, models.as_deref_mut().unwrap_or_default(), &output);
    let adjusted = forest.adjusted(&around.views);
    let upright = forest.most_pillars() > 0;
    let views = drafts
        .into_iter()
        .zip(&adjusted)
        .map(|(draft, adjusted)| {
            let models = models.as_deref().unwrap_or(&[]);
            view(reader, draft, models, adjusted, upright)
        })
        .collect();
    let sound = reader.problems.iter().all(|d| !d.is_error());
    let (mut supports, brief) = forest.finished();
    if held.is_some() {
        whole::hold_outlines(&mut supports);
    }
    sound.then_some(Scene {
        title,
        views,
        supports,
        brief,
        adjusted,
        energy,
        steps: steps.filter(|_| held.is_none()),
        whole: held,
        contested,
        printer,
        output,
    })
}

/// How many views the scene lists, readable or not.
fn view_count(raw: &RawScene) -> Option<usize> {
    match &raw.views {
        Field::Given(list) => list.value.as_ref().ok().map(Vec::len),
        Field::Missing => None,
    }
}

fn title(reader: &mut Reader, field: &Field<String>) -> String {
    let Some((title, span)) = reader.given(field) else {
        return defaults::TITLE.to_string();
    };
    let length = title.chars().count();
    if length > defaults::LONGEST_TITLE {
        reader.error(
            &span,
            format!(
                "the title has {length} characters; the limit is {}",
                defaults::LONGEST_TITLE
            ),
        );
    }
    title.clone()
}

fn models(reader: &mut Reader, field: &Field<List<RawModel>>, whole: &Span) -> Option<Vec<Model>> {
    let (list, span) = reader.required(field, "models", "the scene", whole)?;
    if list.is_empty() || list.len() > defaults::MOST_MODELS {
        reader.error(
            &span,
            format!(
                "{} models; a scene has from 1 to {}",
                list.len(),
                defaults::MOST_MODELS
            ),
        );
        return None;
    }
    let mut models: Vec<Model> = Vec::new();
    let mut whole_list = true;
    for item in list {
        let span = reader.span(item);
        let model = reader.value(item).and_then(|raw| model(reader, raw, &span));
        whole_list &= model.is_some();
        let Some(model) = model else { continue };
        if models.iter().any(|m| m.name == model.name) {
            reader.error(
                &model.span,
                format!("two models are named \"{}\"", printable(&model.name)),
            );
        }
        models.push(model);
    }
    whole_list.then_some(models)
}

fn model(reader: &mut Reader, raw: &RawModel, span: &Span) -> Option<Model> {
    let name = reader.required(&raw.name, "name", "this model", span);
    let name = name.and_then(|(n, at)| names::checked(reader, n, &at, "model").map(|n| (n, at)));
    let owner = name
        .as_ref()
        .map_or("this model".to_string(), |(n, _)| format!("model \"{n}\""));
    let file = reader.required(&raw.file, "file", &owner, span);
    let unit = reader
        .given(&raw.units)
        .map_or(1.0, |(u, _)| placing::unit(*u).0);
    let placing = placing::placing(reader, &raw.place);
    let regions = marks::regions(reader, &raw.regions);
    let detail = detail::detail(reader, &raw.detail);
    let ((name, name_span), (file, file_span), (placing, place_span)) = (name?, file?, placing?);
    Some(Model {
        name,
        file: file.clone(),
        file_span,
        unit,
        placing,
        span: place_span.unwrap_or(name_span),
        regions,
        detail,
        mesh: None,
        lowered: None,
        original: None,
        marks: Arc::default(),
    })
}

/// Reads a model's file; its problems point at the file's name in the scene unless they know a better place.
fn load(reader: &mut Reader, model: &mut Model, read: ReadFile) {
    let parsed = read(&model.file)
        .and_then(|bytes| crate::formats::load_original(&model.file, &bytes, false));
    let Some(loaded) = reader.read(parsed, &model.file_span) else {
        return;
    };
    let warnings = loaded.warnings.into_iter();
    let warnings = warnings.map(|w| placed(w, &model.file_span));
    reader.problems.extend(warnings);
    let loaded = loaded.value;
    let Model { name, file, .. } = &*model;
    let marks = marks::marks(reader, &model.regions, &loaded, name, file);
    model.marks = Arc::new(marks);
    model.mesh = Some(loaded.mesh);
    model.original = Some(Arc::new(loaded.original));
}

/// Makes models smaller that have too many vertices; tells what they could not do or keep.
fn lower(reader: &mut Reader, models: &mut [Model], output: &Output) {
    let remarks: Vec<Option<Diagnostic>> = models
        .par_iter_mut()
        .map(|model| model.lower(output))
        .collect();
    reader.problems.extend(remarks.into_iter().flatten());
}

impl Model {
    fn lower(&mut self, output: &Output) -> Option<Diagnostic> {
        let (mesh, most) = (self.mesh.as_ref()?, self.detail?);
        let original = self.original.as_ref()?;
        let found = detail::lowered(mesh, original, &self.marks, most);
        let count = found.as_ref().map_or(mesh, |l| &l.mesh).vertices.len();
        let lost = output.surface && found.as_ref().is_some_and(|l| l.lost_seams);
        if let Some(lowered) = found {
            self.marks = Arc::new(lowered.marks);
            self.original = Some(Arc::new(lowered.original));
            self.lowered = Some(lowered.mesh);
        }
        let name = printable(&self.name);
        let (text, help) = if count > most {
            (
                format!(
                    "model \"{name}\" keeps {count} vertices, more than `detail: {most}`: with fewer its form would be lost"
                ),
                "a larger `detail`, or a model of fewer separate parts",
            )
        } else if lost {
            (
                format!(
                    "model \"{name}\" is simplified by `detail`, and its texture points have seams: the surface file goes without them"
                ),
                "leave `detail` out for surface files with texture points",
            )
        } else {
            return None;
        };
        Some(warning_at(&self.file_span, text).help(help))
    }
}

fn drafts(
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

fn eye(draft: &Draft) -> Eye {
    Eye {
        view: draft.name.clone(),
        stand: draft.stand,
        span: draft.eye_span.clone(),
    }
}

/// Places a view's models and completes it; models that failed to load are left out (their errors are noted already).
fn view(
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
