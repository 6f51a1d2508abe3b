//! Colours of vertices as files have them: some from 0 to 1, some from 0 to 255, some for a part of the vertices only.

use crate::diag::{Diagnostic, Place};
use crate::formats::text::coordinate;

/// Gathers the colours of a text file's vertices.
#[derive(Default)]
pub struct Colours {
    found: Vec<[f64; 3]>,
    /// Vertices without one.
    without: usize,
    /// The first one that is none: its line, and why.
    bad: Option<(usize, String)>,
}

impl Colours {
    /// The colour of the next vertex, on this line.
    pub fn add_words(&mut self, line: usize, words: [&[u8]; 3]) {
        let mut colour = [0.0; 3];
        for (k, word) in words.iter().enumerate() {
            let value = coordinate(word).and_then(in_range);
            match value {
                Ok(value) => colour[k] = value,
                Err(why) => {
                    self.bad.get_or_insert((line, why));
                }
            }
        }
        self.found.push(colour);
    }

    /// The next vertex has none.
    pub fn add_none(&mut self) {
        self.without += 1;
    }

    /// All colours from 0 to 1; none if the file has none.
    ///
    /// # Errors
    /// A warning that tells why the file's colours are of no use.
    pub fn finish(&self, file: &str) -> Result<Vec<[f64; 4]>, Diagnostic> {
        if self.found.is_empty() {
            return Ok(Vec::new());
        }
        if let Some((line, why)) = &self.bad {
            let message = format!("a vertex has a colour that is {why}: colours are not used");
            return Err(Diagnostic::warning(message).at(Place::Line {
                file: file.to_owned(),
                line: *line,
                excerpt: String::new(),
            }));
        }
        if self.without > 0 {
            let count = self.found.len();
            let all = count + self.without;
            let message = format!("{count} of {all} vertices have a colour: colours are not used");
            return Err(Diagnostic::warning(message).at(Place::File(file.to_owned())));
        }
        let most = self.found.iter().flatten().fold(0.0, |m: f64, c| m.max(*c));
        let one = if most > 1.0 { 255.0 } else { 1.0 };
        let opaque = |c: &[f64; 3]| [c[0] / one, c[1] / one, c[2] / one, 1.0];
        Ok(self.found.iter().map(opaque).collect())
    }
}

fn in_range(value: f64) -> Result<f64, String> {
    if (0.0..=255.0).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{value}, not from 0 to 1 or from 0 to 255"))
    }
}
