//! Cotangents and areas. Sign convention: weights are positive for acute angles, so `sum of w (x_i - x_j)^2 / 2` is the Dirichlet
//! energy.

use crate::index::FaceId;
use crate::mesh::TriMesh;

/// Share of the mean edge added to every edge length (intrinsic mollification, Sharp & Crane 2020): keeps cotangents of
/// degenerate faces finite. 1e-6 changes no angle of a sound mesh by more than 1e-5 rad; without it one needle outweighs the mesh.
const MOLLIFY: f64 = 1e-6;

/// Cotangent of the corner angle and area of faces from mollified edge lengths.
#[derive(Clone, Debug)]
pub struct FaceGeometry {
    /// Cotangent of the angle at each corner, as the face's corners; index: face.
    pub cotangents: Vec<[f64; 3]>,
    /// Square millimetres; positive; index: face.
    pub areas: Vec<f64>,
}

impl FaceGeometry {
    pub fn new(mesh: &TriMesh) -> Self {
        let lengths: Vec<[f64; 3]> = FaceId::all(mesh.faces.len())
            .map(|f| {
                let [a, b, c] = mesh.corners(f);
                [b.distance(c), c.distance(a), a.distance(b)]
            })
            .collect();
        let mean = lengths.iter().flatten().sum::<f64>() / (3 * lengths.len()).max(1) as f64;
        let (cotangents, areas) = lengths
            .iter()
            .map(|l| face_geometry(l.map(|x| x + MOLLIFY * mean), mean))
            .unzip();
        Self { cotangents, areas }
    }

    /// Mixed Voronoi area of every vertex (Meyer et al. 2003), square millimetres; zero for unreferenced ones.
    pub fn vertex_areas(&self, mesh: &TriMesh) -> Vec<f64> {
        let mut areas = vec![0.0; mesh.vertices.len()];
        for (f, face) in mesh.faces.iter().enumerate() {
            let (cot, area) = (self.cotangents[f], self.areas[f]);
            let obtuse = (0..3).find(|k| cot[*k] < 0.0);
            for k in 0..3 {
                let share = match obtuse {
                    Some(o) if o == k => area / 2.0,
                    Some(_) => area / 4.0,
                    None => {
                        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                        // Squared length of the side opposite corner i is 2 A (cot_j + cot_k), and likewise for j.
                        area * (cot[i] * (cot[j] + cot[k]).max(0.0)
                            + cot[j] * (cot[i] + cot[k]).max(0.0))
                            / 4.0
                    }
                };
                areas[face[k]] += share;
            }
        }
        areas
    }
}

/// Cotangents and area from edge lengths opposite each corner (Heron's formula as by Kahan, stable for needles).
fn face_geometry(l: [f64; 3], mean: f64) -> ([f64; 3], f64) {
    let mut s = l;
    s.sort_by(|x, y| y.total_cmp(x));
    let [a, b, c] = s;
    let product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    let area = (product.max(0.0).sqrt() / 4.0).max(MOLLIFY * MOLLIFY * mean * mean);
    let squares = l.map(|x| x * x);
    let sum: f64 = squares.iter().sum();
    (squares.map(|x| (sum - 2.0 * x) / (4.0 * area)), area)
}
