//! Sculpts the bundled models: `cargo run --release --example sculpt -- scenes/models [NAME...]`.
//!
//! Takes a directory and, optionally, names of creatures; writes `<name>.ply` for each (binary, little-endian,
//! millimetres, z up). Deterministic: the same program writes the same bytes.

mod coat;
mod field;
mod fish;
mod hare;
mod meshing;
mod owl;
mod turtle;

use meshing::{Creature, Mesh, sculpt};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Spacing of the first grid, mm; fine enough to catch the thinnest part (claws, about 1.5 mm) several times.
const PITCH: f64 = 0.55;

const NAMES: [&str; 4] = ["owl", "hare", "fish", "turtle"];

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let Some(folder) = args.next().map(PathBuf::from) else {
        eprintln!("usage: sculpt DIR [owl|hare|fish|turtle ...]");
        return ExitCode::from(2);
    };
    let wanted: Vec<String> = args.collect();
    if let Some(unknown) = wanted.iter().find(|w| !NAMES.contains(&w.as_str())) {
        eprintln!(
            "error: no creature is called {unknown:?}; there are {}",
            NAMES.join(", ")
        );
        return ExitCode::from(2);
    }
    for name in NAMES {
        if !wanted.is_empty() && !wanted.iter().any(|w| w == name) {
            continue;
        }
        if let Err(message) = produce(&creature(name), &folder) {
            eprintln!("error: {message}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// The creature of that name, one of [`NAMES`].
fn creature(name: &str) -> Creature {
    match name {
        "owl" => owl::owl(),
        "hare" => hare::hare(),
        "fish" => fish::fish(),
        _ => turtle::turtle(),
    }
}

/// Meshes one creature, stands it on z = 0 and writes it.
fn produce(creature: &Creature, folder: &Path) -> Result<(), String> {
    let mut mesh = sculpt(creature, PITCH)?;
    stand(&mut mesh);
    let path = folder.join(format!("{}.ply", creature.name));
    std::fs::write(&path, ply(&mesh)).map_err(|e| format!("{}: {e}", path.display()))?;
    println!(
        "{}: {} vertices, {} faces",
        path.display(),
        mesh.points.len(),
        mesh.faces.len()
    );
    Ok(())
}

/// Centres the mesh on x and y and puts its lowest point on z = 0.
fn stand(mesh: &mut Mesh) {
    let low = mesh
        .points
        .iter()
        .copied()
        .reduce(glam::DVec3::min)
        .unwrap_or_default();
    let high = mesh
        .points
        .iter()
        .copied()
        .reduce(glam::DVec3::max)
        .unwrap_or_default();
    let shift = (low + high).with_z(2.0 * low.z) * 0.5;
    for p in &mut mesh.points {
        *p -= shift;
    }
}

/// The bytes of a binary PLY file.
fn ply(mesh: &Mesh) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\ncomment millimetres, z up, MIT licence\nelement vertex {}\n\
         property float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        mesh.points.len(),
        mesh.faces.len()
    )
    .into_bytes();
    for p in &mesh.points {
        for c in p.as_vec3().to_array() {
            out.extend(c.to_le_bytes());
        }
    }
    for f in &mesh.faces {
        out.push(3);
        for c in f {
            out.extend((*c as i32).to_le_bytes());
        }
    }
    out
}
