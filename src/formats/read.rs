//! Placeholder readers: OBJ and ASCII PLY or little-endian PLY with `float` x y z and triangle lists.

use crate::diag::{Diagnostic, Warned};
use crate::mesh::TriMesh;
use glam::DVec3;
use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub struct Inspection {
    pub faces: usize,
}

impl Inspection {
    pub fn printable(&self) -> bool {
        true
    }
}

impl std::fmt::Display for Inspection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "{} faces", self.faces)
    }
}

pub fn inspect(file_name: &str, bytes: &[u8]) -> Result<Warned<Inspection>, Diagnostic> {
    let mesh = read_mesh(file_name, bytes)?;
    Ok(Warned { value: Inspection { faces: mesh.value.faces.len() }, warnings: mesh.warnings })
}

pub fn read_mesh(file_name: &str, bytes: &[u8]) -> Result<Warned<TriMesh>, Diagnostic> {
    let mesh = if bytes.starts_with(b"ply") { ply(bytes) } else { Some(obj(bytes)) };
    let mesh = mesh.filter(|m| !m.faces.is_empty() && m.faces.iter().flatten().all(|v| (*v as usize) < m.vertices.len()));
    let value = mesh.ok_or_else(|| Diagnostic::error(format!("cannot read \"{file_name}\"")))?;
    Ok(Warned { value, warnings: Vec::new() })
}

fn obj(bytes: &[u8]) -> TriMesh {
    let mut mesh = TriMesh::default();
    for line in String::from_utf8_lossy(bytes).lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"v") => {
                let c: Vec<f64> = words[1..].iter().filter_map(|w| w.parse().ok()).collect();
                if c.len() >= 3 {
                    mesh.vertices.push(DVec3::new(c[0], c[1], c[2]));
                }
            }
            Some(&"f") => {
                let i: Vec<u32> = words[1..].iter().filter_map(|w| w.split('/').next()?.parse::<u32>().ok()).collect();
                for k in 1..i.len().saturating_sub(1) {
                    mesh.faces.push([i[0], i[k], i[k + 1]].map(|v| v.wrapping_sub(1)));
                }
            }
            _ => {}
        }
    }
    mesh
}

fn ply(bytes: &[u8]) -> Option<TriMesh> {
    let end = bytes.windows(11).position(|w| w == b"end_header\n")? + 11;
    let header = std::str::from_utf8(&bytes[..end]).ok()?;
    let count = |name: &str| header.lines().find_map(|l| l.strip_prefix(name))?.trim().parse::<usize>().ok();
    let (nv, nf) = (count("element vertex ")?, count("element face ")?);
    let mut mesh = TriMesh::default();
    let mut body = &bytes[end..];
    if header.contains("format ascii") {
        let text = std::str::from_utf8(body).ok()?;
        let mut words = text.split_whitespace();
        for _ in 0..nv {
            let mut next = || words.next()?.parse::<f64>().ok();
            mesh.vertices.push(DVec3::new(next()?, next()?, next()?));
        }
        for _ in 0..nf {
            let mut next = || words.next()?.parse::<u32>().ok();
            next()?;
            mesh.faces.push([next()?, next()?, next()?]);
        }
        return Some(mesh);
    }
    let mut take = |n: usize| {
        let (head, rest) = body.split_at_checked(n)?;
        body = rest;
        Some(head)
    };
    for _ in 0..nv {
        let b = take(12)?;
        let c = |i: usize| f64::from(f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]]));
        mesh.vertices.push(DVec3::new(c(0), c(1), c(2)));
    }
    for _ in 0..nf {
        let b = take(13)?;
        let c = |i: usize| u32::from_le_bytes([b[4 * i + 1], b[4 * i + 2], b[4 * i + 3], b[4 * i + 4]]);
        mesh.faces.push([c(0), c(1), c(2)]);
    }
    Some(mesh)
}
