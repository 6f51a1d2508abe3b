//! The list of models: what a scene says of each, and what its file holds.

use super::detail;
use super::marks::{self, MarkedRegion};
use super::placing::{self, Placing};
use crate::diag::Diagnostic;
use crate::intake;
use crate::mesh::{self, Original, TriMesh};
use crate::scene::defaults;
use crate::scene::language::raw::{RawModel, RawScene};
use crate::scene::request::ReadFile;
use crate::scene::resolved::Output;
use crate::scene::text::names;
use crate::scene::text::{Field, List, Reader, Span, placed, printable, warning_at};
use crate::view::Marks;
use rayon::prelude::*;
use std::sync::Arc;

/// A model as the scene describes it.
pub(crate) struct Model {
    pub name: String,
    pub file: String,
    pub file_span: Span,
    /// Millimetres per unit of the file.
    pub unit: f64,
    pub placing: Placing,
    pub span: Span,
    regions: Vec<MarkedRegion>,
    /// The most vertices it may have.
    detail: Option<usize>,
    /// As the file has it: models are placed by this.
    pub mesh: Option<TriMesh>,
    /// In its place, if that has too many vertices.
    pub lowered: Option<TriMesh>,
    pub original: Option<Arc<Original>>,
    pub marks: Arc<Marks>,
}

/// The models as written, before their files are read; `None` if any could not be read.
pub(crate) fn models(reader: &mut Reader, raw: &RawScene, scene_span: &Span) -> Option<Vec<Model>> {
    let mut models = listed(reader, &raw.models, scene_span);
    if let Some(most) = detail::detail(reader, &raw.detail) {
        let all = models.iter_mut().flatten();
        all.for_each(|m| m.detail = Some(m.detail.map_or(most, |own| own.min(most))));
    }
    models
}

fn listed(
    reader: &mut Reader,
    field: &Field<List<RawModel>>,
    scene_span: &Span,
) -> Option<Vec<Model>> {
    let (list, span) = reader.required(field, "models", "the scene", scene_span)?;
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
    let mut all_read = true;
    for item in list {
        let span = reader.span(item);
        let model = reader.value(item).and_then(|raw| model(reader, raw, &span));
        all_read &= model.is_some();
        let Some(model) = model else { continue };
        if models.iter().any(|m| m.name == model.name) {
            reader.error(
                &model.span,
                format!("two models are named \"{}\"", printable(&model.name)),
            );
        }
        models.push(model);
    }
    all_read.then_some(models)
}

fn model(reader: &mut Reader, raw: &RawModel, span: &Span) -> Option<Model> {
    let name = reader.required(&raw.name, "name", "this model", span);
    let name = name.and_then(|(n, at)| names::checked(reader, n, &at, "model").map(|n| (n, at)));
    let owner = name
        .as_ref()
        .map_or("this model".to_string(), |(n, _)| format!("model \"{n}\""));
    let file = reader.required(&raw.file, "file", &owner, span);
    let unit = reader.given(&raw.units).map_or(1.0, |(u, _)| u.measure().0);
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
pub(crate) fn load(reader: &mut Reader, model: &mut Model, read: ReadFile) {
    let parsed =
        read(&model.file).and_then(|bytes| intake::load_original(&model.file, &bytes, false));
    let Some(loaded) = reader.read(parsed, &model.file_span) else {
        return;
    };
    let warnings = loaded.warnings.into_iter();
    let warnings = warnings.map(|w| placed(w, &model.file_span));
    reader.problems.extend(warnings);
    let loaded = loaded.value;
    let flat = model
        .placing
        .no_extent(&model.name, &loaded.mesh, &model.span);
    if let Some(problem) = flat {
        reader.problems.push(problem);
        return;
    }
    let Model { name, file, .. } = &*model;
    let marks = marks::marks(reader, &model.regions, &loaded, name, file);
    model.marks = Arc::new(marks);
    model.mesh = Some(loaded.mesh);
    model.original = Some(Arc::new(loaded.original));
}

/// Makes models smaller that have too many vertices; tells what they could not do or keep.
pub(crate) fn lower(reader: &mut Reader, models: &mut [Model], output: &Output) {
    let remarks: Vec<Option<Diagnostic>> = models
        .par_iter_mut()
        .map(|model| model.lower(output))
        .collect();
    reader.problems.extend(remarks.into_iter().flatten());
}

impl Model {
    /// Whether it has more vertices than are wanted.
    pub(crate) fn is_too_fine(&self) -> bool {
        let counts = self.mesh.as_ref().zip(self.detail);
        counts.is_some_and(|(mesh, most)| mesh.vertices.len() > most)
    }

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
                    "model \"{name}\" keeps {count} vertices, more than `detail: {most}`: with fewer its surface would move by more than {} % of its size, or parts of it would be lost",
                    100.0 * mesh::simplify::LOST
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
