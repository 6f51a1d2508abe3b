//! Polygons with many corners cut into triangles: those of OBJ and PLY files, and the outlines of a scene's supports.
//!
//! Takes any closed chain of points in space, flat or not, convex or not; gives `n - 2` triangles for `n` corners,
//! wound as the polygon. Corners at the same place and crossing outlines give useless triangles, never a failure.
//! Ears are clipped; the two entrances differ only in which ear comes next.

use crate::mesh::turns::turn2;
use glam::{DVec2, DVec3};

/// Work beyond which a concave polygon is cut as if it were convex instead of clipped (corners times reflex corners): a second or so.
const MAX_WORK: usize = 200_000_000;

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
    if n == 3 || reflex.is_empty() || n.saturating_mul(reflex.len()) > MAX_WORK {
        return halve(n);
    }
    clip_ears(&outline, reflex, Next::Onward)
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
    clip_ears(&outline, outline.reflex(), Next::Lowest)
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

    /// Positive for a left turn.
    fn turn(&self, a: usize, b: usize, c: usize) -> f64 {
        self.sign * turn2(self.axis, self.points[a], self.points[b], self.points[c])
    }

    fn holds(&self, [a, b, c]: [usize; 3], p: usize) -> bool {
        self.turn(a, b, p) >= 0.0 && self.turn(b, c, p) >= 0.0 && self.turn(c, a, p) >= 0.0
    }
}

/// Ear clipping on a ring list: only reflex corners can lie in an ear.
fn clip_ears(outline: &Outline, mut reflex: Vec<usize>, rule: Next) -> Vec<[usize; 3]> {
    let n = outline.points.len();
    let mut next: Vec<usize> = (0..n).map(|k| (k + 1) % n).collect();
    let mut previous: Vec<usize> = (0..n).map(|k| (k + n - 1) % n).collect();
    let mut triangles = Vec::with_capacity(n - 2);
    let (mut corner, mut left, mut tried) = (0, n, 0);
    let mut lowest = 0;
    while left > 3 {
        let ear = [previous[corner], corner, next[corner]];
        // After a full round without an ear the outline crosses itself: cut anyway, to end.
        if tried > left || is_ear(outline, ear, &reflex) {
            triangles.push(ear);
            next[ear[0]] = ear[2];
            previous[ear[2]] = ear[0];
            left -= 1;
            tried = 0;
            reflex.retain(|&k| k != corner && outline.turn(previous[k], k, next[k]) <= 0.0);
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

fn is_ear(outline: &Outline, ear: [usize; 3], reflex: &[usize]) -> bool {
    let [a, b, c] = ear;
    outline.turn(a, b, c) > 0.0
        && reflex.iter().all(|&k| {
            ear.contains(&k)
                || ear.iter().any(|&e| outline.points[e] == outline.points[k])
                || !outline.holds(ear, k)
        })
}
