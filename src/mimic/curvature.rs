//! The paper's curvature energy (Eq 9, weights Eq 13) in relative depths `s`, on the whole mesh.
//!
//! Row of vertex `i`: `w_i / sqrt(A_i) * sum over j of c_ij v_j (s_j - s_i)`, three coordinates, `v_j` from the eye. With
//! `s = lambda / lambda0` instead of `lambda` this is the same problem, better scaled; written in differences it is exactly
//! zero for `s = 1`. The unknowns are `s - 1` and `mu - 1` in units of a layer's typical width. Bounds are Eq 11. The gauge is a
//! mean of 1 of the area-weighted `s` over each block of components and groups that hang together: the paper pins one vertex,
//! but then the result depends on which.

use super::conditions::{Condition, plain_tangent};
use super::lazily::{MARGIN, Meaning, solve_lazily};
use super::program::{Program, Quadratic, Row, gathered};
use super::{
    CurvatureOptions, Depths, SolveError, Solved, scales, seen_solid_angles, typical_width,
};
use crate::geom::solid_angle;
use crate::groups::Groups;
use crate::laplacian::FaceGeometry;
use crate::mesh::DisjointSets;
use crate::viewmap::{Target, ViewMap};
use glam::DVec3;

/// Weight of `(mu - 1)^2` relative to the mean diagonal (the paper's alpha, about 1 instead of 0): 1e-12 to 1e-7 give the same
/// surface.
const ALPHA: f64 = 1e-9;

/// Depths of the whole mesh under `conditions`, of which the first `rows` are rows from the start and the others only where
/// a solution breaks them.
pub fn depths(
    options: CurvatureOptions,
    target: &Target,
    map: &ViewMap,
    groups: &Groups,
    conditions: &[Condition],
    rows: usize,
) -> Result<Depths, SolveError> {
    let unit = typical_width(groups);
    let n = target.mesh.vertices.len();
    let geometry = FaceGeometry::new(&target.mesh);
    let areas = geometry.vertex_areas(&target.mesh);
    let used: Vec<bool> = areas.iter().map(|a| *a > 0.0).collect();
    let mut quadratic = Quadratic::new(n + groups.groups.len());
    let visible = visible_vertices(target, map);
    let forms = vertex_forms(target, &geometry, map.plane.eye);
    let weight = |i: usize| {
        let hidden = if visible[i] {
            1.0
        } else {
            options.hidden_weight * options.hidden_weight
        };
        hidden * target.weight(i as u32).powi(2) / areas[i]
    };
    // Twice the square of a form adds its squared coefficients to the diagonal: the mean scales the program to order one.
    let trace: f64 = (0..n)
        .filter(|i| used[*i])
        .map(|i| 2.0 * weight(i) * forms[i].iter().map(|t| t.1.length_squared()).sum::<f64>())
        .sum();
    let mean = trace / n as f64;
    for i in (0..n).filter(|i| used[*i]) {
        for axis in 0..3 {
            let terms: Vec<(usize, f64)> = forms[i].iter().map(|(j, v)| (*j, v[axis])).collect();
            quadratic.form(&terms, weight(i) / mean);
        }
    }
    (0..groups.groups.len()).for_each(|g| quadratic.square(n + g, ALPHA));
    (0..n)
        .filter(|i| !used[*i])
        .for_each(|i| quadratic.square(i, 1.0));
    let tangent = |c: &Condition, s: &[f64]| row(&c.tightened(MARGIN * unit), s, n, unit);
    let start = vec![1.0; n];
    let mut program = Program {
        variables: n + groups.groups.len(),
        linear: vec![0.0; n + groups.groups.len()],
        quadratic: quadratic.finish(),
        equalities: gauge(target, groups, conditions, &areas),
        rows: conditions[..rows]
            .iter()
            .filter_map(|c| tangent(c, &start))
            .collect(),
    };
    let depths = |u: &[f64]| {
        let depth = |i: usize| if used[i] { 1.0 + unit * u[i] } else { 1.0 };
        let mu = (0..groups.groups.len()).map(|g| 1.0 + unit * u[n + g]);
        ((0..n).map(depth).collect(), mu.collect())
    };
    let meaning = Meaning {
        depths: &depths,
        tangent: &tangent,
    };
    let (u, solved) = solve_lazily(&mut program, conditions, &meaning)?;
    let (s, _) = depths(&u);
    let mu = scales(groups, &[], &s, |_| 1.0);
    let solved = Solved {
        gauge: "the area-weighted mean relative depth is 1",
        ..solved
    };
    Ok(Depths { s, mu, solved })
}

/// Vertices of whose faces turned to the eye at least half is seen, by solid angle. A share rather than the vertex itself,
/// which on a silhouette is seen or not by rounding alone: two such flips changed relative depths by 7e-3 on a small ball.
fn visible_vertices(target: &Target, map: &ViewMap) -> Vec<bool> {
    let seen = seen_solid_angles(target, map);
    let mut shares = vec![(0.0, 0.0); target.mesh.vertices.len()];
    for (f, face) in target.mesh.faces.iter().enumerate() {
        let [a, b, c] = target.mesh.corners(f).map(|p| p - map.plane.eye);
        let whole = solid_angle(a, b, c);
        if whole > 0.0 || seen[f] > 0.0 {
            for v in face {
                shares[*v as usize].0 += seen[f];
                shares[*v as usize].1 += whole.abs();
            }
        }
    }
    shares
        .iter()
        .map(|(seen, whole)| *whole > 0.0 && *seen >= 0.5 * whole)
        .collect()
}

/// For every vertex the coefficients (vectors) of `sum of c_ij v_j (s_j - s_i)`: neighbours first, itself last.
fn vertex_forms(target: &Target, geometry: &FaceGeometry, eye: DVec3) -> Vec<Vec<(usize, DVec3)>> {
    let mesh = &target.mesh;
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
    let mut forms: Vec<Vec<(usize, DVec3)>> = vec![Vec::new(); mesh.vertices.len()];
    for pair in sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let (i, j) = (pair[0].0 as usize, pair[0].1 as usize);
        let c: f64 = pair.iter().map(|s| s.2).sum();
        forms[i].push((j, c * (mesh.vertices[j] - eye)));
    }
    for (i, form) in forms.iter_mut().enumerate() {
        let sum: DVec3 = form.iter().map(|t| t.1).sum();
        form.push((i, -sum));
    }
    forms
}

/// One equality a block: the area-weighted mean of `s` is 1.
fn gauge(
    target: &Target,
    groups: &Groups,
    conditions: &[Condition],
    areas: &[f64],
) -> Vec<(Vec<(usize, f64)>, f64)> {
    let n = areas.len();
    let mut blocks = DisjointSets::new(n + groups.groups.len());
    for face in &target.mesh.faces {
        blocks.join(face[0], face[1]);
        blocks.join(face[1], face[2]);
    }
    for bound in &groups.bounds {
        blocks.join(bound.anchor.vertices[0], n as u32 + bound.group);
    }
    let sides = |c: &Condition| Some([c.plus?, c.minus?].map(|s| s.anchor.vertices[0]));
    for [front, back] in conditions.iter().filter_map(sides) {
        blocks.join(front, back);
    }
    let mut members: Vec<(u32, usize)> = (0..n)
        .filter(|i| areas[*i] > 0.0)
        .map(|i| (blocks.root(i as u32), i))
        .collect();
    members.sort_unstable();
    let block = |b: &[(u32, usize)]| {
        let total: f64 = b.iter().map(|m| areas[m.1]).sum();
        (b.iter().map(|m| (m.1, areas[m.1] / total)).collect(), 0.0)
    };
    members.chunk_by(|x, y| x.0 == y.0).map(block).collect()
}

/// The row that touches a condition at the depths `s`; bounds (Eq 11) and orders within groups (Eq 12). An order between
/// groups has no row: `tau / mu` is not convex there.
fn row(condition: &Condition, s: &[f64], n: usize, unit: f64) -> Option<Row> {
    let mut terms = Vec::with_capacity(7);
    let factor = match (condition.plus, condition.minus) {
        (Some(_), Some(_)) if condition.between_groups().is_some() => return None,
        (Some(_), Some(_)) => (-condition.limit).exp(),
        _ => 1.0,
    };
    if let Some(side) = condition.plus {
        let tangent = plain_tangent(&side.anchor, s);
        terms.extend(tangent.iter().map(|(v, g)| (*v, factor * g)));
        if condition.minus.is_none() {
            terms.push((n + side.group as usize, -condition.limit.exp()));
        }
    }
    if let Some(side) = condition.minus {
        let tangent = plain_tangent(&side.anchor, s);
        terms.extend(tangent.iter().map(|(v, g)| (*v, -g)));
        if condition.plus.is_none() {
            terms.push((n + side.group as usize, (-condition.limit).exp()));
        }
    }
    // In s and mu all rows are homogeneous; the unknowns are what these differ from 1, in units.
    let sum: f64 = terms.iter().map(|t| t.1).sum();
    Some(Row {
        kind: condition.kind,
        terms: gathered(terms),
        limit: -sum / unit,
    })
}
