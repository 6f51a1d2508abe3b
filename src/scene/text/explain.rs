//! From the errors of RON and of the lexer to sentences with places.

use super::lexer::{self, Broken, TokenKind};
use super::place::{Span, error_at};
use super::tree;
use super::wording::{nearest, printable};
use crate::diag::Diagnostic;
use ron::error::{Error, Position, SpannedError};

/// Text that does not fall into words.
pub(crate) fn broken(text: &str, broken: Broken) -> Diagnostic {
    match broken {
        Broken::OpenString(span) => {
            error_at(&span, "a string starts here and is not closed on its line")
                .label("a `\"` is missing")
                .help("every text stands between two straight double quotes: \"front\"")
        }
        Broken::OpenComment(span) => {
            error_at(&span, "a comment starts here and is never closed").label("`*/` is missing")
        }
        Broken::SmartQuote(span) => error_at(
            &span,
            "typographic quotes are not RON; text stands in straight double quotes",
        )
        .label("a curly quote, perhaps pasted from a web page")
        .help("write \"front\" with the quote key of the keyboard"),
        Broken::OpenBracket { open, closed_by } => {
            let bracket = &text[open.clone()];
            let wanted = lexer::partner(bracket.as_bytes()[0]) as char;
            let message = match &closed_by {
                None => format!("`{bracket}` is opened here and never closed"),
                Some(by) => {
                    format!(
                        "`{bracket}` is closed by `{}` in line {}",
                        &text[by.clone()],
                        line_of(text, by.start)
                    )
                }
            };
            error_at(&open, message).label(format!("its `{wanted}` is missing"))
        }
        Broken::StrayBracket(span) => {
            error_at(&span, format!("`{}` closes nothing", &text[span.clone()]))
                .label("no bracket is open here")
        }
        Broken::TooDeep(span) => error_at(
            &span,
            format!("brackets nest more than {} deep", lexer::DEEPEST),
        ),
    }
}

/// 1-based line of a byte offset.
fn line_of(text: &str, offset: usize) -> usize {
    text[..offset].matches('\n').count() + 1
}

/// What RON found wrong with the value at `span` of a `what`, in our words. May be several problems.
pub(crate) fn explain(
    text: &str,
    what: &str,
    span: &Span,
    error: &SpannedError,
    wanted: &str,
) -> Vec<Diagnostic> {
    let slice = &text[span.clone()];
    match &error.code {
        Error::NoSuchStructField {
            expected, found, ..
        } => match unknown_fields(slice, span.start, expected) {
            // RON looks a name up before it sees that no `:` follows it.
            list if list.is_empty() => vec![no_colon(slice, span, found)],
            list => list,
        },
        Error::DuplicateStructField { field, .. } => vec![duplicate_field(slice, span, field)],
        Error::NoSuchEnumVariant {
            expected, found, ..
        } => vec![unknown_variant(slice, span.start, found, expected)],
        Error::NoSuchExtension(name) => {
            let at = slice
                .find(name.as_str())
                .map_or(span.start, |i| span.start + i);
            vec![
                error_at(
                    &(at..at + name.len()),
                    format!("RON has no extension `{}`", printable(name)),
                )
                .help(format!(
                    "remove the line `#![enable(...)]`: {what}s do not need it"
                )),
            ]
        }
        Error::ExceededRecursionLimit => vec![error_at(span, "values nest too deep")],
        code if span.len() == text.len() && is_syntax(code) => {
            let at = span.start + offset_of(slice, error.span.end);
            vec![decimal_comma(text, span, at).unwrap_or_else(|| syntax(text, what, at, code))]
        }
        _ => vec![unfit(text, span, wanted, error)],
    }
}

/// How messages about unknown fields begin.
pub(crate) const UNKNOWN_FIELD: &str = "unknown field";

fn unknown_fields(slice: &str, base: usize, expected: &[&'static str]) -> Vec<Diagnostic> {
    let unknown = tree::members(slice)
        .into_iter()
        .filter_map(|member| member.name);
    let unknown = unknown.filter(|name| !expected.contains(&&slice[name.clone()]));
    unknown
        .map(|name| {
            let found = &slice[name.clone()];
            let guess = nearest(found, expected.iter().copied());
            let guess = guess
                .map(|g| format!(", did you mean `{g}`?"))
                .unwrap_or_default();
            error_at(
                &(base + name.start..base + name.end),
                format!("{UNKNOWN_FIELD} `{}`{guess}", printable(found)),
            )
            .help(format!("known here: {}", expected.join(", ")))
        })
        .collect()
}

fn no_colon(slice: &str, span: &Span, found: &str) -> Diagnostic {
    let name = slice.find(found).map_or(span.clone(), |at| {
        span.start + at..span.start + at + found.len()
    });
    let text = format!(
        "no `:` follows `{}`, and no field is called so",
        printable(found)
    );
    error_at(&name, text).help("fields are written `name: value`, and divided by commas")
}

fn duplicate_field(slice: &str, span: &Span, field: &str) -> Diagnostic {
    let names = tree::members(slice)
        .into_iter()
        .filter_map(|member| member.name);
    let second = names.filter(|n| &slice[n.clone()] == field).nth(1);
    let at = second.map_or(span.clone(), |n| span.start + n.start..span.start + n.end);
    error_at(&at, format!("`{field}` is given twice")).label("the second one")
}

fn unknown_variant(slice: &str, base: usize, found: &str, expected: &[&'static str]) -> Diagnostic {
    let end = slice
        .find(|c: char| !(c.is_alphanumeric() || c == '_'))
        .unwrap_or(slice.len());
    let guess = nearest(found, expected.iter().copied());
    let guess = guess
        .map(|g| format!(", did you mean `{g}`?"))
        .unwrap_or_default();
    error_at(
        &(base..base + end),
        format!("unknown choice `{}`{guess}", printable(found)),
    )
    .help(format!("one of: {}", expected.join(", ")))
}

/// A value of the wrong sort. Values inside were skimmed when the whole was read: their text is sound RON.
fn unfit(text: &str, span: &Span, wanted: &str, error: &SpannedError) -> Diagnostic {
    let slice = &text[span.clone()];
    let at = span.start + offset_of(slice, error.span.end);
    if let Some(comma) = decimal_comma(text, span, at) {
        return comma;
    }
    let mut problem = error_at(
        span,
        format!("expected {wanted}, found `{}`", printable(slice)),
    );
    if slice.starts_with('[') && wanted.contains("(x, y") {
        problem = problem.help("points stand in round brackets: (0, -250, 48)");
    }
    if wanted.contains("(x, y") && slice.matches(',').count() > wanted.matches(',').count() {
        problem = problem.help("decimal commas? Numbers are written with a point: 0.5");
    }
    if matches!(error.code, Error::IntegerOutOfBounds) {
        problem = problem
            .label("out of range")
            .help("whole numbers run from 0 to 4294967295");
    }
    problem
}

/// Text that is not RON, at the word where that shows.
fn syntax(text: &str, what: &str, at: usize, code: &Error) -> Diagnostic {
    let tokens = lexer::tokens(text).unwrap_or_default();
    let holding = tokens
        .iter()
        .find(|t| t.span.start <= at && at < t.span.end);
    let before = tokens.iter().rev().find(|t| t.span.end <= at);
    let here = holding.map_or(
        at..text[at..].chars().next().map_or(at, |c| at + c.len_utf8()),
        |t| t.span.clone(),
    );
    let found = printable(&text[here.clone()]);
    let split = holding.is_some_and(|t| t.span.start < at);
    match code {
        Error::ExpectedComma if split => error_at(
            &here,
            format!("`{found}` is neither a number nor a word of RON"),
        ),
        Error::ExpectedComma => match before {
            Some(token) => {
                error_at(&token.span, "a comma is missing after this").label("expected `,` here")
            }
            None => error_at(&here, "a comma is missing before this"),
        },
        Error::TrailingCharacters => error_at(
            &here,
            format!("the {what} ends before this: nothing may follow its closing bracket"),
        ),
        Error::ExpectedIdentifier => {
            error_at(&here, format!("expected a field name, found `{found}`"))
        }
        Error::ExpectedMapColon => error_at(
            &here,
            format!("expected `:` after the field's name, found `{found}`"),
        ),
        code => error_at(
            &here,
            format!("this is not RON: {}", lower_first(&code.to_string())),
        ),
    }
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
    let number = |s: &Span| {
        text[s.clone()]
            .trim_start_matches(['-', '+'])
            .bytes()
            .all(|b| b.is_ascii_digit())
    };
    tokens.windows(4).find_map(|w| {
        let (colon, left, comma, right) = (&w[0], &w[1], &w[2], &w[3]);
        let shaped = colon.kind == TokenKind::Mark(b':')
            && left.kind == TokenKind::Word
            && comma.kind == TokenKind::Mark(b',')
            && right.kind == TokenKind::Word
            && left.span.end == comma.span.start
            && comma.span.end == right.span.start
            && number(&left.span)
            && digits(&right.span);
        let near =
            right.span.start >= span.start && left.span.start <= at && at <= right.span.end + 1;
        (shaped && near).then(|| {
            let (l, r) = (&text[left.span.clone()], &text[right.span.clone()]);
            error_at(
                &(left.span.start..right.span.end),
                "a decimal comma: numbers are written with a point",
            )
            .label(format!("write `{l}.{r}`"))
        })
    })
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map_or(String::new(), |c| c.to_lowercase().chain(chars).collect())
}

/// Byte offset of a position that counts lines and characters from 1.
fn offset_of(text: &str, position: Position) -> usize {
    let line: usize = text
        .split_inclusive('\n')
        .take(position.line.saturating_sub(1))
        .map(str::len)
        .sum();
    let column = position.col.saturating_sub(1);
    line + text[line..]
        .char_indices()
        .nth(column)
        .map_or(text.len() - line, |(i, _)| i)
}
