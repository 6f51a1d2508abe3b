//! Diagnostics on the terminal: with excerpts for people, one line each for editors, JSON for programs.
//!
//! Nothing of the user's text reaches the terminal with its control or direction characters alive.

use super::args::{Global, Style, When};
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use pillarforest::diag::{Diagnostic, Place, Severity, escaped};
use std::fmt::Write as _;
use std::io::{IsTerminal, Write as _};
use std::ops::Range;

/// The scene's name and text, for excerpts.
pub(super) struct Source {
    pub path: String,
    pub text: String,
}

/// Prints diagnostics to standard error.
pub(super) struct Messages {
    style: Style,
    coloured: bool,
    quiet: bool,
    deny_warnings: bool,
}

/// Prints a line to standard error. That may be closed or full; then there is nobody left to tell, and the work goes on.
pub(super) fn tell(line: &str) {
    let _ = std::io::stderr().write_all(format!("{line}\n").as_bytes());
}

/// Whether the surroundings speak against colours: https://no-color.org, or a terminal that has none.
pub(super) fn colours_wanted() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()) && !is_dumb()
}

/// Whether the terminal can only write line after line.
pub(super) fn is_dumb() -> bool {
    std::env::var_os("TERM").is_some_and(|t| t == "dumb")
}

/// Characters of a long line shown before and after the marked place.
const AROUND: usize = 120;

impl Messages {
    pub(super) fn new(global: &Global) -> Self {
        let auto = || std::io::stderr().is_terminal() && colours_wanted();
        let coloured = match global.color {
            When::Always => true,
            When::Never => false,
            When::Auto => auto(),
        };
        Self {
            style: global.diagnostics,
            coloured,
            quiet: global.quiet,
            deny_warnings: global.deny.is_some(),
        }
    }

    /// Whether programs read them.
    pub(super) fn is_json(&self) -> bool {
        self.style == Style::Json
    }

    /// Prints all; tells whether the run must stop.
    pub(super) fn print(&self, list: &[Diagnostic], source: Option<&Source>) -> bool {
        let mut out = String::new();
        let stops = |d: &Diagnostic| d.is_error() || self.deny_warnings && d.is_warning();
        for diagnostic in list.iter().filter(|d| stops(d) || !self.quiet) {
            match self.style {
                Style::Human => out.push_str(&self.human(diagnostic, source)),
                Style::Short => out.push_str(&short(diagnostic, source)),
                Style::Json => out.push_str(&json(diagnostic, source)),
            }
            out.push('\n');
            if self.style == Style::Human {
                out.push('\n');
            }
        }
        // As with `tell`.
        let _ = std::io::stderr().write_all(out.as_bytes());
        list.iter().any(stops)
    }

    /// `2 errors, 1 warning. Nothing was written.`
    pub(super) fn closing(&self, list: &[Diagnostic], last: &str) {
        if self.style == Style::Json {
            return;
        }
        let errors = list.iter().filter(|d| d.is_error()).count();
        let warnings = list.iter().filter(|d| d.is_warning()).count();
        let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        let parts: Vec<String> = [(errors, "error"), (warnings, "warning")]
            .iter()
            .filter(|(n, _)| *n > 0)
            .map(|&(n, what)| count(n, what))
            .collect();
        let denied = if errors == 0 && self.deny_warnings {
            " Warnings are denied."
        } else {
            ""
        };
        tell(&format!("{}.{denied} {last}", parts.join(", ")));
    }

    fn human(&self, diagnostic: &Diagnostic, source: Option<&Source>) -> String {
        let level = match diagnostic.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let message = escaped(&diagnostic.message);
        let label = diagnostic.label.as_deref().map(escaped);
        let mut group = Group::with_title(level.primary_title(message));
        match (&diagnostic.place, source) {
            (Some(Place::Scene(span)), Some(source)) => {
                let view = Excerpt::of(&source.text, span);
                let mark = AnnotationKind::Primary.span(view.mark).label(label);
                let snippet = Snippet::source(view.text)
                    .line_start(view.line)
                    .path(escaped(&source.path));
                group = group.element(snippet.annotation(mark));
            }
            (
                Some(Place::Line {
                    file,
                    line,
                    excerpt,
                }),
                _,
            ) => {
                let excerpt = escaped(excerpt);
                let mark = AnnotationKind::Primary.span(0..excerpt.len()).label(label);
                group = group.element(
                    Snippet::source(excerpt)
                        .line_start(*line)
                        .path(escaped(file))
                        .annotation(mark),
                );
            }
            (Some(Place::Byte { file, offset }), _) => {
                group = group.element(annotate_snippets::Origin::path(format!(
                    "{} at byte {offset}",
                    escaped(file)
                )));
            }
            (Some(Place::File(file)), _) => {
                group = group.element(annotate_snippets::Origin::path(escaped(file)));
            }
            (Some(Place::Scene(_)) | None, _) => {}
        }
        for help in &diagnostic.help {
            group = group.element(Level::HELP.message(escaped(help)));
        }
        let renderer = if self.coloured {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let text = renderer.render(&[group]).to_string();
        match &diagnostic.place {
            Some(Place::Scene(_)) if source.is_none() => without_bar(&text),
            None => without_bar(&text),
            Some(_) => text,
        }
    }
}

/// A message of a title and helps, without the line between them that would join the title to an excerpt.
fn without_bar(text: &str) -> String {
    let lines = text.lines().enumerate();
    let kept: Vec<&str> = lines.filter(|(i, _)| *i != 1).map(|(_, l)| l).collect();
    kept.join("\n")
}

/// The line a span starts in, cut around the span if it is long.
struct Excerpt {
    text: String,
    line: usize,
    /// Bytes of `text`.
    mark: Range<usize>,
}

impl Excerpt {
    fn of(text: &str, span: &Range<usize>) -> Self {
        let start = floor(text, span.start.min(text.len()));
        let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let end = floor(text, span.end.clamp(start, line_end));
        let from = if start - line_start > AROUND {
            floor(text, start - AROUND)
        } else {
            line_start
        };
        let cut = end.min(start + AROUND);
        let to = if line_end - cut > AROUND {
            floor(text, cut + AROUND)
        } else {
            line_end
        };
        let end = end.min(to);
        // Invisible characters are spelled out; the mark moves with them.
        let (before, marked) = (
            escaped_line(&text[from..start]),
            escaped_line(&text[start..end]),
        );
        let after = escaped_line(&text[end..to]);
        let mark = before.len()..before.len() + marked.len();
        Self {
            text: format!("{before}{marked}{after}"),
            line: text[..start].matches('\n').count() + 1,
            mark,
        }
    }
}

/// As `escaped`, but tabs stay and a carriage return vanishes.
fn escaped_line(text: &str) -> String {
    text.replace('\r', "")
        .split('\t')
        .map(escaped)
        .collect::<Vec<_>>()
        .join("\t")
}

/// The nearest character boundary at or before `at`.
fn floor(text: &str, at: usize) -> usize {
    (0..=at)
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}

/// File, line and column (1-based; 0 if there is none).
fn position(diagnostic: &Diagnostic, source: Option<&Source>) -> (String, usize, usize) {
    match (&diagnostic.place, source) {
        (Some(Place::Scene(span)), Some(source)) => {
            let start = floor(&source.text, span.start.min(source.text.len()));
            let before = &source.text[..start];
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
            (escaped(&source.path), line, column)
        }
        (Some(Place::Line { file, line, .. }), _) => (escaped(file), *line, 0),
        (Some(Place::Byte { file, .. } | Place::File(file)), _) => (escaped(file), 0, 0),
        _ => (source.map_or(String::new(), |s| escaped(&s.path)), 0, 0),
    }
}

fn severity(diagnostic: &Diagnostic) -> &'static str {
    match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}

fn short(diagnostic: &Diagnostic, source: Option<&Source>) -> String {
    let (file, line, column) = position(diagnostic, source);
    let mut out = file;
    for number in [line, column].into_iter().filter(|n| *n > 0) {
        let _ = write!(out, ":{number}");
    }
    let colon = if out.is_empty() { "" } else { ": " };
    format!(
        "{out}{colon}{}: {}",
        severity(diagnostic),
        escaped(&diagnostic.message)
    )
}

fn json(diagnostic: &Diagnostic, source: Option<&Source>) -> String {
    let (file, line, column) = position(diagnostic, source);
    let number = |n: usize| (n > 0).then_some(n);
    let (byte_start, byte_end) = match &diagnostic.place {
        Some(Place::Scene(span)) => (Some(span.start as u64), Some(span.end as u64)),
        Some(Place::Byte { offset, .. }) => (Some(*offset), None),
        _ => (None, None),
    };
    serde_json::json!({
        "severity": severity(diagnostic), "message": diagnostic.message, "file": file, "line": number(line),
        "column": number(column), "byte_start": byte_start, "byte_end": byte_end, "label": diagnostic.label,
        "help": diagnostic.help,
    })
    .to_string()
}
