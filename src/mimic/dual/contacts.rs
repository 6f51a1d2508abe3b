//! The small program of the rows at hand: which of them bind, and how strongly.
//!
//! Rows have residuals `r = c - K z + H t`, `K = G P^-1 G'` between them; `t` are the free unknowns, with `S t + d + H'z = 0`.
//! Wanted are `z >= 0` with `r <= 0` and `r z = 0` (equalities: `r = 0`, any `z`). This is the dual method of Goldfarb & Idnani
//! (1983): it begins without rows and takes in the one broken most, letting go of rows whose multiplier would become negative; the
//! dual objective rises with every step, so that it ends. Their factors are kept as `K_FF = L L'` of the binding rows `F` and
//! `V = L^-1 H_F`, so that free unknowns with next to no stiffness of their own (`S` of 1e-9) cost no digits: they are eliminated
//! last, through `S + V'V`.

/// Share of the diagonal of `K` that is added to it, so that rows that say the same twice do no harm: above the rounding of sums of a
/// thousand products. Residuals are measured and fed back (`super`), so that it does not show in results.
const RIDGE: f64 = 1e-11;
/// A row that gives less than this share of what it would alone follows from the binding ones: none of its multiplier can make it
/// hold. Above the ridge.
const DEPENDENT: f64 = 10.0 * RIDGE;
/// A row is broken by more than this, in the units of its residual.
const BROKEN: f64 = 1e-10;
/// Steps for every row in hand: three were the most so far.
const STEPS: usize = 20;

/// See the module.
#[derive(Default)]
pub(crate) struct Contacts {
    k: Vec<Vec<f64>>,
    /// Rows of `H`, sparse.
    h: Vec<Vec<(usize, f64)>>,
    /// Residuals at `z = 0`, `t = 0`.
    pub c: Vec<f64>,
    /// Equalities, whose multipliers may have any sign.
    equal: Vec<bool>,
    /// Rows that bind.
    held: Vec<bool>,
    /// Diagonal of `S`.
    stiffness: Vec<f64>,
    pub d: Vec<f64>,
    pub z: Vec<f64>,
    pub t: Vec<f64>,
    /// The residuals of the last solution.
    pub r: Vec<f64>,
    /// Binding rows in the order of the factor.
    binding: Vec<usize>,
    l: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
    /// `S + V'V`, lower triangle by rows. Binding adds to it; letting go sums it anew, as what is taken off could leave nothing but rounding.
    freedom: Vec<Vec<f64>>,
}

/// What befalls when a row's multiplier grows by 1.
struct Direction {
    z: Vec<f64>,
    t: Vec<f64>,
    /// `L^-1 K_Fp`, for the factor.
    half: Vec<f64>,
}

impl Contacts {
    pub(crate) fn new(stiffness: Vec<f64>) -> Self {
        let mut made = Self {
            d: vec![0.0; stiffness.len()],
            t: vec![0.0; stiffness.len()],
            stiffness,
            ..Self::default()
        };
        made.sum_freedom();
        made
    }

    pub(crate) fn len(&self) -> usize {
        self.c.len()
    }

    pub(crate) fn binding(&self) -> usize {
        self.binding.len()
    }

    /// Adds a row: its products with all rows so far and itself, its row of `H`, its residual at `z = 0` and `t = 0`.
    pub(crate) fn push(&mut self, mut k: Vec<f64>, h: Vec<(usize, f64)>, c: f64, equal: bool) {
        if let Some(own) = k.last_mut() {
            *own *= 1.0 + RIDGE;
        }
        self.k.iter_mut().zip(&k).for_each(|(row, k)| row.push(*k));
        self.k.push(k);
        self.held.push(false);
        self.h.push(h);
        self.c.push(c);
        self.equal.push(equal);
        self.z.push(0.0);
    }

    /// Finds `z` and `t` from those of the last time; false if rows contradict each other or it does not end.
    pub(crate) fn solve(&mut self) -> bool {
        self.restart();
        for _ in 0..STEPS * self.len() + STEPS {
            let broken = (0..self.len()).filter(|i| self.by(*i) > BROKEN);
            let Some(p) = broken.max_by(|i, j| self.by(*i).total_cmp(&self.by(*j))) else {
                return true;
            };
            if !self.take_in(p) {
                return false;
            }
        }
        false
    }

    /// Takes residuals as they were measured for the last solution for true; gives the largest by which a row is not as it
    /// should be.
    pub(crate) fn correct(&mut self, residuals: &[f64]) -> f64 {
        let mut off = 0.0f64;
        for (i, r) in residuals.iter().enumerate() {
            self.c[i] += r - self.r[i];
            off = off.max(if self.held[i] { r.abs() } else { *r });
        }
        off
    }

    /// How far a row that does not bind is broken.
    fn by(&self, i: usize) -> f64 {
        match self.equal[i] {
            // A binding row's residual is rounding.
            _ if self.held[i] => 0.0,
            true => self.r[i].abs(),
            false => self.r[i],
        }
    }

    /// Multipliers of the rows that bound last time with what residuals have become; those that would be negative are let go.
    fn restart(&mut self) {
        loop {
            let a = self.binding.iter().map(|i| self.c[*i]).collect();
            let b = self.d.iter().map(|d| -d).collect();
            let (z, t) = self.saddle(self.forward(a), b);
            let free = |k: &usize| !self.equal[self.binding[*k]];
            let worst = (0..z.len())
                .filter(free)
                .min_by(|i, j| z[*i].total_cmp(&z[*j]));
            match worst.filter(|k| z[*k] <= 0.0) {
                Some(k) => self.let_go(k),
                None => {
                    self.t = t;
                    for (i, z) in self.binding.iter().zip(z) {
                        self.z[*i] = z;
                    }
                    break;
                }
            }
        }
        let z: Vec<f64> = self.binding.iter().map(|i| self.z[*i]).collect();
        let (mut r, t) = (self.c.clone(), self.t.clone());
        self.follow(&mut r, &z, &t);
        self.r = r;
    }

    /// Raises the multiplier of a broken row until it holds, letting go of rows on the way.
    fn take_in(&mut self, p: usize) -> bool {
        let sign = self.r[p].signum();
        loop {
            let way = self.direction(p);
            let change = self.change(p, &way);
            let full = match -change[p] {
                give if give > DEPENDENT * self.k[p][p] => self.r[p].abs() / give,
                _ => f64::INFINITY,
            };
            let limits = self.binding.iter().zip(&way.z).enumerate();
            let limits = limits.filter(|(_, (i, d))| !self.equal[**i] && sign * **d < 0.0);
            let first = limits
                .map(|(k, (i, d))| (k, self.z[*i] / d.abs()))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let step = first.map_or(full, |(_, least)| full.min(least));
            if step.is_infinite() {
                return false;
            }
            self.walk(p, &way, &change, sign * step);
            match first.filter(|(_, least)| *least < full) {
                Some((k, _)) => self.let_go(k),
                None => {
                    self.bind(p, way.half);
                    return true;
                }
            }
        }
    }

    fn direction(&self, p: usize) -> Direction {
        let column: Vec<f64> = self.binding.iter().map(|i| self.k[*i][p]).collect();
        let half = self.forward(column);
        let mut b = vec![0.0; self.stiffness.len()];
        self.h[p].iter().for_each(|(g, h)| b[*g] = -h);
        let (z, t) = self.saddle(half.iter().map(|x| -x).collect(), b);
        Direction { z, t, half }
    }

    /// How all residuals change along the way.
    fn change(&self, p: usize, way: &Direction) -> Vec<f64> {
        let mut change: Vec<f64> = self.k[p].iter().map(|k| -k).collect();
        self.follow(&mut change, &way.z, &way.t);
        change
    }

    /// Adds `H t - K z` of binding rows' `z` to residuals.
    fn follow(&self, r: &mut [f64], z: &[f64], t: &[f64]) {
        for (j, z) in self.binding.iter().zip(z) {
            r.iter_mut().zip(&self.k[*j]).for_each(|(r, k)| *r -= k * z);
        }
        for (r, h) in r.iter_mut().zip(&self.h) {
            *r += h.iter().map(|(g, h)| h * t[*g]).sum::<f64>();
        }
    }

    fn walk(&mut self, p: usize, way: &Direction, change: &[f64], step: f64) {
        for (i, d) in self.binding.iter().zip(&way.z) {
            self.z[*i] += step * d;
        }
        self.z[p] += step;
        self.t
            .iter_mut()
            .zip(&way.t)
            .for_each(|(t, d)| *t += step * d);
        self.r
            .iter_mut()
            .zip(change)
            .for_each(|(r, d)| *r += step * d);
    }

    /// A new last row of the factor.
    fn bind(&mut self, p: usize, mut half: Vec<f64>) {
        let square: f64 = half.iter().map(|x| x * x).sum();
        let own = self.k[p][p];
        let root = (own - square).max(RIDGE * own).sqrt();
        let mut v = vec![0.0; self.stiffness.len()];
        self.h[p].iter().for_each(|(g, h)| v[*g] = *h);
        for (x, row) in half.iter().zip(&self.v) {
            v.iter_mut().zip(row).for_each(|(v, r)| *v -= x * r);
        }
        v.iter_mut().for_each(|v| *v /= root);
        half.push(root);
        add_square(&mut self.freedom, &v);
        self.l.push(half);
        self.v.push(v);
        self.binding.push(p);
        self.held[p] = true;
    }

    /// Takes the `k`-th binding row out of the factor, by rotations that make it triangular again.
    fn let_go(&mut self, k: usize) {
        let row = self.binding.remove(k);
        self.z[row] = 0.0;
        self.held[row] = false;
        self.l.remove(k);
        for j in k..self.l.len() {
            let (a, b) = (self.l[j][j], self.l[j][j + 1]);
            let length = a.hypot(b);
            let (cos, sin) = (a / length, b / length);
            let turn =
                |x: &mut f64, y: &mut f64| (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
            for row in &mut self.l[j..] {
                let (x, y) = row.split_at_mut(j + 1);
                turn(&mut x[j], &mut y[0]);
            }
            let (x, y) = self.v.split_at_mut(j + 1);
            x[j].iter_mut().zip(&mut y[0]).for_each(|(x, y)| turn(x, y));
            self.l[j].truncate(j + 1);
        }
        self.v.pop();
        self.sum_freedom();
    }

    fn sum_freedom(&mut self) {
        let rows = self.stiffness.iter().enumerate();
        self.freedom = rows
            .map(|(g, s)| {
                let mut row = vec![0.0; g + 1];
                row[g] = *s;
                row
            })
            .collect();
        self.v.iter().for_each(|v| add_square(&mut self.freedom, v));
    }

    /// `z` and `t` with `K_FF z - H_F t = L a` and `H_F'z + S t = b`.
    fn saddle(&self, mut a: Vec<f64>, b: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
        let t = self.free(&a, b);
        for (a, v) in a.iter_mut().zip(&self.v) {
            *a += v.iter().zip(&t).map(|(v, t)| v * t).sum::<f64>();
        }
        (self.backward(a), t)
    }

    /// `(S + V'V)^-1 (b - V'a)`.
    fn free(&self, a: &[f64], mut b: Vec<f64>) -> Vec<f64> {
        let n = b.len();
        let mut m = self.freedom.clone();
        for (a, v) in a.iter().zip(&self.v) {
            b.iter_mut().zip(v).for_each(|(b, v)| *b -= v * a);
        }
        for i in 0..n {
            for j in 0..=i {
                let (above, row) = m.split_at_mut(i);
                let other = if j < i { &above[j] } else { &row[0] };
                let dot: f64 = row[0][..j].iter().zip(other).map(|(x, y)| x * y).sum();
                let rest = row[0][j] - dot;
                row[0][j] = if j < i {
                    rest / above[j][j]
                } else {
                    rest.max(1e-14 * row[0][j]).sqrt()
                };
            }
            let dot: f64 = m[i][..i].iter().zip(&b).map(|(l, x)| l * x).sum();
            b[i] = (b[i] - dot) / m[i][i];
        }
        backward(&m, b)
    }

    /// `L^-1 a`.
    fn forward(&self, mut a: Vec<f64>) -> Vec<f64> {
        for (i, row) in self.l.iter().enumerate() {
            let dot: f64 = row[..i].iter().zip(&a).map(|(l, x)| l * x).sum();
            a[i] = (a[i] - dot) / row[i];
        }
        a
    }

    fn backward(&self, a: Vec<f64>) -> Vec<f64> {
        backward(&self.l, a)
    }
}

/// Adds `v v'` to a lower triangle by rows.
fn add_square(m: &mut [Vec<f64>], v: &[f64]) {
    for (row, x) in m.iter_mut().zip(v).filter(|(_, x)| **x != 0.0) {
        row.iter_mut().zip(v).for_each(|(m, y)| *m += x * y);
    }
}

/// `L'^-1 a` of a lower triangle by rows.
fn backward(l: &[Vec<f64>], mut a: Vec<f64>) -> Vec<f64> {
    for i in (0..a.len()).rev() {
        let x = a[i] / l[i][i];
        a[i] = x;
        let (before, _) = a.split_at_mut(i);
        before.iter_mut().zip(&l[i]).for_each(|(a, l)| *a -= l * x);
    }
    a
}
