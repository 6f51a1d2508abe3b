//! Sculpts the bundled models: `cargo run --release --example sculpt -- scenes/models [NAME...]`.
//!
//! Takes a directory and, optionally, names of models; writes `<name>.ply` for each (binary, little-endian,
//! millimetres, z up). Deterministic: the same program writes the same bytes.

mod coat;
mod cow;
mod cube;
mod dragon;
mod field;
mod fish;
mod hare;
mod head;
mod imp;
mod meshing;
mod owl;
mod turtle;
mod vase;

use meshing::{Creature, Mesh, sculpt};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Spacing of the first grid, mm; fine enough to catch the thinnest part (claws, about 1.5 mm) several times.
const PITCH: f64 = 0.55;

/// How a model comes about.
#[derive(Clone, Copy)]
enum Origin {
    /// Meshed from an implicit surface.
    Sculpted(fn() -> Creature),
    /// Computed directly.
    Built(fn() -> Mesh),
}
use Origin::{Built, Sculpted};

/// Every model by the name of its file.
const MODELS: [(&str, Origin); 10] = [
    ("owl", Sculpted(owl::owl)),
    ("hare", Sculpted(hare::hare)),
    ("fish", Sculpted(fish::fish)),
    ("turtle", Sculpted(turtle::turtle)),
    ("head", Sculpted(head::head)),
    ("dragon", Sculpted(dragon::dragon)),
    ("imp", Sculpted(imp::imp)),
    ("cow", Sculpted(cow::cow)),
    ("box", Built(cube::cube)),
    ("vase", Built(vase::vase)),
];

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let names = MODELS.map(|(name, _)| name);
    let Some(folder) = args.next().map(PathBuf::from) else {
        eprintln!("usage: sculpt DIR [{} ...]", names.join("|"));
        return ExitCode::from(2);
    };
    let wanted: Vec<String> = args.collect();
    if let Some(unknown) = wanted.iter().find(|w| !names.contains(&w.as_str())) {
        eprintln!(
            "error: no model is called {unknown:?}; there are {}",
            names.join(", ")
        );
        return ExitCode::from(2);
    }
    for (name, origin) in MODELS {
        if !wanted.is_empty() && !wanted.iter().any(|w| w == name) {
            continue;
        }
        if let Err(message) = produce(name, origin, &folder) {
            eprintln!("error: {name}: {message}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Makes one model, stands it on z = 0 and writes it.
fn produce(name: &str, origin: Origin, folder: &Path) -> Result<(), String> {
    let mut mesh = match origin {
        Sculpted(creature) => sculpt(&creature(), PITCH)?,
        Built(mesh) => mesh(),
    };
    stand(&mut mesh);
    let path = folder.join(format!("{name}.ply"));
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
            out.extend(c.cast_signed().to_le_bytes());
        }
    }
    out
}
