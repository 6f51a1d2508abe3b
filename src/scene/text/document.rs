//! From RON text to raw values: of a scene, or of a layout file that a scene includes.

use super::explain;
use super::lexer;
use super::place::{Span, error_at};
use super::tree;
use super::wanted::Wanted;
use super::wording::printable;
use crate::diag::{Diagnostic, Place};
use crate::scene::defaults;
use serde::de::DeserializeOwned;

/// Text that reads as RON as far as its brackets go.
pub(crate) struct Document<'a> {
    pub text: &'a str,
    /// A "scene" or a "layout".
    pub what: &'static str,
    tokens: Vec<lexer::Token>,
}

impl<'a> Document<'a> {
    /// Refuses what is no document at all, before RON sees it.
    ///
    /// # Errors
    /// No text or too much of it, strings or brackets that are not closed. `start` is the help on where to start from.
    pub(crate) fn new(text: &'a str, what: &'static str, start: &str) -> Result<Self, Diagnostic> {
        if text.trim().is_empty() {
            return Err(Diagnostic::error(format!("the {what} file is empty")).help(start));
        }
        if text.len() > defaults::LONGEST_TEXT {
            return Err(Diagnostic::error(format!(
                "the {what} is {} MB of text; the limit is {} MB",
                text.len() >> 20,
                defaults::LONGEST_TEXT >> 20
            )));
        }
        let tokens = lexer::tokens(text).map_err(|broken| explain::broken(text, broken))?;
        if tokens.is_empty() {
            return Err(error_at(
                &(0..text.trim_end().len().min(80)),
                format!("the {what} holds nothing but comments"),
            )
            .help(start));
        }
        lexer::balanced(&tokens).map_err(|broken| explain::broken(text, broken))?;
        Ok(Self { text, what, tokens })
    }

    /// The first character of the value, behind attributes.
    pub(crate) fn opening(&self) -> Option<u8> {
        let first = tree::skip_attribute(self.text).first()?.span.start;
        self.text.as_bytes().get(first).copied()
    }

    /// The whole as a raw value, which stands in brackets of the kind `open`.
    ///
    /// # Errors
    /// What keeps the text from being such a value, unless that is within a part that fails by itself.
    pub(crate) fn parse<T: DeserializeOwned + Wanted>(
        &self,
        open: u8,
    ) -> Result<T, Vec<Diagnostic>> {
        let (text, what) = (self.text, self.what);
        let first = self.tokens.first().map_or(0..0, |t| t.span.clone());
        match text.as_bytes().get(first.start) {
            Some(b'{') => {
                return Err(vec![
                    error_at(&first, format!("this looks like JSON; {what}s are RON")).help("structs stand in round brackets and field names without quotes: ( units: mm, views: [ ... ] )"),
                ]);
            }
            Some(found) if *found == open || *found == b'#' => {}
            _ => {
                let found = printable(text[first.start..].lines().next().unwrap_or(""));
                let text = format!("expected {}, found `{found}`", T::WANTED);
                return Err(vec![error_at(&first, text)]);
            }
        }
        super::spanned::options()
            .from_str(text)
            .map_err(|error| explain::explain(text, what, &(0..text.len()), &error, T::WANTED))
    }
}

/// The value and what is wrong with it.
pub(crate) type Attempt<T> = (Vec<Diagnostic>, Option<T>);

/// How often a text is read again without its unknown fields; deeper nests of them are not worth more.
const ROUNDS: usize = 4;

/// Reads `text` by `attempt`. A struct with an unknown field tells nothing else: it is read on without such fields, which are told
/// of as well. Problems in the order of the text.
pub(crate) fn read<T>(text: &str, attempt: impl Fn(&str) -> Attempt<T>) -> Attempt<T> {
    let mut text = text.to_string();
    let mut unknown: Vec<Diagnostic> = Vec::new();
    let (mut problems, mut value) = attempt(&text);
    for _ in 0..ROUNDS {
        let (fresh, rest): (Vec<_>, Vec<_>) = problems.into_iter().partition(is_unknown_field);
        problems = rest;
        if fresh.is_empty() {
            break;
        }
        text = fresh.iter().fold(text, |text, problem| {
            tree::without_field(&text, start(problem))
        });
        unknown.extend(fresh);
        (problems, value) = attempt(&text);
    }
    // `pich` is one mistake, not an unknown field and a missing `pitch`.
    let meant = |p: &Diagnostic| {
        unknown
            .iter()
            .any(|u| meant_field(u).is_some_and(|g| p.message.ends_with(&format!("has no `{g}`"))))
    };
    problems.retain(|p| !meant(p));
    problems.extend(unknown);
    problems.sort_by_key(start);
    problems.dedup();
    (problems, value)
}

/// Byte at which a problem's place starts; problems without a place in the text come last.
pub(crate) fn start(problem: &Diagnostic) -> usize {
    match &problem.place {
        Some(Place::Scene(span)) => span.start,
        _ => usize::MAX,
    }
}

/// One in this text, not in a file that it includes.
fn is_unknown_field(problem: &Diagnostic) -> bool {
    problem.message.starts_with(explain::UNKNOWN_FIELD)
        && matches!(problem.place, Some(Place::Scene(_)))
}

/// The field that was meant by an unknown one, if its message guesses.
fn meant_field(unknown: &Diagnostic) -> Option<&str> {
    unknown
        .message
        .split_once("did you mean `")?
        .1
        .split('`')
        .next()
}

/// A problem of an included file's text as one that names the file and the line.
pub(crate) fn in_file(problem: Diagnostic, file: &str, text: &str) -> Diagnostic {
    let Some(Place::Scene(span)) = &problem.place else {
        return match problem.place {
            None => problem.at(Place::File(file.to_string())),
            Some(_) => problem,
        };
    };
    let place = line(file, text, span);
    problem.at(place)
}

/// Characters of a line that are shown before the marked place; what stands farther left is left out.
const BEFORE: usize = 40;

fn line(file: &str, text: &str, span: &Span) -> Place {
    let at = (0..=span.start.min(text.len()))
        .rev()
        .find(|i| text.is_char_boundary(*i))
        .unwrap_or(0);
    let first = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let before = text[first..at].trim_start();
    let from = match before.chars().count() > BEFORE {
        true => at,
        false => at - before.len(),
    };
    Place::Line {
        file: file.to_string(),
        line: text[..at].matches('\n').count() + 1,
        excerpt: printable(text[from..].lines().next().unwrap_or("").trim_end()),
    }
}
