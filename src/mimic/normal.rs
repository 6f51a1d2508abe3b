//! The normal energy in log depth, on the visible sub-mesh, or on all of a mesh that is deformed as a whole.
//!
//! Scaling a face's vertices along their rays by `s = e^x` turns its normal by `theta` with `tan theta = h |grad x|` to first
//! order, `h` the distance of the face's plane from the eye: the plane `q.p = 1` has `q.v_i = 1/s_i`, the tangential part of
//! `q` is the surface gradient of `1/s`, its normal part `1/(h s)`. So `E(x) = sum of a_f h_f^2 |grad_f x|^2` measures what the
//! paper's Eq 2 asks for, as one weighted cotangent matrix. Bounds are linear in `x - m`, groups additive.

use super::conditions::{self, Condition, OnGroup, log_tangent};
use super::depths::{Depths, scales, seen_solid_angles, typical_width};
use super::energy::{FaceWeight, NormalOptions};
use super::keeping::{Keeping, TakingPart};
use super::lazily::{DepthsAndScales, MARGIN, Meaning, solve_lazily};
use super::opening::{Opening, Tie};
use super::program::{Program, Quadratic, Row, RowKind, gathered, mean_diagonal};
use super::solve::{Method, SolveError, Solved};
use crate::index::{FaceId, GroupId, VertexId};
use crate::laplacian::FaceGeometry;
use crate::sight::Sight;
use crate::viewmap::{Image, Target};

/// A face seen as a sliver counts at least this share of its whole solid angle: below it the matrix loses digits.
const LEAST_SEEN: f64 = 0.02;
/// Pulls free offsets (a component, a group with room) to the model's depth, relative to the mean diagonal. From 1e-9 to 1e-7
/// nothing moves by a micrometre; at 1e-5 long waves shrink visibly.
const REGULARISER: f64 = 1e-8;

/// Faces turned by less than this (tangent, 0.06 degrees) count as turned by it in reweighting: below, weights of right
/// faces grow until the matrix loses digits.
const LEAST_TURN: f64 = 1e-3;

/// Weight `w` of hidden faces, where they take part, as of the paper's Fig 9: enough to keep their shape where nothing holds them.
const HIDDEN: f64 = 0.1;

/// Weight of a tie relative to the mean diagonal: what is left of a gap is far below anything printed. As rows ties might
/// contradict bounds.
const TIE: f64 = 10.0;

/// Depths of the faces that take part, and the last program with all the rows that it came to.
pub(crate) fn depths(
    options: NormalOptions,
    sight: &Sight,
    keeping: &Keeping,
    opening: Option<&Opening>,
) -> Result<(Depths, Program), SolveError> {
    let Sight { image, groups, .. } = sight;
    let (target, map) = (&image.target, &image.map);
    let conditions = &conditions::all(groups, keeping);
    let seen = seen_solid_angles(image);
    let taking_part = taking_part(keeping.faces, &seen);
    let index = Variables::new(target, &taking_part);
    let unit = typical_width(groups, keeping.least_unit);
    let scaled = opening.is_none();
    let variables = index.count + if scaled { groups.groups.len() } else { 0 };
    let faces = Faces::new(options.weight, image, &seen, &taking_part, opening);
    // In log depth scales are linear: rows are the same wherever these touch.
    let tangent = |c: &Condition, (s, _): &DepthsAndScales| {
        let harder = c.tightened(MARGIN * unit);
        index.tangent(&harder, s, unit, scaled)
    };
    let start = (index.start(opening), vec![1.0; groups.groups.len()]);
    let mut first: Vec<Row> = conditions.all[..conditions.rows]
        .iter()
        .filter_map(|c| tangent(c, &start))
        .collect();
    first.extend(opening.iter().flat_map(|o| step_rows(o, &index, unit)));
    let mut program = Program {
        variables,
        linear: linear(opening, &index, unit, variables),
        quadratic: faces.energy(&index, variables, opening, &|_| 1.0),
        factor: Vec::new(),
        equalities: Vec::new(),
        rows: first,
    };
    // While conditions are checked the scales are the program's own: the closed form follows the worst bound, and then all others
    // seem broken.
    let depths = |u: &[f64]| {
        let own = |g: GroupId| (u[index.scale(g)] * unit).exp();
        let scale = |g: GroupId| if scaled { own(g) } else { 1.0 };
        let mu: Vec<f64> = GroupId::all(groups.groups.len()).map(scale).collect();
        (index.relative_depths(u, unit), mu)
    };
    let meaning = Meaning {
        depths: &depths,
        tangent: &tangent,
        focal: map.plane.focal,
    };
    let method = match opening {
        Some(_) => Method::DualWorkingSet,
        None => Method::WarmInterior,
    };
    let (mut u, mut solved) = solve_lazily(&mut program, conditions, &meaning, method)?;
    for _ in 0..options.reweight {
        let turned = |f: usize| faces.turned(f, &index, |i| u[i] * unit);
        program.quadratic = faces.energy(&index, variables, opening, &|f| reweighted(turned(f)));
        (u, solved) = solve_lazily(&mut program, conditions, &meaning, method)?;
    }
    let (s, free) = depths(&u);
    let mu = match scaled {
        true => scales(groups, &conditions.all, &s, |g| free[g]),
        false => free,
    };
    let gauge = match opening {
        None => "free offsets are pulled to the model's depth",
        Some(_) => "every piece is pulled to where its tears were found",
    };
    let depths = Depths {
        s,
        mu,
        solved: Solved { gauge, ..solved },
        iterated: None,
    };
    Ok((depths, program))
}

/// Which faces count.
fn taking_part(faces: TakingPart, seen: &[f64]) -> Vec<bool> {
    let takes_part = |seen: &f64| match faces {
        TakingPart::Seen => *seen > 0.0,
        TakingPart::All => true,
    };
    seen.iter().map(takes_part).collect()
}

/// The regulariser's pull to where the surface starts, and the forces on it.
fn linear(opening: Option<&Opening>, index: &Variables, unit: f64, variables: usize) -> Vec<f64> {
    let mut linear = vec![0.0; variables];
    if let Some(opening) = opening {
        for (v, i) in VertexId::all(index.of_vertex.len()).zip(&index.of_vertex) {
            if let Some(i) = i {
                linear[*i] = -REGULARISER * opening.start[v] / unit - opening.push[v];
            }
        }
    }
    linear
}

/// Where each vertex's `x` stands among the unknowns; vertices of faces that take no part have none.
struct Variables {
    of_vertex: Vec<Option<usize>>,
    count: usize,
}

impl Variables {
    fn new(target: &Target, taking_part: &[bool]) -> Self {
        let mut of_vertex = vec![None; target.mesh.vertices.len()];
        let mut count = 0;
        let faces = target.mesh.faces.iter().zip(taking_part);
        for (face, _) in faces.filter(|(_, takes_part)| **takes_part) {
            for v in face {
                of_vertex[*v].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                });
            }
        }
        Self { of_vertex, count }
    }

    /// The variable of a vertex of a face that takes part.
    fn at(&self, vertex: VertexId) -> usize {
        self.of_vertex[vertex].expect("corners of such faces take part")
    }

    /// The variables of a tie.
    fn tied(&self, tie: &Tie) -> Vec<(usize, f64)> {
        let term = |(v, w): &(VertexId, f64)| Some((self.of_vertex[*v]?, *w));
        tie.iter().filter_map(term).collect()
    }

    /// The variable of a group's scale.
    fn scale(&self, group: GroupId) -> usize {
        self.count + group.at()
    }

    /// Relative depths of all vertices near the result: where rows first touch their conditions.
    fn start(&self, opening: Option<&Opening>) -> Vec<f64> {
        match opening {
            Some(o) => o.start.iter().map(|x| x.exp()).collect(),
            None => vec![1.0; self.of_vertex.len()],
        }
    }

    fn relative_depths(&self, u: &[f64], unit: f64) -> Vec<f64> {
        let depth = |i: &Option<usize>| i.map_or(1.0, |i| (u[i] * unit).exp());
        self.of_vertex.iter().map(depth).collect()
    }

    /// The row that touches a condition at the depths `s`; scales are unknowns only if `scaled`, else 1.
    fn tangent(&self, condition: &Condition, s: &[f64], unit: f64, scaled: bool) -> Option<Row> {
        let mut terms: Vec<(usize, f64)> = Vec::with_capacity(8);
        let mut limit = condition.limit;
        let mut add = |side: Option<OnGroup>, sign: f64| {
            let Some(OnGroup { anchor, group }) = side else {
                return Some(());
            };
            let (tangent, constant) = log_tangent(&anchor, s);
            for (v, p) in tangent {
                terms.push((self.of_vertex[v]?, sign * p));
            }
            if scaled {
                terms.push((self.scale(group), -sign));
            }
            limit -= sign * constant;
            Some(())
        };
        add(condition.plus, 1.0)?;
        add(condition.minus, -1.0)?;
        Some(Row {
            kind: condition.kind,
            terms: gathered(terms),
            limit: limit / unit,
        })
    }
}

/// Weight `theta / tan^2 theta` of a face turned by `tan theta = tangent`.
fn reweighted(tangent: f64) -> f64 {
    let tangent = tangent.max(LEAST_TURN);
    tangent.atan() / (tangent * tangent)
}

/// The faces that take part: `tan^2 theta = sum over k of turn_k (x_(k+1) - x_(k+2))^2`, and how much each counts.
struct Faces {
    /// Corners, `turn`, weight.
    faces: Vec<([VertexId; 3], [f64; 3], f64)>,
}

impl Faces {
    fn new(
        weight: FaceWeight,
        image: &Image,
        seen: &[f64],
        taking_part: &[bool],
        opening: Option<&Opening>,
    ) -> Self {
        let Image { target, map, .. } = image;
        let geometry = FaceGeometry::new(&target.mesh);
        let face = |f: FaceId| {
            let corners = target.mesh.corners(f);
            let h = target.mesh.normal(f).dot(corners[0] - map.plane.eye).abs();
            let area = geometry.areas[f];
            let weight = match weight {
                FaceWeight::Area => area,
                FaceWeight::SolidAngle => {
                    let whole = map.plane.solid_angle_of(corners).abs();
                    seen[f].max(LEAST_SEEN * whole)
                }
            };
            let turn = geometry.cotangents[f].map(|cot| h * h * cot / (2.0 * area));
            let factor = opening.map_or(1.0, |o| o.counts[f]);
            // As in the paper's Eq 13 weights count squared.
            let marked = target.face_weight(f).powi(2);
            let hidden = if seen[f] > 0.0 { 1.0 } else { HIDDEN * HIDDEN };
            let all = weight * factor * marked * hidden;
            (target.mesh.faces[f], turn, all)
        };
        let faces = FaceId::all(seen.len()).filter(|f| taking_part[*f]);
        Self {
            faces: faces.map(face).collect(),
        }
    }

    /// The quadratic form with every face's weight times `factor` (index: face that takes part), scaled and regularised.
    fn energy(
        &self,
        index: &Variables,
        variables: usize,
        opening: Option<&Opening>,
        factor: &dyn Fn(usize) -> f64,
    ) -> sprs::CsMat<f64> {
        let mut quadratic = Quadratic::new(variables);
        for (n, (corners, turn, weight)) in self.faces.iter().enumerate() {
            let at = corners.map(|v| index.at(v));
            for k in 0..3 {
                let (i, j) = (at[(k + 1) % 3], at[(k + 2) % 3]);
                quadratic.difference(i, j, factor(n) * weight * turn[k]);
            }
        }
        let energy = quadratic.finish();
        let mean = mean_diagonal(&energy, index.count);
        let ties = opening.map_or(&[][..], |o| &o.ties);
        let ties = ties.iter().map(|t| index.tied(t)).collect();
        regularised(energy, mean, ties)
    }

    /// `tan theta` of the `n`th face under the depths `x` of the variables.
    fn turned(&self, n: usize, index: &Variables, x: impl Fn(usize) -> f64) -> f64 {
        let (corners, turn, _) = &self.faces[n];
        let x = corners.map(|v| x(index.at(v)));
        let square: f64 = (0..3)
            .map(|k| turn[k] * (x[(k + 1) % 3] - x[(k + 2) % 3]).powi(2))
            .sum();
        square.max(0.0).sqrt()
    }
}

/// Scaled to a mean diagonal of 1, with the ties, and the regulariser on every unknown.
fn regularised(
    energy: sprs::CsMat<f64>,
    mean: f64,
    ties: Vec<Vec<(usize, f64)>>,
) -> sprs::CsMat<f64> {
    let mut tied = Quadratic::new(energy.rows());
    ties.iter().for_each(|t| tied.form(t, TIE));
    let mut triplets = sprs::TriMat::new((energy.rows(), energy.cols()));
    tied.finish()
        .iter()
        .for_each(|(v, (i, j))| triplets.add_triplet(i, j, *v));
    energy
        .iter()
        .for_each(|(v, (i, j))| triplets.add_triplet(i, j, v / mean));
    (0..energy.rows()).for_each(|i| triplets.add_triplet(i, i, REGULARISER));
    triplets.to_csc()
}

/// Both limits of every step.
fn step_rows(opening: &Opening, index: &Variables, unit: f64) -> Vec<Row> {
    let at = |v: VertexId| index.of_vertex[v];
    let mut rows = Vec::with_capacity(opening.steps.len());
    for (i, step) in opening.steps.iter().enumerate() {
        let (Some(near), Some(far)) = (at(step.near), at(step.far)) else {
            continue;
        };
        let row = |sign: f64, limit: f64| Row {
            kind: RowKind::Step(i as u32),
            terms: vec![(near, sign), (far, -sign)],
            limit,
        };
        rows.push(row(1.0, -step.least / unit));
        if step.most.is_finite() {
            rows.push(row(-1.0, step.most / unit));
        }
    }
    rows
}
