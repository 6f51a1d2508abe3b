//! A singular quadratic form made invertible: one unknown of every part that gives way is pinned (see [`super`]).

use super::super::factor::{Factor, Half};
use super::super::program::{gathered, mean_diagonal, times};
use crate::mesh::DisjointSets;
use sprs::CsMat;

/// A lone unknown with less than this share of the mean diagonal is pinned, too: scales of groups have 1e-9, and `Q^-1` would drown
/// everything else.
const SOFT: f64 = 1e-3;
/// Stiffness, as a share of the mean diagonal, that parts with none are lent: without it a part that no row holds could be anywhere.
/// It draws to the last solution and so has no share in the optimum.
const LENT: f64 = 1e-10;
/// Steps of every solution: with the last solution to start from, the third changes nothing that the noise leaves.
const STEPS: usize = 2;

/// `P` with its pins.
pub(crate) struct Pinned {
    upper: CsMat<f64>,
    /// Sums of the rows of `P`.
    sums: Vec<f64>,
    /// Pin of every unknown, if its part has one.
    pin: Vec<Option<usize>>,
    /// Pinned unknowns.
    pub places: Vec<usize>,
    /// The weight of pins.
    sigma: f64,
    factor: Factor,
    /// How far each unknown moves when its pin's part gives way by 1.
    pub direction: Vec<f64>,
    /// `S`, with what is lent.
    pub stiffness: Vec<f64>,
    pub lent: Vec<f64>,
}

impl Pinned {
    /// Pins and factorises a form given by its upper triangle; nothing if it is indefinite or needs more than `most` pins.
    pub(crate) fn new(upper: &CsMat<f64>, most: usize) -> Option<Self> {
        let n = upper.cols();
        let sigma = mean_diagonal(upper, n);
        let (pin, places) = pins(upper, SOFT * sigma);
        if places.len() > most {
            return None;
        }
        let mut pinned = upper.clone();
        for p in &places {
            let at = pinned.nnz_index(*p, *p)?;
            pinned.data_mut()[at.0] += sigma;
        }
        let ones = vec![1.0; n];
        let mut made = Self {
            sums: times(upper, &ones),
            factor: Factor::new(&pinned)?,
            upper: upper.clone(),
            direction: Vec::new(),
            stiffness: vec![0.0; places.len()],
            lent: Vec::new(),
            pin,
            places,
            sigma,
        };
        made.find_directions();
        // A part that gains by giving way; what is below that is rounding.
        let bent = made.stiffness.iter().any(|s| *s < -LENT * sigma);
        made.lend();
        (!bent).then_some(made)
    }

    fn find_directions(&mut self) {
        let n = self.sums.len();
        let mut force = vec![0.0; n];
        self.places.iter().for_each(|p| force[*p] = self.sigma);
        let start = self.pin.iter().map(|p| f64::from(u8::from(p.is_some())));
        self.direction = self.solve(start.collect(), &force);
        let pull = self.times(&self.direction);
        for (i, pin) in self.pin.iter().enumerate() {
            if let Some(p) = pin {
                self.stiffness[*p] += self.direction[i] * pull[i];
            }
        }
        for (s, p) in self.stiffness.iter_mut().zip(&self.places) {
            *s /= self.direction[*p];
        }
    }

    fn lend(&mut self) {
        for s in &mut self.stiffness {
            let lent = (LENT * self.sigma - *s).max(0.0);
            self.lent.push(lent);
            *s += lent;
        }
    }

    /// `n'x` of every part.
    pub(crate) fn along(&self, x: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.places.len()];
        for ((pin, n), x) in self.pin.iter().zip(&self.direction).zip(x) {
            if let Some(p) = pin {
                sums[*p] += n * x;
            }
        }
        sums
    }

    /// `n'g` of a sparse vector, only parts that it has to do with.
    pub(crate) fn along_terms(&self, terms: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let share = |(i, v): &(usize, f64)| Some((self.pin[*i]?, v * self.direction[*i]));
        gathered(terms.iter().filter_map(share).collect())
    }

    /// `n t`.
    pub(crate) fn moved(&self, t: &[f64]) -> Vec<f64> {
        let by = self.pin.iter().zip(&self.direction);
        by.map(|(pin, n)| pin.map_or(0.0, |p| n * t[p])).collect()
    }

    /// The least value of every unknown and its neighbours; lone unknowns are nobody's concern.
    pub(crate) fn least_near(&self, values: &[usize]) -> Vec<usize> {
        let mut near = vec![usize::MAX; values.len()];
        for (j, column) in self.upper.outer_iterator().enumerate() {
            for (i, _) in column.iter().filter(|(i, _)| *i != j) {
                let least = values[i].min(values[j]);
                near[i] = near[i].min(least);
                near[j] = near[j].min(least);
            }
        }
        near
    }

    /// `L^-1 g` for `Q = L L'`.
    pub(crate) fn half(&self, terms: &[(usize, f64)], work: &mut [f64]) -> Half {
        self.factor.half(terms, work)
    }

    /// `Q^-1 b` from a start near it, or from 0: every step takes off all but 1e-5 of what is missing.
    pub(crate) fn solve(&self, mut x: Vec<f64>, b: &[f64]) -> Vec<f64> {
        for _ in 0..STEPS {
            let mut rest = self.times(&x);
            self.places
                .iter()
                .for_each(|p| rest[*p] += self.sigma * x[*p]);
            rest.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
            if rest.iter().all(|r| *r == 0.0) {
                break;
            }
            self.factor.solve(&mut rest);
            x.iter_mut().zip(&rest).for_each(|(x, r)| *x += r);
        }
        x
    }

    /// `P x` through differences: of smooth `x` the product itself is rounding.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut product: Vec<f64> = self.sums.iter().zip(x).map(|(s, x)| s * x).collect();
        for (j, column) in self.upper.outer_iterator().enumerate() {
            for (i, v) in column.iter().filter(|(i, _)| *i != j) {
                let pull = v * (x[j] - x[i]);
                product[i] += pull;
                product[j] -= pull;
            }
        }
        product
    }
}

/// The pin of every unknown, and the pinned ones: the first of every part of several, and lone ones below `soft`.
fn pins(upper: &CsMat<f64>, soft: f64) -> (Vec<Option<usize>>, Vec<usize>) {
    let n = upper.cols();
    let (mut parts, mut diagonal) = (DisjointSets::new(n), vec![0.0; n]);
    for (v, (i, j)) in upper {
        if i == j {
            diagonal[i] = *v;
        } else {
            parts.join(i as u32, j as u32);
        }
    }
    let (mut pin, mut places) = (vec![None; n], Vec::new());
    for part in parts.members() {
        let first = part[0];
        if part.len() > 1 || diagonal[first] < soft {
            part.iter().for_each(|i| pin[*i] = Some(places.len()));
            places.push(first);
        }
    }
    (pin, places)
}
