//! Wavefront OBJ: positions, faces, texture points of face corners and colours of vertices (`v x y z r g b`).
//!
//! `tobj` reads; what it is given has been checked line by line ([`check`]) and cleaned here of all that it stumbles over:
//! comments behind a line, lines continued by `\`, weights (it divides by them), groups and materials (it splits the mesh at them),
//! colours of some vertices only, texture points that cannot be used, vertices without coordinates. It numbers vertices as faces come to use them, so the
//! first face it sees calls all of them in the file's order, and the mesh keeps the file's numbers. Colours and texture points
//! that cannot be used are left out with a warning: the surface is there without them.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::colours;
use crate::formats::obj_check::{Usable, check, logical_lines};
use crate::index::VertexId;
use crate::mesh::polygon::triangulate;
use crate::mesh::weld::keep_vertices;
use crate::mesh::{Attributes, NO_UV, TriMesh, Uvs};
use glam::{DVec2, DVec3};
use std::io::Write;

/// # Errors
/// The first line that cannot be read as what it claims to be, or a file without faces.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Warned<NamedMesh>, Diagnostic> {
    let Warned {
        value: usable,
        warnings,
    } = check(file, bytes)?;
    let failed = |why: tobj::LoadError| {
        let message = format!("the file cannot be read as OBJ: {why}");
        Diagnostic::error(message).at(Place::File(file.to_owned()))
    };
    let options = tobj::LoadOptions::default();
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let text = clean(bytes, &usable);
    let (models, _) =
        tobj::load_obj_buf(&mut text.as_slice(), &options, no_materials).map_err(failed)?;
    // Without groups and materials everything is one model.
    let [model] = &models[..] else {
        return Err(failed(tobj::LoadError::GenericFailure));
    };
    let (mut mesh, mut attributes) = from_tobj(&model.mesh, &usable);
    if !usable.sound.is_empty() {
        keep_vertices(&mut mesh, &usable.sound);
        let mut keep = usable.sound.iter();
        attributes.colours.retain(|_| keep.next() == Some(&true));
    }
    Ok(Warned {
        warnings,
        value: NamedMesh {
            name: String::new(),
            mesh,
            attributes,
        },
    })
}

/// A face that calls all vertices, and all texture points if they are used, in their order: so many corners.
fn roll_call(usable: &Usable) -> usize {
    // One texture point is ours: see `clean`.
    let points = usable.texture_points.map_or(0, |count| count + 1);
    usable.vertices.max(points)
}

/// The lines that `tobj` is to read. `tobj` gives a corner without a texture point that of the corner before; such corners
/// get one of our own here, behind all of the file's.
fn clean(bytes: &[u8], usable: &Usable) -> Vec<u8> {
    let mut text = b"f".to_vec();
    for k in 1..=roll_call(usable) {
        let vertex = k.min(usable.vertices);
        // Writing to memory cannot fail.
        let _ = match usable.texture_points {
            Some(count) => write!(text, " {vertex}/{}", k.min(count + 1)),
            None => write!(text, " {vertex}"),
        };
    }
    text.push(b'\n');
    let none = usable.texture_points.map(|count| (count + 1).to_string());
    let mut sound = usable.sound.iter();
    for (_, line) in logical_lines(bytes) {
        let mut words = line
            .split(u8::is_ascii_whitespace)
            .filter(|w| !w.is_empty());
        match words.next() {
            Some(b"v") => {
                let count = if usable.coloured { 6 } else { 3 };
                if sound.next() == Some(&false) {
                    // It goes again later: the file's numbers count it.
                    put(
                        &mut text,
                        b"v",
                        [b"0".as_slice(); 6].into_iter().take(count),
                    );
                } else {
                    put(&mut text, b"v", words.take(count));
                }
            }
            Some(b"vt") if none.is_some() => {
                // A point may have one coordinate, or none.
                let zeros = [b"0".as_slice(); 2];
                put(&mut text, b"vt", words.take(2).chain(zeros).take(2));
            }
            Some(b"f" | b"fo") => {
                text.push(b'f');
                for word in words {
                    let mut parts = word.split(|b| *b == b'/');
                    text.push(b' ');
                    text.extend_from_slice(parts.next().unwrap_or_default());
                    if let Some(none) = &none {
                        let point = parts.next().filter(|p| !p.is_empty());
                        text.push(b'/');
                        text.extend_from_slice(point.unwrap_or(none.as_bytes()));
                    }
                }
                text.push(b'\n');
            }
            _ => {}
        }
    }
    if none.is_some() {
        text.extend_from_slice(b"vt 0 0\n");
    }
    text
}

fn put<'w>(text: &mut Vec<u8>, keyword: &[u8], words: impl Iterator<Item = &'w [u8]>) {
    text.extend_from_slice(keyword);
    for word in words {
        text.push(b' ');
        text.extend_from_slice(word);
    }
    text.push(b'\n');
}

/// The mesh with the file's vertices and its faces cut into triangles, and what belongs to them.
fn from_tobj(read: &tobj::Mesh, usable: &Usable) -> (TriMesh, Attributes) {
    let positions = read.positions.chunks_exact(3).map(DVec3::from_slice);
    let vertices: Vec<DVec3> = positions.collect();
    let mut faces = Vec::with_capacity(read.indices.len() / 3);
    let mut corners = Vec::new();
    let texture = |corner: usize| {
        let point = read.texcoord_indices[corner];
        // The last one is that of corners without any.
        let own = usable.texture_points == Some(point as usize);
        if own { NO_UV } else { point }
    };
    let arities = read.face_arities.iter().map(|arity| *arity as usize);
    // `tobj` lists no arities if all faces are triangles, which the first one may be too.
    let arities = arities.chain(std::iter::repeat(3)).skip(1);
    let mut first = roll_call(usable);
    for arity in arities {
        if first >= read.indices.len() {
            break;
        }
        let polygon = &read.indices[first..first + arity];
        let points: Vec<DVec3> = polygon.iter().map(|v| vertices[VertexId(*v)]).collect();
        for triangle in triangulate(&points) {
            faces.push(triangle.map(|k| polygon[k]));
            if usable.texture_points.is_some() {
                corners.push(triangle.map(|k| texture(first + k)));
            }
        }
        first += arity;
    }
    let uvs = usable.texture_points.map(|count| Uvs {
        corners,
        points: read
            .texcoords
            .chunks_exact(2)
            .take(count)
            .map(DVec2::from_slice)
            .collect(),
    });
    let attributes = Attributes {
        colours: colours::scaled(&read.vertex_color),
        uvs,
        scalars: Vec::new(),
    };
    (TriMesh::new(vertices, faces), attributes)
}
