//! Wavefront OBJ before it is read: every line is checked, and what is wrong is told with its line.
//!
//! Takes the bytes of a file; gives how much of it can be used ([`Usable`]), or the first line that cannot be read as what it
//! claims to be. `tobj` names no line in its errors, takes `nan` for a number and a missing texture point for the one before:
//! it meets none of these in what is left. Values themselves are its business, none is kept here.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::colours::Colours;
use crate::formats::flaws::Flaws;
use crate::formats::text::{at_line, coordinate, excerpt, lines, number_or_nan, without_bom};

/// Keywords of the format that say nothing about the surface.
const IGNORED: [&[u8]; 31] = [
    b"vp",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"l",
    b"p",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"curv",
    b"curv2",
    b"surf",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
];

/// Names longer than this are cut where they are shown or written.
const MAX_NAME: usize = 255;

/// What of a file can be used.
#[derive(Clone, Debug)]
pub(super) struct Usable {
    pub vertices: usize,
    /// Which of them have coordinates; empty: all. No face uses one that has none.
    pub sound: Vec<bool>,
    /// Whether every sound vertex has a colour.
    pub coloured: bool,
    /// How many texture points there are; `None` if no face uses any, or if they are of no use.
    pub texture_points: Option<usize>,
}

/// # Errors
/// The first line that cannot be read as what it claims to be, or a file without faces.
pub(super) fn check(file: &str, bytes: &[u8]) -> Result<Warned<Usable>, Diagnostic> {
    let mut scan = Scan::new(file, bytes);
    for (number, line) in logical_lines(bytes) {
        scan.line(number, &line)?;
    }
    scan.finish()
}

/// Keywords of lines of numbers, which a `\` at the end continues. Behind all others there are names of things and files, and
/// some programs write names that end in a `\`.
const CONTINUED: [&[u8]; 21] = [
    b"v", b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p", b"cstype", b"deg", b"bmat", b"step",
    b"curv", b"curv2", b"surf", b"parm", b"trim", b"hole", b"scrv", b"sp", b"con",
];

/// Lines with continuations joined and comments cut off; the number is that of the first one.
pub(super) fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let mut physical = lines(without_bom(bytes));
    std::iter::from_fn(move || {
        let (number, first) = physical.next()?;
        let mut line = first.to_vec();
        while is_continued(&line) && line.trim_ascii_end().last() == Some(&b'\\') {
            line.truncate(line.trim_ascii_end().len() - 1);
            line.push(b' ');
            let Some((_, more)) = physical.next() else {
                break;
            };
            line.extend_from_slice(more);
        }
        // Only at the start of a word: `1.#IND` is a broken number, not a number with a comment.
        let starts_comment =
            |k: &usize| line[*k] == b'#' && (*k == 0 || line[*k - 1].is_ascii_whitespace());
        if let Some(hash) = (0..line.len()).find(starts_comment) {
            line.truncate(hash);
        }
        Some((number, line))
    })
}

fn is_continued(line: &[u8]) -> bool {
    let mut words = line.trim_ascii_start().split(u8::is_ascii_whitespace);
    let keyword = words.next().unwrap_or_default();
    CONTINUED.contains(&keyword.strip_suffix(b"\\").unwrap_or(keyword))
}

/// What has been read so far.
struct Scan<'a> {
    file: &'a str,
    bytes: &'a [u8],
    vertices: usize,
    /// By line.
    flaws: Flaws<usize>,
    colours: Colours,
    texture_points: usize,
    /// The first texture point that is none: its line, and why.
    bad_texture: Option<(usize, String)>,
    normals: usize,
    faces: usize,
    /// Vertices that faces use before they are there: the line and the 1-based index.
    early: Vec<(usize, usize)>,
    /// Largest vt and vn index with its line: they may be defined later.
    largest_vt: (usize, usize),
    largest_vn: (usize, usize),
    bad_names: Vec<usize>,
    unknown: Vec<(usize, String)>,
}

impl<'a> Scan<'a> {
    fn new(file: &'a str, bytes: &'a [u8]) -> Self {
        Self {
            file,
            bytes,
            vertices: 0,
            flaws: Flaws::default(),
            colours: Colours::default(),
            texture_points: 0,
            bad_texture: None,
            normals: 0,
            faces: 0,
            early: Vec::new(),
            largest_vt: (0, 0),
            largest_vn: (0, 0),
            bad_names: Vec::new(),
            unknown: Vec::new(),
        }
    }

    fn line(&mut self, number: usize, line: &[u8]) -> Result<(), Diagnostic> {
        if line.contains(&0) {
            return Err(at_line(
                self.file,
                number,
                line,
                "a zero byte in a text file: damaged, or not an OBJ file",
            ));
        }
        let mut words = line
            .split(u8::is_ascii_whitespace)
            .filter(|w| !w.is_empty());
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        match keyword {
            b"v" => self.vertex(number, line, words),
            b"f" | b"fo" => self.face(number, line, words),
            b"vt" => {
                self.texture_point(number, words);
                Ok(())
            }
            b"vn" => {
                self.normals += 1;
                Ok(())
            }
            b"o" | b"g" => {
                if line.len() > MAX_NAME || line.iter().any(|b| b.is_ascii_control() && *b != b'\t')
                {
                    self.bad_names.push(number);
                }
                Ok(())
            }
            // Old editors end files with a Ctrl-Z.
            b"\x1A" => Ok(()),
            _ if IGNORED.contains(&keyword) => Ok(()),
            _ if keyword.iter().all(u8::is_ascii_graphic) => {
                self.unknown.push((number, excerpt(keyword)));
                Ok(())
            }
            _ => Err(at_line(
                self.file,
                number,
                line,
                "not a line of an OBJ file: it starts with bytes that are not text",
            )),
        }
    }

    fn vertex<'w>(
        &mut self,
        number: usize,
        line: &[u8],
        mut words: impl Iterator<Item = &'w [u8]>,
    ) -> Result<(), Diagnostic> {
        let (mut count, mut flaw) = (0, None);
        for word in words.by_ref().take(3) {
            if let Err(why) = coordinate(word) {
                if number_or_nan(word).is_err() {
                    return Err(at_line(
                        self.file,
                        number,
                        line,
                        no_coordinate(self.vertices, &why),
                    ));
                }
                flaw.get_or_insert(why);
            }
            count += 1;
        }
        if count < 3 {
            let message = format!("a vertex with {count} coordinates, 3 wanted");
            return Err(at_line(self.file, number, line, message));
        }
        self.vertices += 1;
        if let Some(why) = flaw {
            self.flaws.add(self.vertices - 1, number, why);
            return Ok(());
        }
        // Three more numbers are a colour; one is a weight, and what more would be nobody agrees on.
        let more: Vec<&[u8]> = words.take(4).collect();
        if let [r, g, b] = more[..] {
            self.colours.check(number, [r, g, b]);
        } else {
            self.colours.miss();
        }
        Ok(())
    }

    fn texture_point<'w>(&mut self, number: usize, words: impl Iterator<Item = &'w [u8]>) {
        for word in words.take(2) {
            if let Err(why) = coordinate(word) {
                self.bad_texture.get_or_insert((number, why));
            }
        }
        self.texture_points += 1;
    }

    fn face<'w>(
        &mut self,
        number: usize,
        line: &[u8],
        words: impl Iterator<Item = &'w [u8]>,
    ) -> Result<(), Diagnostic> {
        let mut count = 0;
        for word in words {
            self.corner(number, word)
                .map_err(|why| at_line(self.file, number, line, why))?;
            count += 1;
        }
        if count < 3 {
            let message =
                format!("a face with {count} corners, at least 3 wanted (is the file cut short?)");
            return Err(at_line(self.file, number, line, message));
        }
        self.faces += 1;
        Ok(())
    }

    /// Notes the indices of `7`, `7/1`, `7//3`, `7/1/3` or of the same with negative (relative) numbers.
    fn corner(&mut self, number: usize, word: &[u8]) -> Result<(), String> {
        let mut parts = word.split(|b| *b == b'/');
        let vertex = parts.next().unwrap_or_default();
        let position = index(vertex, self.vertices, "vertex")?;
        if position > self.vertices {
            self.early.push((number, position));
        }
        for (part, texture) in parts.by_ref().take(2).zip([true, false]) {
            if part.is_empty() {
                continue;
            }
            if texture {
                let vt = index(part, self.texture_points, "texture")?;
                self.largest_vt = self.largest_vt.max((vt, number));
            } else {
                let vn = index(part, self.normals, "normal")?;
                self.largest_vn = self.largest_vn.max((vn, number));
            }
        }
        match parts.next() {
            Some(_) => Err(format!(
                "a face corner with too many slashes: `{}`",
                excerpt(word)
            )),
            None => Ok(()),
        }
    }

    fn finish(self) -> Result<Warned<Usable>, Diagnostic> {
        let of_file =
            |message: String| Err(Diagnostic::error(message).at(Place::File(self.file.to_owned())));
        if self.faces == 0 {
            return match self.vertices {
                0 => of_file("the file has no vertices and no faces".to_owned()),
                n => of_file(format!("the file has {n} vertices but no faces")),
            };
        }
        if self.vertices.max(self.texture_points) >= u32::MAX as usize {
            return of_file("the file has more than 4294967294 vertices".to_owned());
        }
        self.check_range()?;
        self.check_flaws()?;
        let mut warnings = self.warnings();
        warnings.extend(self.flaws.left_out(self.file));
        let coloured = self
            .colours
            .finish(self.file, |line| excerpt(self.text_of(line)))
            .unwrap_or_else(|warning| {
                warnings.push(warning);
                false
            });
        let unused = self.largest_vt.0 == 0 || self.bad_texture.is_some() || self.dangling();
        Ok(Warned {
            warnings,
            value: Usable {
                vertices: self.vertices,
                sound: match self.flaws.is_empty() {
                    true => Vec::new(),
                    false => self.flaws.sound(self.vertices),
                },
                coloured,
                texture_points: (!unused).then_some(self.texture_points),
            },
        })
    }

    /// Whether faces use texture points or normals that the file does not have.
    fn dangling(&self) -> bool {
        self.largest_vt.0 > self.texture_points || self.largest_vn.0 > self.normals
    }

    /// Faces may come before their vertices, so this waits for the end.
    fn check_range(&self) -> Result<(), Diagnostic> {
        let vertices = self.vertices;
        let missing = |(_, index): &&(usize, usize)| *index > vertices;
        let Some((line, index)) = self.early.iter().find(missing) else {
            return Ok(());
        };
        let message = format!("a face uses vertex {index}, but the file has {vertices} vertices");
        Err(at_line(self.file, *line, self.text_of(*line), message))
    }

    /// Faces may use vertices without coordinates before these are there, so the file is gone through again.
    fn check_flaws(&self) -> Result<(), Diagnostic> {
        if self.flaws.is_empty() {
            return Ok(());
        }
        let mut used = vec![false; self.vertices];
        let mut so_far = 0;
        for (_, line) in logical_lines(self.bytes) {
            let mut words = line
                .split(u8::is_ascii_whitespace)
                .filter(|w| !w.is_empty());
            match words.next() {
                Some(b"v") => so_far += 1,
                Some(b"f" | b"fo") => {
                    for word in words {
                        let vertex = word.split(|b| *b == b'/').next().unwrap_or_default();
                        if let Ok(position) = index(vertex, so_far, "vertex") {
                            used[position - 1] = true;
                        }
                    }
                }
                _ => {}
            }
        }
        let used = (0..self.vertices).filter(|v| used[*v]);
        let Some(flaw) = self.flaws.first_used(self.vertices, used) else {
            return Ok(());
        };
        let message = no_coordinate(flaw.vertex, &flaw.why);
        Err(at_line(self.file, flaw.at, self.text_of(flaw.at), message))
    }

    /// A line of the file.
    fn text_of(&self, line: usize) -> &[u8] {
        lines(self.bytes).nth(line - 1).unwrap_or_default().1
    }

    fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = Vec::new();
        let mut warn = |line: usize, message: String| {
            warnings.push(Diagnostic::warning(message).at(Place::Line {
                file: self.file.to_owned(),
                line,
                excerpt: excerpt(self.text_of(line)),
            }));
        };
        let missing_vt = self.largest_vt.0 > self.texture_points;
        if self.dangling() {
            let (_, line) = if missing_vt {
                self.largest_vt
            } else {
                self.largest_vn
            };
            warn(
                line,
                format!(
                    "faces use texture point {} and normal {}, but the file has {} and {}: texture points are not used",
                    self.largest_vt.0, self.largest_vn.0, self.texture_points, self.normals
                ),
            );
        }
        if let Some((line, why)) = &self.bad_texture {
            warn(
                *line,
                format!(
                    "a texture point has a coordinate that is {why}: texture points are not used"
                ),
            );
        }
        if let Some(first) = self.bad_names.first() {
            warn(
                *first,
                format!(
                    "object names longer than {MAX_NAME} bytes or with control characters are not used ({} of them)",
                    self.bad_names.len()
                ),
            );
        }
        if let Some((first, word)) = self.unknown.first() {
            warn(
                *first,
                format!(
                    "lines with unknown keywords are ignored ({} of them), the first is `{word}`",
                    self.unknown.len()
                ),
            );
        }
        warnings
    }
}

fn no_coordinate(vertex: usize, why: &str) -> String {
    format!("vertex {} has a coordinate that is {why}", vertex + 1)
}

/// An absolute 1-based index; `so_far` elements of its kind have been defined above.
fn index(word: &[u8], so_far: usize, kind: &str) -> Result<usize, String> {
    let text = std::str::from_utf8(word).unwrap_or_default();
    let Ok(given) = text.parse::<i64>() else {
        return Err(format!(
            "a face corner that is not a whole number: `{}`",
            excerpt(word)
        ));
    };
    let size = usize::try_from(given.unsigned_abs()).unwrap_or(usize::MAX);
    match given {
        0 => Err(format!("a {kind} index 0: OBJ counts from 1")),
        1..=0xFFFF_FFFE => Ok(size),
        _ if given > 0 => Err(format!("a {kind} index {given}, more than 4294967294")),
        _ if size > so_far => Err(format!(
            "a relative {kind} index {given}, but only {so_far} are defined above"
        )),
        _ => Ok(so_far + 1 - size),
    }
}
