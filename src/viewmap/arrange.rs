//! The arrangement itself: a constrained Delaunay triangulation split at crossings. The only module that names `spade`.

use super::map::{self, ViewMap, ViewMapError};
use super::outline::Segment;
use super::target::Target;
use crate::geom::ImagePlane;
use crate::index::{CellId, PointId, VertexId};
use crate::mesh::{TriMesh, face_neighbours};
use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Snapping grids tried in turn, as shares of the window: `spade` can fail on points 1e-9 apart, and then a coarser grid helps.
pub const GRIDS: [f64; 3] = [
    1.0 / (1u64 << 26) as f64,
    1.0 / (1u64 << 23) as f64,
    1.0 / (1u64 << 20) as f64,
];

/// Triangulates the window with the edges of the wanted faces and the outlines as constraints. Labels are left empty.
pub(crate) fn arrange(
    plane: &ImagePlane,
    target: &Target,
    wanted: &[bool],
    outlines: &[Segment],
) -> Result<ViewMap, ViewMapError> {
    let segments = segments(target, wanted, outlines);
    let (lo, hi) = target.image_box();
    let reached = Cell::new(0);
    for (rung, grid) in GRIDS.into_iter().enumerate() {
        let snap = Snap {
            origin: lo,
            step: (hi - lo).max_element() * grid,
        };
        // Last resort against a panic of the triangulation on degenerate input: the next grid, then an error.
        let run = || triangulate(&segments, (lo, hi), &snap, &reached);
        if let Ok(Ok((points, cells))) = catch_unwind(AssertUnwindSafe(run)) {
            let neighbours = neighbours(&cells);
            return Ok(ViewMap {
                plane: *plane,
                points,
                cells,
                neighbours,
                doubtful_sr: 0.0,
                grid: rung,
            });
        }
    }
    let [a, b] = segments.get(reached.get()).copied().unwrap_or([lo, hi]);
    Err(ViewMapError::Triangulation((a + b) / 2.0))
}

/// Edges of wanted faces, each once, then the outlines.
fn segments(target: &Target, wanted: &[bool], outlines: &[Segment]) -> Vec<Segment> {
    let mut pairs: Vec<(VertexId, VertexId)> = Vec::new();
    for (face, _) in target.mesh.faces.iter().zip(wanted).filter(|(_, w)| **w) {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            pairs.push((a.min(b), a.max(b)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let image = |v: VertexId| target.image[v];
    pairs
        .iter()
        .map(|&(a, b)| [image(a), image(b)])
        .chain(outlines.iter().copied())
        .collect()
}

struct Snap {
    origin: DVec2,
    step: f64,
}

impl Snap {
    fn key(&self, q: DVec2) -> (i64, i64) {
        let k = ((q - self.origin) / self.step).round();
        (k.x as i64, k.y as i64)
    }

    fn point(&self, key: (i64, i64)) -> DVec2 {
        self.origin + self.step * DVec2::new(key.0 as f64, key.1 as f64)
    }
}

type Triangles = (Vec<DVec2>, Vec<map::Cell>);

/// `reached` is left at the segment that was being put in.
fn triangulate(
    segments: &[Segment],
    (lo, hi): (DVec2, DVec2),
    snap: &Snap,
    reached: &Cell<usize>,
) -> Result<Triangles, String> {
    // Distinct snapped points in a fixed order; the window's corners keep everything inside the hull.
    let frame = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    let mut keys: Vec<(i64, i64)> = segments
        .iter()
        .flatten()
        .chain(&frame)
        .map(|q| snap.key(*q))
        .collect();
    keys.sort_unstable();
    keys.dedup();
    let index = |q: &DVec2| {
        keys.binary_search(&snap.key(*q))
            .map_err(|_| "lost point".to_string())
    };
    let points: Vec<Point2<f64>> = keys
        .iter()
        .map(|k| snap.point(*k))
        .map(|p| Point2::new(p.x, p.y))
        .collect();
    let mut cdt =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::bulk_load_cdt(points, Vec::new())
            .map_err(|e| e.to_string())?;
    for (at, [a, b]) in segments.iter().enumerate() {
        reached.set(at);
        let (a, b) = (index(a)?, index(b)?);
        if a != b {
            let (a, b) = (
                spade::handles::FixedVertexHandle::from_index(a),
                spade::handles::FixedVertexHandle::from_index(b),
            );
            cdt.add_constraint_and_split(a, b, |p| p);
        }
    }
    let points = cdt
        .vertices()
        .map(|v| DVec2::new(v.position().x, v.position().y))
        .collect();
    let corners = cdt
        .inner_faces()
        .map(|f| f.vertices().map(|v| PointId::new(v.fix().index())));
    Ok((
        points,
        corners
            .map(|corners| map::Cell {
                corners,
                face: None,
                support: None,
                facet: None,
                leaves: None,
                support_depth: f64::INFINITY,
                outline: [false; 3],
            })
            .collect(),
    ))
}

/// For every cell the cells across its three sides.
pub(crate) fn neighbours(cells: &[map::Cell]) -> Vec<[Option<CellId>; 3]> {
    let across = face_neighbours(&TriMesh {
        vertices: Vec::new(),
        faces: cells
            .iter()
            .map(|c| c.corners.map(|p| VertexId(p.0)))
            .collect(),
    });
    across
        .into_iter()
        .map(|n| n.map(|f| f.map(|f| CellId(f.0))))
        .collect()
}
