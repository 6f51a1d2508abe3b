//! The plainest solid, for studying what a flat face and a sharp edge do: a cube of small squares, computed, not sculpted.

use crate::meshing::Mesh;
use glam::DVec3;
use std::collections::BTreeMap;

/// Squares along an edge.
const SQUARES: i32 = 16;
/// Length of an edge, mm.
const WIDTH: f64 = 40.0;

/// The cube, 6 · 16² + 2 vertices and twice as many squares' halves; all squares of a side have the same diagonal.
pub(crate) fn cube() -> Mesh {
    let mut numbers = BTreeMap::new();
    let mut mesh = Mesh {
        points: Vec::new(),
        faces: Vec::new(),
    };
    for axis in 0..3 {
        for outer in [0, SQUARES] {
            for i in 0..SQUARES {
                for j in 0..SQUARES {
                    let mut corner = |a: i32, b: i32| {
                        let mut at = [outer; 3];
                        (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (i + a, j + b);
                        *numbers.entry(at).or_insert_with(|| {
                            mesh.points.push(place(at));
                            mesh.points.len() as u32 - 1
                        })
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    // On the side at 0 the corners run clockwise, seen from outside.
                    if outer == 0 {
                        mesh.faces.extend([[a, c, b], [a, d, c]]);
                    } else {
                        mesh.faces.extend([[a, b, c], [a, c, d]]);
                    }
                }
            }
        }
    }
    mesh
}

/// Position in mm of a corner of the lattice.
fn place(at: [i32; 3]) -> DVec3 {
    DVec3::from_array(at.map(f64::from)) * (WIDTH / f64::from(SQUARES))
}
