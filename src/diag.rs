//! What the program has to tell its user: errors, warnings and notes as values.
//!
//! Takes nothing, prints nothing. Every stage that can meet bad input returns `Diagnostic`s (all of a stage at once);
//! only the binary renders them. A message says what was found and what was wanted, a help line what to type.

use std::ops::Range;

/// How bad it is. Errors stop the build before anything is written; notes are no problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    Error,
    Warning,
    Note,
}

/// Where in the user's files the problem lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A byte range of the scene's text.
    Scene(Range<usize>),
    /// A line (1-based) of a layout or text model file, with the offending line's text (shortened, made safe to print).
    Line {
        file: String,
        line: usize,
        excerpt: String,
    },
    /// A byte offset of a binary model file.
    Byte { file: String, offset: u64 },
    /// A file as a whole.
    File(String),
}

/// One error, warning or note.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    pub severity: Severity,
    /// One sentence in lower case: what was found, what was wanted; numbers with units.
    pub message: String,
    pub place: Option<Place>,
    /// Short text under the marked excerpt.
    pub label: Option<String>,
    /// What to type, one line each.
    pub help: Vec<String>,
    /// Whether the program failed: nothing need be wrong with what the user gave.
    pub fault: bool,
}

impl Diagnostic {
    pub fn error(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            place: None,
            label: None,
            help: Vec::new(),
            fault: false,
        }
    }

    pub fn warning(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(message)
        }
    }

    pub fn note(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Note,
            ..Self::error(message)
        }
    }

    pub fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// The same as an error.
    pub fn into_error(self) -> Self {
        Self {
            severity: Severity::Error,
            ..self
        }
    }

    pub fn help(mut self, line: impl Into<String>) -> Self {
        self.help.push(line.into());
        self
    }

    /// The same as a fault of the program's own.
    pub fn fault(mut self) -> Self {
        self.fault = true;
        self
    }

    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }

    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// A value together with the warnings met on the way to it.
#[derive(Clone, Debug)]
pub struct Warned<T> {
    pub value: T,
    pub warnings: Vec<Diagnostic>,
}

/// Text that cannot play tricks on a terminal: control characters, text direction marks and invisible characters
/// are written as `\u{..}`; line ends and tabs too.
pub fn escaped(text: &str) -> String {
    let hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{061c}' | '\u{feff}')
    };
    text.chars()
        .flat_map(|c| {
            if hidden(c) {
                c.escape_unicode().collect::<Vec<_>>()
            } else {
                vec![c]
            }
        })
        .collect()
}
