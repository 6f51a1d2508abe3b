//! Colours of vertices as text files have them: some from 0 to 1, some from 0 to 255, some for a part of the vertices only.

use crate::diag::{Diagnostic, Place};
use crate::formats::text::coordinate;

/// Tells whether the colours of a file's vertices are of use.
#[derive(Default)]
pub(super) struct Colours {
    /// Vertices with one.
    with: usize,
    without: usize,
    /// The first one that is none: its line, and why.
    bad: Option<(usize, String)>,
}

impl Colours {
    /// The colour of the next vertex, on this line.
    pub(super) fn check(&mut self, line: usize, words: [&[u8]; 3]) {
        for word in words {
            if let Err(why) = coordinate(word).and_then(in_range) {
                self.bad.get_or_insert((line, why));
            }
        }
        self.with += 1;
    }

    /// The next vertex has none.
    pub(super) fn miss(&mut self) {
        self.without += 1;
    }

    /// Whether every vertex has one; `text_of` shows a line of the file.
    ///
    /// # Errors
    /// A warning that tells why the file's colours are of no use.
    pub(super) fn finish(
        &self,
        file: &str,
        text_of: impl Fn(usize) -> String,
    ) -> Result<bool, Diagnostic> {
        if self.with == 0 {
            return Ok(false);
        }
        if let Some((line, why)) = &self.bad {
            let message = format!("a vertex has a colour that is {why}: colours are not used");
            return Err(Diagnostic::warning(message).at(Place::Line {
                file: file.to_owned(),
                line: *line,
                excerpt: text_of(*line),
            }));
        }
        if self.without > 0 {
            let count = self.with;
            let all = count + self.without;
            let message = format!("{count} of {all} vertices have a colour: colours are not used");
            return Err(Diagnostic::warning(message).at(Place::File(file.to_owned())));
        }
        Ok(true)
    }
}

/// Red, green and blue of all vertices, one after the other, as opaque colours from 0 to 1.
pub(super) fn scaled(read: &[f64]) -> Vec<[f64; 4]> {
    let most = read.iter().fold(0.0, |m: f64, c| m.max(*c));
    let one = if most > 1.0 { 255.0 } else { 1.0 };
    let opaque = |c: &[f64]| [c[0] / one, c[1] / one, c[2] / one, 1.0];
    read.chunks_exact(3).map(opaque).collect()
}

fn in_range(value: f64) -> Result<f64, String> {
    if (0.0..=255.0).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{value}, not from 0 to 1 or from 0 to 255"))
    }
}
