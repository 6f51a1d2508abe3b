//! Polygons with many corners cut into triangles: those of OBJ and PLY files, and the outlines of a scene's supports.
//!
//! Takes any closed chain of points in space, flat or not, convex or not; gives `n - 2` triangles for `n` corners,
//! wound as the polygon. Corners at the same place and crossing outlines give useless triangles, never a failure.
//! Ears are clipped; the two entrances differ only in which ear comes next.

use crate::mesh::turns::turn2;
use glam::{DVec2, DVec3};

/// Corners and cells looked at beyond which ears are cut off as they come, whatever lies in them: some seconds. Outlines that wind
/// around themselves thousands of times get there, a comb of a million teeth does not.
const MAX_WORK: usize = 400_000_000;

/// Which ear is clipped next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// The first at or after the corner before the last one: every corner is looked at some few times.
    Onward,
    /// The lowest corner that is one: fans where an outline is convex, and a search from the start for every triangle.
    Lowest,
}

/// Triangles of corner numbers `0 .. points.len()`, in any time that a file of any size can be given.
pub fn triangulate(points: &[DVec3]) -> Vec<[usize; 3]> {
    let n = points.len();
    if n < 3 {
        return Vec::new();
    }
    let outline = Outline::new(points);
    let reflex = outline.reflex();
    if n == 3 || reflex.is_empty() {
        return halve(n);
    }
    clip_ears(&outline, &reflex, Next::Onward)
}

/// Triangles of a simple polygon in the ground plane that turns counter-clockwise, of at most some thousand corners. The caps of a
/// scene's prisms are cut this way: no point of theirs is far from the others, and printed files keep their bytes.
pub fn triangulate_outline(polygon: &[DVec2]) -> Vec<[usize; 3]> {
    let points: Vec<DVec3> = polygon.iter().map(|p| p.extend(0.0)).collect();
    let outline = Outline {
        points: &points,
        axis: 2,
        sign: 1.0,
    };
    clip_ears(&outline, &outline.reflex(), Next::Lowest)
}

/// Triangles of a convex polygon by halving its outline: a fan of a large one would be all needles in one corner.
fn halve(n: usize) -> Vec<[usize; 3]> {
    let mut triangles = Vec::with_capacity(n - 2);
    let mut chains = vec![(0, n - 1)];
    while let Some((first, last)) = chains.pop() {
        let middle = (first + last).div_ceil(2);
        triangles.push([first, middle, last]);
        chains.extend(
            [(first, middle), (middle, last)]
                .into_iter()
                .filter(|(a, b)| b - a > 1),
        );
    }
    triangles
}

/// A polygon seen along the axis nearest to its normal, so that it turns counter-clockwise.
struct Outline<'a> {
    points: &'a [DVec3],
    axis: usize,
    sign: f64,
}

impl<'a> Outline<'a> {
    fn new(points: &'a [DVec3]) -> Self {
        let origin = points[0];
        let normal: DVec3 = points
            .windows(2)
            .map(|p| (p[0] - origin).cross(p[1] - origin))
            .sum();
        let axis = normal.abs().max_position();
        Self {
            points,
            axis,
            sign: normal[axis].signum(),
        }
    }

    /// Corners at which it does not turn left.
    fn reflex(&self) -> Vec<usize> {
        let n = self.points.len();
        let reflex = |k: &usize| self.turn((k + n - 1) % n, *k, (k + 1) % n) <= 0.0;
        (0..n).filter(reflex).collect()
    }

    /// A corner as seen along the axis.
    fn flat(&self, k: usize) -> DVec2 {
        let p = self.points[k];
        DVec2::new(p[(self.axis + 1) % 3], p[(self.axis + 2) % 3])
    }

    /// Positive for a left turn.
    fn turn(&self, a: usize, b: usize, c: usize) -> f64 {
        self.sign * turn2(self.axis, self.points[a], self.points[b], self.points[c])
    }

    fn holds(&self, [a, b, c]: [usize; 3], p: usize) -> bool {
        self.turn(a, b, p) >= 0.0 && self.turn(b, c, p) >= 0.0 && self.turn(c, a, p) >= 0.0
    }
}

/// Ear clipping on a ring list: only reflex corners can lie in an ear.
fn clip_ears(outline: &Outline, reflex: &[usize], rule: Next) -> Vec<[usize; 3]> {
    let n = outline.points.len();
    let mut next: Vec<usize> = (0..n).map(|k| (k + 1) % n).collect();
    let mut previous: Vec<usize> = (0..n).map(|k| (k + n - 1) % n).collect();
    let mut triangles = Vec::with_capacity(n - 2);
    let (mut corner, mut left, mut tried) = (0, n, 0);
    let mut lowest = 0;
    let mut reflex = Reflex::new(outline, reflex);
    while left > 3 {
        let ear = [previous[corner], corner, next[corner]];
        // After a full round without an ear the outline crosses itself: cut anyway, to end.
        if tried > left || reflex.work > MAX_WORK || reflex.leaves_free(outline, ear) {
            triangles.push(ear);
            next[ear[0]] = ear[2];
            previous[ear[2]] = ear[0];
            left -= 1;
            tried = 0;
            reflex.is_one[corner] = false;
            // Corners turn left once they do: only those that did not are looked at again.
            for k in [ear[0], ear[2]] {
                reflex.is_one[k] &= outline.turn(previous[k], k, next[k]) <= 0.0;
            }
            if corner == lowest {
                lowest = ear[2];
            }
            corner = match rule {
                Next::Onward => ear[0],
                Next::Lowest => lowest,
            };
        } else {
            tried += 1;
            corner = next[corner];
        }
    }
    let first = match rule {
        Next::Onward => previous[corner],
        Next::Lowest => lowest,
    };
    triangles.push([first, next[first], next[next[first]]]);
    triangles
}

/// The corners at which the outline does not turn left, in square cells over the plane that it is seen in.
struct Reflex {
    /// Of every corner.
    is_one: Vec<bool>,
    /// Corners cell by cell, and where each cell begins.
    corners: Vec<usize>,
    starts: Vec<usize>,
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Corners and cells looked at so far.
    work: usize,
}

impl Reflex {
    fn new(outline: &Outline, reflex: &[usize]) -> Self {
        let mut is_one = vec![false; outline.points.len()];
        reflex.iter().for_each(|k| is_one[*k] = true);
        let flat = |k: &usize| outline.flat(*k);
        let far = DVec2::splat(f64::INFINITY);
        let low = reflex.iter().map(flat).fold(far, DVec2::min);
        let high = reflex.iter().map(flat).fold(-far, DVec2::max);
        let side = (high - low).max_element();
        let across = (reflex.len() as f64).sqrt().ceil().max(1.0);
        // Of no extent: one cell holds all.
        let cell = if side > 0.0 { side / across } else { 1.0 };
        let count = |extent: f64| (extent / cell).floor() as usize + 1;
        let size = (high - low).max(DVec2::ZERO);
        let mut found = Self {
            is_one,
            corners: Vec::new(),
            starts: Vec::new(),
            low,
            cell,
            columns: count(size.x),
            rows: count(size.y),
            work: 0,
        };
        let home = |k: &usize| {
            let [x, y] = found.cell_at(outline.flat(*k));
            y * found.columns + x
        };
        let mut placed: Vec<(usize, usize)> = reflex.iter().map(|k| (home(k), *k)).collect();
        placed.sort_unstable();
        let cells = found.columns * found.rows;
        let mut starts = vec![0; cells + 1];
        placed.iter().for_each(|(home, _)| starts[home + 1] += 1);
        for c in 0..cells {
            starts[c + 1] += starts[c];
        }
        found.starts = starts;
        found.corners = placed.into_iter().map(|(_, k)| k).collect();
        found
    }

    /// Column and row of the cell that is nearest to a point.
    fn cell_at(&self, p: DVec2) -> [usize; 2] {
        let place = (p - self.low) / self.cell;
        [
            (place.x.max(0.0) as usize).min(self.columns - 1),
            (place.y.max(0.0) as usize).min(self.rows - 1),
        ]
    }

    /// First and last column of a row that a triangle meets, and one more to both sides for what rounding moves.
    fn columns_in_row(&self, triangle: [DVec2; 3], row: usize) -> Option<[usize; 2]> {
        let bottom = self.low.y + (row as f64 - 1e-3) * self.cell;
        let top = bottom + (1.0 + 2e-3) * self.cell;
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..3 {
            let (p, q) = (triangle[k], triangle[(k + 1) % 3]);
            let (p, q) = if p.y <= q.y { (p, q) } else { (q, p) };
            if q.y < bottom || p.y > top {
                continue;
            }
            let rise = q.y - p.y;
            let at = |y: f64| p.x + (q.x - p.x) * ((y - p.y) / rise).clamp(0.0, 1.0);
            let ends = if rise > 0.0 {
                [at(bottom), at(top)]
            } else {
                [p.x, q.x]
            };
            for x in ends {
                least = least.min(x);
                most = most.max(x);
            }
        }
        if least > most {
            return None;
        }
        let [x0, _] = self.cell_at(DVec2::new(least, self.low.y));
        let [x1, _] = self.cell_at(DVec2::new(most, self.low.y));
        Some([x0.saturating_sub(1), (x1 + 1).min(self.columns - 1)])
    }

    /// Whether a corner with its neighbours is an ear: it turns left, and nothing of the outline lies in it.
    fn leaves_free(&mut self, outline: &Outline, ear: [usize; 3]) -> bool {
        let [a, b, c] = ear;
        if outline.turn(a, b, c) <= 0.0 {
            return false;
        }
        let flat = ear.map(|k| outline.flat(k));
        let [_, y0] = self.cell_at(flat[0].min(flat[1]).min(flat[2]));
        let [_, y1] = self.cell_at(flat[0].max(flat[1]).max(flat[2]));
        for y in y0..=y1 {
            let Some([x0, x1]) = self.columns_in_row(flat, y) else {
                continue;
            };
            // The cells of a row follow each other.
            let row = y * self.columns;
            let inside = &self.corners[self.starts[row + x0]..self.starts[row + x1 + 1]];
            self.work += 1 + inside.len();
            let lies_in_it = |k: &usize| {
                self.is_one[*k]
                    && !ear.contains(k)
                    && !ear.iter().any(|&e| outline.points[e] == outline.points[*k])
                    && outline.holds(ear, *k)
            };
            if inside.iter().any(lies_in_it) {
                return false;
            }
        }
        true
    }
}
