//! Wavefront OBJ: positions, faces, texture points of face corners and colours of vertices (`v x y z r g b`).
//!
//! Every line is checked here first, with its number; `tobj` then reads what is left (`v` and `f` lines with absolute
//! position indices), because its own errors name no line, it splits meshes at groups and seams, rejects continued
//! lines, and a bad material file makes it panic. Vertices and faces keep the file's order. Colours and texture points that
//! cannot be used are left out with a warning: the surface is there without them.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::colours::Colours;
use crate::formats::read::NamedMesh;
use crate::formats::text::{at_line, coordinate, excerpt, lines, without_bom};
use crate::mesh::polygon::triangulate;
use crate::mesh::{Attributes, NO_UV, TriMesh, Uvs};
use glam::{DVec2, DVec3};
use std::fmt::Write;

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

/// # Errors
/// The first line that cannot be read as what it claims to be, or a file without faces.
pub fn read(file: &str, bytes: &[u8]) -> Result<Warned<NamedMesh>, Diagnostic> {
    let mut scan = Scan::new(file, bytes);
    for (number, line) in logical_lines(without_bom(bytes)) {
        scan.line(number, &line)?;
    }
    scan.finish()
}

/// Lines with continuations (a `\` at the end) joined and comments cut off; the number is that of the first one.
fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let mut physical = lines(bytes);
    std::iter::from_fn(move || {
        let (number, first) = physical.next()?;
        let mut line = first.to_vec();
        while !is_comment(&line) && line.trim_ascii_end().last() == Some(&b'\\') {
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

fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().first() == Some(&b'#')
}

/// A polygon of the file: its line, and where its corners are in `Scan::corners`.
struct Polygon {
    line: usize,
    first: usize,
    count: usize,
}

/// What has been read so far.
struct Scan<'a> {
    file: &'a str,
    bytes: &'a [u8],
    positions: Vec<DVec3>,
    colours: Colours,
    texture_points: Vec<DVec2>,
    /// The first texture point that is none: its line, and why.
    bad_texture: Option<(usize, String)>,
    normals: i64,
    /// Absolute 1-based position indices.
    corners: Vec<i64>,
    /// Absolute 1-based indices of their texture points; 0: none.
    textures: Vec<i64>,
    polygons: Vec<Polygon>,
    /// Largest vt and vn index with its line: they may be defined later.
    largest_vt: (i64, usize),
    largest_vn: (i64, usize),
    bad_names: Vec<usize>,
    unknown: Vec<(usize, String)>,
}

impl<'a> Scan<'a> {
    fn new(file: &'a str, bytes: &'a [u8]) -> Self {
        Self {
            file,
            bytes,
            positions: Vec::new(),
            colours: Colours::default(),
            texture_points: Vec::new(),
            bad_texture: None,
            normals: 0,
            corners: Vec::new(),
            textures: Vec::new(),
            polygons: Vec::new(),
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
            .split(|b| b.is_ascii_whitespace())
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
            _ if keyword.iter().all(|b| b.is_ascii_graphic()) => {
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
        let mut position = [0.0; 3];
        let mut count = 0;
        for word in words.by_ref().take(3) {
            position[count] = coordinate(word).map_err(|why| {
                let message = format!(
                    "vertex {} has a coordinate that is {why}",
                    self.positions.len() + 1
                );
                at_line(self.file, number, line, message)
            })?;
            count += 1;
        }
        if count < 3 {
            let message = format!("a vertex with {count} coordinates, 3 wanted");
            return Err(at_line(self.file, number, line, message));
        }
        self.positions.push(DVec3::from_array(position));
        // Three more numbers are a colour; one is a weight, and what more would be nobody agrees on.
        let more: Vec<&[u8]> = words.take(4).collect();
        if let [r, g, b] = more[..] {
            self.colours.add_words(number, [r, g, b]);
        } else {
            self.colours.add_none();
        }
        Ok(())
    }

    fn texture_point<'w>(&mut self, number: usize, words: impl Iterator<Item = &'w [u8]>) {
        let mut point = [0.0; 2];
        for (k, word) in words.take(2).enumerate() {
            match coordinate(word) {
                Ok(value) => point[k] = value,
                Err(why) => {
                    self.bad_texture.get_or_insert((number, why));
                }
            }
        }
        self.texture_points.push(point.into());
    }

    fn face<'w>(
        &mut self,
        number: usize,
        line: &[u8],
        words: impl Iterator<Item = &'w [u8]>,
    ) -> Result<(), Diagnostic> {
        let first = self.corners.len();
        for word in words {
            let (corner, texture) = self
                .corner(number, word)
                .map_err(|why| at_line(self.file, number, line, why))?;
            self.corners.push(corner);
            self.textures.push(texture);
        }
        let count = self.corners.len() - first;
        if count < 3 {
            let message =
                format!("a face with {count} corners, at least 3 wanted (is the file cut short?)");
            return Err(at_line(self.file, number, line, message));
        }
        self.polygons.push(Polygon {
            line: number,
            first,
            count,
        });
        Ok(())
    }

    /// The absolute indices of position and texture point (0: none) of `7`, `7/1`, `7//3`, `7/1/3` or of the same with
    /// negative (relative) numbers.
    fn corner(&mut self, number: usize, word: &[u8]) -> Result<(i64, i64), String> {
        let mut parts = word.split(|b| *b == b'/');
        let position = index(
            parts.next().unwrap_or_default(),
            self.positions.len() as i64,
            "vertex",
        )?;
        let mut point = 0;
        for (part, texture) in parts.by_ref().take(2).zip([true, false]) {
            if part.is_empty() {
                continue;
            }
            if texture {
                point = index(part, self.texture_points.len() as i64, "texture")?;
                self.largest_vt = self.largest_vt.max((point, number));
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
            None => Ok((position, point)),
        }
    }

    fn finish(self) -> Result<Warned<NamedMesh>, Diagnostic> {
        let whole =
            |message: String| Err(Diagnostic::error(message).at(Place::File(self.file.to_owned())));
        if self.polygons.is_empty() {
            return match self.positions.len() {
                0 => whole("the file has no vertices and no faces".to_owned()),
                n => whole(format!("the file has {n} vertices but no faces")),
            };
        }
        self.check_range()?;
        let (mesh, corners) = match self.through_tobj() {
            Ok(read) => read,
            Err(why) => return whole(format!("the file cannot be read as OBJ: {why}")),
        };
        let mut warnings = self.warnings();
        let uvs = self.uvs(corners);
        let colours = self.colours.finish(self.file);
        warnings.extend(colours.as_ref().err().cloned());
        Ok(Warned {
            warnings,
            value: NamedMesh {
                name: String::new(),
                mesh,
                attributes: Attributes {
                    colours: colours.unwrap_or_default(),
                    uvs,
                    scalars: Vec::new(),
                },
            },
        })
    }

    /// Texture points of all face corners, of which `corners` are the places in `textures`; `None` if there are none that
    /// can be used.
    fn uvs(&self, corners: Vec<[usize; 3]>) -> Option<Uvs> {
        let none = self.largest_vt.0 == 0;
        if none || self.bad_texture.is_some() || self.dangling() {
            return None;
        }
        let point = |c: usize| u32::try_from(self.textures[c] - 1).unwrap_or(NO_UV);
        Some(Uvs {
            corners: corners.into_iter().map(|c| c.map(point)).collect(),
            points: self.texture_points.clone(),
        })
    }

    /// Whether faces use texture points or normals that the file does not have.
    fn dangling(&self) -> bool {
        self.largest_vt.0 > self.texture_points.len() as i64 || self.largest_vn.0 > self.normals
    }

    /// Faces may come before their vertices, so this waits for the end.
    fn check_range(&self) -> Result<(), Diagnostic> {
        let vertices = self.positions.len();
        for polygon in &self.polygons {
            for corner in &self.corners[polygon.first..polygon.first + polygon.count] {
                if *corner > vertices as i64 {
                    let message = format!(
                        "a face uses vertex {corner}, but the file has {vertices} vertices"
                    );
                    let (_, text) = lines(self.bytes).nth(polygon.line - 1).unwrap_or_default();
                    return Err(at_line(self.file, polygon.line, text, message));
                }
            }
        }
        Ok(())
    }

    /// The mesh with the file's vertices and faces, and where the corners of its faces stand in `corners`.
    fn through_tobj(&self) -> Result<(TriMesh, Vec<[usize; 3]>), tobj::LoadError> {
        let mut clean = String::new();
        for p in &self.positions {
            // `{:?}` prints enough digits to read the same bits back.
            let _ = writeln!(clean, "v {:?} {:?} {:?}", p.x, p.y, p.z);
        }
        for polygon in &self.polygons {
            clean.push('f');
            for corner in &self.corners[polygon.first..polygon.first + polygon.count] {
                let _ = write!(clean, " {corner}");
            }
            clean.push('\n');
        }
        let options = tobj::LoadOptions::default();
        let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
        let (models, _) = tobj::load_obj_buf(&mut clean.as_bytes(), &options, no_materials)?;
        let mut corners: Vec<[usize; 3]> = Vec::new();
        let mut first = 0;
        for model in &models {
            let (found, count) = from_tobj(&model.mesh);
            corners.extend(found.into_iter().map(|t| t.map(|k| first + k as usize)));
            first += count;
        }
        // `tobj` numbers vertices as faces come to use them: the file's own indices stand in `corners`.
        let index = |c: usize| self.corners[c] as u32 - 1;
        let faces = corners.iter().map(|t| t.map(index)).collect();
        let vertices = self.positions.clone();
        Ok((TriMesh { vertices, faces }, corners))
    }

    fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = Vec::new();
        let mut warn = |line: usize, message: String| {
            warnings.push(Diagnostic::warning(message).at(Place::Line {
                file: self.file.to_owned(),
                line,
                excerpt: String::new(),
            }));
        };
        let missing_vt = self.largest_vt.0 > self.texture_points.len() as i64;
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
                    self.largest_vt.0,
                    self.largest_vn.0,
                    self.texture_points.len(),
                    self.normals
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

/// An absolute 1-based index; `so_far` elements of its kind have been defined above.
fn index(word: &[u8], so_far: i64, kind: &str) -> Result<i64, String> {
    let text = std::str::from_utf8(word).unwrap_or_default();
    let Ok(given) = text.parse::<i64>() else {
        return Err(format!(
            "a face corner that is not a whole number: `{}`",
            excerpt(word)
        ));
    };
    match given {
        0 => Err(format!("a {kind} index 0: OBJ counts from 1")),
        1..=0xFFFF_FFFE => Ok(given),
        _ if given > 0 => Err(format!("a {kind} index {given}, more than 4294967294")),
        _ if given < -so_far => Err(format!(
            "a relative {kind} index {given}, but only {so_far} are defined above"
        )),
        _ => Ok(so_far + 1 + given),
    }
}

/// The triangles of a model of `tobj` read without triangulation, as places in its list of corners, of which it has so many.
fn from_tobj(mesh: &tobj::Mesh) -> (Vec<[u32; 3]>, usize) {
    let vertices: Vec<DVec3> = mesh
        .positions
        .chunks_exact(3)
        .map(DVec3::from_slice)
        .collect();
    let mut triangles = Vec::with_capacity(mesh.indices.len() / 3);
    let mut rest = mesh.indices.as_slice();
    let mut arities = mesh.face_arities.iter();
    let mut first = 0;
    while !rest.is_empty() {
        let count = arities
            .next()
            .map_or(3, |a| *a as usize)
            .clamp(1, rest.len());
        let (polygon, tail) = rest.split_at(count);
        rest = tail;
        let corners: Vec<DVec3> = polygon.iter().map(|v| vertices[*v as usize]).collect();
        triangles.extend(
            triangulate(&corners)
                .into_iter()
                .map(|t| t.map(|k| first + k)),
        );
        first += count as u32;
    }
    (triangles, mesh.indices.len())
}
