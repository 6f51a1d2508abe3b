//! Any mesh as a support: closed, or with a border and a thickness.

use super::entry::{BodyEntry, name};
use super::framed::FramedMesh;
use crate::index::{FaceId, VertexId};
use crate::mesh::{Edges, TriMesh};
use crate::scene::defaults;
use crate::scene::language::raw::RawBody;
use crate::scene::models::placing;
use crate::scene::text::{Field, Reader, Span, error_at, placed};
use glam::{DMat4, DVec3};

/// A mesh as the scene says it, in its place: its frame is the scene's.
pub(crate) fn mesh<'r>(
    reader: &mut Reader,
    raw: &'r RawBody,
    entry: &BodyEntry,
) -> Option<FramedMesh<'r>> {
    let name = name(reader, &raw.name, "mesh");
    let (file, file_span) = reader.required(&raw.file, "file", "this Mesh", entry.span)?;
    let unit = reader.given(&raw.units).map_or(1.0, |(u, _)| u.measure().0);
    let (placing, _) = placing::placing(reader, &raw.place)?;
    let crease = match &raw.creases {
        Field::Missing => None,
        field => Some(reader.within(field, "creases", defaults::CREASES)?.0),
    };
    let crease = crease.map(f64::to_radians);
    let loaded =
        (entry.read)(file).and_then(|bytes| crate::intake::load_model(file, &bytes, false));
    let loaded = reader.read(loaded, &file_span)?;
    // Whether it is sound is found below: warnings with advice for models would only repeat it.
    let repairs = loaded.warnings.into_iter().filter(|w| w.help.is_empty());
    let repairs = repairs.map(|w| placed(w, &file_span));
    reader.problems.extend(repairs);
    // A support does not turn to an eye.
    let placing = placing.or_facing(defaults::FACING.into());
    let matrix = placing.matrix(&loaded.value, unit, DVec3::ZERO);
    let mesh = loaded.value.transformed(matrix);
    Some(FramedMesh {
        crease,
        ..FramedMesh::plain(
            name?,
            solid(reader, mesh, &raw.thickness, &file_span)?,
            DMat4::IDENTITY,
            &raw.depth,
        )
    })
}

/// The mesh itself if it is closed; otherwise what it is with some thickness behind its mean direction.
fn solid(
    reader: &mut Reader,
    mesh: TriMesh,
    thickness: &Field<f64>,
    span: &Span,
) -> Option<TriMesh> {
    let open = Edges::new(&mesh).iter().filter(|e| e.len() == 1).count();
    match (open, thickness) {
        (0, Field::Missing) => Some(mesh),
        (0, _) => {
            reader.error(
                span,
                "`thickness` is for meshes with a border; this one is closed",
            );
            None
        }
        (_, Field::Missing) => {
            let text = format!("the mesh is open: {open} edges have one face only");
            reader.problems.push(error_at(span, text).help(
                "make it solid: `thickness: 5` goes on behind it, square to its mean direction",
            ));
            None
        }
        (_, field) => {
            let thickness = reader.positive(field, "thickness")?;
            let mean: DVec3 = FaceId::all(mesh.faces.len())
                .map(|f| mesh.area_vector(f))
                .sum();
            let Some(ahead) = mean.try_normalize() else {
                reader.error(span, "the mesh looks to all sides alike: it has no behind");
                return None;
            };
            Some(thickened(&mesh, -thickness * ahead))
        }
    }
}

/// A surface with a border made solid: a copy of it `by` away, and walls between the borders.
fn thickened(mesh: &TriMesh, by: DVec3) -> TriMesh {
    let n = mesh.vertices.len();
    let mut solid = mesh.clone();
    solid.vertices.extend(mesh.vertices.iter().map(|v| *v + by));
    let behind = |v: VertexId| v.plus(n);
    let back = mesh.faces.iter().map(|f| [f[2], f[1], f[0]].map(behind));
    solid.faces.extend(back);
    for sides in Edges::new(mesh).iter().filter(|sides| sides.len() == 1) {
        let side = &sides[0];
        let (a, b) = match side.forward {
            true => (side.low, side.high),
            false => (side.high, side.low),
        };
        solid
            .faces
            .extend([[b, a, behind(a)], [b, behind(a), behind(b)]]);
    }
    solid
}
