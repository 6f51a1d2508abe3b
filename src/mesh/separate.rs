//! Draws surfaces apart that cut each other by next to nothing.
//!
//! After rounding a thin flap may lie a few micrometres through the face below it. Vertices of the flap are moved along the
//! other face's normal to the side where most of it is. Works on the neighbourhood of the trouble only.

use crate::index::{FaceId, VertexId};
use crate::mesh::boxes::Box3;
use crate::mesh::intersect::self_intersections;
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;

/// Distances that cutting faces are given, millimetres, in turn: from ten f32 steps at 100 mm to a hundredth of a printed line.
pub(super) const MARGINS_MM: [f64; 5] = [1e-4, 3e-4, 1e-3, 2e-3, 4e-3];
/// Rounds at each distance: moving one vertex may push it into the next face.
const ROUNDS: usize = 3;
/// More pairs than this are a real overlap.
const MOST: usize = 400;
/// How far around the trouble faces are looked at, millimetres.
const AROUND_MM: f64 = 0.05;

/// Separates cutting faces, given as `pairs`. Gives the index of the distance that was enough; `None` if some of them, or new ones
/// nearby, are left.
pub fn separate(mesh: &mut TriMesh, pairs: &[[FaceId; 2]]) -> Option<usize> {
    if pairs.len() > MOST {
        return None;
    }
    let mut near = Neighbourhood::new(mesh, pairs);
    for (rung, margin) in MARGINS_MM.into_iter().enumerate() {
        for _ in 0..ROUNDS {
            let pairs = self_intersections(&near.mesh, MOST + 1);
            if pairs.is_empty() {
                near.write_back(mesh);
                return Some(rung);
            }
            if pairs.len() > MOST {
                return None;
            }
            for [a, b] in pairs {
                near.push_apart(a, b, margin);
            }
        }
    }
    None
}

/// The part of a mesh around some faces.
struct Neighbourhood {
    mesh: TriMesh,
    /// Vertices in the whole mesh.
    vertices: Vec<VertexId>,
}

impl Neighbourhood {
    fn new(mesh: &TriMesh, pairs: &[[FaceId; 2]]) -> Self {
        let grown = |f: FaceId| {
            let Box3 { lo, hi } = Box3::of_face(mesh, f);
            Box3 {
                lo: lo - AROUND_MM,
                hi: hi + AROUND_MM,
            }
        };
        // Long faces have large boxes, but what matters lies where both of a pair are.
        let trouble: Vec<Box3> = pairs
            .iter()
            .map(|[a, b]| {
                let (a, b) = (grown(*a), grown(*b));
                Box3 {
                    lo: a.lo.max(b.lo),
                    hi: a.hi.min(b.hi),
                }
            })
            .collect();
        let meets = |f: &FaceId| {
            let own = Box3::of_face(mesh, *f);
            trouble.iter().any(|t| own.overlaps(t))
        };
        let faces: Vec<[VertexId; 3]> = FaceId::all(mesh.faces.len())
            .filter(meets)
            .map(|f| mesh.faces[f])
            .collect();
        let mut vertices: Vec<VertexId> = faces.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let local = |v: VertexId| VertexId::new(vertices.partition_point(|x| *x < v));
        Self {
            mesh: TriMesh {
                vertices: vertices.iter().map(|v| mesh.vertices[*v]).collect(),
                faces: faces.iter().map(|f| f.map(local)).collect(),
            },
            vertices,
        }
    }

    /// Moves the vertices of one face to one side of the other, whichever takes the smaller move.
    fn push_apart(&mut self, a: FaceId, b: FaceId, margin: f64) {
        let moves = [self.moves(a, b, margin), self.moves(b, a, margin)];
        let far =
            |m: &Vec<(VertexId, DVec3)>| m.iter().map(|(_, d)| d.length()).fold(0.0, f64::max);
        let best = moves
            .iter()
            .filter(|m| !m.is_empty() && far(m) <= 3.0 * margin)
            .min_by(|x, y| far(x).total_cmp(&far(y)));
        for (v, by) in best.into_iter().flatten() {
            let moved = self.mesh.vertices[*v] + *by;
            self.mesh.vertices[*v] = moved.as_vec3().as_dvec3();
        }
    }

    /// What moves the vertices of `face` that `floor` does not share at least `margin` to the side of the farthest of them.
    fn moves(&self, floor: FaceId, face: FaceId, margin: f64) -> Vec<(VertexId, DVec3)> {
        let normal = self.mesh.normal(floor);
        let foot = self.mesh.corners(floor)[0];
        let shared = &self.mesh.faces[floor];
        let heights: Vec<(VertexId, f64)> = self.mesh.faces[face]
            .iter()
            .filter(|v| !shared.contains(v))
            .map(|v| (*v, (self.mesh.vertices[*v] - foot).dot(normal)))
            .collect();
        let farthest = heights
            .iter()
            .map(|h| h.1)
            .max_by(|x, y| x.abs().total_cmp(&y.abs()));
        let side = farthest.unwrap_or(0.0).signum();
        heights
            .into_iter()
            .filter(|(_, h)| side * h < margin)
            .map(|(v, h)| (v, (side * margin - h) * normal))
            .collect()
    }

    fn write_back(&self, mesh: &mut TriMesh) {
        for (v, p) in self.vertices.iter().zip(&self.mesh.vertices) {
            mesh.vertices[*v] = *p;
        }
    }
}
