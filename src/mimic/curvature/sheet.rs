//! What the rows of the curvature energy are made of: one-rings, areas and curvatures of a surface about its eye.
//!
//! `C` is the cotangent matrix, `A` the mixed Voronoi areas, `L = A^-1 C` the Laplacian: on a smooth surface `L v = -2 H n`
//! (Botsch et al. 2010), `H` positive where it bulges out.

use crate::index::VertexId;
use crate::laplacian::FaceGeometry;
use crate::mesh::TriMesh;
use glam::DVec3;

/// Curvatures below this share of the model's mean one cannot be told from none: divisions by curvature are by this at least.
/// At 1e-3 the faces of a box outweigh its edges a million times and the program loses digits; at 0.1 gently curved parts of the
/// creatures count as flat.
const FLAT: f64 = 0.01;

/// Coefficients of the relative depths in the row of a vertex, three coordinates at once, and its value at the depths where
/// the row was made.
pub(crate) struct Form {
    pub terms: Vec<(usize, DVec3)>,
    pub value: DVec3,
}

/// A surface as the eye's rays and its distances make it.
pub(crate) struct Sheet {
    /// Vertices from the eye, millimetres.
    rays: Vec<DVec3>,
    /// Neighbours of every vertex with their entries of `C`.
    rings: Vec<Vec<(usize, f64)>>,
    /// Square millimetres; zero for vertices without faces.
    pub areas: Vec<f64>,
    /// `C v`, millimetres.
    flow: Vec<DVec3>,
}

impl Sheet {
    pub(crate) fn new(mesh: &TriMesh, eye: DVec3) -> Self {
        let geometry = FaceGeometry::new(mesh);
        let rays: Vec<DVec3> = mesh.vertices.iter().map(|v| *v - eye).collect();
        let rings = rings(mesh, &geometry);
        let flow = rings.iter().enumerate().map(|(i, ring)| {
            let steps = ring.iter().map(|(j, c)| *c * (rays[*j] - rays[i]));
            steps.sum()
        });
        Self {
            areas: geometry.vertex_areas(mesh),
            flow: flow.collect(),
            rays,
            rings,
        }
    }

    /// Rows of Eq 9: `sum over j of c_ij v_j (s_j - s_i)`, exactly zero for `s = 1`.
    pub(crate) fn scale_invariant(&self) -> Vec<Form> {
        let form = |ring: &Vec<(usize, f64)>, i| {
            let mut terms = self.neighbours(ring);
            let sum: DVec3 = terms.iter().map(|t| t.1).sum();
            terms.push((i, -sum));
            Form {
                terms,
                value: DVec3::ZERO,
            }
        };
        self.each(form)
    }

    /// The same without the term `lambda_i / lambda0_i` of Eq 7: `sum over j of c_ij v_j s_j - (sum over j of c_ij) v_i s_i -
    /// (C v)_i`.
    pub(crate) fn absolute(&self) -> Vec<Form> {
        let form = |ring: &Vec<(usize, f64)>, i: usize| {
            let mut terms = self.neighbours(ring);
            let sum: f64 = ring.iter().map(|t| t.1).sum();
            terms.push((i, -sum * self.rays[i]));
            Form {
                terms,
                value: DVec3::ZERO,
            }
        };
        self.each(form)
    }

    /// Rows of Eq 9 with the cotangents of the surface `moved`, which this one is at relative depths `s`:
    /// `sum over j of c_ij (v_j s_j - v_i s_i) - (C0 v)_i s_i`. What is wanted stays the model's curvature over each vertex's
    /// region, `C v = -2 A H n`, which grows with the surface as lengths do: so these rows are scale invariant, too, and those of
    /// the model itself are [`Self::scale_invariant`].
    pub(crate) fn rows_on(&self, moved: &Self, s: &[f64]) -> Vec<Form> {
        let form = |ring: &Vec<(usize, f64)>, i: usize| {
            let mut terms = self.neighbours(ring);
            let sum: f64 = ring.iter().map(|t| t.1).sum();
            terms.push((i, -sum * self.rays[i] - self.flow[i]));
            Form {
                terms,
                value: moved.flow[i] - s[i] * self.flow[i],
            }
        };
        moved.each(form)
    }

    /// The curvature below which a part of this surface counts as flat, 1 / mm.
    pub(crate) fn flat(&self) -> f64 {
        let curvature = |i: usize| self.areas[i] * self.curvature(i);
        let total: f64 = self.areas.iter().sum();
        FLAT * (0..self.areas.len()).map(curvature).sum::<f64>() / total
    }

    /// `sqrt(H^2 + flat^2)` of every vertex, 1 / mm: the size of the mean curvature, never less than `flat`.
    pub(crate) fn curvatures(&self, flat: f64) -> Vec<f64> {
        (0..self.areas.len())
            .map(|i| self.curvature(i).hypot(flat))
            .collect()
    }

    /// Size of the mean curvature at a vertex, 1 / mm.
    fn curvature(&self, i: usize) -> f64 {
        if self.areas[i] > 0.0 {
            self.flow[i].length() / (2.0 * self.areas[i])
        } else {
            0.0
        }
    }

    fn neighbours(&self, ring: &[(usize, f64)]) -> Vec<(usize, DVec3)> {
        ring.iter().map(|(j, c)| (*j, *c * self.rays[*j])).collect()
    }

    fn each(&self, form: impl Fn(&Vec<(usize, f64)>, usize) -> Form) -> Vec<Form> {
        let rings = self.rings.iter().enumerate();
        rings.map(|(i, ring)| form(ring, i)).collect()
    }
}

/// Neighbours, rising, with the sum of `cot / 2` of the angles that face the edge to them.
fn rings(mesh: &TriMesh, geometry: &FaceGeometry) -> Vec<Vec<(usize, f64)>> {
    let mut sides: Vec<(VertexId, VertexId, f64)> = Vec::with_capacity(6 * mesh.faces.len());
    for (f, face) in mesh.faces.iter().enumerate() {
        for k in 0..3 {
            let (i, j, c) = (
                face[(k + 1) % 3],
                face[(k + 2) % 3],
                geometry.cotangents[f][k] / 2.0,
            );
            sides.extend([(i, j, c), (j, i, c)]);
        }
    }
    sides.sort_by_key(|s| (s.0, s.1));
    let mut rings = vec![Vec::new(); mesh.vertices.len()];
    for pair in sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let c: f64 = pair.iter().map(|s| s.2).sum();
        rings[pair[0].0].push((pair[0].1.at(), c));
    }
    rings
}
