//! Coats: many small overlapping tiles (feathers, fish scales, fur locks) or cells (skin pebbles, shell scutes) laid on a
//! base surface. A coat gives the height in millimetres by which the base is raised at a point.

use crate::field::{Field, gradient, scramble, settle, step, v};
use glam::DVec3;

/// One tile: rooted at `root`, growing along the unit tangent `along`, `side` across it, `out` away from the surface.
pub(crate) struct Tile {
    pub root: DVec3,
    along: DVec3,
    side: DVec3,
    out: DVec3,
    /// Root to tip, mm.
    pub length: f64,
    /// Half width, mm.
    pub half: f64,
    /// Height of the tip above the base, mm.
    pub lift: f64,
}

impl Tile {
    /// Tile on the surface of `base` at `root`, growing along `flow` (any vector; its tangential part counts).
    pub(crate) fn on(base: &Field, root: DVec3, flow: DVec3, size: [f64; 3]) -> Tile {
        let out = gradient(base, root).normalize_or(DVec3::Z);
        let along = (flow - out * flow.dot(out)).normalize_or(out.any_orthonormal_vector());
        let [length, half, lift] = size;
        Tile {
            root,
            along,
            side: out.cross(along),
            out,
            length,
            half,
            lift,
        }
    }

    /// Position of `p` relative to the tile: along, across and above it, mm.
    fn local(&self, p: DVec3) -> DVec3 {
        let d = p - self.root;
        v(d.dot(self.along), d.dot(self.side), d.dot(self.out))
    }
}

/// Outline and relief of the tiles of one coat.
#[derive(Clone, Copy)]
pub(crate) struct Shape {
    /// Where the tip begins to round, share of the length: 0.3 gives a leaf, 0.7 a rounded bar.
    pub shoulder: f64,
    /// Exponent of the outline at the tip: 2 round, towards 1 pointed.
    pub point: f64,
    /// Width over which the edge falls to the tile below, mm. Below about 0.7 mm the mesh can no longer show it cleanly.
    pub edge: f64,
    /// Height of the bulge across the tile, mm.
    pub crown: f64,
    /// Height of the quill along the middle, mm.
    pub quill: f64,
}

/// Tiles in a grid of cubic cells, so that a query looks at its own cell only.
pub(crate) struct Coat {
    tiles: Vec<Tile>,
    shape: Shape,
    cells: Cells,
}

impl Coat {
    /// Coat of `tiles`, all of one `shape`.
    pub(crate) fn new(tiles: Vec<Tile>, shape: Shape) -> Coat {
        let balls: Vec<(DVec3, f64)> = tiles
            .iter()
            .map(|t| (t.root + t.along * (0.4 * t.length), 0.7 * t.length + t.half))
            .collect();
        Coat {
            cells: Cells::new(&balls, 3.0),
            tiles,
            shape,
        }
    }

    /// Height of the coat at `p`, mm; 0 where no tile reaches.
    pub(crate) fn height(&self, p: DVec3) -> f64 {
        let mut top: f64 = 0.0;
        for &i in self.cells.at(p) {
            let h = self.tile_height(&self.tiles[i as usize], p);
            // The blend shrinks with the lower tile, so that a tile fading in never raises its neighbour by a jump.
            let k = (2.0 * top.min(h)).min(0.5);
            top = if k > 1e-6 {
                crate::field::meet(top, h, k)
            } else {
                top.max(h)
            };
        }
        top
    }

    fn tile_height(&self, tile: &Tile, p: DVec3) -> f64 {
        let q = tile.local(p);
        let reach = tile.length + tile.half;
        if q.y.abs() > tile.half || q.x > tile.length || q.z.abs() > 0.6 * reach {
            return 0.0;
        }
        let s = q.x / tile.length;
        let across = q.y / tile.half;
        let beyond = ((s - self.shape.shoulder) / (1.0 - self.shape.shoulder)).max(0.0);
        let r = (across.abs().powi(2) + beyond.powf(self.shape.point)).sqrt();
        let within = (1.0 - r) * tile.half;
        if within <= 0.0 || s < -0.35 {
            return 0.0;
        }
        let rim = step(0.0, self.shape.edge.min(0.8 * tile.half), within);
        let root = step(-0.35, 0.1, s);
        let slope = 0.3 + 0.7 * s.max(0.0);
        let crown = self.shape.crown * (1.0 - across * across);
        let quill = self.shape.quill * (-(q.y / 0.45).powi(2)).exp();
        (tile.lift * slope + (crown + quill) * root) * rim * root
    }
}

/// Cells around seeds: the relief depends on the distance to the border between neighbouring seeds.
pub(crate) struct Mosaic {
    seeds: Vec<DVec3>,
    cells: Cells,
}

impl Mosaic {
    /// Mosaic of `seeds`; a query sees those within `reach` mm.
    pub(crate) fn new(seeds: Vec<DVec3>, reach: f64) -> Mosaic {
        let balls: Vec<(DVec3, f64)> = seeds.iter().map(|&s| (s, reach)).collect();
        Mosaic {
            cells: Cells::new(&balls, 3.0),
            seeds,
        }
    }

    /// Distance from `p` to the border of its cell, mm, with corners rounded over `soft` mm, and the cell's seed.
    pub(crate) fn border(&self, p: DVec3, soft: f64) -> Option<(f64, usize)> {
        let near = self.cells.at(p);
        let nearest = *near.iter().min_by(|&&a, &&b| {
            let d = |i: u32| self.seeds[i as usize].distance_squared(p);
            d(a).total_cmp(&d(b))
        })?;
        let own = self.seeds[nearest as usize];
        let mut border = f64::INFINITY;
        for &i in near.iter().filter(|&&i| i != nearest) {
            let other = self.seeds[i as usize];
            let d = ((own + other) * 0.5 - p).dot((other - own).normalize_or_zero());
            border = crate::field::join(border, d, soft);
        }
        border.is_finite().then_some((border, nearest as usize))
    }

    /// Pebbled skin: every cell bulges by `height` mm, with grooves `groove` mm wide on each side of a border.
    pub(crate) fn pebbles(&self, p: DVec3, height: f64, groove: f64) -> f64 {
        self.border(p, 0.3)
            .map_or(0.0, |(d, _)| height * step(-0.15, groove, d))
    }
}

/// Indices of balls by cubic cell.
struct Cells {
    low: DVec3,
    pitch: f64,
    dims: [usize; 3],
    lists: Vec<Vec<u32>>,
}

impl Cells {
    fn new(balls: &[(DVec3, f64)], pitch: f64) -> Cells {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for &(c, r) in balls {
            low = low.min(c - r);
            high = high.max(c + r);
        }
        if balls.is_empty() {
            (low, high) = (DVec3::ZERO, DVec3::ZERO);
        }
        let dims = ((high - low) / pitch)
            .ceil()
            .max(DVec3::ONE)
            .to_array()
            .map(|n| n as usize);
        let mut cells = Cells {
            low,
            pitch,
            dims,
            lists: vec![Vec::new(); dims.iter().product()],
        };
        for (i, &(c, r)) in balls.iter().enumerate() {
            cells.insert(i as u32, c, r);
        }
        cells
    }

    fn insert(&mut self, i: u32, c: DVec3, r: f64) {
        let span = |axis: usize| {
            let at = |x: f64| ((x - self.low[axis]) / self.pitch).floor().max(0.0) as usize;
            at(c[axis] - r)..=at(c[axis] + r).min(self.dims[axis] - 1)
        };
        for z in span(2) {
            for y in span(1) {
                for x in span(0) {
                    let low = self.low + v(x as f64, y as f64, z as f64) * self.pitch;
                    if c.distance(c.clamp(low, low + self.pitch)) <= r {
                        self.lists[(z * self.dims[1] + y) * self.dims[0] + x].push(i);
                    }
                }
            }
        }
    }

    fn at(&self, p: DVec3) -> &[u32] {
        let q = (p - self.low) / self.pitch;
        if q.min_element() < 0.0 {
            return &[];
        }
        let [x, y, z] = q.to_array().map(|n| n as usize);
        if x >= self.dims[0] || y >= self.dims[1] || z >= self.dims[2] {
            return &[];
        }
        &self.lists[(z * self.dims[1] + y) * self.dims[0] + x]
    }
}

/// Points scattered evenly over the surface of `base` inside the box `low..high`; `gap` gives the distance to keep from
/// other points in mm, or `None` where no point is wanted.
pub(crate) fn scatter(
    base: &Field,
    low: DVec3,
    high: DVec3,
    gap: &dyn Fn(DVec3) -> Option<f64>,
) -> Vec<DVec3> {
    // Candidates: a jittered 1 mm lattice near the surface, taken in a shuffled order.
    let n = ((high - low) / 1.0).ceil();
    let mut candidates: Vec<(f64, DVec3)> = Vec::new();
    for k in 0..n.z as i64 {
        for j in 0..n.y as i64 {
            for i in 0..n.x as i64 {
                let jitter = v(
                    scramble(i, j, k),
                    scramble(i, j, k + 999),
                    scramble(i, j, k - 999),
                );
                let p = low + v(i as f64, j as f64, k as f64) + jitter;
                if base(p).abs() < 1.0 {
                    let p = settle(base, p, 4, 1.0);
                    candidates.push((scramble(i + 77, j, k), p));
                }
            }
        }
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(DVec3, f64)> = Vec::new();
    for (_, p) in candidates {
        if let Some(r) = gap(p) {
            let free = kept
                .iter()
                .all(|(q, s)| p.distance_squared(*q) > (r.min(*s)).powi(2));
            if free {
                kept.push((p, r));
            }
        }
    }
    kept.into_iter().map(|(p, _)| p).collect()
}
