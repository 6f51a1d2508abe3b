//! PLY: text, little-endian and big-endian, any scalar types, polygons and triangle strips.
//!
//! An own reader: the counts of a header are untrusted, so nothing is allocated or looped by them alone; every row
//! costs bytes of the file. Colours, texture points (of vertices, or of face corners as the list `texcoord`) and all other
//! numbers of vertices are kept where they can be used.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::channels::Channels;
use crate::formats::flaws::{Flaw, Flaws};
use crate::formats::narrow::{count, index};
use crate::formats::text::{at_byte, at_line, check_coordinate, excerpt, number_or_nan};
use crate::index::VertexId;
use crate::mesh::polygon::triangulate;
use crate::mesh::weld::keep_vertices;
use crate::mesh::{TriMesh, Uvs};
use glam::{DVec2, DVec3};

/// Real headers have some ten lines; scanners' up to a hundred.
const MAX_HEADER_LINES: usize = 4096;
const MAX_HEADER_BYTES: usize = 1 << 20;

/// # Errors
/// Headers that lie or name unknown types, rows that end early, coordinates that are not finite, indices out of range.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Warned<NamedMesh>, Diagnostic> {
    let header = Header::read(file, bytes)?;
    let mut body = Body {
        file,
        bytes,
        at: header.length,
        line: header.lines + 1,
        encoding: header.encoding,
    };
    let mut builder = Builder::default();
    for element in &header.elements {
        body.element(element, &mut builder)?;
        builder.vertices_known |= element.name == "vertex";
    }
    if let Some(flaw) = builder.used_flaw() {
        return Err(body.flawed(flaw));
    }
    let (mesh, mut warnings) = builder.finish(file)?;
    let left = bytes.get(body.at..).unwrap_or_default().trim_ascii();
    if !left.is_empty() {
        let message = format!(
            "ignored {} bytes after the last declared element",
            left.len()
        );
        warnings.push(Diagnostic::warning(message).at(Place::Byte {
            file: file.to_owned(),
            offset: body.at as u64,
        }));
    }
    Ok(Warned {
        value: mesh,
        warnings,
    })
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl NumberType {
    fn named(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// What means 1 in a colour, if the type says so.
    fn one(self) -> Option<f64> {
        match self {
            Self::U8 => Some(255.0),
            Self::U16 => Some(65535.0),
            _ => None,
        }
    }

    /// The value of bytes in little-endian order; integers are exact in f64.
    fn value(self, b: [u8; 8]) -> f64 {
        match self {
            Self::I8 => f64::from(i8::from_le_bytes([b[0]])),
            Self::U8 => f64::from(b[0]),
            Self::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Self::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Self::I32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F64 => f64::from_le_bytes(b),
        }
    }
}

#[derive(Debug)]
struct Property {
    name: String,
    scalar: NumberType,
    /// The type of its length, for a list.
    length: Option<NumberType>,
}

#[derive(Debug)]
struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
    line: usize,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// Bytes up to the body, and lines.
    length: usize,
    lines: usize,
}

impl Header {
    fn read(file: &str, bytes: &[u8]) -> Result<Self, Diagnostic> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let (mut at, mut number) = (0, 0);
        loop {
            let rest = &bytes[at..];
            number += 1;
            let (line, step) =
                header_line(rest, number, at).map_err(|why| at_line(file, number, rest, why))?;
            at += step;
            let text = String::from_utf8_lossy(line);
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let fail = |why: String| at_line(file, number, line, why);
            match words.as_slice() {
                ["ply"] if number == 1 => {}
                _ if number == 1 => {
                    return Err(fail(
                        "not a PLY file: its first line is not `ply`".to_owned(),
                    ));
                }
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, _version] => encoding = Some(encoding_named(name).map_err(fail)?),
                ["element", name, count] => {
                    elements.push(element(name, count, number).map_err(fail)?);
                }
                ["property", words @ ..] => {
                    let property = property(words).map_err(fail)?;
                    match elements.last_mut() {
                        Some(element) => element.properties.push(property),
                        None => return Err(fail("a property before the first element".to_owned())),
                    }
                }
                ["end_header"] => break,
                _ => return Err(fail("not a line of a PLY header".to_owned())),
            }
        }
        let Some(encoding) = encoding else {
            let message = "the header has no `format` line";
            return Err(at_line(file, number, b"", message));
        };
        Ok(Self {
            encoding,
            elements,
            length: at,
            lines: number,
        })
    }
}

/// The first line of `rest`, and how many bytes it takes with its end; `number` and `at` are its place in the file.
fn header_line(rest: &[u8], number: usize, at: usize) -> Result<(&[u8], usize), String> {
    let is_end = |b: &u8| matches!(b, b'\n' | b'\r');
    if number > MAX_HEADER_LINES || at > MAX_HEADER_BYTES {
        return Err(format!("the header has more than {MAX_HEADER_LINES} lines"));
    }
    let Some(end) = rest.iter().take(MAX_HEADER_BYTES).position(is_end) else {
        return Err("the header has no `end_header`".to_owned());
    };
    let both = usize::from(rest[end..].starts_with(b"\r\n"));
    Ok((&rest[..end], end + 1 + both))
}

fn encoding_named(name: &str) -> Result<Encoding, String> {
    match name {
        "ascii" => Ok(Encoding::Text),
        "binary_little_endian" => Ok(Encoding::Little),
        "binary_big_endian" => Ok(Encoding::Big),
        _ => Err(format!(
            "unknown format `{}`; ascii, binary_little_endian or binary_big_endian wanted",
            excerpt(name.as_bytes())
        )),
    }
}

fn element(name: &str, count: &str, line: usize) -> Result<Element, String> {
    let digits = count.bytes().all(|b| b.is_ascii_digit());
    let Some(count) = count.parse().ok().filter(|_| digits) else {
        return Err(format!(
            "an element count that is not a whole number: `{}`",
            excerpt(count.as_bytes())
        ));
    };
    Ok(Element {
        name: name.to_owned(),
        count,
        properties: Vec::new(),
        line,
    })
}

fn property(words: &[&str]) -> Result<Property, String> {
    let scalar = |word: &str| {
        NumberType::named(word)
            .ok_or_else(|| format!("unknown property type `{}`", excerpt(word.as_bytes())))
    };
    match words {
        ["list", length, item, name] => {
            let length = scalar(length)?;
            if matches!(length, NumberType::F32 | NumberType::F64) {
                return Err("a list whose length is not a whole number".to_owned());
            }
            Ok(Property {
                name: (*name).to_owned(),
                scalar: scalar(item)?,
                length: Some(length),
            })
        }
        [item, name] => Ok(Property {
            name: (*name).to_owned(),
            scalar: scalar(item)?,
            length: None,
        }),
        _ => Err("a property needs a type and a name".to_owned()),
    }
}

/// Where a value of a row goes.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Axis(usize),
    /// A place in [`Channels`].
    Channel(usize),
    Polygon,
    /// Texture points of the polygon in the same row.
    CornerUvs,
    Strip,
    Skip,
}

fn role(element: &Element, property: &Property, channels: &mut Channels) -> Role {
    let indices = matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
    match (element.name.as_str(), property.length.is_some()) {
        ("vertex", false) => match property.name.as_str() {
            "x" => Role::Axis(0),
            "y" => Role::Axis(1),
            "z" => Role::Axis(2),
            name => channels
                .place(name, property.scalar.one())
                .map_or(Role::Skip, Role::Channel),
        },
        ("face", true) if indices => Role::Polygon,
        ("face", true) if property.name == "texcoord" => Role::CornerUvs,
        ("tristrips", true) if indices => Role::Strip,
        _ => Role::Skip,
    }
}

/// The part after the header, and how far it has been read.
struct Body<'a> {
    file: &'a str,
    bytes: &'a [u8],
    at: usize,
    line: usize,
    encoding: Encoding,
}

impl Body<'_> {
    fn element(&mut self, element: &Element, builder: &mut Builder) -> Result<(), Diagnostic> {
        let roles: Vec<Role> = element
            .properties
            .iter()
            .map(|p| role(element, p, &mut builder.channels))
            .collect();
        if element.name == "vertex" && (0..3).any(|axis| !roles.contains(&Role::Axis(axis))) {
            let message = "the element `vertex` lacks a property x, y or z";
            return Err(at_line(self.file, element.line, b"element vertex", message));
        }
        // Rows without properties take no bytes: there is nothing to read, however many are declared.
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut list = Vec::new();
        for row in 0..element.count {
            let mut point = [0.0; 3];
            let mut flaw = None;
            for (property, role) in element.properties.iter().zip(&roles) {
                let start = self.at;
                let count = match property.length {
                    Some(length) => self.length(length, property, element, row)?,
                    None => 1,
                };
                list.clear();
                for _ in 0..count {
                    list.push(self.scalar(property.scalar, element, row)?);
                }
                let at = (start, row, element.name.as_str());
                match role {
                    Role::Axis(axis) => {
                        point[*axis] = list[0];
                        if let Err(why) = check_coordinate(list[0]) {
                            let line = self.line;
                            flaw.get_or_insert((RowPlace { row, start, line }, why));
                        }
                    }
                    Role::Channel(channel) => builder.channels.push(*channel, list[0]),
                    Role::CornerUvs => builder.corner_uvs(&list),
                    Role::Polygon => builder.polygon(&list).map_err(|why| self.fail(at, why))?,
                    Role::Strip => builder.strip(&list).map_err(|why| self.fail(at, why))?,
                    Role::Skip => {}
                }
            }
            if element.name == "vertex" {
                if let Some((place, why)) = flaw {
                    builder.flaws.add(builder.vertices.len(), place, why);
                }
                builder.vertices.push(DVec3::from_array(point));
            }
        }
        Ok(())
    }

    /// The message about a vertex that a face uses.
    fn flawed(&mut self, flaw: &Flaw<RowPlace>) -> Diagnostic {
        let RowPlace { row, start, line } = flaw.at;
        self.line = line;
        let why = format!("a coordinate that is {}", flaw.why);
        self.fail((start, row, "vertex"), why)
    }

    fn fail(&self, (start, row, element): (usize, u64, &str), why: String) -> Diagnostic {
        let message = format!("{} {row}: {why}", excerpt(element.as_bytes()));
        match self.encoding {
            Encoding::Text => at_line(self.file, self.line, self.text_line(start), message),
            _ => at_byte(self.file, start, message),
        }
    }

    /// The line of text around a byte.
    fn text_line(&self, at: usize) -> &[u8] {
        let at = at.min(self.bytes.len());
        let is_end = |b: &u8| matches!(b, b'\n' | b'\r');
        let start = (at..self.bytes.len())
            .find(|k| !self.bytes[*k].is_ascii_whitespace())
            .unwrap_or(at);
        let from = self.bytes[..start]
            .iter()
            .rposition(is_end)
            .map_or(0, |k| k + 1);
        let to = self.bytes[start..]
            .iter()
            .position(is_end)
            .map_or(self.bytes.len(), |k| start + k);
        &self.bytes[from..to]
    }

    /// The length of a list, known to fit into what is left of the file.
    fn length(
        &mut self,
        length: NumberType,
        property: &Property,
        element: &Element,
        row: u64,
    ) -> Result<usize, Diagnostic> {
        let start = self.at;
        let count = self.scalar(length, element, row)?;
        let no_length = || {
            self.fail(
                (start, row, &element.name),
                format!("a list of length {count}"),
            )
        };
        if count < 0.0 || count.fract() != 0.0 {
            return Err(no_length());
        }
        // Every item takes at least a blank and a digit in text.
        let smallest = if self.encoding == Encoding::Text {
            1
        } else {
            property.scalar.size()
        };
        let left = self.bytes.len() - self.at;
        if count * smallest as f64 > left as f64 {
            let why = format!("a list of {count} items, but the file ends {left} bytes later");
            return Err(self.fail((start, row, &element.name), why));
        }
        index(count).map(|n| n as usize).ok_or_else(no_length)
    }

    fn scalar(
        &mut self,
        scalar: NumberType,
        element: &Element,
        row: u64,
    ) -> Result<f64, Diagnostic> {
        let start = self.at;
        if self.encoding == Encoding::Text {
            let Some(word) = self.word() else {
                return Err(self.short(element, row));
            };
            let word = word.to_vec();
            return number(&word, scalar)
                .map_err(|why| self.fail((start, row, &element.name), why));
        }
        let size = scalar.size();
        let Some(raw) = self.bytes.get(start..start + size) else {
            return Err(self.short(element, row));
        };
        self.at += size;
        let mut value = [0; 8];
        value[..size].copy_from_slice(raw);
        if self.encoding == Encoding::Big {
            value[..size].reverse();
        }
        Ok(scalar.value(value))
    }

    fn short(&self, element: &Element, row: u64) -> Diagnostic {
        let message = format!(
            "the header declares {} rows of `{}`, the file ends in row {}",
            element.count,
            excerpt(element.name.as_bytes()),
            row + 1
        );
        match self.encoding {
            Encoding::Text => at_line(self.file, self.line, b"", message),
            _ => at_byte(self.file, self.bytes.len(), message),
        }
    }

    /// The next word of a text body; counts the lines passed.
    fn word(&mut self) -> Option<&[u8]> {
        while let Some(b) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace()) {
            let second_of_two = *b == b'\n' && self.at > 0 && self.bytes[self.at - 1] == b'\r';
            self.line += usize::from(matches!(b, b'\n' | b'\r') && !second_of_two);
            self.at += 1;
        }
        let start = self.at;
        let length = self.bytes[start..].iter().position(u8::is_ascii_whitespace);
        self.at = length.map_or(self.bytes.len(), |l| start + l);
        (self.at > start).then(|| &self.bytes[start..self.at])
    }
}

fn number(word: &[u8], scalar: NumberType) -> Result<f64, String> {
    if matches!(scalar, NumberType::F32 | NumberType::F64) {
        return number_or_nan(word).map_err(|why| format!("a value that is {why}"));
    }
    let text = std::str::from_utf8(word).unwrap_or_default();
    text.parse::<i64>()
        .map(|v| v as f64)
        .map_err(|_| format!("not a whole number: `{}`", excerpt(word)))
}

/// Where a value of a row stands.
struct RowPlace {
    row: u64,
    /// Byte, and line in a text file.
    start: usize,
    line: usize,
}

#[derive(Default)]
struct Builder {
    vertices: Vec<DVec3>,
    flaws: Flaws<RowPlace>,
    /// Whether all vertices have been read, so that indices can be checked where they stand.
    vertices_known: bool,
    /// Corners of all polygons, and how many each has: vertices may come after the faces.
    corners: Vec<u32>,
    arities: Vec<u32>,
    channels: Channels,
    /// Texture points of face corners, and how many of them every row of faces has.
    uvs: Vec<DVec2>,
    uv_counts: Vec<u32>,
}

impl Builder {
    fn polygon(&mut self, list: &[f64]) -> Result<(), String> {
        if list.len() < 3 {
            return Err(format!("{} corners, at least 3 wanted", list.len()));
        }
        for value in list {
            let corner = self.index(*value)?;
            self.corners.push(corner);
        }
        self.arities.push(count(list.len()));
        Ok(())
    }

    fn corner_uvs(&mut self, list: &[f64]) {
        let pairs = list.chunks_exact(2);
        self.uv_counts.push(if list.len().is_multiple_of(2) {
            count(pairs.len())
        } else {
            u32::MAX
        });
        self.uvs.extend(pairs.map(DVec2::from_slice));
    }

    /// Strips are ended by -1; every other triangle is turned.
    fn strip(&mut self, list: &[f64]) -> Result<(), String> {
        for strip in list.split(|v| *v == -1.0) {
            for (k, t) in strip.windows(3).enumerate() {
                let [a, b, c] = [self.index(t[0])?, self.index(t[1])?, self.index(t[2])?];
                if a != b && b != c && c != a {
                    let turned = if k % 2 == 0 { [a, b, c] } else { [b, a, c] };
                    self.corners.extend(turned);
                    self.arities.push(3);
                }
            }
        }
        Ok(())
    }

    fn index(&self, value: f64) -> Result<u32, String> {
        let count = self.vertices.len();
        if self.vertices_known && value >= count as f64 {
            return Err(format!(
                "a vertex index {value}, but there are {count} vertices (counted from 0)"
            ));
        }
        index(value).ok_or_else(|| format!("a vertex index {value}"))
    }

    /// That of the first flawed vertex that a face uses.
    fn used_flaw(&self) -> Option<&Flaw<RowPlace>> {
        if self.flaws.is_empty() {
            return None;
        }
        let used = self.corners.iter().map(|c| *c as usize);
        self.flaws.first_used(self.vertices.len(), used)
    }

    /// # Errors
    /// No faces, or indices out of range. Flawed vertices that faces use have been refused.
    fn finish(mut self, file: &str) -> Result<(NamedMesh, Vec<Diagnostic>), Diagnostic> {
        let place = || Place::File(file.to_owned());
        let count = self.vertices.len();
        if self.arities.is_empty() {
            let message = format!("the file has {count} vertices but no faces");
            return Err(Diagnostic::error(message).at(place()));
        }
        if let Some(bad) = self.corners.iter().find(|c| **c as usize >= count) {
            let message = format!(
                "a face uses vertex {bad}, but the file has {count} vertices (counted from 0)"
            );
            return Err(Diagnostic::error(message).at(place()));
        }
        let corners = self.triangles();
        let faces = corners.iter().map(|t| t.map(|c| self.corners[c as usize]));
        let mut mesh = TriMesh::new(self.vertices, faces);
        let left_out = self.flaws.left_out(file);
        if left_out.is_some() {
            let kept = self.flaws.sound(count);
            keep_vertices(&mut mesh, &kept);
            self.channels.keep(&kept);
        }
        let count = mesh.vertices.len();
        let (mut attributes, mut warnings) = self.channels.finish(file, count, &mesh.faces);
        warnings.extend(left_out);
        let sound = self.uvs.iter().all(|p| p.is_finite());
        if sound && self.uv_counts == self.arities {
            attributes.uvs = Some(Uvs {
                points: self.uvs,
                corners,
            });
        } else if self.uv_counts.iter().any(|n| *n > 0) {
            let why = if sound {
                "some faces have other than two numbers a corner"
            } else {
                "some are not finite numbers"
            };
            let message = format!("the texture points of face corners are not used: {why}");
            warnings.push(Diagnostic::warning(message).at(place()));
        }
        let name = String::new();
        Ok((
            NamedMesh {
                name,
                mesh,
                attributes,
            },
            warnings,
        ))
    }

    /// All polygons in triangles, as places in `corners`.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::with_capacity(self.arities.len());
        let mut first = 0;
        for arity in &self.arities {
            let polygon = &self.corners[first as usize..(first + arity) as usize];
            let points: Vec<DVec3> = polygon
                .iter()
                .map(|v| self.vertices[VertexId(*v)])
                .collect();
            triangles.extend(
                triangulate(&points)
                    .into_iter()
                    .map(|t| t.map(|k| first + count(k))),
            );
            first += arity;
        }
        triangles
    }
}
