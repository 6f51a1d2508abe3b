//! Optimised surfaces as PLY (binary, with everything that is known of their vertices) and as OBJ (geometry, texture points and
//! colours). Not for printing: such a surface may be open, torn or cross itself.

use crate::formats::narrow::{byte, single};
use crate::index::VertexId;
use crate::mesh::{NO_UV, Uvs, VertexScalar};
use crate::surface::Surface;
use glam::DVec2;
use std::fmt::Write;

/// Names of our own properties; an input's scalar of the same name is written as `input_...`.
const OWN: [&str; 7] = [
    "lambda",
    "lambda0",
    "lambda_min",
    "lambda_max",
    "mu",
    "group",
    "input_vertex",
];

/// The bytes of a little-endian PLY file. Texture points stand at vertices (`s`, `t`) if every vertex has one only, else at face
/// corners (`texcoord`, as MeshLab has them); both in 32 bits, the only ones it reads.
pub fn write_surface_ply(surface: &Surface) -> Vec<u8> {
    let attributes = &surface.attributes;
    let uvs = attributes.uvs.as_ref();
    let at_vertices = uvs.and_then(|uvs| uvs.per_vertex(&surface.mesh));
    let at_corners = uvs.filter(|_| at_vertices.is_none());
    let alpha = attributes.colours.iter().any(|c| c[3] != 1.0);
    let channels = match (attributes.colours.is_empty(), alpha) {
        (true, _) => 0,
        (false, false) => 3,
        (false, true) => 4,
    };
    let mut header = head(surface, channels, at_vertices.is_some());
    // Writing to a String cannot fail.
    let _ = writeln!(header, "element face {}", surface.mesh.faces.len());
    header.push_str("property list uchar int vertex_indices\n");
    if at_corners.is_some() {
        header.push_str("property list uchar float texcoord\n");
    }
    header.push_str("end_header\n");
    let mut bytes = header.into_bytes();
    push_vertices(&mut bytes, surface, channels, at_vertices.as_deref());
    push_faces(&mut bytes, &surface.mesh.faces, at_corners);
    bytes
}

fn push_vertices(bytes: &mut Vec<u8>, surface: &Surface, channels: usize, uvs: Option<&[DVec2]>) {
    let attributes = &surface.attributes;
    for (v, reach) in surface.reach.iter().enumerate() {
        let mut double = |value: f64| bytes.extend_from_slice(&value.to_le_bytes());
        surface.mesh.vertices[v]
            .to_array()
            .into_iter()
            .for_each(&mut double);
        let own = [
            reach.lambda,
            reach.lambda0,
            reach.lambda_min,
            reach.lambda_max,
            reach.mu,
        ];
        own.into_iter().for_each(&mut double);
        bytes.extend_from_slice(&reach.group.to_le_bytes());
        bytes.extend_from_slice(&surface.input_vertex[v].0.to_le_bytes());
        if let Some(colour) = attributes.colours.get(v) {
            bytes.extend(colour[..channels].iter().map(|c| byte(*c)));
        }
        if let Some(points) = uvs {
            push_point(bytes, points[v]);
        }
        for scalar in &attributes.scalars {
            bytes.extend_from_slice(&scalar.values[v].to_le_bytes());
        }
    }
}

fn push_faces(bytes: &mut Vec<u8>, faces: &[[VertexId; 3]], uvs: Option<&Uvs>) {
    for (f, face) in faces.iter().enumerate() {
        bytes.push(3);
        face.iter()
            .for_each(|v| bytes.extend_from_slice(&v.0.to_le_bytes()));
        let Some(uvs) = uvs else { continue };
        bytes.push(6);
        for uv in uvs.corners[f] {
            push_point(
                bytes,
                uvs.points.get(uv as usize).copied().unwrap_or_default(),
            );
        }
    }
}

/// A texture point in 32 bits.
fn push_point(bytes: &mut Vec<u8>, point: DVec2) {
    for c in point.to_array() {
        bytes.extend_from_slice(&single(c).to_le_bytes());
    }
}

/// The header down to the last property of vertices.
fn head(surface: &Surface, channels: usize, uvs: bool) -> String {
    let mut head = String::from("ply\nformat binary_little_endian 1.0\n");
    for note in &surface.notes {
        let _ = writeln!(head, "comment {}", plain(note));
    }
    let _ = writeln!(head, "element vertex {}", surface.mesh.vertices.len());
    let mut property = |kind: &str, name: &str| {
        let _ = writeln!(head, "property {kind} {name}");
    };
    for name in ["x", "y", "z"].iter().chain(&OWN[..5]) {
        property("double", name);
    }
    OWN[5..].iter().for_each(|name| property("int", name));
    let colours = ["red", "green", "blue", "alpha"];
    colours[..channels]
        .iter()
        .for_each(|name| property("uchar", name));
    if uvs {
        property("float", "s");
        property("float", "t");
    }
    let mut names: Vec<String> = Vec::new();
    for VertexScalar { name, .. } in &surface.attributes.scalars {
        let mut name = plain(name);
        while OWN.contains(&name.as_str()) || names.contains(&name) {
            name.insert_str(0, "input_");
        }
        property("double", &name);
        names.push(name);
    }
    head
}

/// The text of an OBJ file: `v` with colours, `vt`, `f`. It cannot hold more.
pub fn write_surface_obj(surface: &Surface) -> Vec<u8> {
    let mut text = String::new();
    for note in &surface.notes {
        let _ = writeln!(text, "# {}", plain(note));
    }
    for (v, p) in surface.mesh.vertices.iter().enumerate() {
        // Shortest digits that read back as the same number.
        let _ = write!(text, "v {} {} {}", p.x, p.y, p.z);
        if let Some([r, g, b, _]) = surface.attributes.colours.get(v) {
            let _ = write!(text, " {r} {g} {b}");
        }
        text.push('\n');
    }
    let uvs = surface.attributes.uvs.as_ref();
    for p in uvs.iter().flat_map(|uvs| &uvs.points) {
        let _ = writeln!(text, "vt {} {}", p.x, p.y);
    }
    for (f, face) in surface.mesh.faces.iter().enumerate() {
        text.push('f');
        for (k, v) in face.iter().enumerate() {
            let _ = write!(text, " {}", v.0 + 1);
            let uv = uvs.map_or(NO_UV, |uvs| uvs.corners[f][k]);
            if uv != NO_UV {
                let _ = write!(text, "/{}", uv + 1);
            }
        }
        text.push('\n');
    }
    text.into_bytes()
}

/// One line of plain characters, as headers of such files may have.
fn plain(text: &str) -> String {
    let kept = |c: char| {
        if c == ' ' || c.is_ascii_graphic() {
            c
        } else {
            '?'
        }
    };
    text.chars().map(kept).collect()
}
