//! Binary STL: little-endian f32, millimetres, z up.

use crate::formats::narrow::count;
use crate::index::FaceId;
use crate::mesh::Solid;

const HEADER_BYTES: usize = 80;
const RECORD_BYTES: usize = 50;

/// The bytes of a binary STL file.
///
/// `title` goes into the 80-byte header as far as it fits; the header never starts with `solid`, by which readers
/// take a file for text. Coordinates are rounded to f32, normals are those of the f64 faces.
pub fn write_stl(solid: &Solid, title: &str) -> Vec<u8> {
    let mesh = solid.mesh();
    let mut bytes = Vec::with_capacity(HEADER_BYTES + 4 + RECORD_BYTES * mesh.faces.len());
    bytes.extend_from_slice(&header(title));
    bytes.extend_from_slice(&count(mesh.faces.len()).to_le_bytes());
    for face in FaceId::all(mesh.faces.len()) {
        for point in std::iter::once(mesh.normal(face)).chain(mesh.corners(face)) {
            for coordinate in point.as_vec3().to_array() {
                bytes.extend_from_slice(&coordinate.to_le_bytes());
            }
        }
        bytes.extend_from_slice(&[0, 0]);
    }
    bytes
}

fn header(title: &str) -> [u8; HEADER_BYTES] {
    let text = format!("pillarforest, millimetres, z up: {title}");
    let mut header = [b' '; HEADER_BYTES];
    let printable = text.chars().map(|c| {
        if c.is_ascii_graphic() || c == ' ' {
            c as u8
        } else {
            b'?'
        }
    });
    header
        .iter_mut()
        .zip(printable)
        .for_each(|(slot, byte)| *slot = byte);
    header
}
