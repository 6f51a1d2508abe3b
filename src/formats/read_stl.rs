//! STL, binary and text.
//!
//! Which of the two is decided by the length a binary header promises, not by the word `solid`, which many binary
//! files carry too. Normals are not read: the corners say more.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::text::{
    at_byte, at_line, check_coordinate, coordinate, excerpt, lines, without_bom,
};
use crate::mesh::TriMesh;
use glam::DVec3;

const HEADER: usize = 84;
const FACET: usize = 50;

/// # Errors
/// A count that does not fit the length, a coordinate that is no finite number, or what breaks the text form.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Warned<TriMesh>, Diagnostic> {
    let promised = bytes.get(80..HEADER).map(|b| {
        u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])) * FACET as u64 + HEADER as u64
    });
    if promised == Some(bytes.len() as u64) || !looks_like_text(bytes) {
        read_binary(file, bytes)
    } else {
        read_text(file, bytes).map(|value| Warned {
            value,
            warnings: Vec::new(),
        })
    }
}

fn looks_like_text(bytes: &[u8]) -> bool {
    let start = without_bom(bytes).trim_ascii_start();
    start
        .get(..5)
        .is_some_and(|w| w.eq_ignore_ascii_case(b"solid"))
        && !start.iter().take(1024).any(|b| *b == 0)
}

fn read_binary(file: &str, bytes: &[u8]) -> Result<Warned<TriMesh>, Diagnostic> {
    let Some(count) = bytes.get(80..HEADER) else {
        let message = format!(
            "not an STL file: {} bytes are less than the 84 of a binary header, and it does not start with `solid`",
            bytes.len()
        );
        return Err(at_byte(file, bytes.len(), message));
    };
    let declared = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
    let body = &bytes[HEADER..];
    let (present, tail) = (body.len() / FACET, body.len() % FACET);
    if declared != present {
        let message = format!(
            "the header declares {declared} triangles, the file holds {present}: cut short, or not a binary STL file"
        );
        return Err(at_byte(file, 80, message));
    }
    let mut warnings = Vec::new();
    if tail > 0 {
        let message = format!("ignored {tail} bytes after the {declared} declared triangles");
        warnings.push(Diagnostic {
            severity: crate::diag::Severity::Warning,
            ..at_byte(file, bytes.len() - tail, message)
        });
    }
    let mut soup = Soup::default();
    for (number, facet) in body.chunks_exact(FACET).enumerate() {
        for corner in 0..3 {
            let at = 12 + 12 * corner;
            soup.vertices
                .push(binary_corner(&facet[at..at + 12]).map_err(|why| {
                    let message = format!("triangle {} has a coordinate that is {why}", number + 1);
                    at_byte(file, HEADER + number * FACET + at, message)
                })?);
        }
    }
    let value = soup.finish(file)?;
    Ok(Warned { value, warnings })
}

fn binary_corner(bytes: &[u8]) -> Result<DVec3, String> {
    let mut corner = [0.0; 3];
    for (value, b) in corner.iter_mut().zip(bytes.chunks_exact(4)) {
        *value = check_coordinate(f32::from_le_bytes([b[0], b[1], b[2], b[3]]).into())?;
    }
    Ok(DVec3::from_array(corner))
}

/// Corners, three a triangle.
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
}

impl Soup {
    fn finish(self, file: &str) -> Result<TriMesh, Diagnostic> {
        if self.vertices.is_empty() {
            let place = Place::File(file.to_owned());
            return Err(Diagnostic::error("the file has no triangles").at(place));
        }
        let Ok(corners) = u32::try_from(self.vertices.len()) else {
            let place = Place::File(file.to_owned());
            return Err(Diagnostic::error("the file has more than 1431655765 triangles").at(place));
        };
        let faces = (0..corners / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]);
        Ok(TriMesh::new(self.vertices, faces))
    }
}

/// What the text form may say next.
#[derive(Clone, Copy, PartialEq)]
enum Expect {
    FacetOrEnd,
    Vertex,
    EndFacet,
    Solid,
}

/// Reads line by line: every exporter puts one statement on a line.
fn read_text(file: &str, bytes: &[u8]) -> Result<TriMesh, Diagnostic> {
    let mut soup = Soup::default();
    let mut expect = Expect::Solid;
    let mut last = 1;
    for (number, line) in lines(without_bom(bytes)) {
        last = number;
        let words: Vec<&[u8]> = line
            .split(u8::is_ascii_whitespace)
            .filter(|w| !w.is_empty())
            .take(6)
            .collect();
        let Some(first) = words.first() else {
            continue;
        };
        let wrong = |wanted: &str| {
            at_line(
                file,
                number,
                line,
                format!("`{}` found, {wanted} wanted", excerpt(first)),
            )
        };
        let keyword = first.to_ascii_lowercase();
        expect = match (keyword.as_slice(), expect) {
            (b"solid", Expect::Solid) => Expect::FacetOrEnd,
            (b"facet", Expect::FacetOrEnd) => Expect::Vertex,
            (b"endsolid", Expect::FacetOrEnd) => Expect::Solid,
            (b"outer", Expect::Vertex) | (b"endloop", Expect::EndFacet) => expect,
            (b"vertex", Expect::Vertex) => {
                let corner =
                    text_corner(&words[1..]).map_err(|why| at_line(file, number, line, why))?;
                soup.vertices.push(corner);
                if soup.vertices.len().is_multiple_of(3) {
                    Expect::EndFacet
                } else {
                    Expect::Vertex
                }
            }
            (b"endfacet", Expect::EndFacet) => Expect::FacetOrEnd,
            (_, Expect::FacetOrEnd) => return Err(wrong("`facet` or `endsolid`")),
            (_, Expect::Vertex) => return Err(wrong("`vertex` (three of them in a facet)")),
            (_, Expect::EndFacet) => return Err(wrong("`endloop` or `endfacet`")),
            (_, Expect::Solid) => return Err(wrong("`solid`")),
        };
    }
    if matches!(expect, Expect::Vertex | Expect::EndFacet) {
        return Err(at_line(
            file,
            last,
            b"",
            "the file ends inside of a facet: it is cut short",
        ));
    }
    if expect == Expect::FacetOrEnd && !soup.vertices.is_empty() {
        return Err(at_line(
            file,
            last,
            b"",
            "the file ends without `endsolid`: it is cut short",
        ));
    }
    soup.finish(file)
}

fn text_corner(words: &[&[u8]]) -> Result<DVec3, String> {
    if words.len() != 3 {
        return Err(format!(
            "a vertex with {} coordinates, 3 wanted",
            words.len()
        ));
    }
    let mut corner = [0.0; 3];
    for (value, word) in corner.iter_mut().zip(words) {
        *value = coordinate(word).map_err(|why| format!("a coordinate that is {why}"))?;
    }
    Ok(DVec3::from_array(corner))
}
