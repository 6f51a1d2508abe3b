//! A model for a view: read and made fit to be looked at.

use crate::diag::{Diagnostic, Warned};
use crate::formats::{NamedMesh, read_as_one};
use crate::mesh::gate::{Gated, gate};
use crate::mesh::size::size_doubt;
use crate::mesh::{Original, TriMesh};
use crate::words::gate as words;

/// A model fit to be looked at, and what its file has.
#[derive(Clone, Debug)]
pub struct Admitted {
    pub mesh: TriMesh,
    pub original: Original,
}

/// Only the mesh of [`load_original`].
///
/// # Errors
/// As [`load_original`].
pub fn load_model(
    file_name: &str,
    bytes: &[u8],
    at_own_size: bool,
) -> Result<Warned<TriMesh>, Diagnostic> {
    let Warned { value, warnings } = load_original(file_name, bytes, at_own_size)?;
    Ok(Warned {
        value: value.mesh,
        warnings,
    })
}

/// With `at_own_size` (nothing else says how large it is to be), sizes that suggest another unit are warned of.
///
/// # Errors
/// As [`read_mesh`](crate::formats::read_mesh), and models without faces, extent or thickness.
pub fn load_original(
    file_name: &str,
    bytes: &[u8],
    at_own_size: bool,
) -> Result<Warned<Admitted>, Diagnostic> {
    let read = read_as_one(file_name, bytes)?;
    let mut warnings = read.warnings;
    let NamedMesh {
        mesh: as_read,
        attributes,
        ..
    } = read.value;
    let gated = gate(as_read.clone()).map_err(|why| words::refused(file_name, why))?;
    warnings.extend(words::repaired(file_name, &gated));
    let Gated {
        mesh, vertex_of, ..
    } = gated;
    if at_own_size {
        warnings.extend(size_doubt(&mesh).map(|doubt| words::doubted(file_name, doubt)));
    }
    let original = Original {
        mesh: as_read,
        attributes,
        vertex_of,
        lowered_from: None,
    };
    Ok(Warned {
        value: Admitted { mesh, original },
        warnings,
    })
}
