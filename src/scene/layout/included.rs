//! Layout files: pillars, and adjustments of models, that a scene includes with `File("layout.ron")`.
//!
//! Takes the file's bytes; gives entries as if they stood in the scene. Problems name the file and the line. Places of entries are
//! byte ranges that go on behind the scene's text, for the checks; [`Included::told`] finds them again.

use super::around::Around;
use crate::diag::{Diagnostic, Place};
use crate::planner::Adjustment;
use crate::scene::defaults;
use crate::scene::language::raw::{RawAdjust, RawLayout, RawPillars};
use crate::scene::supports::depths::Wish;
use crate::scene::supports::pillars::{PillarEntry, some_entries};
use crate::scene::text::document::{self, Attempt, Document, in_file};
use crate::scene::text::lexer;
use crate::scene::text::{Field, List, Reader, Span, Spanned, error_at, nearest, printable};

/// A layout file.
pub(crate) struct Included {
    file: String,
    text: String,
    /// Where the scene's text ends and this one goes on, bytes.
    shift: usize,
    pub entries: Vec<PillarEntry>,
    /// By name of the view.
    pub adjust: Vec<(String, Adjustment)>,
}

/// What messages call the text.
const LAYOUT: &str = "layout";
const START: &str = "`pillarforest plan` writes a layout";

/// Reads a layout file; its problems are added to the scene's. `depth` is the scene's.
pub(crate) fn included(
    reader: &mut Reader,
    file: &str,
    bytes: Vec<u8>,
    depth: &Wish,
    around: &Around,
) -> Option<Included> {
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let offset = error.utf8_error().valid_up_to() as u64;
            let text = format!("the layout is not UTF-8 text: byte {offset} fits no character");
            let file = file.to_string();
            let problem = Diagnostic::error(text).at(Place::Byte { file, offset });
            reader
                .problems
                .push(problem.help("save it as UTF-8 in the editor"));
            return None;
        }
    };
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).to_string();
    // What the scene says of depths is told at its own place, if it is wrong.
    let depth = depth.placeless();
    let (problems, found) = document::read(&text, |text| attempt(text, &depth, around));
    let problems = problems.into_iter().map(|p| in_file(p, file, &text));
    reader.problems.extend(problems);
    let shift = reader.text.len() + 1;
    let (mut entries, adjust) = found?;
    for spot in entries.iter_mut().flat_map(|e| &mut e.spots) {
        spot.span = spot.span.start + shift..spot.span.end + shift;
    }
    Some(Included {
        file: file.to_string(),
        text,
        shift,
        entries,
        adjust,
    })
}

impl Included {
    /// A problem of the checks with its place in this file, if that is where it lies.
    pub(crate) fn told(&self, problem: Diagnostic) -> Diagnostic {
        match &problem.place {
            Some(Place::Scene(span)) if span.start >= self.shift => {
                let span = span.start - self.shift..span.end - self.shift;
                in_file(problem.at(Place::Scene(span)), &self.file, &self.text)
            }
            _ => problem,
        }
    }
}

type Found = (Vec<PillarEntry>, Vec<(String, Adjustment)>);

fn attempt(text: &str, depth: &Wish, around: &Around) -> Attempt<Found> {
    let raw = match parse(text) {
        Ok(raw) => raw,
        Err(problems) => return (problems, None),
    };
    let mut reader = Reader::new(text, LAYOUT);
    if let Some((unit, _)) = reader.given(&raw.units) {
        (reader.unit, reader.unit_name) = unit.measure();
    }
    let all = lexer::trimmed(text);
    let pillars = reader.required(&raw.pillars, "pillars", "the layout", &all);
    let entries = pillars.map(|(list, span)| some_entries(&mut reader, list, &span, depth));
    let adjust = match reader.given(&raw.adjust) {
        Some((list, _)) => adjustments(&mut reader, list, around),
        None => Vec::new(),
    };
    (reader.problems, entries.map(|entries| (entries, adjust)))
}

/// A bare list is a layout with nothing but pillars.
fn parse(text: &str) -> Result<RawLayout, Vec<Diagnostic>> {
    let document = Document::new(text, LAYOUT, START).map_err(|problem| vec![problem])?;
    if document.opening() != Some(b'[') {
        return document.parse(b'(');
    }
    let list: List<RawPillars> = document.parse(b'[')?;
    let text = &text[lexer::trimmed(text)];
    let pillars = Spanned {
        address: text.as_ptr() as usize,
        length: text.len(),
        value: Ok(list),
    };
    Ok(RawLayout {
        pillars: Field::Given(pillars),
        ..RawLayout::default()
    })
}

fn adjustments(
    reader: &mut Reader,
    list: &List<RawAdjust>,
    around: &Around,
) -> Vec<(String, Adjustment)> {
    let mut found: Vec<(String, Adjustment)> = Vec::new();
    for item in list.iter().take(2 * defaults::MOST_VIEWS) {
        let span = reader.span(item);
        let Some(raw) = reader.value(item) else {
            continue;
        };
        let Some((view, at)) = view(reader, raw, &span, around) else {
            continue;
        };
        if found.iter().any(|(v, _)| *v == view) {
            let text = format!("view \"{}\" is adjusted twice", printable(&view));
            reader.error(&at, text);
        }
        found.push((view, adjustment(reader, raw)));
    }
    found
}

fn view(
    reader: &mut Reader,
    raw: &RawAdjust,
    span: &Span,
    around: &Around,
) -> Option<(String, Span)> {
    let (name, at) = reader.required(&raw.view, "view", "this adjustment", span)?;
    let known = &around.views;
    // A view that could not be read may be the one that is meant.
    let missing = known.len() == around.view_count && !known.contains(&name.as_str());
    if missing {
        let guess = nearest(name, known.iter().copied())
            .map(|g| format!(", did you mean \"{g}\"?"))
            .unwrap_or_default();
        let text = format!("there is no view \"{}\"{guess}", printable(name));
        let help = format!("views of the scene: {}", known.join(", "));
        reader.problems.push(error_at(&at, text).help(help));
        return None;
    }
    Some((name.clone(), at))
}

fn adjustment(reader: &mut Reader, raw: &RawAdjust) -> Adjustment {
    let turn = reader.number(&raw.turn, "turn");
    let scale = reader.within(&raw.scale, "scale", defaults::SIZE_FACTORS);
    let shift = reader.point_field(&raw.shift, "shift");
    Adjustment {
        turn: turn.map_or(0.0, |(v, _)| v.to_radians()),
        scale: scale.map_or(1.0, |(v, _)| v),
        shift: shift.map_or(glam::DVec2::ZERO, |(v, _)| v.into()),
    }
}
