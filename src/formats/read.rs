//! Meshes from people's files: OBJ, STL, PLY and 3MF.
//!
//! Takes a file's name and bytes. The name's extension says the format, the first bytes must not contradict it.
//! Never panics, never allocates by a number that only stands in a header, never follows a path in a file.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::{read_3mf, read_obj, read_ply, read_stl};
use crate::mesh::{Attributes, TriMesh};

/// Formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    Obj,
    Stl,
    Ply,
    ThreeMf,
}

impl MeshFormat {
    /// As people write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::ThreeMf => "3MF",
        }
    }

    /// By the extension, in any case.
    pub fn of(file_name: &str) -> Option<Self> {
        let (_, extension) = file_name.rsplit_once('.')?;
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "3mf" => Some(Self::ThreeMf),
            _ => None,
        }
    }
}

/// The mesh of a file as it stands there; 3MF objects are put together, each with vertices of its own.
///
/// # Errors
/// One message with the file and, as far as there is one, the line or byte.
pub fn read_mesh(file_name: &str, bytes: &[u8]) -> Result<Warned<TriMesh>, Diagnostic> {
    let Warned { value, warnings } = read_as_one(file_name, bytes)?;
    Ok(Warned {
        value: value.mesh,
        warnings,
    })
}

/// All bodies of a file as one. A file of several has no attributes.
///
/// # Errors
/// As [`read_mesh`].
pub fn read_as_one(file_name: &str, bytes: &[u8]) -> Result<Warned<NamedMesh>, Diagnostic> {
    let Warned {
        mut value,
        warnings,
    } = read_bodies(file_name, bytes)?;
    if value.len() == 1 {
        return Ok(Warned {
            value: value.remove(0),
            warnings,
        });
    }
    let mut all = TriMesh::default();
    for body in &value {
        if all.vertices.len() + body.mesh.vertices.len() > u32::MAX as usize {
            let message = "the bodies of the file have more than 4294967295 vertices together";
            return Err(Diagnostic::error(message).at(Place::File(file_name.to_owned())));
        }
        all.append(&body.mesh);
    }
    Ok(Warned {
        value: NamedMesh {
            name: String::new(),
            mesh: all,
            attributes: Attributes::default(),
        },
        warnings,
    })
}

/// As [`read_mesh`], with the bodies of a 3MF file kept apart.
///
/// # Errors
/// As [`read_mesh`].
pub fn read_bodies(file_name: &str, bytes: &[u8]) -> Result<Warned<Vec<NamedMesh>>, Diagnostic> {
    let format = sniffed_format(file_name, bytes)
        .map_err(|why| Diagnostic::error(why).at(Place::File(file_name.to_owned())))?;
    let single = |read: Warned<NamedMesh>| Warned {
        value: vec![read.value],
        warnings: read.warnings,
    };
    match format {
        MeshFormat::Obj => read_obj::read(file_name, bytes).map(single),
        MeshFormat::Stl => read_stl::read(file_name, bytes).map(|read| {
            single(Warned {
                value: NamedMesh {
                    name: String::new(),
                    mesh: read.value,
                    attributes: Attributes::default(),
                },
                warnings: read.warnings,
            })
        }),
        MeshFormat::Ply => read_ply::read(file_name, bytes).map(single),
        MeshFormat::ThreeMf => read_3mf::read(file_name, bytes),
    }
}

/// The format by the extension, if the content can be that.
fn sniffed_format(file_name: &str, bytes: &[u8]) -> Result<MeshFormat, String> {
    if bytes.is_empty() {
        return Err("the file is empty".to_owned());
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err("the file is empty but for blanks".to_owned());
    }
    let wanted = "OBJ, STL, PLY or 3MF wanted";
    let Some(format) = MeshFormat::of(file_name) else {
        return Err(match recognised(bytes) {
            Some(what) => format!("unknown extension, and the content is {what}; {wanted}"),
            None => format!("unknown extension; {wanted}"),
        });
    };
    match recognised(bytes) {
        Some(what) if !fits(format, what) => Err(format!(
            "the extension says {}, but the content is {what}",
            format.name()
        )),
        _ => Ok(format),
    }
}

const ZIP: &str = "a zip archive (3MF, if it is a model)";
const PLY: &str = "PLY";

fn fits(format: MeshFormat, what: &str) -> bool {
    matches!(
        (format, what),
        (MeshFormat::ThreeMf, ZIP) | (MeshFormat::Ply, PLY)
    )
}

/// What the first bytes give away for sure.
fn recognised(bytes: &[u8]) -> Option<&'static str> {
    const MAGIC: [(&[u8], &str); 15] = [
        (b"PK\x03\x04", ZIP),
        (b"PK\x05\x06", ZIP),
        (b"ply\n", PLY),
        (b"ply\r", PLY),
        (b"\x89PNG", "a PNG picture"),
        (b"\xFF\xD8\xFF", "a JPEG picture"),
        (b"GIF8", "a GIF picture"),
        (b"%PDF", "a PDF document"),
        (b"\x1F\x8B", "gzip-compressed: unpack it first"),
        (b"glTF", "a binary glTF model (GLB)"),
        (b"\x7FELF", "a program"),
        (b"\xFF\xFE", "UTF-16 text: save it as UTF-8"),
        (b"\xFE\xFF", "UTF-16 text: save it as UTF-8"),
        (
            b"version https://git-lfs",
            "a git-lfs pointer, not the model itself: run `git lfs pull`",
        ),
        (b"Kaydara FBX", "an FBX model"),
    ];
    if let Some((_, what)) = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Some(what);
    }
    let start = bytes.trim_ascii_start();
    let start = start[..start.len().min(16)].to_ascii_lowercase();
    let is_page = start.starts_with(b"<!doctype html") || start.starts_with(b"<html");
    is_page.then_some("an HTML page (an error page saved as a model?)")
}
