//! The normal energy in log depth, on the visible sub-mesh.
//!
//! Scaling a face's vertices along their rays by `s = e^x` turns its normal by `theta` with `tan theta = h |grad x|` to first
//! order, `h` the distance of the face's plane from the eye: the plane `q.p = 1` has `q.v_i = 1/s_i`, the tangential part of
//! `q` is the surface gradient of `1/s`, its normal part `1/(h s)`. So `E(x) = sum of a_f h_f^2 |grad_f x|^2` measures what the
//! paper's Eq 2 asks for, as one weighted cotangent matrix. Bounds are linear in `x - m`, groups additive.

use super::ordering::Order;
use super::program::{Program, Quadratic, Row, RowKind, mean_diagonal};
use super::{Depths, FaceWeight, NormalOptions, SolveError, scales, seen_solid_angles, solve};
use crate::groups::{Anchor, Groups};
use crate::laplacian::FaceGeometry;
use crate::viewmap::{Target, ViewMap};

/// A face seen as a sliver counts at least this share of its whole solid angle: below it the matrix loses digits.
const LEAST_SEEN: f64 = 0.02;
/// Pulls free offsets (a component, a group with room) to the model's depth, relative to the mean diagonal. From 1e-9 to 1e-7
/// nothing moves by a micrometre; at 1e-5 long waves shrink visibly.
const REGULARISER: f64 = 1e-8;

/// Depths of the visible sub-mesh.
pub fn depths(
    options: NormalOptions,
    target: &Target,
    map: &ViewMap,
    groups: &Groups,
    orders: &[Order],
) -> Result<Depths, SolveError> {
    let seen = seen_solid_angles(target, map);
    let index = Variables::new(target, &seen);
    let unit = typical_width(groups);
    let mut quadratic = Quadratic::new(index.count + groups.groups.len());
    add_faces(&mut quadratic, options.weight, target, map, &seen, &index);
    let energy = quadratic.finish();
    let mean = mean_diagonal(&energy, index.count);
    let program = Program {
        variables: index.count + groups.groups.len(),
        quadratic: regularised(energy, mean),
        equalities: Vec::new(),
        rows: rows(groups, orders, &index, unit),
    };
    let (u, solved) = solve(&program)?;
    let s: Vec<f64> = index
        .of_vertex
        .iter()
        .map(|i| i.map_or(1.0, |i| (u[i as usize] * unit).exp()))
        .collect();
    Ok(Depths {
        mu: scales(groups, &s),
        s,
        solved,
    })
}

/// Where each vertex's `x` stands among the unknowns; vertices of unseen faces have none.
struct Variables {
    of_vertex: Vec<Option<u32>>,
    count: usize,
}

impl Variables {
    fn new(target: &Target, seen: &[f64]) -> Self {
        let mut of_vertex = vec![None; target.mesh.vertices.len()];
        let mut count = 0;
        for (face, _) in target
            .mesh
            .faces
            .iter()
            .zip(seen)
            .filter(|(_, s)| **s > 0.0)
        {
            for v in face {
                of_vertex[*v as usize].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                });
            }
        }
        Self {
            of_vertex,
            count: count as usize,
        }
    }

    /// Terms of `factor * sum of weight * x` over the anchor's vertices.
    fn terms(&self, anchor: &Anchor, factor: f64) -> Vec<(usize, f64)> {
        anchor
            .terms()
            .filter_map(|(v, w)| Some((self.of_vertex[v]? as usize, factor * w)))
            .collect()
    }
}

/// The median width of the bounds in log depth: the unit of all unknowns, so that the solver's tolerances mean the same in
/// every scene.
fn typical_width(groups: &Groups) -> f64 {
    let mut widths: Vec<f64> = groups
        .bounds
        .iter()
        .map(|b| (b.upper / b.lower).ln())
        .collect();
    widths.sort_by(f64::total_cmp);
    widths
        .get(widths.len() / 2)
        .copied()
        .filter(|w| *w > 0.0)
        .unwrap_or(1.0)
}

fn add_faces(
    quadratic: &mut Quadratic,
    weight: FaceWeight,
    target: &Target,
    map: &ViewMap,
    seen: &[f64],
    index: &Variables,
) {
    let geometry = FaceGeometry::new(&target.mesh);
    let eye = map.plane.eye;
    for (f, face) in target
        .mesh
        .faces
        .iter()
        .enumerate()
        .filter(|(f, _)| seen[*f] > 0.0)
    {
        let [a, b, c] = target.mesh.corners(f).map(|p| p - eye);
        let h = target.mesh.normal(f).dot(a).abs();
        let density = match weight {
            FaceWeight::Area => 1.0,
            FaceWeight::SolidAngle => {
                let whole = crate::geom::solid_angle(a, b, c).abs();
                seen[f].max(LEAST_SEEN * whole) / geometry.areas[f]
            }
        };
        for k in 0..3 {
            let ends = [face[(k + 1) % 3], face[(k + 2) % 3]]
                .map(|v| index.of_vertex[v as usize].expect("corners of seen faces take part"));
            quadratic.difference(
                ends[0] as usize,
                ends[1] as usize,
                density * h * h * geometry.cotangents[f][k] / 2.0,
            );
        }
    }
}

/// Scaled to a mean diagonal of 1, with the regulariser on every unknown.
fn regularised(energy: sprs::CsMat<f64>, mean: f64) -> sprs::CsMat<f64> {
    let mut triplets = sprs::TriMat::new((energy.rows(), energy.cols()));
    energy
        .iter()
        .for_each(|(v, (i, j))| triplets.add_triplet(i, j, v / mean));
    (0..energy.rows()).for_each(|i| triplets.add_triplet(i, i, REGULARISER));
    triplets.to_csc()
}

fn rows(groups: &Groups, orders: &[Order], index: &Variables, unit: f64) -> Vec<Row> {
    let m = |g: u32| index.count + g as usize;
    let mut rows = Vec::with_capacity(2 * groups.bounds.len() + orders.len());
    for (i, bound) in groups.bounds.iter().enumerate() {
        let mut far = index.terms(&bound.anchor, 1.0);
        far.push((m(bound.group), -1.0));
        let near = far.iter().map(|(j, v)| (*j, -v)).collect();
        rows.push(Row {
            kind: RowKind::Far(i as u32),
            terms: far,
            limit: bound.upper.ln() / unit,
        });
        rows.push(Row {
            kind: RowKind::Near(i as u32),
            terms: near,
            limit: -bound.lower.ln() / unit,
        });
    }
    for (i, order) in orders.iter().enumerate() {
        let mut terms = index.terms(&order.front, 1.0);
        terms.extend(index.terms(&order.back, -1.0));
        if order.front_group != order.back_group {
            terms.extend([(m(order.front_group), -1.0), (m(order.back_group), 1.0)]);
        }
        rows.push(Row {
            kind: RowKind::Order(i as u32),
            terms,
            limit: -order.ratio.ln() / unit,
        });
    }
    rows
}
