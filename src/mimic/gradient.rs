//! Relief by compressed gradients, after Weyrich, Deng, Barnes, Rusinkiewicz & Finkelstein, *Digital Bas-Relief from 3D Scenes*
//! (SIGGRAPH 2007), on the triangles of the model, as the paper's Fig 11 compares itself with it.
//!
//! The height field is the depth `z` over the eye's image, its slope at an image point `q` the gradient of `ln z`: a step `dz` on a
//! width of
//! `z dq`. Slopes `g` are attenuated to `C(g) = log(1 + alpha g) / alpha` and keep their direction; slopes of silhouettes become 0, and
//! so do jumps of depth, across which the parts are joined. The field with these slopes in the sense of least squares (Poisson's
//! equation) is then compressed linearly into the layer (`compress`).
//!
//! What deviates: a finite element for every seen face in place of pixels; all bounds hold exactly, where the original scales to a
//! wanted height; without its optional sharpening and its treatment of several frequencies, as in Fig 11. The unknown is the
//! *change* of `ln z`, which is 0 for `alpha = 0` without silhouettes, so that the result is the linear compression itself. Of an
//! eye at infinity it is `focal ln z`, whose gradient is the slope there.

use super::compress::compressed;
use super::depths::{Depths, seen_solid_angles};
use super::energy::GradientOptions;
use super::program::{Program, Quadratic};
use super::solve::SolveError;
use super::solving::solve;
use crate::groups::anchor;
use crate::index::{FaceId, VertexId};
use crate::laplacian::FaceGeometry;
use crate::mesh::TriMesh;
use crate::sight::Sight;
use crate::viewmap::{Image, Target, ViewMap};
use glam::DVec2;

const NOT_AN_OPTIMUM: &str = "compressed gradients, integrated and scaled into the layer (Weyrich et al. 2007): not an optimum within the bounds";
/// Slopes from this on are silhouettes: faces seen at less than 10 degrees. Their image is so thin that nothing of them is
/// recognised, and at the rim of a ball slopes grow without bound.
const SILHOUETTE: f64 = 5.67;
/// Depths of neighbouring sheets jump if they differ by more than this share: twice what merging thin cells moves them by.
const JUMP: f64 = 2e-4;
/// Weight of differences along edges of unseen faces, and of the change itself, relative to the mean diagonal: they only carry the
/// field on to vertices nobody sees.
const UNSEEN: f64 = 1e-6;
const REGULARISER: f64 = 1e-9;

/// Depths of the compressed gradients.
///
/// # Errors
/// If no surface lies within all bounds.
pub(crate) fn depths(options: GradientOptions, sight: &Sight) -> Result<Depths, SolveError> {
    let change = WantedChange::new(options.compression, &sight.image).integrated()?;
    let focal = sight.image.map.plane.focal;
    let shape: Vec<f64> = change.iter().map(|x| (x / focal).exp()).collect();
    compressed(&shape, sight, NOT_AN_OPTIMUM)
}

/// `log(1 + alpha g) / alpha`.
fn attenuated(slope: f64, alpha: f64) -> f64 {
    if alpha > 0.0 {
        (alpha * slope).ln_1p() / alpha
    } else {
        slope
    }
}

/// The change of `ln z` that is wanted: along the sides of faces, and across jumps.
struct WantedChange {
    vertices: usize,
    /// Sides of seen faces: `weight * (x_i - x_j - step)^2`.
    sides: Vec<FaceSide>,
    jumps: Vec<Jump>,
    /// Edges of unseen faces.
    unseen: Vec<[VertexId; 2]>,
}

/// A point where sheets meet: `weight * (sum of coefficient * x - step)^2`.
struct Jump {
    terms: Vec<(usize, f64)>,
    weight: f64,
    step: f64,
}

struct FaceSide {
    ends: [VertexId; 2],
    weight: f64,
    step: f64,
}

impl WantedChange {
    fn new(alpha: f64, image: &Image) -> Self {
        let Image { target, map, .. } = image;
        let solid = seen_solid_angles(image);
        let (seen, unseen): (Vec<FaceId>, Vec<FaceId>) =
            FaceId::all(solid.len()).partition(|f| solid[*f] > 0.0);
        let flat = TriMesh {
            vertices: target.image.iter().map(|q| q.extend(0.0)).collect(),
            faces: seen.iter().map(|f| target.mesh.faces[*f]).collect(),
        };
        let geometry = FaceGeometry::new(&flat);
        let mut sides = Vec::with_capacity(3 * seen.len());
        for (n, f) in seen.iter().enumerate() {
            let change = wanted_change(target, map.plane.focal, *f, alpha);
            let (face, q) = (target.mesh.faces[*f], target.image_of(*f));
            sides.extend((0..3).map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                FaceSide {
                    ends: [face[i], face[j]],
                    // The integral of a squared gradient is the sum of `cot / 2` times squared differences.
                    weight: geometry.cotangents[n][k] / 2.0,
                    step: change.dot(q[i] - q[j]),
                }
            }));
        }
        let lengths: f64 = flat.faces.iter().map(|f| perimeter(target, *f)).sum();
        let edge = lengths / (3 * seen.len()).max(1) as f64;
        let edges = |f: &FaceId| {
            let face = target.mesh.faces[*f];
            [0, 1, 2].map(|k| [face[k], face[(k + 1) % 3]])
        };
        Self {
            vertices: target.mesh.vertices.len(),
            sides,
            jumps: jumps(target, map, edge),
            unseen: unseen.iter().flat_map(edges).collect(),
        }
    }

    /// The change of `ln z` of every vertex.
    fn integrated(&self) -> Result<Vec<f64>, SolveError> {
        let mut quadratic = Quadratic::new(self.vertices);
        let mut linear = vec![0.0; self.vertices];
        let total: f64 = self.sides.iter().map(|s| 4.0 * s.weight).sum();
        let mean = total / self.vertices as f64;
        for FaceSide {
            ends: [i, j],
            weight,
            step,
        } in &self.sides
        {
            let weight = weight / mean;
            quadratic.difference(i.at(), j.at(), weight);
            linear[*i] -= 2.0 * weight * step;
            linear[*j] += 2.0 * weight * step;
        }
        for Jump {
            terms,
            weight,
            step,
        } in &self.jumps
        {
            let weight = weight / mean;
            quadratic.form(terms, weight);
            terms
                .iter()
                .for_each(|(i, a)| linear[*i] -= 2.0 * weight * step * a);
        }
        self.unseen
            .iter()
            .for_each(|[i, j]| quadratic.difference(i.at(), j.at(), UNSEEN));
        (0..self.vertices).for_each(|i| quadratic.square(i, REGULARISER));
        let program = Program {
            variables: self.vertices,
            quadratic: quadratic.finish(),
            factor: Vec::new(),
            linear,
            equalities: Vec::new(),
            rows: Vec::new(),
        };
        Ok(solve(&program)?.u)
    }
}

fn perimeter(target: &Target, face: [VertexId; 3]) -> f64 {
    let q = face.map(|v| target.image[v]);
    (0..3).map(|k| q[k].distance(q[(k + 1) % 3])).sum()
}

/// How much the gradient of `ln z` in the image is to change on a face.
fn wanted_change(target: &Target, focal: f64, face: FaceId, alpha: f64) -> DVec2 {
    let q = target.image_of(face);
    let x = target.mesh.faces[face].map(|v| focal * target.depth[v].ln());
    let (a, b) = (q[1] - q[0], q[2] - q[0]);
    let (dx, dy) = (x[1] - x[0], x[2] - x[0]);
    let gradient = (dx * -b.perp() + dy * a.perp()) / a.perp_dot(b);
    let slope = gradient.length();
    if slope == 0.0 {
        return DVec2::ZERO;
    }
    // On a face without image not even the slope is known: nothing of it is seen either.
    if !slope.is_finite() {
        return DVec2::ZERO;
    }
    if slope > SILHOUETTE {
        return -gradient;
    }
    (attenuated(slope, alpha) / slope - 1.0) * gradient
}

/// Both ends of all sides of cells at which the depth of the model jumps; a side counts as much as a row of pixels of the size `edge`.
fn jumps(target: &Target, map: &ViewMap, edge: f64) -> Vec<Jump> {
    let mut jumps = Vec::new();
    for (c, cell) in map.all() {
        for (k, n) in map.neighbours[c].iter().enumerate() {
            let Some(n) = n.filter(|n| *n > c) else {
                continue;
            };
            let (Some(f), Some(g)) = (cell.face, map.cells[n].face) else {
                continue;
            };
            if f == g {
                continue;
            }
            let ends = [k, (k + 1) % 3].map(|e| map.points[cell.corners[e]]);
            let weight = ends[0].distance(ends[1]) / edge / 2.0;
            for q in ends {
                let [(a, za), (b, zb)] = [f, g].map(|f| anchor(target, f, q));
                let step = map.plane.focal * (zb / za).ln();
                if step.abs() > JUMP {
                    let near = a.terms().map(|(v, w)| (v.at(), w));
                    let far = b.terms().map(|(v, w)| (v.at(), -w));
                    jumps.push(Jump {
                        terms: near.chain(far).collect(),
                        weight,
                        step,
                    });
                }
            }
        }
    }
    jumps
}
