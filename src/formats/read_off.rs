//! OFF, the Object File Format of Geomview: text, with colours and normals of vertices or without.
//!
//! The first line says `OFF`, with letters before it for what vertices have besides their place: `ST` texture points, `C` colours,
//! `N` normals. Then come the numbers of vertices, faces and edges, and a line for every vertex and every face. Counts are
//! untrusted: nothing is allocated or looped by them alone. Colours of faces, normals and texture points are not read.

use crate::diag::{Diagnostic, Place, Severity, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::colours::{self, Colours};
use crate::formats::flaws::Flaws;
use crate::formats::text::{at_line, coordinate, excerpt, lines, number_or_nan, without_bom};
use crate::index::VertexId;
use crate::mesh::polygon::triangulate;
use crate::mesh::weld::keep_vertices;
use crate::mesh::{Attributes, TriMesh};
use glam::DVec3;

/// # Errors
/// A header that is none, the first line that is no vertex or face, or a file that is cut short.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Warned<NamedMesh>, Diagnostic> {
    let mut rows = OffLines {
        file,
        lines: lines(without_bom(bytes)),
        last: 1,
    };
    let header = rows.header()?;
    let mut body = OffBody::default();
    for vertex in 0..header.vertices {
        let row = rows.wanted("vertex", vertex, header.vertices)?;
        body.vertex(&row, header.before, header.behind)
            .map_err(|why| row.fail(file, format!("vertex {vertex} {why}")))?;
    }
    for face in 0..header.faces {
        let row = rows.wanted("face", face, header.faces)?;
        body.face(&row)
            .map_err(|why| row.fail(file, format!("face {face} {why}")))?;
    }
    let mut read = body.finish(file, bytes)?;
    if let Some(row) = rows.next() {
        let count = 1 + rows.count();
        let message = format!("ignored {count} lines after the last declared face");
        read.warnings.push(Diagnostic {
            severity: Severity::Warning,
            ..row.fail(file, message)
        });
    }
    Ok(read)
}

struct OffHeader {
    /// How many numbers a vertex has before its colour, and behind.
    before: usize,
    behind: usize,
    vertices: u64,
    faces: u64,
}

/// A line that says something, without its comment.
struct OffLine<'a> {
    number: usize,
    line: &'a [u8],
    words: Vec<&'a [u8]>,
}

impl OffLine<'_> {
    fn fail(&self, file: &str, message: String) -> Diagnostic {
        at_line(file, self.number, self.line, message)
    }
}

/// What is left of the file.
struct OffLines<'a, L> {
    file: &'a str,
    lines: L,
    /// Number of the last line read.
    last: usize,
}

impl<'a, L: Iterator<Item = (usize, &'a [u8])>> Iterator for OffLines<'_, L> {
    type Item = OffLine<'a>;

    fn next(&mut self) -> Option<OffLine<'a>> {
        for (number, line) in self.lines.by_ref() {
            self.last = number;
            let said = line.split(|b| *b == b'#').next().unwrap_or_default();
            let words = said.split(u8::is_ascii_whitespace);
            let words: Vec<&[u8]> = words.filter(|w| !w.is_empty()).collect();
            if !words.is_empty() {
                return Some(OffLine {
                    number,
                    line,
                    words,
                });
            }
        }
        None
    }
}

impl<'a, L: Iterator<Item = (usize, &'a [u8])>> OffLines<'_, L> {
    fn header(&mut self) -> Result<OffHeader, Diagnostic> {
        let file = self.file;
        let no_header = || at_line(file, 1, b"", "not an OFF file: its first word is not `OFF`");
        let first = self.next().ok_or_else(no_header)?;
        let Some(prefix) = first.words[0].strip_suffix(b"OFF") else {
            let message = format!(
                "not an OFF file: its first word is `{}`, not `OFF`",
                excerpt(first.words[0])
            );
            return Err(first.fail(file, message));
        };
        if prefix.iter().any(|b| matches!(b, b'4' | b'n')) {
            let message = "an OFF file of points with other than three coordinates".to_owned();
            return Err(first.fail(file, message));
        }
        if first.words.get(1).is_some_and(|w| *w == b"BINARY") {
            let message = "a binary OFF file; the text form is wanted".to_owned();
            let help = "save it as text, or as PLY";
            return Err(first.fail(file, message).help(help));
        }
        // Some programs write the counts behind the word.
        let counts = if first.words.len() > 1 {
            OffLine {
                words: first.words[1..].to_vec(),
                ..first
            }
        } else {
            let cut = at_line(
                file,
                self.last,
                b"",
                "the file ends after its first word: it is cut short",
            );
            self.next().ok_or(cut)?
        };
        let number = |k: usize| {
            let word = counts.words.get(k).copied().unwrap_or_default();
            let text = std::str::from_utf8(word).unwrap_or_default();
            text.parse::<u64>().map_err(|_| {
                let message = format!(
                    "the numbers of vertices and faces wanted, found `{}`",
                    excerpt(counts.line)
                );
                counts.fail(file, message)
            })
        };
        Ok(OffHeader {
            before: if prefix.contains(&b'N') { 6 } else { 3 },
            behind: if prefix.contains(&b'T') { 2 } else { 0 },
            vertices: number(0)?,
            faces: number(1)?,
        })
    }

    fn wanted(&mut self, what: &str, number: u64, count: u64) -> Result<OffLine<'a>, Diagnostic> {
        self.next().ok_or_else(|| {
            let message = format!(
                "the file declares {count} {}, but ends before {what} {number}: it is cut short",
                if what == "face" { "faces" } else { "vertices" }
            );
            at_line(self.file, self.last, b"", message)
        })
    }
}

/// What has been read. Polygons wait until all vertices are known to be sound.
#[derive(Default)]
struct OffBody {
    vertices: Vec<DVec3>,
    /// By line.
    flaws: Flaws<usize>,
    colours: Colours,
    rgb: Vec<f64>,
    corners: Vec<u32>,
    arities: Vec<usize>,
}

impl OffBody {
    /// # Errors
    /// What is wrong, as a message goes on after "vertex 7".
    fn vertex(&mut self, row: &OffLine, before: usize, behind: usize) -> Result<(), String> {
        let mut point = [0.0; 3];
        let mut flaw = None;
        for (k, value) in point.iter_mut().enumerate() {
            let Some(word) = row.words.get(k) else {
                return Err(format!("has {k} coordinates, 3 wanted"));
            };
            match coordinate(word) {
                Ok(number) => *value = number,
                Err(why) if number_or_nan(word).is_ok() => {
                    flaw.get_or_insert(why);
                }
                Err(why) => return Err(format!("has a coordinate that is {why}")),
            }
        }
        if let Some(why) = flaw {
            self.flaws.add(self.vertices.len(), row.number, why);
        } else {
            let end = row.words.len().saturating_sub(behind);
            match row.words.get(before..end).unwrap_or_default() {
                [r, g, b] | [r, g, b, _] => {
                    self.colours.check(row.number, [r, g, b]);
                    let number = |w: &&[u8]| coordinate(w).unwrap_or(0.0);
                    self.rgb.extend([r, g, b].map(number));
                }
                _ => self.colours.miss(),
            }
        }
        self.vertices.push(DVec3::from_array(point));
        Ok(())
    }

    /// # Errors
    /// As [`OffBody::vertex`]'s.
    fn face(&mut self, row: &OffLine) -> Result<(), String> {
        let whole = |word: &[u8]| {
            let text = std::str::from_utf8(word).unwrap_or_default();
            text.parse::<u32>()
                .map_err(|_| format!("has a number that is not whole: `{}`", excerpt(word)))
        };
        let count = whole(row.words[0])? as usize;
        if count < 3 {
            return Err(format!("has {count} corners, at least 3 wanted"));
        }
        let Some(corners) = row.words.get(1..=count) else {
            let found = row.words.len() - 1;
            return Err(format!(
                "has {found} of the {count} corners that it declares"
            ));
        };
        let vertices = self.vertices.len();
        for word in corners {
            let corner = whole(word)?;
            if corner as usize >= vertices {
                return Err(format!(
                    "uses vertex {corner}, but the file has {vertices} vertices (counted from 0)"
                ));
            }
            self.corners.push(corner);
        }
        self.arities.push(count);
        Ok(())
    }

    fn finish(self, file: &str, bytes: &[u8]) -> Result<Warned<NamedMesh>, Diagnostic> {
        let count = self.vertices.len();
        if self.arities.is_empty() {
            let message = format!("the file has {count} vertices but no faces");
            return Err(Diagnostic::error(message).at(Place::File(file.to_owned())));
        }
        let text_of = |line: usize| lines(bytes).nth(line - 1).unwrap_or_default().1;
        let used = self.corners.iter().map(|c| *c as usize);
        if !self.flaws.is_empty()
            && let Some(flaw) = self.flaws.first_used(count, used)
        {
            let message = format!(
                "vertex {} has a coordinate that is {}",
                flaw.vertex, flaw.why
            );
            return Err(at_line(file, flaw.at, text_of(flaw.at), message));
        }
        let mut faces = Vec::with_capacity(self.arities.len());
        let mut rest = self.corners.as_slice();
        for arity in &self.arities {
            let (polygon, behind) = rest.split_at(*arity);
            let points = polygon.iter().map(|v| self.vertices[VertexId(*v)]);
            let triangles = triangulate(&points.collect::<Vec<_>>());
            faces.extend(triangles.into_iter().map(|t| t.map(|k| polygon[k])));
            rest = behind;
        }
        let mut warnings: Vec<Diagnostic> = self.flaws.left_out(file).into_iter().collect();
        let mut mesh = TriMesh::new(self.vertices, faces);
        if !self.flaws.is_empty() {
            keep_vertices(&mut mesh, &self.flaws.sound(count));
        }
        let coloured = self.colours.finish(file, |line| excerpt(text_of(line)));
        let coloured = coloured.unwrap_or_else(|warning| {
            warnings.push(warning);
            false
        });
        let colours = match coloured {
            true => colours::scaled(&self.rgb),
            false => Vec::new(),
        };
        Ok(Warned {
            value: NamedMesh {
                name: String::new(),
                mesh,
                attributes: Attributes {
                    colours,
                    ..Attributes::default()
                },
            },
            warnings,
        })
    }
}
