//! From scene text to a [`Scene`] in which nothing is left to decide.
//!
//! Takes text and a way to read the files it names; gives the scene or *all* of its problems in the order of the text.
//! After it: lengths are millimetres, names are unique and fit for files, numbers are finite and in range, meshes are
//! in place, pillars neither overlap nor float, eyes stand in the open.

use super::checks::Eye;
use super::document::{self, Document};
use super::forest::{self, Around};
use super::placing::{self, Placing};
use super::raw::{List, RawModel, RawScene};
use super::reader::{Reader, Span, placed, printable, warning_at};
use super::spanned::Field;
use super::views::{drafts, eye, view};
use super::{defaults, detail, lexer, marks, names, options, whole};
use crate::diag::{Diagnostic, Severity, Warned};
use crate::mesh::{Original, TriMesh};
use crate::scene::{Output, Scene};
use crate::view::Marks;
use rayon::prelude::*;
use std::sync::Arc;

/// Reads a file, a model or a layout, by the name the scene gives.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, Diagnostic>;

/// A model as the scene describes it.
pub struct Model {
    pub name: String,
    pub file: String,
    file_span: Span,
    /// Millimetres per unit of the file.
    pub unit: f64,
    pub placing: Placing,
    pub span: Span,
    regions: Vec<marks::Region>,
    /// The most vertices it may have.
    detail: Option<usize>,
    /// As the file has it: models are placed by this.
    pub mesh: Option<TriMesh>,
    /// In its place, if that has too many vertices.
    pub lowered: Option<TriMesh>,
    pub original: Option<Arc<Original>>,
    pub marks: Arc<Marks>,
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
        .and_then(|bytes| crate::intake::load_original(&model.file, &bytes, false));
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
