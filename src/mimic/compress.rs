//! Compression of depth into the layer, without an optimisation of the look: what reliefs are compared with.
//!
//! Takes a shape: for every vertex the depth that is to be compressed, over the model's. The relief's depth is the mix
//!
//! ```text
//! z' = ((1 - k) Z + k B) / mu
//! ```
//!
//! of the shape's depth `Z` and that of the middle `B` of the layers, with one `k` for all and a scale `mu` for each support: on
//! a layer that is parallel to the image `z'` is a linear function of `Z` (Cignoni et al. 1997), and on any other the linear function
//! leans with it. `k` is the smallest one that fits every bound, by bisection on the bounds themselves, so that they hold on
//! every ray as they do for any other surface; `mu` then lets each support's part touch its far bound. Groups of one support
//! share their scale, so that parts in front stay in front.
//!
//! `B` is one surface for the whole model, because faces between two supports bend with both: of all surfaces within the
//! bounds the one nearest to the middles, which is a quadratic program in `y = 1 / s`. There the bounds are linear without tangents:
//! `nu / upper <= sum of w_k y_k <= nu / lower`, `nu = 1 / mu`.

use super::depths::{Depths, typical_width};
use super::lazily::MARGIN;
use super::program::{Program, Quadratic, Row, RowKind};
use super::solve::{SolveError, Solved};
use super::solving::solve;
use crate::groups::{Bound, Groups};
use crate::index::SupportId;
use crate::mesh::DisjointSets;
use crate::sight::Sight;
use crate::viewmap::Target;

/// What the result of [`compressed`] is for the model's own depths.
const LINEAR: &str = "linear compression of depth, not the optimum of an energy";
/// Weight of differences along edges against distances from the middle: it spans the surface over vertices without bounds.
/// At 1e-4 it rounds off the middle of a groove by a hundredth of the layer, at 1e-8 the program loses digits.
const SPAN: f64 = 1e-6;
/// Halvings of the interval of mixes: to the last digit.
const HALVINGS: u32 = 52;

/// Depths of the model itself compressed.
///
/// # Errors
/// If no surface lies within all bounds.
pub(crate) fn linear(sight: &Sight) -> Result<Depths, SolveError> {
    let shape = vec![1.0; sight.image.target.mesh.vertices.len()];
    compressed(&shape, sight, LINEAR)
}

/// The depths of the mix, see the module; `shape` is `Z` over the model's depth, index: vertex.
///
/// # Errors
/// If no surface lies within all bounds.
pub(crate) fn compressed(
    shape: &[f64],
    sight: &Sight,
    not_an_optimum: &'static str,
) -> Result<Depths, SolveError> {
    let layers = Layers::new(&sight.image.target, &sight.groups);
    let (middle, solved) = layers.middle()?;
    let shape = layers.levelled(shape);
    let mix = |k: f64| -> Vec<f64> {
        let both = shape.iter().zip(&middle);
        both.map(|(z, b)| (1.0 - k) * z + k * b).collect()
    };
    let share =
        smallest(|k| layers.scales(&mix(k)).is_some()).ok_or(SolveError::Infeasible(Vec::new()))?;
    let s = mix(share);
    let of_support = layers
        .scales(&s)
        .ok_or(SolveError::Infeasible(Vec::new()))?;
    Ok(Depths {
        mu: layers.slots.iter().map(|slot| of_support[*slot]).collect(),
        s,
        solved: Solved {
            gauge: "every support's relief touches its far bound",
            not_an_optimum: Some(not_an_optimum),
            optimality: Default::default(),
            ..solved
        },
        iterated: None,
    })
}

/// The smallest share that fits, if 1 does.
fn smallest(fits: impl Fn(f64) -> bool) -> Option<f64> {
    if fits(0.0) {
        return Some(0.0);
    }
    if !fits(1.0) {
        return None;
    }
    let (mut less, mut enough) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let k = (less + enough) / 2.0;
        if fits(k) {
            enough = k;
        } else {
            less = k;
        }
    }
    Some(enough)
}

/// The bounds of a view by support.
struct Layers<'a> {
    target: &'a Target,
    groups: &'a Groups,
    /// The support of every group, counted without those that carry nothing.
    slots: Vec<usize>,
    supports: usize,
    used: Vec<bool>,
    /// Vertices that hang together by faces and supports.
    blocks: Vec<Vec<usize>>,
    unit: f64,
}

impl<'a> Layers<'a> {
    fn new(target: &'a Target, groups: &'a Groups) -> Self {
        let mut carriers: Vec<SupportId> = groups.groups.iter().map(|g| g.support).collect();
        carriers.sort_unstable();
        carriers.dedup();
        let slot = |s: SupportId| carriers.partition_point(|c| *c < s);
        let slots: Vec<usize> = groups.groups.iter().map(|g| slot(g.support)).collect();
        let mut used = vec![false; target.mesh.vertices.len()];
        let corners = target.mesh.faces.iter().flatten();
        corners.for_each(|v| used[*v] = true);
        Self {
            blocks: blocks(target, groups, &slots, &used),
            supports: carriers.len(),
            unit: typical_width(groups, 0.0),
            target,
            groups,
            slots,
            used,
        }
    }

    /// Relative depths of the surface in the middle of the layers, of mean inverse 1 in each block.
    fn middle(&self) -> Result<(Vec<f64>, Solved), SolveError> {
        let n = self.used.len();
        let bounds = &self.groups.bounds[..self.groups.needed];
        let mut quadratic = Quadratic::new(n + self.supports);
        let mut linear = vec![0.0; n + self.supports];
        for bound in bounds {
            let inverse = 2.0 / (bound.lower + bound.upper);
            let (terms, value) = self.line(bound, inverse);
            quadratic.form(&terms, 1.0);
            terms
                .iter()
                .for_each(|(i, a)| linear[*i] += 2.0 * a * value);
        }
        for face in &self.target.mesh.faces {
            for k in 0..3 {
                let (i, j) = (face[k].at(), face[(k + 1) % 3].at());
                quadratic.difference(i, j, SPAN);
            }
        }
        let unused = (0..n).filter(|i| !self.used[*i]);
        unused.for_each(|i| quadratic.square(i, 1.0));
        let even = |b: &Vec<usize>| {
            let share = 1.0 / b.len() as f64;
            (b.iter().map(|i| (*i, share)).collect(), 0.0)
        };
        let program = Program {
            variables: n + self.supports,
            quadratic: quadratic.finish(),
            factor: Vec::new(),
            linear,
            equalities: self.blocks.iter().map(even).collect(),
            rows: bounds
                .iter()
                .enumerate()
                .flat_map(|(i, b)| self.rows(i as u32, b))
                .collect(),
        };
        let solution = solve(&program)?;
        let inverse = |u: &f64| 1.0 + self.unit * u;
        if solution.u[..n].iter().any(|u| inverse(u) <= 0.0) {
            return Err(SolveError::Unsolved {
                reason: "the middle of the layers passes through the eye".into(),
                worst: None,
            });
        }
        let depths = solution.u[..n].iter().map(|u| 1.0 / inverse(u));
        Ok((depths.collect(), solution.solved))
    }

    /// `sum of w_k y_k - inverse * nu` in terms of what `y` and `nu` differ from 1, in units, and its value where they are 1.
    fn line(&self, bound: &Bound, inverse: f64) -> (Vec<(usize, f64)>, f64) {
        let terms = bound.anchor.terms().map(|(v, w)| (v.at(), w));
        let mut terms: Vec<(usize, f64)> = terms.collect();
        terms.push((self.used.len() + self.slot(bound), -inverse));
        (terms, (1.0 - inverse) / self.unit)
    }

    /// Both rows of a bound, a little harder than they are to be kept.
    fn rows(&self, number: u32, bound: &Bound) -> [Row; 2] {
        let margin = 1.0 + 2.0 * MARGIN * self.unit;
        let (terms, value) = self.line(bound, 1.0 / (bound.lower * margin));
        let near = Row {
            kind: RowKind::Near(number),
            terms,
            limit: -value,
        };
        let (terms, value) = self.line(bound, margin / bound.upper);
        let far = Row {
            kind: RowKind::Far(number),
            terms: terms.iter().map(|(i, a)| (*i, -a)).collect(),
            limit: value,
        };
        [near, far]
    }

    fn slot(&self, bound: &Bound) -> usize {
        self.slots[bound.group]
    }

    /// The shape with a mean of 1 in each block, which is what the middle has.
    fn levelled(&self, shape: &[f64]) -> Vec<f64> {
        let mut level = vec![1.0; shape.len()];
        for block in &self.blocks {
            let mean = block.iter().map(|i| shape[*i]).sum::<f64>() / block.len() as f64;
            block.iter().for_each(|i| level[*i] = shape[*i] / mean);
        }
        level
    }

    /// The smallest scale of each support that keeps depths within its far bounds, if they keep its near bounds with it.
    fn scales(&self, s: &[f64]) -> Option<Vec<f64>> {
        let mut least = vec![f64::MIN_POSITIVE; self.supports];
        let mut most = vec![f64::INFINITY; self.supports];
        for bound in &self.groups.bounds {
            let (slot, depth) = (self.slot(bound), bound.anchor.relative_depth(s));
            least[slot] = least[slot].max(depth / bound.upper);
            most[slot] = most[slot].min(depth / bound.lower);
        }
        let room = 1.0 + MARGIN * self.unit;
        let fits = least.iter().zip(&most).all(|(l, m)| l * room <= *m);
        fits.then_some(least)
    }
}

/// Blocks of used vertices that hang together, by their first vertices.
fn blocks(target: &Target, groups: &Groups, slots: &[usize], used: &[bool]) -> Vec<Vec<usize>> {
    let n = used.len();
    let supports = slots.iter().map(|s| s + 1).max().unwrap_or(0);
    let mut sets = DisjointSets::new(n + supports);
    for [a, b, c] in &target.mesh.faces {
        sets.join(a.0, b.0);
        sets.join(b.0, c.0);
    }
    for bound in &groups.bounds {
        let support = n + slots[bound.group];
        sets.join(bound.anchor.vertices[0].0, support as u32);
    }
    let vertices = |mut set: Vec<usize>| {
        set.retain(|i| *i < n && used[*i]);
        set
    };
    let blocks = sets.members().into_iter().map(vertices);
    blocks.filter(|b| !b.is_empty()).collect()
}
