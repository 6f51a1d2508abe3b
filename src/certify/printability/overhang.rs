//! How far faces hang out over nothing.
//!
//! A face hangs if it looks down and is flatter than [`STEEP_DEG`] degrees from the horizontal; the bottom of the print, which lies on
//! the bed, does not. Hanging faces that share an edge are one ledge. A ledge is held where it borders on a face that goes on
//! *downwards* from their edge (a wall below, or a steeper slope); its reach is the largest horizontal distance of one of its
//! points from the nearest such edge. A bridge is held at both ends and reaches half its span. A ledge that is held nowhere starts
//! in mid-air: its reach is its own extent.

use super::check::{Margin, PrintCheck, PrintFinding};
use crate::certify::point::without_minus_zero;
use crate::geom::to_segment;
use crate::index::FaceId;
use crate::mesh::{DisjointSets, TriMesh, face_neighbours};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Faces steeper than this are laid down line on line.
pub const STEEP_DEG: f64 = 45.0;
/// Faces this near to the lowest point lie on the bed, millimetres.
const BED_MM: f64 = 0.01;

/// Points of hanging faces are at most this far apart along edges, millimetres, on faces of up to [`FINEST`] such steps.
const GRID_MM: f64 = 1.0;
const FINEST: u32 = 100;

/// The ledge that reaches farthest.
pub(crate) fn overhang(mesh: &TriMesh, most: Margin) -> PrintCheck {
    let ledges = ledges(mesh);
    let reaches: Vec<(f64, DVec3)> = ledges.par_iter().map(Ledge::reach).collect();
    let over = reaches.iter().filter(|r| r.0 > most.wanted).count();
    let (reach, place) = reaches
        .into_iter()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or_default();
    PrintCheck {
        finding: PrintFinding::Overhang { ledges: over },
        place: without_minus_zero(place),
        value_mm: reach,
        wanted_mm: most.wanted,
        limit_mm: most.limit,
        ok: reach <= most.limit,
    }
}

/// Hanging faces that hang together.
#[derive(Default)]
struct Ledge {
    /// Corners, and points between them.
    points: Vec<DVec3>,
    /// Edges that something below holds.
    held: Vec<[DVec2; 2]>,
}

impl Ledge {
    /// Millimetres, and where.
    fn reach(&self) -> (f64, DVec3) {
        let (lo, hi) = self
            .points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| {
                (lo.min(*p), hi.max(*p))
            });
        let of = |p: &DVec3| {
            let distance = |e: &[DVec2; 2]| match e[0] == e[1] {
                true => e[0].distance(p.truncate()),
                false => to_segment(p.truncate(), e[0], e[1]),
            };
            self.held
                .iter()
                .map(distance)
                .fold((hi - lo).truncate().length(), f64::min)
        };
        let reaches = self.points.iter().map(|p| (of(p), *p));
        reaches
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or_default()
    }
}

fn ledges(mesh: &TriMesh) -> Vec<Ledge> {
    let floor = mesh.bounds().map_or(0.0, |(lo, _)| lo.z) + BED_MM;
    let flat = -STEEP_DEG.to_radians().cos();
    let hangs: Vec<bool> = (0..mesh.faces.len())
        .into_par_iter()
        .map(FaceId::new)
        .map(|f| mesh.normal(f).z < flat && mesh.corners(f).iter().any(|c| c.z > floor))
        .collect();
    let neighbours = face_neighbours(mesh);
    let mut sets = DisjointSets::new(mesh.faces.len());
    let hanging = || FaceId::all(mesh.faces.len()).filter(|f| hangs[*f]);
    for f in hanging() {
        for n in neighbours[f].into_iter().flatten() {
            if hangs[n] {
                sets.join(f.0, n.0);
            }
        }
    }
    let mut ledge_of: Vec<Option<usize>> = vec![None; hangs.len()];
    let mut ledges: Vec<Ledge> = Vec::new();
    for f in hanging() {
        let slot = &mut ledge_of[FaceId(sets.root(f.0))];
        let ledge = *slot.get_or_insert_with(|| {
            ledges.push(Ledge::default());
            ledges.len() - 1
        });
        let ledge = &mut ledges[ledge];
        let corners = mesh.corners(f);
        ledge.points.extend(points(corners));
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let other = neighbours[f][k].filter(|n| !hangs[*n]);
            if other.is_some_and(|n| goes_down(mesh, n, (a + b) / 2.0)) {
                ledge.held.push([a.truncate(), b.truncate()]);
            }
        }
    }
    ledges
}

/// A grid over a face, its corners included: the middle of a bridge has no corner.
fn points([a, b, c]: [DVec3; 3]) -> impl Iterator<Item = DVec3> {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let n = ((longest / GRID_MM).ceil() as u32).clamp(1, FINEST);
    (0..=n).flat_map(move |i| {
        (0..=n - i).map(move |j| {
            a + f64::from(i) / f64::from(n) * (b - a) + f64::from(j) / f64::from(n) * (c - a)
        })
    })
}

/// Whether a face lies below one of its edges.
fn goes_down(mesh: &TriMesh, face: FaceId, edge: DVec3) -> bool {
    let corners = mesh.corners(face);
    corners.iter().sum::<DVec3>().z / 3.0 < edge.z
}
