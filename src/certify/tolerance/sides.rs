//! Sides of a view map at which an eye that moves sees its pieces part, and the worst of them that is more than a speck.

use super::rift::{Rift, parting};
use crate::geom::{ImagePlane, parallax};
use crate::groups::anchor;
use crate::index::{CellId, PointId, SupportId};
use crate::mesh::DisjointSets;
use crate::relief::Relief;
use crate::viewmap::{Target, ViewMap};
use glam::DVec3;

/// Sides that open by less for each millimetre of movement are left out, 1/mm: they would take an eye hundreds of metres.
const LEAST: f64 = 1e-9;

/// The same of any eye.
pub(crate) fn least(plane: &ImagePlane) -> f64 {
    LEAST / (plane.focal * plane.focal)
}

/// See the module.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CutSide {
    /// Image points of its ends.
    points: [PointId; 2],
    /// Of the cells on both sides.
    pub supports: [SupportId; 2],
    /// Directions of the ends, one long along the forward axis, and unit ones.
    rays: [DVec3; 2],
    ends: [DVec3; 2],
    /// Unit normal of the plane through eye and side.
    pub normal: DVec3,
    /// Distances from the eye, millimetres: at both ends, of both cells' reliefs and faces.
    relief: [[f64; 2]; 2],
    model: [[f64; 2]; 2],
}

impl CutSide {
    /// By how much more the relief parts than the model at the worse end, radians for each millimetre that an eye `back`
    /// millimetres farther away moves square to the side.
    pub(crate) fn excess(&self, back: f64) -> f64 {
        self.beyond_the_model(|_, [a, b]| parallax(a + back, b + back))
    }

    /// The same for an eye that moves by `e`: radians, exactly.
    pub(crate) fn opening(&self, e: DVec3) -> f64 {
        self.beyond_the_model(|end, distances| parting(end, self.normal, distances, e))
    }

    /// The larger excess at the two ends (unit directions) of what `parted` gives for two distances there.
    fn beyond_the_model(&self, parted: impl Fn(DVec3, [f64; 2]) -> f64) -> f64 {
        let at = |k: usize| {
            let of = |distances| parted(self.ends[k], distances);
            let (relief, model) = (of(self.relief[k]), of(self.model[k]));
            // Only what the model opens in the same order is the model's own.
            let own = (model * relief.signum()).max(0.0);
            (relief.abs() - own).max(0.0)
        };
        at(0).max(at(1))
    }

    pub(crate) fn nearest(&self) -> f64 {
        let all = self.relief.iter().flatten();
        all.copied().fold(f64::INFINITY, f64::min)
    }

    /// In the middle of the side.
    pub(crate) fn cut(&self) -> Rift {
        let middle = (self.rays[0] + self.rays[1]) / 2.0;
        // Depths along the forward axis are harmonic along the side.
        let nearness = |k: usize, cell: usize| self.rays[k].length() / self.relief[k][cell];
        let [a, b] =
            [0, 1].map(|cell| 2.0 * middle.length() / (nearness(0, cell) + nearness(1, cell)));
        Rift {
            direction: middle.normalize(),
            normal: self.normal,
            distances: [a.min(b), a.max(b)],
        }
    }

    /// Radians.
    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }
}

/// All sides between two cells with reliefs that open at all, in the order of the cells.
pub(crate) fn sides(map: &ViewMap, target: &Target, relief: &Relief) -> Vec<CutSide> {
    let mut sides = Vec::new();
    let least = least(&map.plane);
    for c in CellId::all(map.cells.len()) {
        for k in 0..3 {
            let next = map.neighbours[c][k].filter(|n| *n > c);
            let side = next.and_then(|n| side(map, target, relief, [c, n], k));
            sides.extend(side.filter(|s| s.excess(0.0) > least));
        }
    }
    sides
}

fn side(
    map: &ViewMap,
    target: &Target,
    relief: &Relief,
    cells: [CellId; 2],
    k: usize,
) -> Option<CutSide> {
    let corners = map.cells[cells[0]].corners;
    let points = [corners[k], corners[(k + 1) % 3]];
    let rays = points.map(|p| map.plane.direction(map.points[p]));
    let ends = rays.map(DVec3::normalize);
    let (mut of_relief, mut of_model) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
    let mut supports = [SupportId(0); 2];
    for (i, c) in cells.into_iter().enumerate() {
        let cell = &map.cells[c];
        let depth = relief.depth[c]?;
        supports[i] = cell.support?;
        for (end, point) in points.iter().enumerate() {
            let corner = cell.corners.iter().position(|p| p == point)?;
            let (_, model) = anchor(target, cell.face?, map.points[*point]);
            of_relief[end][i] = depth[corner] * rays[end].length();
            of_model[end][i] = model * rays[end].length();
        }
    }
    Some(CutSide {
        points,
        supports,
        rays,
        ends,
        normal: ends[0].cross(ends[1]).try_normalize()?,
        relief: of_relief,
        model: of_model,
    })
}

/// Where an opening becomes more than a speck.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Critical {
    /// Of opening, as `rate` gives it.
    pub rate: f64,
    /// The longest side of that rate or more in the cut.
    pub side: usize,
}

/// The largest rate at which sides of that rate or more hang together over `extent` radians. Sides are joined at shared points
/// (indices below `points`), steepest first, until a cut is long enough.
pub(crate) fn critical(
    sides: &[CutSide],
    points: usize,
    rate: impl Fn(&CutSide) -> f64,
    extent: f64,
) -> Option<Critical> {
    let mut order: Vec<(f64, usize)> = sides.iter().map(rate).zip(0..).collect();
    order.retain(|(rate, _)| *rate > 0.0);
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut sets = DisjointSets::new(points);
    let mut boxes = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); points];
    for (n, (rate, i)) in order.iter().enumerate() {
        let side = &sides[*i];
        let roots = side.points.map(|p| PointId(sets.root(p.0)));
        let [a, b] = side.ends;
        let grown = roots.map(|r| boxes[r]);
        let lo = grown[0].0.min(grown[1].0).min(a.min(b));
        let hi = grown[0].1.max(grown[1].1).max(a.max(b));
        sets.join(roots[0].0, roots[1].0);
        let root = PointId(sets.root(roots[0].0));
        boxes[root] = (lo, hi);
        if (hi - lo).length() >= extent {
            let of_cut = order[..=n].iter().map(|o| o.1);
            let of_cut = of_cut.filter(|i| sets.root(sides[*i].points[0].0) == root.0);
            let longest = of_cut.max_by(|i, j| sides[*i].length().total_cmp(&sides[*j].length()));
            return longest.map(|side| Critical { rate: *rate, side });
        }
    }
    None
}
