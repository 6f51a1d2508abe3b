//! The descent against the exact optimum over the same levels, on small sheets of triangles.

use super::super::min_cut::tests::Lcg;
use super::super::patches::{Patch, PatchId, PatchPoint, Patches, Seam};
use super::*;
use crate::index::{FaceId, GroupId, SupportId};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Depth of the layer's back from the eye, and how far its front lies before it, millimetres.
const BACK: f64 = 150.0;
const THICK: f64 = 3.0;

/// A strip of squares of two triangles each, in waves that the layer does not hold.
struct TriangleSheet {
    columns: usize,
    rows: usize,
    side: f64,
    /// Slope and phase of every wave, with its direction over its length.
    waves: Vec<(f64, f64, DVec2)>,
    /// The model is deeper by so much from a column on: a contour.
    jump: Option<(usize, f64)>,
    /// Largest step in log depth.
    highest: f64,
}

impl TriangleSheet {
    fn random(lcg: &mut Lcg) -> Self {
        let mut within = |lo: f64, hi: f64| lo + (hi - lo) * lcg.share();
        let wave = |within: &mut dyn FnMut(f64, f64) -> f64| {
            let direction = DVec2::from_angle(within(-0.8, 0.8));
            (
                within(0.3, 2.5),
                within(0.0, TAU),
                direction / within(6.0, 24.0),
            )
        };
        let waves = vec![wave(&mut within), wave(&mut within)];
        let side = within(0.7, 3.0);
        let highest = within(-0.7, 1.0) * THICK / BACK;
        let depth = within(-20.0, 20.0);
        let columns = 3 + lcg.below(6) as usize;
        let jump = 1 + lcg.below(2 * columns as u64) as usize;
        Self {
            columns,
            rows: 1 + lcg.below(3) as usize,
            side,
            waves,
            jump: (jump < columns).then_some((jump, depth)),
            highest: if highest > 0.004 {
                highest
            } else {
                f64::INFINITY
            },
        }
    }

    /// Whether a column lies behind the contour.
    fn behind(&self, column: usize) -> bool {
        self.jump.is_some_and(|(from, _)| column >= from)
    }

    /// The corner of a square of a column, with the model's depth as its third coordinate.
    fn corner(&self, column: usize, x: usize, y: usize) -> DVec3 {
        let at = self.side * DVec2::new(x as f64, y as f64);
        let wave = |(slope, phase, k): &(f64, f64, DVec2)| {
            slope / (TAU * k.length()) * (TAU * k.dot(at) + phase).sin()
        };
        let jump = self
            .jump
            .filter(|_| self.behind(column))
            .map_or(0.0, |j| j.1);
        at.extend(BACK + jump + self.waves.iter().map(wave).sum::<f64>())
    }

    /// The triangles of a square, left one first: places of their corners.
    fn triangle(&self, i: usize) -> (usize, [(usize, usize); 3]) {
        let (square, right) = (i / 2, i % 2 == 1);
        let (x, y) = (square / self.rows, square % self.rows);
        let places = if right {
            [(x + 1, y), (x + 1, y + 1), (x, y + 1)]
        } else {
            [(x, y), (x + 1, y), (x, y + 1)]
        };
        (x, places)
    }

    fn corners(&self, i: usize) -> [DVec3; 3] {
        let (column, places) = self.triangle(i);
        places.map(|(x, y)| self.corner(column, x, y))
    }

    fn normal(&self, i: usize) -> DVec3 {
        let [a, b, c] = self.corners(i);
        (b - a).cross(c - a).normalize()
    }

    fn patch(&self, i: usize) -> Patch {
        let [a, b, c] = self.corners(i);
        let area = (b - a).cross(c - a).length() / 2.0;
        let h = BACK * self.normal(i).z;
        let seen_mm2 = self.side * self.side / 2.0;
        let cot = |p: DVec3, q: DVec3, r: DVec3| (q - p).dot(r - p) / (2.0 * area);
        let room = [a, b, c].map(|p| (((BACK - THICK) / p.z).ln(), (BACK / p.z).ln()));
        let unit = |k| [0, 1, 2].map(|j| f64::from(j == k));
        Patch {
            face: FaceId::new(i),
            group: GroupId(u32::from(self.behind(self.triangle(i).0))),
            support: SupportId(0),
            seen_mm2,
            tilt: [cot(a, b, c), cot(b, c, a), cot(c, a, b)]
                .map(|cot| seen_mm2 * h * h * cot / (2.0 * area)),
            room,
            even: (
                room.iter().map(|r| r.0).fold(f64::NEG_INFINITY, f64::max),
                room.iter().map(|r| r.1).fold(f64::INFINITY, f64::min),
            ),
            points: (0..3)
                .map(|k| PatchPoint {
                    weights: unit(k),
                    lower: room[k].0,
                    upper: room[k].1,
                })
                .collect(),
            highest: self.highest,
        }
    }

    /// The seam of two triangles if they have a side in common.
    fn seam(&self, i: usize, j: usize) -> Option<Seam> {
        let ((_, a), (_, b)) = (self.triangle(i), self.triangle(j));
        let common: Vec<(usize, usize)> = (0..3)
            .flat_map(|k| (0..3).map(move |l| (k, l)))
            .filter(|(k, l)| a[*k] == b[*l])
            .collect();
        let &[first, second] = &common[..] else {
            return None;
        };
        let ends = [first, second];
        let unit = |k| [0, 1, 2].map(|j| f64::from(j == k));
        let (at_i, at_j) = (self.corners(i), self.corners(j));
        let line = ends.map(|(k, _)| at_i[k].truncate());
        Some(Seam {
            patches: [PatchId::new(i), PatchId::new(j)],
            ends: ends.map(|(k, l)| [unit(k), unit(l)]),
            gaps: ends.map(|(k, l)| (at_j[l].z / at_i[k].z).ln()),
            length_mm: line[0].distance(line[1]),
            line,
            crease: self.normal(i).angle_between(self.normal(j)),
            free: [f64::INFINITY; 2],
            highest: self.highest,
        })
    }

    fn patches(&self) -> Patches {
        let count = 2 * self.rows * self.columns;
        let near = |i: usize| i + 1..count.min(i + 2 * self.rows + 1);
        Patches {
            patches: (0..count).map(|i| self.patch(i)).collect(),
            of_cell: Vec::new(),
            seams: (0..count)
                .flat_map(|i| near(i).filter_map(move |j| self.seam(i, j)))
                .collect(),
            rims: Vec::new(),
            width: (BACK / (BACK - THICK)).ln(),
            depth: BACK,
            focal: 1.0,
        }
    }
}

fn prices(length: f64, ordered: bool) -> Prices {
    Prices {
        tilt: 1f64.to_radians().powi(-2),
        length,
        height: length / 2.0,
        crease: 0.5,
        ordered,
    }
}

fn start(sheet: &TriangleSheet, patches: &Patches) -> PatchDepths {
    pressed(&patches.patches, |p| {
        sheet.corners(p.face.at()).map(|c| c.z)
    })
}

/// All that the descent can give each patch: the start, and every level in its reach.
fn labels(functional: &Functional, start: &PatchDepths) -> Vec<Vec<[f64; 3]>> {
    let mut labels: Vec<Vec<[f64; 3]>> = start.iter().map(|y| vec![*y]).collect();
    for (i, y) in functional.levels().into_iter().flatten() {
        labels[i].push(y);
    }
    labels
}

/// The least value of the functional over all choices of labels, patch by patch: a table over the labels of those patches
/// that have neighbours still to come.
fn optimum(f: &Functional, labels: &[Vec<[f64; 3]>]) -> f64 {
    let mut open: Vec<usize> = Vec::new();
    let mut table = vec![0.0];
    for (i, own) in labels.iter().enumerate() {
        let sides: Vec<(usize, &Seam)> = f
            .seams
            .iter()
            .filter(|s| s.patches[1].at() == i)
            .map(|s| (s.patches[0].at(), s))
            .collect();
        let mut longer = Vec::with_capacity(table.len() * own.len());
        for (at, before) in table.iter().enumerate() {
            let mut label = vec![0; labels.len()];
            let mut rest = at;
            for j in open.iter().rev() {
                label[*j] = rest % labels[*j].len();
                rest /= labels[*j].len();
            }
            longer.extend(own.iter().map(|y| {
                let seam = |(j, s): &(usize, &Seam)| f.seam(s, &labels[*j][label[*j]], y);
                before + f.unary(OwnPatch::new(i), y) + sides.iter().map(seam).sum::<f64>()
            }));
        }
        (open, table) = ([&open[..], &[i]].concat(), longer);
        let done = |j: usize| {
            let of_j = |s: &&Seam| s.patches[0].at() == j;
            f.seams.iter().filter(of_j).all(|s| s.patches[1].at() <= i)
        };
        while let Some(place) = open.iter().position(|j| done(*j)) {
            let inner: usize = open[place + 1..].iter().map(|j| labels[*j].len()).product();
            let count = labels[open.remove(place)].len();
            let least = |n: usize| {
                let first = n / inner * count * inner + n % inner;
                (0..count)
                    .map(|k| table[first + k * inner])
                    .fold(f64::INFINITY, f64::min)
            };
            table = (0..table.len() / count).map(least).collect();
        }
    }
    table[0]
}

#[test]
fn the_optimum_by_tables_is_that_of_all_choices() {
    let mut lcg = Lcg(7);
    for _ in 0..3 {
        let mut sheet = TriangleSheet::random(&mut lcg);
        (sheet.columns, sheet.rows) = (1, 2);
        let patches = sheet.patches();
        let f = Functional::new(&patches, prices(10.0, true), 0..4);
        let labels = labels(&f, &start(&sheet, &patches));
        let count: usize = labels.iter().map(Vec::len).product();
        let value = |mut n: usize| {
            let mut field = Vec::new();
            for l in &labels {
                field.push(l[n % l.len()]);
                n /= l.len();
            }
            f.value(&field)
        };
        let least = (0..count).map(value).fold(f64::INFINITY, f64::min);
        let found = optimum(&f, &labels);
        assert!(
            (found - least).abs() <= 1e-12 * least,
            "{found} instead of {least}"
        );
    }
}

/// Values of the descent and of the optimum, summed over many sheets, and the number of sheets torn.
fn compared(contours: bool, limited: bool) -> (f64, f64, usize) {
    let mut lcg = Lcg(3);
    let (mut found, mut least, mut torn) = (0.0, 0.0, 0);
    for n in 0..150 {
        let mut sheet = TriangleSheet::random(&mut lcg);
        let price = 3.0 * 100f64.powf(lcg.share());
        let contour = sheet
            .jump
            .unwrap_or((sheet.columns / 2, 6.0 - 12.0 * lcg.share()));
        sheet.jump = contours.then_some(contour);
        sheet.highest = if limited {
            sheet.highest.min(0.8 * THICK / BACK)
        } else {
            f64::INFINITY
        };
        let patches = sheet.patches();
        let f = Functional::new(&patches, prices(price, true), 0..patches.patches.len());
        let mut field = start(&sheet, &patches);
        let labels = labels(&f, &field);
        f.descend(&mut field);
        let (value, optimum) = (f.value(&field), optimum(&f, &labels));
        assert!(
            value >= optimum * (1.0 - 1e-9),
            "sheet {n}: {value} below {optimum}"
        );
        torn += usize::from(f.pieces(&field).iter().any(|p| *p > 0));
        found += value;
        least += optimum;
    }
    (found, least, torn)
}

#[test]
fn the_descent_ends_near_the_optimum() {
    for (contours, limited, most) in [
        (false, false, 1.02),
        (true, false, 1.15),
        (false, true, 1.4),
        (true, true, 1.4),
    ] {
        let (found, least, torn) = compared(contours, limited);
        let ratio = found / least;
        assert!(torn > 60, "too easy: {torn} sheets torn");
        assert!(
            ratio < most,
            "{ratio} with contours {contours}, limits {limited}"
        );
    }
}
