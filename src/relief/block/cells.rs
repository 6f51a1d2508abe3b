//! The cells of a block with their corner depths, and the fans that hang together around their points.

use crate::geom::ImagePlane;
use crate::index::{CellId, PointId, indices};
use crate::viewmap::ViewMap;
use glam::DVec2;

indices! {
    /// A cell of a block, in contrast to one of its view map.
    LocalId
    /// A fan of a block.
    FanId
}

/// A corner of a cell: the cell, and which of its three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellCorner {
    pub cell: LocalId,
    pub k: usize,
}

/// The cells around a point that hang together through shared sides, counter-clockwise.
pub(crate) struct Fan {
    pub q: DVec2,
    pub corners: Vec<CellCorner>,
    /// Whether they close a full circle.
    pub closed: bool,
}

/// See the module. Lists by cell have three entries, one for every corner, or side from corner `k` to the next.
pub(crate) struct BlockCells {
    pub plane: ImagePlane,
    pub in_map: Vec<CellId>,
    points: Vec<[PointId; 3]>,
    pub depth: Vec<[f64; 3]>,
    pub neighbours: Vec<[Option<LocalId>; 3]>,
    pub fans: Vec<Fan>,
    pub fan_of: Vec<[FanId; 3]>,
}

impl BlockCells {
    /// `cells` rise; each has depths.
    pub(crate) fn new(map: &ViewMap, cells: &[CellId], depth: &[Option<[f64; 3]>]) -> Self {
        let local = |c: CellId| cells.binary_search(&c).ok().map(LocalId::new);
        let neighbours = cells.iter().map(|c| map.neighbours[*c].map(|n| local(n?)));
        let depth = cells
            .iter()
            .map(|c| depth[*c].expect("only cells with depths are kept"));
        let mut block = Self {
            plane: map.plane,
            in_map: cells.to_vec(),
            points: cells.iter().map(|c| map.cells[*c].corners).collect(),
            depth: depth.collect(),
            neighbours: neighbours.collect(),
            fans: Vec::new(),
            fan_of: Vec::new(),
        };
        block.gather_fans(map);
        block
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = LocalId> + use<> {
        LocalId::all(self.in_map.len())
    }

    /// All sides, by cell and corner.
    pub(crate) fn sides(&self) -> impl Iterator<Item = CellCorner> + use<> {
        self.all()
            .flat_map(|cell| (0..3).map(move |k| CellCorner { cell, k }))
    }

    pub(crate) fn point(&self, at: CellCorner) -> PointId {
        self.points[at.cell][at.k]
    }

    pub(crate) fn points_of(&self, cell: LocalId) -> [PointId; 3] {
        self.points[cell]
    }

    pub(crate) fn depth_at(&self, at: CellCorner) -> f64 {
        self.depth[at.cell][at.k]
    }

    pub(crate) fn fan_at(&self, at: CellCorner) -> FanId {
        self.fan_of[at.cell][at.k]
    }

    pub(crate) fn across(&self, side: CellCorner) -> Option<LocalId> {
        self.neighbours[side.cell][side.k]
    }

    /// Both fans at the ends of a side.
    pub(crate) fn ends(&self, side: CellCorner) -> [FanId; 2] {
        let fans = self.fan_of[side.cell];
        [fans[side.k], fans[(side.k + 1) % 3]]
    }

    /// Depths around a fan.
    pub(crate) fn fan_depths(&self, f: FanId) -> Vec<f64> {
        let corners = self.fans[f].corners.iter();
        corners.map(|at| self.depth_at(*at)).collect()
    }

    /// The corner at the same point in the next cell counter-clockwise (`side` 2) or clockwise (`side` 0).
    fn turn(&self, at: CellCorner, side: usize) -> Option<CellCorner> {
        let cell = self.neighbours[at.cell][(at.k + side) % 3]?;
        let point = self.point(at);
        let k = self.points[cell].iter().position(|p| *p == point)?;
        Some(CellCorner { cell, k })
    }

    fn gather_fans(&mut self, map: &ViewMap) {
        let mut found: Vec<[Option<FanId>; 3]> = vec![[None; 3]; self.in_map.len()];
        for at in self.sides() {
            if found[at.cell][at.k].is_some() {
                continue;
            }
            let mut first = at;
            while let Some(before) = self.turn(first, 0).filter(|b| *b != at) {
                first = before;
            }
            let closed = self.turn(first, 0).is_some();
            let start = if closed { at } else { first };
            let mut corners = vec![start];
            while let Some(next) = self
                .turn(corners[corners.len() - 1], 2)
                .filter(|n| *n != start)
            {
                corners.push(next);
            }
            let id = FanId::new(self.fans.len());
            corners
                .iter()
                .for_each(|at| found[at.cell][at.k] = Some(id));
            self.fans.push(Fan {
                q: map.points[self.point(at)],
                corners,
                closed,
            });
        }
        let all = |fans: [Option<FanId>; 3]| fans.map(|f| f.expect("every corner is in a fan"));
        self.fan_of = found.into_iter().map(all).collect();
    }
}
