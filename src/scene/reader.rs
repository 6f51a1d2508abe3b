//! From raw values to checked ones, and from RON's errors to sentences.
//!
//! A [`Reader`] collects every problem of one scene; asking it for a value either gives it or notes why not.

use super::defaults;
use super::lexer::{self, Broken, Kind};
use super::raw::Wanted;
use super::spanned::{Field, Spanned};
use super::tree;
use crate::diag::{Diagnostic, Place};
use ron::error::{Error, Position, SpannedError};
use std::ops::Range;

/// Byte range of the scene's text.
pub type Span = Range<usize>;

/// Collects the problems of one text.
pub struct Reader<'a> {
    pub text: &'a str,
    pub problems: Vec<Diagnostic>,
    /// Millimetres per unit of the scene.
    pub unit: f64,
    pub unit_name: &'static str,
}

/// An error at a place of the scene.
pub fn error_at(span: &Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(message).at(Place::Scene(span.clone()))
}

/// A warning at a place of the scene.
pub fn warning_at(span: &Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::warning(message).at(Place::Scene(span.clone()))
}

impl<'a> Reader<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, problems: Vec::new(), unit: 1.0, unit_name: "mm" }
    }

    /// Where a value stands.
    pub fn span<T>(&self, spanned: &Spanned<T>) -> Span {
        let start = spanned.address.saturating_sub(self.text.as_ptr() as usize).min(self.text.len());
        start..(start + spanned.length).min(self.text.len())
    }

    pub fn error(&mut self, span: &Span, message: impl Into<String>) {
        self.problems.push(error_at(span, message));
    }

    /// The value if it could be read; otherwise its problem is noted.
    pub fn value<'v, T: Wanted>(&mut self, spanned: &'v Spanned<T>) -> Option<&'v T> {
        match &spanned.value {
            Ok(value) => Some(value),
            Err(error) => {
                let span = self.span(spanned);
                let found = explain(self.text, &span, error, T::WANTED);
                self.problems.extend(found);
                None
            }
        }
    }

    /// The value and place of a field if it is there and right.
    pub fn given<'v, T: Wanted>(&mut self, field: &'v Field<T>) -> Option<(&'v T, Span)> {
        match field {
            Field::Missing => None,
            Field::Given(spanned) => {
                let span = self.span(spanned);
                self.value(spanned).map(|value| (value, span))
            }
        }
    }

    /// As `given`, but a missing field is an error of `owner` ("view \"front\""), which stands at `place`.
    pub fn required<'v, T: Wanted>(
        &mut self,
        field: &'v Field<T>,
        name: &str,
        owner: &str,
        place: &Span,
    ) -> Option<(&'v T, Span)> {
        self.need(field, name, owner, place);
        self.given(field)
    }

    /// Notes an error if the field is missing.
    pub fn need<T: Wanted>(&mut self, field: &Field<T>, name: &str, owner: &str, place: &Span) {
        if matches!(field, Field::Missing) {
            let head = head_of(self.text, place);
            self.problems.push(
                error_at(&head, format!("{owner} has no `{name}`"))
                    .label(format!("`{name}` is missing here"))
                    .help(format!("add `{name}: ...`: {}", T::WANTED)),
            );
        }
    }

    /// A number that is neither NaN nor infinite.
    pub fn number(&mut self, field: &Field<f64>, name: &str) -> Option<(f64, Span)> {
        let (value, span) = self.given(field)?;
        if value.is_finite() {
            return Some((*value, span));
        }
        self.error(&span, format!("`{name}` must be a finite number, found {value}"));
        None
    }

    /// A length in millimetres, signed, within ten metres.
    pub fn length(&mut self, field: &Field<f64>, name: &str) -> Option<(f64, Span)> {
        let (value, span) = self.number(field, name)?;
        let value = self.scaled(value, name, &span)?;
        Some((value, span))
    }

    /// A length of at least `least` millimetres.
    pub fn length_from(&mut self, field: &Field<f64>, name: &str, least: f64) -> Option<(f64, Span)> {
        let (value, span) = self.length(field, name)?;
        if value >= least {
            return Some((value, span));
        }
        let wanted = if least > 0.0 { format!("at least {least} mm") } else { "not negative".to_string() };
        self.error(&span, format!("`{name}` is {} mm; it must be {wanted}", short(value)));
        None
    }

    /// A point in millimetres.
    pub fn point<const N: usize>(&mut self, values: &[f64; N], name: &str, span: &Span) -> Option<[f64; N]> {
        if let Some(bad) = values.iter().find(|v| !v.is_finite()) {
            self.error(span, format!("`{name}` has a coordinate that is not a finite number: {bad}"));
            return None;
        }
        let mut scaled = [0.0; N];
        for (to, from) in scaled.iter_mut().zip(values) {
            *to = self.scaled(*from, name, span)?;
        }
        Some(scaled)
    }

    /// A field that is a point, in millimetres.
    pub fn point_field<const N: usize>(&mut self, field: &Field<[f64; N]>, name: &str) -> Option<([f64; N], Span)>
    where
        [f64; N]: Wanted,
    {
        let (values, span) = self.given(field)?;
        let point = self.point(values, name, &span)?;
        Some((point, span))
    }

    /// A whole number within a range.
    pub fn count(
        &mut self,
        field: &Field<u32>,
        name: &str,
        range: std::ops::RangeInclusive<u32>,
    ) -> Option<(u32, Span)> {
        let (&value, span) = self.given(field)?;
        if range.contains(&value) {
            return Some((value, span));
        }
        let wanted = match *range.end() {
            u32::MAX => format!("at least {}", range.start()),
            end => format!("from {} to {end}", range.start()),
        };
        self.error(&span, format!("`{name}` is {value}; it must be {wanted}"));
        None
    }

    fn scaled(&mut self, value: f64, name: &str, span: &Span) -> Option<f64> {
        let scaled = value * self.unit;
        if scaled.abs() <= defaults::LARGEST {
            return Some(scaled);
        }
        let metres = short(scaled / 1000.0);
        self.error(span, format!("`{name}` is {value} {}, that is {metres} m; scenes end at 10 m", self.unit_name));
        None
    }
}

/// A number for people: at most three decimals, none without need.
pub fn short(value: f64) -> String {
    let rounded = (value * 1e3).round() / 1e3;
    if value != 0.0 && rounded == 0.0 { format!("{value:e}") } else { format!("{rounded}") }
}

/// `, did you mean ...` for the nearest of `known`, if any is near.
pub fn nearest<'k>(found: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let lower = found.to_lowercase();
    let likeness = |k: &str| strsim::jaro_winkler(&lower, &k.to_lowercase());
    let best = known.into_iter().map(|k| (likeness(k), k)).fold(None, |best: Option<(f64, &str)>, next| match best {
        Some(b) if b.0 >= next.0 => Some(b),
        _ => Some(next),
    })?;
    (best.0 > 0.78).then_some(best.1)
}

/// Makes text fit for one line of a terminal: control and direction characters escaped, cut at 60 characters or the first line end.
pub fn printable(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    let mut out = crate::diag::escaped(&line.chars().take(60).collect::<String>());
    if line.len() < text.len() || line.chars().count() > 60 {
        out.push_str("...");
    }
    out
}

/// The first token of what stands at `place`, with its bracket.
fn head_of(text: &str, place: &Span) -> Span {
    let slice = &text[place.clone()];
    let end = slice.find(['(', '[']).map_or(slice.len().min(1), |i| i + 1);
    place.start..place.start + end
}

/// Text that does not fall into words.
pub fn broken(text: &str, broken: Broken) -> Diagnostic {
    match broken {
        Broken::OpenString(span) => error_at(&span, "a string starts here and is not closed on its line")
            .label("a `\"` is missing")
            .help("every text stands between two straight double quotes: \"front\""),
        Broken::OpenComment(span) => {
            error_at(&span, "a comment starts here and is never closed").label("`*/` is missing")
        }
        Broken::SmartQuote(span) => {
            error_at(&span, "typographic quotes are not RON; text stands in straight double quotes")
                .label("a curly quote, perhaps pasted from a web page")
                .help("write \"front\" with the quote key of the keyboard")
        }
        Broken::OpenBracket { open, closed_by } => {
            let bracket = &text[open.clone()];
            let wanted = lexer::partner(bracket.as_bytes()[0]) as char;
            let message = match &closed_by {
                None => format!("`{bracket}` is opened here and never closed"),
                Some(by) => {
                    format!("`{bracket}` is closed by `{}` in line {}", &text[by.clone()], line_of(text, by.start))
                }
            };
            error_at(&open, message).label(format!("its `{wanted}` is missing"))
        }
        Broken::StrayBracket(span) => {
            error_at(&span, format!("`{}` closes nothing", &text[span.clone()])).label("no bracket is open here")
        }
        Broken::TooDeep(span) => error_at(&span, format!("brackets nest more than {} deep", lexer::DEEPEST)),
    }
}

/// 1-based line of a byte offset.
fn line_of(text: &str, offset: usize) -> usize {
    text[..offset].matches('\n').count() + 1
}

/// What RON found wrong with the value at `span`, in our words. May be several problems.
pub fn explain(text: &str, span: &Span, error: &SpannedError, wanted: &str) -> Vec<Diagnostic> {
    let slice = &text[span.clone()];
    match &error.code {
        Error::NoSuchStructField { expected, .. } => unknown_fields(slice, span.start, expected),
        Error::DuplicateStructField { field, .. } => vec![duplicate_field(slice, span, field)],
        Error::NoSuchEnumVariant { expected, found, .. } => vec![unknown_variant(slice, span.start, found, expected)],
        Error::NoSuchExtension(name) => {
            let at = slice.find(name.as_str()).map_or(span.start, |i| span.start + i);
            vec![error_at(&(at..at + name.len()), format!("RON has no extension `{}`", printable(name)))
                .help("remove the line `#![enable(...)]`: scenes do not need it")]
        }
        Error::ExceededRecursionLimit => vec![error_at(span, "values nest too deep")],
        code => vec![unfit(text, span, code, wanted, error)],
    }
}

fn unknown_fields(slice: &str, base: usize, expected: &[&'static str]) -> Vec<Diagnostic> {
    let unknown = tree::entries(slice).into_iter().filter_map(|entry| entry.name);
    let unknown = unknown.filter(|name| !expected.contains(&&slice[name.clone()]));
    unknown
        .map(|name| {
            let found = &slice[name.clone()];
            let guess = nearest(found, expected.iter().copied());
            let guess = guess.map(|g| format!(", did you mean `{g}`?")).unwrap_or_default();
            error_at(&(base + name.start..base + name.end), format!("unknown field `{}`{guess}", printable(found)))
                .help(format!("known here: {}", expected.join(", ")))
        })
        .collect()
}

fn duplicate_field(slice: &str, span: &Span, field: &str) -> Diagnostic {
    let names = tree::entries(slice).into_iter().filter_map(|entry| entry.name);
    let second = names.filter(|n| &slice[n.clone()] == field).nth(1);
    let at = second.map_or(span.clone(), |n| span.start + n.start..span.start + n.end);
    error_at(&at, format!("`{field}` is given twice")).label("the second one")
}

fn unknown_variant(slice: &str, base: usize, found: &str, expected: &[&'static str]) -> Diagnostic {
    let end = slice.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(slice.len());
    let guess = nearest(found, expected.iter().copied());
    let guess = guess.map(|g| format!(", did you mean `{g}`?")).unwrap_or_default();
    error_at(&(base..base + end), format!("unknown choice `{}`{guess}", printable(found)))
        .help(format!("one of: {}", expected.join(", ")))
}

/// A value of the wrong sort, or text that is not RON at all.
fn unfit(text: &str, span: &Span, code: &Error, wanted: &str, error: &SpannedError) -> Diagnostic {
    let slice = &text[span.clone()];
    let at = span.start + offset_of(slice, error.span.end);
    if let Some(comma) = decimal_comma(text, span, at) {
        return comma;
    }
    if is_syntax(code) {
        let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
        return error_at(&(at..end), format!("this is not RON: {}", lower_first(&code.to_string())));
    }
    let mut problem = error_at(span, format!("expected {wanted}, found `{}`", printable(slice)));
    if slice.starts_with('[') && wanted.contains("(x, y") {
        problem = problem.help("points stand in round brackets: (0, -250, 48)");
    }
    if matches!(code, Error::IntegerOutOfBounds) {
        problem = problem.label("out of range").help("whole numbers run from 0 to 4294967295");
    }
    problem
}

/// Whether the text breaks RON's own rules there.
fn is_syntax(code: &Error) -> bool {
    matches!(
        code,
        Error::ExpectedComma
            | Error::ExpectedMapColon
            | Error::ExpectedIdentifier
            | Error::ExpectedAttribute
            | Error::ExpectedAttributeEnd
            | Error::UnexpectedChar(_)
            | Error::InvalidEscape(_)
            | Error::TrailingCharacters
            | Error::Eof
            | Error::UnclosedBlockComment
            | Error::UnclosedLineComment
    )
}

/// `5,0` where a number was meant: a digit, a comma without a space, digits, next to the place of the error.
fn decimal_comma(text: &str, span: &Span, at: usize) -> Option<Diagnostic> {
    let tokens = lexer::tokens(text).ok()?;
    let digits = |s: &Span| text[s.clone()].bytes().all(|b| b.is_ascii_digit());
    let number = |s: &Span| text[s.clone()].trim_start_matches(['-', '+']).bytes().all(|b| b.is_ascii_digit());
    tokens.windows(4).find_map(|w| {
        let (colon, left, comma, right) = (&w[0], &w[1], &w[2], &w[3]);
        let shaped = colon.kind == Kind::Mark(b':')
            && left.kind == Kind::Word
            && comma.kind == Kind::Mark(b',')
            && right.kind == Kind::Word
            && left.span.end == comma.span.start
            && comma.span.end == right.span.start
            && number(&left.span)
            && digits(&right.span);
        let near = right.span.start >= span.start && left.span.start <= at && at <= right.span.end + 1;
        (shaped && near).then(|| {
            let (l, r) = (&text[left.span.clone()], &text[right.span.clone()]);
            error_at(&(left.span.start..right.span.end), "a decimal comma: numbers are written with a point")
                .label(format!("write `{l}.{r}`"))
        })
    })
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |c| c.to_lowercase().chain(chars).collect())
}

/// Byte offset of a position that counts lines and characters from 1.
fn offset_of(text: &str, position: Position) -> usize {
    let line: usize = text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum();
    let column = position.col.saturating_sub(1);
    line + text[line..].char_indices().nth(column).map_or(text.len() - line, |(i, _)| i)
}
