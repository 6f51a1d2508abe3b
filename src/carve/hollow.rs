//! The carving in front of a relief: a frustum of the eye's rays.

use super::boolean::{Boolean, BooleanError};
use super::sound::SPARE_MM;
use crate::geom::rings::{Rings, common, joined, offset, simple, taken, widened};
use crate::index::{CellId, SupportId};
use crate::mesh::{TriMesh, without_spare_corners};
use crate::relief::block;
use crate::support::Slab;
use crate::viewmap::ViewMap;
use glam::{DVec2, DVec3};

/// Overlap of the carving's wider rim with the carving itself, millimetres: more than any bed width, or a fin is left between.
const RIM_OVERLAP_MM: f64 = 0.05;
/// How far the carving starts in front of support and layer, millimetres.
const CLEAR_MM: f64 = 1.0;
/// The finished shape is drawn in by this much, millimetres: parts that touch in a point come apart, as solids must.
const PART_MM: f64 = 0.003;

/// How a carving ends, millimetres at the support.
#[derive(Clone, Copy)]
pub(crate) struct CarvingEdge {
    /// Narrower than the relief by this where the support goes on beside it.
    pub bed: f64,
    /// Wider by this, a printed line, where the support ends or is hidden: the gap to what a nearer support hides must print. What would
    /// be left standing beside the carving and is thinner than that goes too.
    pub line: f64,
}

/// The solid to take out of `support`, a mesh, in front of its relief on `cells` (rising).
pub(crate) fn hollow(
    map: &ViewMap,
    slab: &Slab,
    (support, mesh): (SupportId, &TriMesh),
    cells: &[CellId],
    edge: CarvingEdge,
) -> Result<Boolean, BooleanError> {
    let scale = map.plane.scale(slab.plane(map.plane.forward, 0.0));
    let relief = simple(map.outlines(cells, scale));
    let carved = shape(map, slab, support, &relief, edge, scale);
    let near = offset(&relief, 2.0 * edge.line);
    let rings = without_fins(&carved, &outline(map, mesh, scale), &near, edge.line);
    let floor = (slab.backing() + slab.deepest()) / 2.0;
    frustum(map, slab, &rings, scale, floor)
}

/// The same in front of a shell, which is not flat: down to `floor(cell, q)`. What would be left beside it is not looked for: taking that
/// away too made the films of a vase no fewer.
pub(crate) fn shell_hollow(
    map: &ViewMap,
    slab: &Slab,
    support: SupportId,
    cells: &[CellId],
    edge: CarvingEdge,
    floor: impl Fn(CellId, DVec2) -> f64,
) -> Result<Boolean, BooleanError> {
    let scale = map.plane.scale(slab.plane(map.plane.forward, 0.0));
    let mut depth = vec![None; map.cells.len()];
    for c in cells {
        depth[*c] = Some(map.triangle(*c).map(|q| floor(*c, q)));
    }
    // Everything behind the floor, to beyond the support: what is left of a frustum through all of it is what is in front.
    let beyond = |by: f64| slab.beyond() + by * CLEAR_MM;
    let end = |_: CellId, q: DVec2| slab.plane(map.plane.direction(q), beyond(2.0));
    let behind = block(map, cells, &depth, end, |_, _| false, 0.0);
    let kept: Vec<CellId> = cells
        .iter()
        .copied()
        .filter(|c| behind.dropped.binary_search(c).is_err())
        .collect();
    let relief = simple(map.outlines(&kept, scale));
    let rings = shape(map, slab, support, &relief, edge, scale);
    let behind = Boolean::new(&without_spare_corners(behind.mesh, SPARE_MM))?;
    frustum(map, slab, &rings, scale, beyond(1.0))?.minus(&behind)
}

/// The frustum of rays through rings drawn in by [`PART_MM`], from in front of everything to `floor` millimetres behind the datum plane.
fn frustum(
    map: &ViewMap,
    slab: &Slab,
    rings: &Rings,
    scale: f64,
    floor: f64,
) -> Result<Boolean, BooleanError> {
    // The prism's bottom becomes the far end: (right, up, towards the eye) is right-handed.
    Boolean::prism(&offset(rings, -PART_MM), |p, height| {
        let q = p / scale;
        let offset = if height < 0.5 {
            floor
        } else {
            -slab.front() - CLEAR_MM
        };
        map.plane
            .point(q, slab.plane(map.plane.direction(q), offset))
    })
}

/// The part of the image that is carved, millimetres at the support: narrower than the relief where its support goes on beside it, wider
/// where it ends or is hidden. A shell is carved to different depths; what of it is hidden stays.
fn shape(
    map: &ViewMap,
    slab: &Slab,
    support: SupportId,
    relief: &Rings,
    edge: CarvingEdge,
    scale: f64,
) -> Rings {
    let goes_on = |c: &CellId| match map.cells[*c].support {
        Some(found) => found == support || slab.is_shell(),
        None => false,
    };
    let seen: Vec<CellId> = CellId::all(map.cells.len()).filter(goes_on).collect();
    let seen = map.outlines(&seen, scale);
    // Beyond the mapped window supports may go on: nothing is carved there.
    let goes_on = simple([seen, beyond_window(map, scale, 2.0 * edge.line)].concat());
    let rim = taken(
        &offset(relief, edge.line),
        &offset(&goes_on, -RIM_OVERLAP_MM),
    );
    joined(&offset(relief, -edge.bed), &rim)
}

/// A frame `width` millimetres wide around what the view map covers.
fn beyond_window(map: &ViewMap, scale: f64, width: f64) -> Rings {
    let first = map.points[0];
    let (lo, hi) = map
        .points
        .iter()
        .fold((first, first), |(lo, hi), q| (lo.min(*q), hi.max(*q)));
    let corners = |by: f64| {
        let (lo, hi) = (scale * lo - by, scale * hi + by);
        vec![lo.to_array(), [hi.x, lo.y], hi.to_array(), [lo.x, hi.y]]
    };
    let mut hole = corners(0.0);
    hole.reverse();
    vec![corners(width), hole]
}

/// The carving with all that it would leave of a support's `outline` in slivers, thinner than a `line`: where a nearer support hides just
/// as much of it as the carving is wider, or the relief ends just beside it, films would stand there that nobody can print or see. Only
/// `near` the relief.
fn without_fins(carved: &Rings, outline: &Rings, near: &Rings, line: f64) -> Rings {
    // What stands beside the finished shape.
    let standing = taken(outline, &offset(carved, -PART_MM));
    let stout = widened(&offset(&standing, -line / 2.0), line / 2.0 + PART_MM);
    let fins = taken(&standing, &stout);
    let fins = common(&fins, near);
    // So that nothing is left between a fin and the carving, nor outside of it.
    let fins = offset(&fins, RIM_OVERLAP_MM);
    joined(carved, &fins)
}

/// What the eye would see of a mesh if nothing stood before it.
fn outline(map: &ViewMap, mesh: &TriMesh, scale: f64) -> Rings {
    let project = |v: &DVec3| map.plane.project(*v).map(|q| scale * q);
    let image: Vec<Option<DVec2>> = mesh.vertices.iter().map(project).collect();
    let seen = mesh.faces.iter().filter_map(|face| {
        let [Some(a), Some(b), Some(c)] = face.map(|v| image[v]) else {
            return None;
        };
        ((b - a).perp_dot(c - a) > 0.0).then(|| [a, b, c].map(|p| p.to_array()).to_vec())
    });
    simple(seen.collect())
}
