//! Finds the view map: the faces that are seen, the arrangement of their edges, and a label for every cell.

use super::arrange::arrange;
use super::field::SupportField;
use super::map::{Cell, ViewMap, ViewMapError};
use super::outline::seen_outlines;
use super::target::Target;
use super::thin::merge_thin;
use crate::geom::{ImagePlane, barycentric};
use crate::index::{CellId, ComponentId, FaceId, FacetId, PointId};
use crate::mesh::{face_components, face_objects};
use glam::DVec2;
use rayon::prelude::*;

/// Cells thinner than this, in millimetres at the model's mean distance, are merged away: below it, f32 coordinates and
/// exact intersection tests of finished solids no longer agree (0.0005 leaves some crossings), above it lines visibly shift.
pub const THINNEST_MM: f64 = 0.002;

/// Rounds of finding faces that the first guess missed. The creatures and scans need two or three.
const MAX_ROUNDS: usize = 5;

/// Computes the view map of `target` over `supports`.
///
/// # Errors
/// If no face is seen, or the triangulation fails on every snapping grid tried.
pub fn view_map(
    plane: ImagePlane,
    target: &Target,
    supports: &SupportField,
) -> Result<ViewMap, ViewMapError> {
    let looking = Looking {
        plane,
        target,
        supports,
    };
    let mut wanted = looking.seen_at_samples();
    if !wanted.iter().any(|w| *w) {
        return Err(ViewMapError::NothingSeen);
    }
    let outlines = seen_outlines(&plane, supports, target.image_box());
    let mut map = arrange(&plane, target, &wanted, &outlines)?;
    let mut doubtful = looking.label(&mut map);
    for _ in 1..MAX_ROUNDS {
        let missing = looking.missing_faces(&map, &doubtful, &wanted);
        if missing.is_empty() {
            break;
        }
        missing.iter().for_each(|f| wanted[*f] = true);
        map = arrange(&plane, target, &wanted, &outlines)?;
        doubtful = looking.label(&mut map);
    }
    map.doubtful_sr = doubtful.iter().map(|c| map.solid_angle(*c)).sum();
    merge_thin(&mut map, THINNEST_MM / plane.scale(mean(&target.depth)));
    // Parts that overlap, as kits and game models have them, are one object with one outline.
    let objects = match supports.holds_outlines() {
        true => face_objects(&target.mesh),
        false => face_components(&target.mesh),
    };
    mark_outlines(&mut map, &objects);
    Ok(map)
}

/// One eye looking at its models and the supports.
struct Looking<'a> {
    plane: ImagePlane,
    target: &'a Target,
    supports: &'a SupportField<'a>,
}

impl Looking<'_> {
    /// Faces seen at their centre or near a corner.
    fn seen_at_samples(&self) -> Vec<bool> {
        let target = self.target;
        let is_seen = |f: FaceId| {
            let corners = target.image_of(f);
            let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
            let samples = [
                centre,
                centre.lerp(corners[0], 0.9),
                centre.lerp(corners[1], 0.9),
                centre.lerp(corners[2], 0.9),
            ];
            samples.iter().any(|q| self.seen_face(*q) == Some(f))
        };
        (0..target.mesh.faces.len())
            .into_par_iter()
            .map(FaceId::new)
            .map(|f| target.may_be_seen(f) && is_seen(f))
            .collect()
    }

    /// The front-most face on the ray `q`.
    fn seen_face(&self, q: DVec2) -> Option<FaceId> {
        let Self { plane, target, .. } = self;
        let hit = target
            .bvh
            .first_hit_where(plane.eye, plane.direction(q), |f| target.may_be_seen(f));
        hit.map(|h| h.face)
    }

    /// Labels every cell by a ray through its centre; gives the cells that stick out of their face.
    fn label(&self, map: &mut ViewMap) -> Vec<CellId> {
        let labelled = |c| self.labelled(map, c);
        map.cells = {
            let cells = 0..map.cells.len() as u32;
            cells.into_par_iter().map(|c| labelled(CellId(c))).collect()
        };
        let sticks_out = |c: &CellId| {
            let face = map.cells[*c].face;
            face.is_some_and(|f| !holds(self.target.image_of(f), map.triangle(*c)))
        };
        CellId::all(map.cells.len()).filter(sticks_out).collect()
    }

    /// A cell with what the ray through its centre meets.
    fn labelled(&self, map: &ViewMap, c: CellId) -> Cell {
        let supports = self.supports;
        let centre = map.points_mean(map.cells[c].corners);
        let direction = map.plane.direction(centre);
        let hit = supports.bvh.first_hit(map.plane.eye, direction);
        let support = hit.map(|h| supports.owner[h.face]);
        let through = support.filter(|s| supports.goes_through(*s));
        let wall = through.and_then(|s| supports.wall(s, map.plane.eye, direction));
        Cell {
            face: self.seen_face(centre),
            support,
            facet: hit.map(|h| FacetId::of(h.face)),
            leaves: wall.map(|(_, leaves)| FacetId::of(leaves.face)),
            support_depth: hit.map_or(f64::INFINITY, |h| h.t),
            ..map.cells[c]
        }
    }

    /// Faces not yet wanted that rays near the corners of doubtful cells meet.
    fn missing_faces(&self, map: &ViewMap, doubtful: &[CellId], wanted: &[bool]) -> Vec<FaceId> {
        let mut found = Vec::new();
        for c in doubtful {
            let corners = map.triangle(*c);
            let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
            for share in [0.0, 0.5, 0.98] {
                for corner in corners {
                    found.extend(self.seen_face(centre.lerp(corner, share)));
                }
            }
        }
        found.retain(|f| !wanted[*f]);
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// Marks the corners of cells that lie on sides where the image of their component (or object) ends.
fn mark_outlines(map: &mut ViewMap, component: &[ComponentId]) {
    let of = |cell: &Cell| cell.face.map(|f| component[f]);
    let mut marked: Vec<(PointId, ComponentId)> = Vec::new();
    for (cell, across) in map.cells.iter().zip(&map.neighbours) {
        let Some(own) = of(cell) else { continue };
        for (k, next) in across.iter().enumerate() {
            let beyond = next.and_then(|n| of(&map.cells[n]));
            if beyond != Some(own) {
                marked.extend([k, (k + 1) % 3].map(|k| (cell.corners[k], own)));
            }
        }
    }
    marked.sort_unstable();
    for cell in &mut map.cells {
        if let Some(own) = of(cell) {
            cell.outline = cell
                .corners
                .map(|p| marked.binary_search(&(p, own)).is_ok());
        }
    }
}

/// Whether `outer` holds all points of `inner` but for rounding.
fn holds(outer: [DVec2; 3], inner: [DVec2; 3]) -> bool {
    let [a, b, c] = outer;
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let area = (b - a).perp_dot(c - a).abs();
    // A point may lie outside by 1e-7 of the image: ten times the snapping grid, a fortieth of a micrometre at 250 mm.
    let slack = 1e-7 * longest / area + 1e-9;
    inner
        .iter()
        .all(|q| barycentric(a, b, c, *q).min_element() >= -slack)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
