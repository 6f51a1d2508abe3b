//! From scene text to a [`Scene`] in which nothing is left to decide.
//!
//! Takes text and a way to read the files it names; gives the scene or *all* of its problems in the order of the text.
//! After it: lengths are millimetres, names are unique and fit for files, numbers are finite and in range, meshes are
//! in place, pillars neither overlap nor float, eyes stand in the open.

use super::carriers::carriers;
use super::defaults;
use super::language::raw::RawScene;
use super::layout::Around;
use super::models::{Model, load, lower, models};
use super::options::{energy, printing, steps, whole};
use super::request::{Begun, Purpose, ReadFile};
use super::resolved::Scene;
use super::text::document::{self, Document};
use super::text::lexer;
use super::text::{Field, Reader, printable, warning_at};
use super::views::{Draft, Eye, drafts, view};
use crate::diag::{Diagnostic, Warned};
use crate::kinds::{Bounded, ReliefKind};
use crate::mimic::Energy;

/// Reads and checks a whole scene. Places of problems are byte ranges of `text` after a byte order mark.
///
/// # Errors
/// Every problem found, warnings among them, at least one of them an error.
pub fn resolve(text: &str, read: ReadFile) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    resolve_for(text, read, Purpose::Build, &|_| ())
}

/// As [`resolve`], but pillars that the scene lists are the given ones of a [`Brief`](crate::planner::Brief), free to be moved:
/// those that overlap or stand beside the base are what is to be mended.
///
/// # Errors
/// As [`resolve`].
pub fn resolve_to_mend(text: &str, read: ReadFile) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    resolve_for(text, read, Purpose::Mend, &|_| ())
}

/// [`resolve`] or [`resolve_to_mend`], by the purpose, for those who wait: tells as it goes on to models, and to those it simplifies.
///
/// # Errors
/// As [`resolve`].
pub fn resolve_for(
    text: &str,
    read: ReadFile,
    purpose: Purpose,
    told: Begun,
) -> Result<Warned<Scene>, Vec<Diagnostic>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (problems, scene) = document::read(text, |text| match parse(text) {
        Err(problems) => (problems, None),
        Ok(raw) => {
            let mut reader = Reader::new(text, SCENE);
            let scene = build(&mut reader, &raw, read, purpose, told);
            (reader.problems, scene)
        }
    });
    match scene {
        Some(value) if !problems.iter().any(Diagnostic::is_error) => Ok(Warned {
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

fn build(
    reader: &mut Reader,
    raw: &RawScene,
    read: ReadFile,
    purpose: Purpose,
    told: Begun,
) -> Option<Scene> {
    let scene_span = lexer::trimmed(reader.text);
    if let Some((unit, _)) = reader.given(&raw.units) {
        (reader.unit, reader.unit_name) = unit.measure();
    }
    let title = title(reader, &raw.title);
    let mut models = models(reader, raw, &scene_span);
    let drafts = drafts(reader, &raw.views, &scene_span, models.as_deref());
    let printer = printing::printer(reader, &raw.printer);
    let making = printing::making(reader, &raw.make, &printer);
    let seen = reader.within(&raw.seen, "seen", defaults::SEEN_ALLOWED);
    if !drafts.is_empty() && Some(drafts.len()) == view_count(raw) {
        warn_of_unseen(reader, models.as_deref().unwrap_or_default(), &drafts);
    }
    let eyes: Vec<Eye> = drafts.iter().map(Draft::eye).collect();
    let around = Around {
        read,
        purpose,
        making: &making,
        views: drafts.iter().map(|d| d.name.as_str()).collect(),
        view_count: view_count(raw).unwrap_or(drafts.len()),
    };
    let carriers = carriers(reader, raw, &scene_span, &around);
    let energy = energy::energy(reader, &raw.energy);
    let steps = steps::steps(reader, &raw.energy, carriers.most_pillars(), &making);
    let held = whole::whole(reader, raw);
    let contested = energy::contested(reader, &raw.contested);
    let output = printing::output(reader, &raw.output);
    carriers.check(reader, &eyes, &around);
    whole::check_supports(reader, raw, held, carriers.bodies());
    let models = models.as_deref_mut().unwrap_or_default();
    told("models");
    load_all(reader, models, read, held);
    if models.iter().any(Model::is_too_fine) {
        told("simplifying models");
    }
    lower(reader, models, &output);
    told("scene");
    let adjusted = carriers.adjusted(&around.views);
    let upright = carriers.most_pillars() > 0;
    let drafts = drafts.into_iter().zip(&adjusted);
    let views = drafts
        .map(|(draft, adjusted)| view(reader, draft, models, adjusted, making.way, upright))
        .collect();
    let sound = reader.problems.iter().all(|d| !d.is_error());
    let (mut supports, brief) = carriers.finished();
    if held.is_some() {
        whole::hold_outlines(&mut supports);
    }
    let making = making.of(&supports);
    sound.then_some(Scene {
        title,
        views,
        supports,
        brief,
        adjusted,
        relief: match (held, steps, energy) {
            (Some(bounded), _, energy) => ReliefKind::Whole(energy, bounded),
            (None, Some(steps), Energy::Normal(options)) => ReliefKind::Torn(options, steps),
            (None, _, energy) => ReliefKind::HeightField(energy),
        },
        contested,
        making,
        printer,
        seen_arcmin: seen.map_or(defaults::SEEN, |(v, _)| v),
        output,
    })
}

/// Reads the files of all models.
fn load_all(reader: &mut Reader, models: &mut [Model], read: ReadFile, held: Option<Bounded>) {
    for model in models.iter_mut() {
        load(reader, model, read);
        if let (Some(_), Some(mesh)) = (held, &model.mesh) {
            whole::check_closed(reader, mesh, &model.name, &model.file_span);
        }
    }
}

/// Models that nobody is to see: most likely a name was forgotten.
fn warn_of_unseen(reader: &mut Reader, models: &[Model], drafts: &[Draft]) {
    let shown = |name: &str| {
        let mut all = drafts.iter().flat_map(|d| &d.models);
        all.any(|(shown, _)| shown == name)
    };
    for model in models.iter().filter(|m| !shown(&m.name)) {
        let name = printable(&model.name);
        let text = format!("model \"{name}\" is in no view, so nothing of it will be made");
        let help = format!("add it to the `models` of a view: models: [\"{name}\"]; or remove it");
        let warning = warning_at(&model.span, text).help(help);
        reader.problems.push(warning);
    }
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
