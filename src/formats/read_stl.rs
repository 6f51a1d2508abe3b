//! STL, binary and text.
//!
//! Which of the two is decided by the length a binary header promises, not by the word `solid`, which many binary
//! files carry too. Normals are not read: the corners say more.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::read_stl_text::corners;
use crate::formats::text::{at_byte, check_coordinate, without_bom};
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
        let vertices = corners(file, bytes)?;
        Ok(Warned {
            value: Soup { vertices }.finish(file)?,
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
