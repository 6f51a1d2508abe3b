//! A vase turned on a lathe, computed, not sculpted: something to be carved.

use crate::meshing::Mesh;
use glam::DVec3;
use std::f64::consts::TAU;

/// Corners of every ring.
const RINGS: u32 = 90;
/// Rings of the outside, and as many of the inside.
const ROWS: u32 = 24;
const HEIGHT: f64 = 110.0;
/// Of the wall and the bottom, mm.
const WALL: f64 = 6.0;

/// Outer radius at a height, mm: a narrow foot, a belly, a neck and a lip.
fn radius(z: f64) -> f64 {
    let t = z / HEIGHT;
    36.0 - 10.0 * (TAU * (0.95 * t + 0.22)).sin() - 3.0 * t
}

/// Outside up, inside down, as one ring after the other between two points on the axis.
pub(crate) fn vase() -> Mesh {
    let share = |k: u32| f64::from(k) / f64::from(ROWS);
    let outside = (0..=ROWS)
        .map(|k| HEIGHT * share(k))
        .map(|z| (radius(z), z));
    let inside = (0..=ROWS).rev().map(|k| WALL + (HEIGHT - WALL) * share(k));
    let profile: Vec<(f64, f64)> = outside
        .chain(inside.map(|z| (radius(z) - WALL, z)))
        .collect();
    let mut mesh = Mesh {
        points: vec![DVec3::ZERO, DVec3::new(0.0, 0.0, WALL)],
        faces: Vec::new(),
    };
    for (r, z) in &profile {
        for i in 0..RINGS {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(RINGS)).sin_cos();
            mesh.points.push(DVec3::new(r * cos, r * sin, *z));
        }
    }
    let at = |ring: u32, i: u32| 2 + ring * RINGS + i % RINGS;
    let last = profile.len() as u32 - 1;
    for i in 0..RINGS {
        mesh.faces.push([0, at(0, i + 1), at(0, i)]);
        mesh.faces.push([1, at(last, i), at(last, i + 1)]);
        for ring in 0..last {
            let [a, b] = [at(ring, i), at(ring, i + 1)];
            let [c, d] = [at(ring + 1, i + 1), at(ring + 1, i)];
            mesh.faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}
