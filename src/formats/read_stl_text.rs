//! The text form of STL, word by word.
//!
//! Programs write it in several dialects: `endloop` or `end loop`, one statement on a line or a facet or all of it, `solid` and
//! `endsolid` once, twice or between any two facets. None of that says anything about the surface, so only what does is asked for:
//! three vertices in every facet, and an end.

use crate::diag::Diagnostic;
use crate::formats::text::{at_line, coordinate, excerpt, lines, without_bom};
use glam::DVec3;
use std::iter::Peekable;

/// Corners of all facets, three each.
///
/// # Errors
/// The first word that is out of place, or a file that is cut short, with its line.
pub(super) fn corners(file: &str, bytes: &[u8]) -> Result<Vec<DVec3>, Diagnostic> {
    let mut reader = FacetReader {
        file,
        words: words(without_bom(bytes)).peekable(),
        last: 1,
    };
    let mut found = Vec::new();
    let mut closed = true;
    while let Some(word) = reader.next() {
        match word.meaning {
            WordKind::Solid => reader.pass_name(&word),
            WordKind::EndSolid => {
                closed = true;
                reader.pass_name(&word);
            }
            WordKind::Facet => {
                closed = false;
                reader.facet(&mut found)?;
            }
            _ if closed && found.is_empty() => return Err(reader.wrong(&word, "`facet`")),
            _ => return Err(reader.wrong(&word, "`facet` or `endsolid`")),
        }
    }
    if closed {
        Ok(found)
    } else {
        Err(reader.cut_short("the file ends without `endsolid`: it is cut short"))
    }
}

/// What a word is to the format.
#[derive(Clone, Copy, Debug, PartialEq)]
enum WordKind {
    Solid,
    Facet,
    Outer,
    Loop,
    Vertex,
    EndLoop,
    EndFacet,
    EndSolid,
    /// A number, a name, `normal`.
    Other,
}

impl WordKind {
    fn of(word: &[u8]) -> Self {
        match word.to_ascii_lowercase().as_slice() {
            b"solid" => Self::Solid,
            b"facet" => Self::Facet,
            b"outer" => Self::Outer,
            b"loop" => Self::Loop,
            b"vertex" => Self::Vertex,
            b"endloop" => Self::EndLoop,
            b"endfacet" => Self::EndFacet,
            b"endsolid" => Self::EndSolid,
            _ => Self::Other,
        }
    }

    /// Of a word behind `end`.
    fn ended(self) -> Self {
        match self {
            Self::Solid => Self::EndSolid,
            Self::Loop => Self::EndLoop,
            Self::Facet => Self::EndFacet,
            _ => Self::Other,
        }
    }
}

/// A word and where it stands.
#[derive(Clone, Copy)]
struct Word<'a> {
    text: &'a [u8],
    meaning: WordKind,
    number: usize,
    line: &'a [u8],
    /// Of the line, what is behind the word.
    rest: &'a [u8],
}

fn split(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace)
        .filter(|w| !w.is_empty())
}

fn words(bytes: &[u8]) -> impl Iterator<Item = Word<'_>> {
    lines(bytes).flat_map(|(number, line)| {
        let mut rest = line;
        std::iter::from_fn(move || {
            rest = rest.trim_ascii_start();
            let end = rest.iter().position(u8::is_ascii_whitespace);
            let (text, behind) = rest.split_at(end.unwrap_or(rest.len()));
            rest = behind;
            (!text.is_empty()).then(|| Word {
                text,
                meaning: WordKind::of(text),
                number,
                line,
                rest,
            })
        })
    })
}

struct FacetReader<'a, W: Iterator<Item = Word<'a>>> {
    file: &'a str,
    words: Peekable<W>,
    /// Line of the last word read.
    last: usize,
}

impl<'a, W: Iterator<Item = Word<'a>>> FacetReader<'a, W> {
    /// The next word; `end loop` is one word.
    fn next(&mut self) -> Option<Word<'a>> {
        let mut word = self.words.next()?;
        if word.text.eq_ignore_ascii_case(b"end")
            && let Some(second) = self.words.peek()
            && second.meaning.ended() != WordKind::Other
        {
            word = Word {
                meaning: second.meaning.ended(),
                text: word.text,
                ..*second
            };
            self.words.next();
        }
        self.last = word.number;
        Some(word)
    }

    /// Passes the name of a solid: the rest of its line, as far as no facet begins there and nothing ends.
    fn pass_name(&mut self, head: &Word) {
        let mut rest = split(head.rest).peekable();
        while let Some(word) = rest.next() {
            let mut then =
                |wanted: &[u8]| rest.peek().is_some_and(|w| w.eq_ignore_ascii_case(wanted));
            let is_name = match WordKind::of(word) {
                WordKind::Facet => !then(b"normal"),
                WordKind::EndSolid => false,
                _ => !(word.eq_ignore_ascii_case(b"end") && then(b"solid")),
            };
            if !is_name {
                break;
            }
            self.words.next();
        }
    }

    /// What comes after `facet`. The normal is passed: the corners say more.
    fn facet(&mut self, found: &mut Vec<DVec3>) -> Result<(), Diagnostic> {
        let cut_short = "the file ends inside of a facet: it is cut short";
        while self
            .words
            .next_if(|w| w.meaning == WordKind::Other && !is_end(w))
            .is_some()
        {}
        for corner in 0..4 {
            loop {
                let Some(word) = self.next() else {
                    return Err(self.cut_short(cut_short));
                };
                match (word.meaning, corner) {
                    (WordKind::Outer | WordKind::Loop, 0) | (WordKind::EndLoop, 3) => {}
                    (WordKind::Vertex, 0..3) => {
                        found.push(self.vertex(&word)?);
                        break;
                    }
                    (WordKind::EndFacet, 3) => return Ok(()),
                    (_, 3) => return Err(self.wrong(&word, "`endloop` or `endfacet`")),
                    _ => return Err(self.wrong(&word, "`vertex` (three of them in a facet)")),
                }
            }
        }
        Ok(())
    }

    fn vertex(&mut self, head: &Word<'a>) -> Result<DVec3, Diagnostic> {
        let mut corner = [0.0; 3];
        let mut count = 0;
        while let Some(word) = self
            .words
            .next_if(|w| w.meaning == WordKind::Other && !is_end(w))
        {
            self.last = word.number;
            if let Some(value) = corner.get_mut(count) {
                *value = coordinate(word.text)
                    .map_err(|why| self.at(&word, format!("a coordinate that is {why}")))?;
            }
            count += 1;
        }
        if count != 3 {
            if self.words.peek().is_none() {
                return Err(self.cut_short("the file ends inside of a facet: it is cut short"));
            }
            let message = format!("a vertex with {count} coordinates, 3 wanted");
            return Err(self.at(head, message));
        }
        Ok(DVec3::from_array(corner))
    }

    fn at(&self, word: &Word, message: String) -> Diagnostic {
        at_line(self.file, word.number, word.line, message)
    }

    fn wrong(&self, word: &Word, wanted: &str) -> Diagnostic {
        let message = format!("`{}` found, {wanted} wanted", excerpt(word.text));
        self.at(word, message)
    }

    fn cut_short(&self, message: &str) -> Diagnostic {
        at_line(self.file, self.last, b"", message)
    }
}

fn is_end(word: &Word) -> bool {
    word.text.eq_ignore_ascii_case(b"end")
}
