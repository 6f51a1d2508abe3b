//! Meshes from people's files: OBJ, STL, PLY, OFF and 3MF.
//!
//! Takes a file's name and bytes. The name's extension says the format, the first bytes must not contradict it.
//! Never panics, never allocates by a number that only stands in a header, never follows a path in a file.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::mesh_format::MeshFormat;
use crate::formats::sniff::sniffed;
use crate::formats::{read_3mf, read_obj, read_off, read_ply, read_stl};
use crate::mesh::{Attributes, TriMesh};

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
    let format =
        sniffed(file_name, bytes).map_err(|wrong| wrong.at(Place::File(file_name.to_owned())))?;
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
        MeshFormat::Off => read_off::read(file_name, bytes).map(single),
        MeshFormat::ThreeMf => read_3mf::read(file_name, bytes),
    }
}
