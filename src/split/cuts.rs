//! Cutting the base into plates that fit the bed.
//!
//! Takes the base's outline, the sockets and the bed; gives cuts along x and y, the pins that align neighbouring plates, and the
//! plates as solids. Plates keep their place in the forest: each is half the clearance short of a cut, so that what stands on
//! them is where it was.
//!
//! A cut may run through sockets (the peg then ties two plates together) but never leaves a thin wall beside one if there is a
//! choice. Pins are as high as half the plate and start at its underside: they print lying on the bed.

use crate::carve::boolean::{Boolean, BooleanError};
use crate::geom::{contains, gap, to_segment};
use glam::{DVec2, DVec3};

/// Pins: width along the cut and length across it, millimetres. Wide enough not to break, short enough to hide.
const PIN_WIDTH_MM: f64 = 6.0;
const PIN_LENGTH_MM: f64 = 4.0;
/// Material wanted around holes and beside cuts, millimetres.
pub(crate) const WALL_MM: f64 = 1.2;
/// Where cuts and pins may lie is tried in steps of this, millimetres.
const STEP_MM: f64 = 0.5;
/// Beyond any base, millimetres; and how far tools start outside of what they cut.
const OUT_MM: f64 = 10.0;

/// The base to be cut.
pub(crate) struct Baseplate<'a> {
    pub outline: &'a [DVec2],
    pub thickness: f64,
    /// One outline a socket.
    pub sockets: &'a [Vec<DVec2>],
    pub clearance: f64,
}

/// How the base is cut: a grid; empty for one plate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cuts {
    /// Where cuts along y lie, and those along x, rising.
    pub x: Vec<f64>,
    pub y: Vec<f64>,
}

/// A pin across a cut: from the plate before it into the plate after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Where its middle crosses the cut.
    pub at: DVec2,
    /// Across a cut along y (else along x).
    pub along_x: bool,
    /// Column and row of the plate that has the pin.
    pub from: (usize, usize),
}

impl Pin {
    /// The rectangle from `back` before the cut to `ahead` after it, `half` to both sides.
    fn rectangle(&self, back: f64, ahead: f64, half: f64) -> (DVec2, DVec2) {
        let way = if self.along_x { DVec2::X } else { DVec2::Y };
        let side = half * (DVec2::ONE - way);
        (self.at - back * way - side, self.at + ahead * way + side)
    }

    /// What of it is seen from above, millimetres.
    pub fn outline(&self) -> (DVec2, DVec2) {
        self.rectangle(0.0, PIN_LENGTH_MM, PIN_WIDTH_MM / 2.0)
    }

    /// Column and row of the plate that has its hole.
    fn hole(&self) -> (usize, usize) {
        let (i, j) = self.from;
        if self.along_x { (i + 1, j) } else { (i, j + 1) }
    }
}

impl Baseplate<'_> {
    fn bounds(&self) -> (DVec2, DVec2) {
        let points = || self.outline.iter().copied();
        (
            points().fold(DVec2::INFINITY, DVec2::min),
            points().fold(DVec2::NEG_INFINITY, DVec2::max),
        )
    }

    /// As few plates as the bed asks for; `None` if it is too small for any.
    pub(crate) fn cuts(&self, bed: [f64; 3]) -> Option<Cuts> {
        let (lo, hi) = self.bounds();
        let size = hi - lo;
        let beds = [DVec2::new(bed[0], bed[1]), DVec2::new(bed[1], bed[0])];
        if beds.iter().any(|b| size.cmple(*b).all()) {
            return Some(Cuts::default());
        }
        let limits = beds.map(|b| b - PIN_LENGTH_MM);
        let count = |limit: &DVec2| (size / *limit).ceil();
        let plates = |limit: &DVec2| count(limit).x * count(limit).y;
        let limit = limits
            .into_iter()
            .filter(|l| l.min_element() > 2.0 * PIN_WIDTH_MM)
            .min_by(|a, b| plates(a).total_cmp(&plates(b)))?;
        let along = |k: usize| {
            let sides: Vec<(f64, f64)> = self.sockets.iter().map(|s| range(s, k)).collect();
            let n = count(&limit)[k] as usize;
            positions((lo[k], hi[k]), n, limit[k], &sides)
        };
        Some(Cuts {
            x: along(0),
            y: along(1),
        })
    }

    /// Two pins for each cut between two plates, where there is room.
    pub(crate) fn pins(&self, cuts: &Cuts) -> Vec<Pin> {
        let (lo, hi) = self.bounds();
        let (x, y) = (lines(lo.x, &cuts.x, hi.x), lines(lo.y, &cuts.y, hi.y));
        let mut pins = Vec::new();
        for (i, j) in cells(&x, &y) {
            let pin = |along_x, at| Pin {
                at,
                along_x,
                from: (i, j),
            };
            if i + 2 < x.len() {
                let at = |t| pin(true, DVec2::new(x[i + 1], t));
                pins.extend(self.two(y[j], y[j + 1], at));
            }
            if j + 2 < y.len() {
                let at = |t| pin(false, DVec2::new(t, y[j + 1]));
                pins.extend(self.two(x[i], x[i + 1], at));
            }
        }
        pins
    }

    /// The two free places nearest to the quarters of the common edge.
    fn two(&self, from: f64, to: f64, pin: impl Fn(f64) -> Pin) -> Vec<Pin> {
        let count = ((to - from) / STEP_MM) as usize;
        let places = (0..=count).map(|k| from + STEP_MM * k as f64);
        let inside: Vec<f64> = places
            .filter(|t| contains(self.outline, pin(*t).at))
            .collect();
        let (Some(first), Some(last)) = (inside.first(), inside.last()) else {
            return Vec::new();
        };
        let half = PIN_WIDTH_MM / 2.0 + self.clearance + WALL_MM;
        let free = inside
            .iter()
            .copied()
            .filter(|t| from + half < *t && *t < to - half && self.has_room(&pin(*t), half));
        let free: Vec<f64> = free.collect();
        let nearest = |share: f64| {
            let wish = first + share * (last - first);
            let nearer = |a: &&f64, b: &&f64| (*a - wish).abs().total_cmp(&(*b - wish).abs());
            free.iter().min_by(nearer).copied()
        };
        match (nearest(0.25), nearest(0.75)) {
            (Some(a), Some(b)) if b - a >= 2.0 * PIN_WIDTH_MM => vec![pin(a), pin(b)],
            (Some(_), Some(_)) => nearest(0.5).map(pin).into_iter().collect(),
            _ => Vec::new(),
        }
    }

    fn has_room(&self, pin: &Pin, half: f64) -> bool {
        let reach = PIN_LENGTH_MM + self.clearance + WALL_MM;
        let (lo, hi) = pin.rectangle(reach, reach, half);
        let ring = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
        is_inside(self.outline, &ring, 0.0) && self.sockets.iter().all(|s| gap(s, &ring) > 0.0)
    }

    /// The plate in a cell of the grid without its sockets; `None` if the base does not reach there.
    pub(crate) fn plate(
        &self,
        cuts: &Cuts,
        pins: &[Pin],
        cell: (usize, usize),
    ) -> Result<Option<Boolean>, BooleanError> {
        let (lo, hi) = self.bounds();
        let side = |list: &[f64], k: usize, lo: f64, hi: f64| {
            let short = self.clearance / 2.0;
            let from = k.checked_sub(1).map_or(lo - OUT_MM, |k| list[k] + short);
            let to = list.get(k).map_or(hi + OUT_MM, |c| c - short);
            (from, to)
        };
        let (x, y) = (
            side(&cuts.x, cell.0, lo.x, hi.x),
            side(&cuts.y, cell.1, lo.y, hi.y),
        );
        let ring = vec![self.outline.iter().map(DVec2::to_array).collect()];
        let base = Boolean::upright(&ring, -self.thickness, 0.0)?;
        let part = Boolean::cuboid(
            DVec3::new(x.0, y.0, -self.thickness - OUT_MM),
            DVec3::new(x.1, y.1, OUT_MM),
        )?;
        let mut plate = base.common(&part)?;
        if plate.is_empty() {
            return Ok(None);
        }
        let middle = -self.thickness / 2.0;
        for pin in pins.iter().filter(|p| p.from == cell) {
            let (lo, hi) = pin.rectangle(WALL_MM, PIN_LENGTH_MM, PIN_WIDTH_MM / 2.0);
            let top = middle - self.clearance;
            plate = plate.plus(&Boolean::cuboid(
                lo.extend(-self.thickness),
                hi.extend(top),
            )?)?;
        }
        for pin in pins.iter().filter(|p| p.hole() == cell) {
            let (lo, hi) = pin.rectangle(
                WALL_MM,
                PIN_LENGTH_MM + self.clearance,
                PIN_WIDTH_MM / 2.0 + self.clearance,
            );
            let below = lo.extend(-self.thickness - OUT_MM);
            plate = plate.minus(&Boolean::cuboid(below, hi.extend(middle))?)?;
        }
        Ok(Some(plate))
    }
}

/// Columns and rows of a grid.
pub(crate) fn grid(cuts: &Cuts) -> Vec<(usize, usize)> {
    let rows = 0..=cuts.y.len();
    rows.flat_map(|j| (0..=cuts.x.len()).map(move |i| (i, j)))
        .collect()
}

fn cells(x: &[f64], y: &[f64]) -> Vec<(usize, usize)> {
    (0..y.len() - 1)
        .flat_map(|j| (0..x.len() - 1).map(move |i| (i, j)))
        .collect()
}

fn lines(lo: f64, cuts: &[f64], hi: f64) -> Vec<f64> {
    let ends = |end| std::iter::once(end);
    ends(lo)
        .chain(cuts.iter().copied())
        .chain(ends(hi))
        .collect()
}

fn range(outline: &[DVec2], k: usize) -> (f64, f64) {
    let values = || outline.iter().map(|p| p[k]);
    (
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
    )
}

/// Whether a ring lies inside an outline, at least `margin` from it.
pub(crate) fn is_inside(outline: &[DVec2], ring: &[DVec2], margin: f64) -> bool {
    let n = outline.len();
    let clear = |p: &DVec2| {
        contains(outline, *p)
            && (0..n).all(|k| to_segment(*p, outline[k], outline[(k + 1) % n]) >= margin)
    };
    ring.iter().all(clear)
}

/// Where `n - 1` cuts part a range so that no part is longer than `limit`: as even as can be without a thin wall beside a socket.
/// `sides` are the sockets' ranges.
fn positions((lo, hi): (f64, f64), n: usize, limit: f64, sides: &[(f64, f64)]) -> Vec<f64> {
    let mut cuts = Vec::new();
    let mut last = lo;
    for k in 1..n {
        let even = lo + (hi - lo) * k as f64 / n as f64;
        let from = (hi - (n - k) as f64 * limit).max(last + limit / 4.0);
        let to = last + limit;
        let wall = |at: f64| {
            let ends = sides.iter().flat_map(|s| [s.0, s.1]);
            ends.map(|e| (e - at).abs()).fold(WALL_MM, f64::min)
        };
        let count = ((to - from) / STEP_MM).max(0.0) as usize;
        let tries = (0..=count).map(|i| (from + STEP_MM * i as f64).min(to));
        let better = |a: &f64, b: &f64| {
            let far = |at: &f64| (at - even).abs();
            wall(*a)
                .total_cmp(&wall(*b))
                .then(far(b).total_cmp(&far(a)))
        };
        let at = tries
            .chain([even.clamp(from.min(to), to)])
            .max_by(better)
            .unwrap_or(even);
        cuts.push(at);
        last = at;
    }
    cuts
}
