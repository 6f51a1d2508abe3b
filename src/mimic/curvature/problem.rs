//! One program of the curvature energy, over the surface that its rows are made of.

use super::sheet::{Form, Sheet};
use crate::groups::Groups;
use crate::index::{FaceId, VertexId};
use crate::mesh::DisjointSets;
use crate::mimic::conditions::{self, Condition, Conditions, OnGroup, plain_tangent};
use crate::mimic::depths::{Depths, scales, seen_solid_angles, typical_width};
use crate::mimic::energy::{CurvatureForm, CurvatureOptions};
use crate::mimic::keeping::Keeping;
use crate::mimic::lazily::{DepthsAndScales, MARGIN, Meaning, solve_lazily};
use crate::mimic::program::{Program, Quadratic, Row, RowKind, gathered};
use crate::mimic::solve::{Method, SolveError, Solved};
use crate::sight::Sight;
use crate::viewmap::Image;

/// Weight of `(mu - 1)^2` relative to the mean diagonal (the paper's alpha, about 1 instead of 0): 1e-12 to 1e-7 give the same
/// surface.
const ALPHA: f64 = 1e-9;

/// No group is scaled by less: that of a support a thousand times as far from the eye as the model. At 0.1 a plate 14 times as far is
/// 47 degrees off instead of 35. Far smaller values are within the solver's tolerance of 0, where contradictions vanish.
const LEAST_SCALE: f64 = 1e-3;

/// What all programs of one view have in common.
pub(crate) struct Problem<'a> {
    pub options: CurvatureOptions,
    pub image: &'a Image<'a>,
    groups: &'a Groups,
    conditions: Conditions,
    /// Of all unknowns, in relative depth.
    pub unit: f64,
    pub visible: Vec<bool>,
    /// The surface of the model itself.
    pub model: Sheet,
}

impl<'a> Problem<'a> {
    pub(crate) fn new(options: CurvatureOptions, sight: &'a Sight, keeping: &Keeping) -> Self {
        let Sight { image, groups, .. } = sight;
        Self {
            options,
            image,
            groups,
            conditions: conditions::all(groups, keeping),
            unit: typical_width(groups, keeping.least_unit),
            visible: visible_vertices(image),
            model: Sheet::new(&image.target.mesh, image.map.plane.eye),
        }
    }

    /// The linearised problem.
    pub(crate) fn first(&self) -> Result<(Depths, Program), SolveError> {
        let forms = if self.options.scale_invariant {
            self.model.scale_invariant()
        } else {
            self.model.absolute()
        };
        let start = vec![1.0; self.image.target.mesh.vertices.len()];
        self.solve(&self.model, &forms, &start)
    }

    pub(crate) fn is_used(&self, vertex: usize) -> bool {
        self.model.areas[vertex] > 0.0
    }

    /// Minimises the sum of the squares of `forms`, rows of the surface `sheet` made at the relative depths `start`. Gives the program with
    /// all the rows that it came to, too.
    ///
    /// # Errors
    /// As [`solve_lazily`].
    pub(crate) fn solve(
        &self,
        sheet: &Sheet,
        forms: &[Form],
        start: &[f64],
    ) -> Result<(Depths, Program), SolveError> {
        let scaled = self.options.group_scales;
        let tangent = |c: &Condition, at: &DepthsAndScales| {
            let row = row(&c.tightened(MARGIN * self.unit), at, start, self.unit);
            Some(if scaled {
                row
            } else {
                row.without(start.len())
            })
        };
        let mut program = self.program(sheet, forms, start);
        let at_start = (start.to_vec(), vec![1.0; self.groups.groups.len()]);
        let first = self.conditions.all[..self.conditions.rows].iter();
        // Orders between groups get theirs where a solution breaks them: at scales of 1 they would be far off.
        let first = first.filter(|c| c.between_groups().is_none());
        program.rows = first.filter_map(|c| tangent(c, &at_start)).collect();
        if scaled {
            program.rows.extend(self.least_scales(start.len()));
        }
        let depths = |u: &[f64]| self.depths_and_scales(u, start);
        let meaning = Meaning {
            depths: &depths,
            tangent: &tangent,
            focal: self.image.map.plane.focal,
        };
        let method = match self.options.form {
            CurvatureForm::Quadratic => Method::DualWorkingSet,
            CurvatureForm::Conic => Method::InteriorPoint,
        };
        let (u, solved) = solve_lazily(&mut program, &self.conditions, &meaning, method)?;
        let (s, own) = depths(&u);
        let depths = Depths {
            mu: match scaled {
                true => scales(self.groups, &self.conditions.all, &s, |g| own[g.at()]),
                false => vec![1.0; self.groups.groups.len()],
            },
            s,
            solved: Solved {
                gauge: self.gauge_in_words(),
                ..solved
            },
            iterated: None,
        };
        Ok((depths, program))
    }

    /// The program without rows.
    fn program(&self, sheet: &Sheet, forms: &[Form], start: &[f64]) -> Program {
        let n = start.len();
        let variables = n + self.groups.groups.len();
        let mut quadratic = Quadratic::new(variables);
        let mut linear = vec![0.0; variables];
        self.gather(sheet, forms, &mut quadratic, &mut linear);
        (0..self.groups.groups.len()).for_each(|g| quadratic.square(n + g, ALPHA));
        let unused = (0..n).filter(|i| !self.is_used(*i));
        unused.for_each(|i| quadratic.square(i, 1.0));
        let (quadratic, factor) = quadratic.finish_with_factor();
        Program {
            variables,
            linear,
            quadratic,
            factor: match self.options.form {
                CurvatureForm::Quadratic => Vec::new(),
                CurvatureForm::Conic => factor,
            },
            equalities: if self.options.scale_invariant {
                gauge(self, start)
            } else {
                Vec::new()
            },
            rows: Vec::new(),
        }
    }

    /// What the unknowns mean: relative depths, and the program's own scales, as conditions are checked with (see `normal`).
    fn depths_and_scales(&self, u: &[f64], start: &[f64]) -> DepthsAndScales {
        let n = start.len();
        let depth = |i: usize| {
            if self.is_used(i) {
                start[i] + self.unit * u[i]
            } else {
                1.0
            }
        };
        let mu = (0..self.groups.groups.len()).map(|g| 1.0 + self.unit * u[n + g]);
        ((0..n).map(depth).collect(), mu.collect())
    }

    /// Without them bounds that contradict each other would all be kept at the eye itself, with scales of 0: their rows are homogeneous.
    fn least_scales(&self, first: usize) -> impl Iterator<Item = Row> {
        (0..self.groups.groups.len()).map(move |g| Row {
            kind: RowKind::Scale(g as u32),
            terms: vec![(first + g, -1.0)],
            limit: (1.0 - LEAST_SCALE) / self.unit,
        })
    }

    fn gauge_in_words(&self) -> &'static str {
        match (self.options.scale_invariant, self.options.group_scales) {
            (true, true) => "the area-weighted mean relative depth is 1",
            (true, false) => "the bounds, which are absolute",
            (false, _) => "nothing: the energy knows the model's size and determines every depth",
        }
    }

    /// The squares of all forms with their weights, scaled to a mean diagonal of 1.
    fn gather(&self, sheet: &Sheet, forms: &[Form], quadratic: &mut Quadratic, linear: &mut [f64]) {
        let weights = self.weights(sheet);
        let used = || (0..forms.len()).filter(|i| self.is_used(*i));
        // Twice the square of a form adds its squared coefficients to the diagonal.
        let squares = |i: usize| {
            forms[i]
                .terms
                .iter()
                .map(|t| t.1.length_squared())
                .sum::<f64>()
        };
        let trace: f64 = used().map(|i| 2.0 * weights[i] * squares(i)).sum();
        let mean = trace / forms.len() as f64;
        for i in used() {
            let Form { terms, value } = &forms[i];
            for axis in 0..3 {
                let terms: Vec<(usize, f64)> = terms.iter().map(|(j, v)| (*j, v[axis])).collect();
                quadratic.form(&terms, weights[i] / mean);
                let slope = 2.0 * weights[i] / mean * value[axis] / self.unit;
                terms.iter().for_each(|(j, v)| linear[*j] += slope * v);
            }
        }
    }

    /// Weights of the squares of all forms: `w_i^2 / A_i`, over the squared mean curvature of the model if Eq 9 is not to
    /// cancel it.
    fn weights(&self, sheet: &Sheet) -> Vec<f64> {
        let flat = self.model.flat();
        let curvatures = self.model.curvatures(flat);
        let hidden = self.options.hidden_weight;
        let weight = |i: usize| {
            let seen = if self.visible[i] {
                1.0
            } else {
                hidden * hidden
            };
            let bend = if self.options.mean_curvature {
                // In units of the curvature that counts as flat.
                flat / curvatures[i]
            } else {
                1.0
            };
            seen * self.image.target.weight(VertexId::new(i)).powi(2) / sheet.areas[i] * bend * bend
        };
        (0..self.visible.len()).map(weight).collect()
    }
}

/// Vertices of whose faces turned to the eye at least half is seen, by solid angle. A share rather than the vertex itself,
/// which on a silhouette is seen or not by rounding alone: two such flips changed relative depths by 7e-3 on a small ball.
fn visible_vertices(image: &Image) -> Vec<bool> {
    let Image { target, map, .. } = image;
    let seen = seen_solid_angles(image);
    let mut shares = vec![(0.0, 0.0); target.mesh.vertices.len()];
    for (f, face) in FaceId::all(target.mesh.faces.len()).zip(&target.mesh.faces) {
        let whole = map.plane.solid_angle_of(target.mesh.corners(f));
        if whole > 0.0 || seen[f] > 0.0 {
            for v in face {
                shares[*v].0 += seen[f];
                shares[*v].1 += whole.abs();
            }
        }
    }
    shares
        .iter()
        .map(|(seen, whole)| *whole > 0.0 && *seen >= 0.5 * whole)
        .collect()
}

/// One equality a block: the area-weighted mean of `s` is 1. The unknowns are what `s` differs from `start`, in units. Blocks that
/// absolute bounds hold need none.
fn gauge(problem: &Problem, start: &[f64]) -> Vec<(Vec<(usize, f64)>, f64)> {
    let areas = &problem.model.areas;
    let n = areas.len();
    let mut blocks = DisjointSets::new(n + problem.groups.groups.len());
    for [a, b, c] in &problem.image.target.mesh.faces {
        blocks.join(a.0, b.0);
        blocks.join(b.0, c.0);
    }
    for bound in &problem.groups.bounds {
        blocks.join(bound.anchor.vertices[0].0, n as u32 + bound.group.0);
    }
    let sides = |c: &Condition| Some([c.plus?, c.minus?].map(|s| s.anchor.vertices[0].0));
    for [front, back] in problem.conditions.all.iter().filter_map(sides) {
        blocks.join(front, back);
    }
    let held =
        |set: &[usize]| !problem.options.group_scales && set.last().is_some_and(|last| *last >= n);
    let block = |mut b: Vec<usize>| {
        b.retain(|i| *i < n && areas[*i] > 0.0);
        let total: f64 = b.iter().map(|i| areas[*i]).sum();
        let terms: Vec<_> = b.iter().map(|i| (*i, areas[*i] / total)).collect();
        let missing: f64 = terms.iter().map(|(i, a)| a * (1.0 - start[*i])).sum();
        (!terms.is_empty()).then_some((terms, missing / problem.unit))
    };
    let blocks = blocks.members().into_iter().filter(|set| !held(set));
    blocks.filter_map(block).collect()
}

/// The row that touches a condition at the depths `s` and scales `mu`. The unknowns are what depths differ from `start` and scales from
/// 1, in units.
///
/// The rows of bounds (Eq 11) and of orders within a group (Eq 12) are tangents of `tau`, and homogeneous. An order between groups
/// compares `tau / mu`, which is not concave. Its row is a tangent of `ln tau - ln mu` instead: near where it touches it is exact, and
/// farther off the front's `mu` and the back's `tau` let a little through, which the next round's row takes back.
fn row(condition: &Condition, (s, mu): &DepthsAndScales, start: &[f64], unit: f64) -> Row {
    let n = start.len();
    let mut terms = Vec::with_capacity(8);
    let mut add = |side: Option<OnGroup>, depth: f64, scale: f64| {
        let Some(OnGroup { anchor, group }) = side else {
            return;
        };
        let tangent = plain_tangent(&anchor, s);
        terms.extend(tangent.iter().map(|(v, g)| (v.at(), depth * g)));
        if scale != 0.0 {
            terms.push((n + group.at(), scale));
        }
    };
    let (plus, minus) = (condition.plus, condition.minus);
    let mut limit = 0.0;
    match [plus, minus] {
        [Some(front), Some(back)] if front.group != back.group => {
            let [front_tau, back_tau] = [front, back].map(|side| side.anchor.relative_depth(s));
            add(plus, 1.0 / front_tau, -1.0 / mu[front.group]);
            add(minus, -1.0 / back_tau, 1.0 / mu[back.group]);
            limit = -condition.excess(s, mu);
        }
        [Some(_), Some(_)] => {
            add(plus, (-condition.limit).exp(), 0.0);
            add(minus, -1.0, 0.0);
        }
        _ => {
            add(plus, 1.0, -condition.limit.exp());
            add(minus, -1.0, (-condition.limit).exp());
        }
    }
    let begin = |v: usize| start.get(v).copied().unwrap_or(1.0);
    let sum: f64 = terms.iter().map(|(v, c)| c * begin(*v)).sum();
    Row {
        kind: condition.kind,
        terms: gathered(terms),
        limit: (limit - sum) / unit,
    }
}
