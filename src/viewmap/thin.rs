//! Removes cells too thin to print or to round: short sides are collapsed, flat cells flipped away.
//!
//! Every crossing of two lines that nearly meet leaves slivers far below any printer's resolution. A needle (one short side)
//! loses that side; a cap (three long sides) gives its area to the cell across its longest side. Lines move by less than the
//! given height. Works on the triangulation only: nothing inverts, nothing overlaps, the window stays covered.

use super::arrange::neighbours;
use super::map::{Cell, ViewMap};
use crate::geom::orient;
use crate::index::{CellId, PointId};
use glam::DVec2;

/// Gives every cell a height of at least `height` (image units) where the triangulation allows it.
pub(crate) fn merge_thin(map: &mut ViewMap, height: f64) {
    let mut work = MergeWork::new(map, height);
    work.run();
    let (points, cells) = work.finish();
    map.neighbours = neighbours(&cells);
    map.points = points;
    map.cells = cells;
}

/// Sides up to this many heights are collapsed where neither of the gentler ways is open.
const LAST_RESORT: f64 = 20.0;

struct MergeWork {
    height: f64,
    points: Vec<DVec2>,
    cells: Vec<Option<Cell>>,
    /// Cells around each point, in no particular order.
    around: Vec<Vec<CellId>>,
    /// Corners of the window stay.
    fixed: Vec<bool>,
    queue: std::collections::VecDeque<CellId>,
}

impl MergeWork {
    fn new(map: &ViewMap, height: f64) -> Self {
        let mut around = vec![Vec::new(); map.points.len()];
        for (c, cell) in map.all() {
            cell.corners.iter().for_each(|p| around[*p].push(c));
        }
        let mut fixed = vec![false; map.points.len()];
        for (cell, across) in map.cells.iter().zip(&map.neighbours) {
            for k in (0..3).filter(|k| across[*k].is_none()) {
                fixed[cell.corners[k]] = true;
                fixed[cell.corners[(k + 1) % 3]] = true;
            }
        }
        let cells: Vec<_> = map.cells.iter().copied().map(Some).collect();
        let queue = CellId::all(cells.len()).collect();
        Self {
            height,
            points: map.points.clone(),
            cells,
            around,
            fixed,
            queue,
        }
    }

    fn run(&mut self) {
        // Each step removes two cells or swaps two; the budget only stops two flat cells from swapping for ever.
        let mut budget = 4 * self.cells.len();
        while let Some(c) = self.queue.pop_front() {
            let Some(cell) = self.cells[c].filter(|cell| self.too_thin(cell)) else {
                continue;
            };
            if budget == 0 {
                return;
            }
            budget -= 1;
            let _ = self.collapse_short_side(&cell, 2.0)
                || self.flip_long_side(c, &cell)
                || self.collapse_short_side(&cell, LAST_RESORT);
        }
    }

    fn at(&self, p: PointId) -> DVec2 {
        self.points[p]
    }

    /// Length of the side from corner `k` to the next.
    fn side(&self, cell: &Cell, k: usize) -> f64 {
        self.at(cell.corners[k])
            .distance(self.at(cell.corners[(k + 1) % 3]))
    }

    fn too_thin(&self, cell: &Cell) -> bool {
        let [a, b, c] = cell.corners.map(|p| self.at(p));
        let longest = (0..3).map(|k| self.side(cell, k)).fold(0.0, f64::max);
        orient(a, b, c) < self.height * longest
    }

    fn collapse_short_side(&mut self, cell: &Cell, times: f64) -> bool {
        let k = (0..3)
            .min_by(|i, j| self.side(cell, *i).total_cmp(&self.side(cell, *j)))
            .expect("three sides");
        if self.side(cell, k) > times * self.height {
            return false;
        }
        let (a, b) = (cell.corners[k], cell.corners[(k + 1) % 3]);
        // Points of the input come before crossings: keep the former.
        let (keep, drop) = (a.min(b), a.max(b));
        self.merge(drop, keep) || self.merge(keep, drop)
    }

    /// Moves point `from` onto `to` if no cell turns over and the triangulation stays one.
    fn merge(&mut self, from: PointId, to: PointId) -> bool {
        if self.fixed[from] || self.common_neighbours(from, to) != 2 {
            return false;
        }
        let moved = |cell: &Cell| cell.corners.map(|p| if p == from { to } else { p });
        let (dying, staying): (Vec<CellId>, Vec<CellId>) = self.around[from]
            .iter()
            .partition(|c| self.cell(**c).corners.contains(&to));
        let stays_upright = |c: &CellId| {
            let [a, b, d] = moved(self.cell(*c)).map(|p| self.at(p));
            orient(a, b, d) > 0.0
        };
        if !staying.iter().all(stays_upright) {
            return false;
        }
        for c in dying {
            let corners = self.cell(c).corners;
            corners
                .iter()
                .for_each(|p| self.around[*p].retain(|x| *x != c));
            self.cells[c] = None;
        }
        for c in staying {
            let corners = moved(self.cell(c));
            self.cells[c] = Some(Cell {
                corners,
                ..*self.cell(c)
            });
            self.around[to].push(c);
            self.queue.push_back(c);
        }
        self.around[from].clear();
        true
    }

    fn cell(&self, c: CellId) -> &Cell {
        self.cells[c]
            .as_ref()
            .expect("only live cells are listed around points")
    }

    fn ring(&self, p: PointId) -> Vec<PointId> {
        let mut ring: Vec<PointId> = self.around[p]
            .iter()
            .flat_map(|c| self.cell(*c).corners)
            .filter(|x| *x != p)
            .collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    fn common_neighbours(&self, a: PointId, b: PointId) -> usize {
        let ring = self.ring(b);
        self.ring(a)
            .iter()
            .filter(|x| ring.binary_search(x).is_ok())
            .count()
    }

    /// Replaces the cell and its neighbour across its longest side by two that have the neighbour's label.
    fn flip_long_side(&mut self, c: CellId, cell: &Cell) -> bool {
        let k = (0..3)
            .max_by(|i, j| self.side(cell, *i).total_cmp(&self.side(cell, *j)))
            .expect("three sides");
        let (a, b, v) = (
            cell.corners[k],
            cell.corners[(k + 1) % 3],
            cell.corners[(k + 2) % 3],
        );
        let across = self.around[a]
            .iter()
            .copied()
            .find(|x| *x != c && self.cell(*x).corners.contains(&b));
        let Some(other) = across else { return false };
        let label = *self.cell(other);
        let Some(d) = label.corners.iter().copied().find(|p| *p != a && *p != b) else {
            return false;
        };
        let upright =
            |x: PointId, y: PointId, z: PointId| orient(self.at(x), self.at(y), self.at(z)) > 0.0;
        let better =
            self.thinness([a, d, v]).min(self.thinness([d, b, v])) > self.thinness(cell.corners);
        if !upright(a, d, v) || !upright(d, b, v) || !better {
            return false;
        }
        self.cells[c] = Some(Cell {
            corners: [a, d, v],
            ..label
        });
        self.cells[other] = Some(Cell {
            corners: [d, b, v],
            ..label
        });
        self.around[b].retain(|x| *x != c);
        self.around[d].push(c);
        self.around[a].retain(|x| *x != other);
        self.around[v].push(other);
        self.queue.push_back(c);
        self.queue.push_back(other);
        true
    }

    /// Height over the longest side: flips must make the thinner of two cells less thin, so they cannot go in circles.
    fn thinness(&self, corners: [PointId; 3]) -> f64 {
        let [a, b, c] = corners.map(|p| self.at(p));
        orient(a, b, c) / a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    fn finish(self) -> (Vec<DVec2>, Vec<Cell>) {
        let mut index = vec![None; self.points.len()];
        let mut points = Vec::new();
        let mut cells: Vec<Cell> = self.cells.into_iter().flatten().collect();
        for corner in cells.iter_mut().flat_map(|c| &mut c.corners) {
            *corner = *index[*corner].get_or_insert_with(|| {
                points.push(self.points[*corner]);
                PointId::new(points.len() - 1)
            });
        }
        (points, cells)
    }
}
