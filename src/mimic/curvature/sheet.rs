//! What the rows of the curvature energy are made of: one-rings, areas, curvatures and normals of a surface about its eye.
//!
//! `C` is the cotangent matrix, `A` the mixed Voronoi areas, `L = A^-1 C` the Laplacian: on a smooth surface `L v = -2 H n`
//! (Botsch et al. 2010), `H` positive where it bulges out.

use crate::laplacian::FaceGeometry;
use crate::mesh::TriMesh;
use glam::DVec3;

/// Curvatures below this share of the model's mean one cannot be told from none: the normal of a vertex is then that of its
/// faces, and divisions by curvature are by this at least. At 1e-3 the faces of a box outweigh its edges a million times and
/// the program loses digits; at 0.1 gently curved parts of the creatures count as flat.
const FLAT: f64 = 0.01;

/// Coefficients of the relative depths in the row of a vertex, three coordinates at once, and its value at the depths where
/// the row was made.
pub struct Form {
    pub terms: Vec<(usize, DVec3)>,
    pub value: DVec3,
}

/// A surface as the eye's rays and its distances make it.
pub struct Sheet {
    /// Vertices from the eye, millimetres.
    rays: Vec<DVec3>,
    /// Neighbours of every vertex with their entries of `C`.
    rings: Vec<Vec<(usize, f64)>>,
    /// Square millimetres; zero for vertices without faces.
    pub areas: Vec<f64>,
    /// `C v`, millimetres.
    flow: Vec<DVec3>,
    /// Of the faces around each vertex by their areas; unit length.
    normals: Vec<DVec3>,
}

impl Sheet {
    pub fn new(mesh: &TriMesh, eye: DVec3) -> Self {
        let geometry = FaceGeometry::new(mesh);
        let rays: Vec<DVec3> = mesh.vertices.iter().map(|v| *v - eye).collect();
        let rings = rings(mesh, &geometry);
        let flow = rings.iter().enumerate().map(|(i, ring)| {
            let steps = ring.iter().map(|(j, c)| *c * (rays[*j] - rays[i]));
            steps.sum()
        });
        let mut normals = vec![DVec3::ZERO; rays.len()];
        for (f, face) in mesh.faces.iter().enumerate() {
            let area = mesh.area_vector(f);
            face.iter().for_each(|v| normals[*v as usize] += area);
        }
        Self {
            areas: geometry.vertex_areas(mesh),
            flow: flow.collect(),
            normals: normals.iter().map(|n| n.normalize_or_zero()).collect(),
            rays,
            rings,
        }
    }

    /// Rows of Eq 9: `sum over j of c_ij v_j (s_j - s_i)`, exactly zero for `s = 1`.
    pub fn scale_invariant(&self) -> Vec<Form> {
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
    pub fn absolute(&self) -> Vec<Form> {
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

    /// Rows about this surface, at relative depths `s`, that want the normals `wanted`: those of Eq 9 with this surface as
    /// reference, where the wanted vector is the present one turned as `n -> n + (wanted across n)`. Its part along `n` stays, or
    /// else the curvature would shrink from step to step wherever the normal cannot be reached.
    pub fn turned(&self, s: &[f64], wanted: &[DVec3], flat: f64) -> Vec<Form> {
        let normals = self.curvature_normals(flat);
        let form = |ring: &Vec<(usize, f64)>, i: usize| {
            let missing = self.signed_flow(i) * wanted[i].reject_from(normals[i]);
            let missing = if missing.is_finite() {
                missing
            } else {
                DVec3::ZERO
            };
            let mut terms = self.neighbours(ring);
            let sum: DVec3 = terms.iter().map(|t| t.1).sum();
            terms.push((i, -sum - missing));
            terms.iter_mut().for_each(|(j, v)| *v /= s[*j]);
            Form {
                terms,
                value: -missing,
            }
        };
        self.each(form)
    }

    /// The curvature below which a part of this surface counts as flat, 1 / mm.
    pub fn flat(&self) -> f64 {
        let curvature = |i: usize| self.areas[i] * self.curvature(i);
        let total: f64 = self.areas.iter().sum();
        FLAT * (0..self.areas.len()).map(curvature).sum::<f64>() / total
    }

    /// `sqrt(H^2 + flat^2)` of every vertex, 1 / mm: the size of the mean curvature, never less than `flat`.
    pub fn curvatures(&self, flat: f64) -> Vec<f64> {
        (0..self.areas.len())
            .map(|i| self.curvature(i).hypot(flat))
            .collect()
    }

    /// The normals `L v / (-2 H)` of all vertices; where the surface is flat, those of the faces.
    pub fn curvature_normals(&self, flat: f64) -> Vec<DVec3> {
        let normal = |i: usize| {
            let outwards = if self.signed_flow(i) < 0.0 { -1.0 } else { 1.0 };
            let curved = outwards * self.flow[i] / (2.0 * self.areas[i]);
            let mixed = curved + flat * self.normals[i];
            mixed.try_normalize().unwrap_or(self.normals[i])
        };
        (0..self.areas.len()).map(normal).collect()
    }

    /// Size of the mean curvature at a vertex, 1 / mm.
    fn curvature(&self, i: usize) -> f64 {
        if self.areas[i] > 0.0 {
            self.flow[i].length() / (2.0 * self.areas[i])
        } else {
            0.0
        }
    }

    /// Length of `C v` at a vertex, negative where the surface bulges out: `C v` is this times the normal.
    fn signed_flow(&self, i: usize) -> f64 {
        let length = self.flow[i].length();
        if self.flow[i].dot(self.normals[i]) < 0.0 {
            -length
        } else {
            length
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
    let mut sides: Vec<(u32, u32, f64)> = Vec::with_capacity(6 * mesh.faces.len());
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
        rings[pair[0].0 as usize].push((pair[0].1 as usize, c));
    }
    rings
}
