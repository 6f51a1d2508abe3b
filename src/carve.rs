//! From reliefs to solids: supports are carved along the eyes' rays in front of the reliefs, and everything is united.
//!
//! Takes supports and, per view, the relief over its view map. Gives the whole forest, the bare part (base and pillars) and each
//! view's reliefs as meshes. The only module that names the boolean library (`manifold-rust`) and the polygon one (`i_overlay`).
//!
//! Operands never share a wall. The carving reaches deeper than any relief, to half-way inside the relief's solid backing, and
//! is a hair narrower than the relief where the support goes on beside it (so the relief's edge is bedded in the support) but
//! wider where the support ends or is hidden (so no fin of it is left standing there).

use crate::groups::Groups;
use crate::mesh::TriMesh;
use crate::relief::{Relief, block};
use crate::support::{Slab, Support};
use crate::viewmap::ViewMap;
use glam::{DVec2, DVec3};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::outline::offset::OutlineOffset;
use i_overlay::mesh::style::{LineJoin, OutlineStyle};
use manifold_rust::linalg::{Vec2, Vec3};
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64, OpType};
use rayon::prelude::*;

/// How far a relief's edge is bedded in its support, millimetres at the support. Less than a tenth of a printer's line, so unseen;
/// at 0.002 (the thinnest cells) operands touch again.
const BED_MM: f64 = 0.012;
/// Overlap of the carving's wider rim with the carving itself, millimetres: more than `BED_MM`, or a fin is left between.
const RIM_OVERLAP_MM: f64 = 0.04;
/// How far the carving goes beyond the support's outline, millimetres: the gap to what a nearer support hides must print.
const RIM_MM: f64 = 0.4;
/// How far the carving starts in front of support and layer, millimetres.
const CLEAR_MM: f64 = 1.0;

/// What one view adds to the forest.
pub struct ViewRelief<'a> {
    pub name: &'a str,
    pub map: &'a ViewMap,
    pub groups: &'a Groups,
    pub relief: &'a Relief,
}

/// The forest as meshes, not yet checked.
#[derive(Clone, Debug, Default)]
pub struct Pieces {
    /// Everything as one.
    pub whole: TriMesh,
    /// Base and pillars without reliefs.
    pub bare: TriMesh,
    /// The reliefs of each view, in the order of the views.
    pub reliefs: Vec<TriMesh>,
    /// Corners filled in and cells given up while closing the reliefs.
    pub filled: usize,
    pub dropped: usize,
}

/// Why the solids could not be united.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{support}: {step} failed ({reason})")]
pub struct CarveError {
    pub support: String,
    pub step: &'static str,
    pub reason: String,
}

/// Carves and unites everything.
///
/// # Errors
/// If the boolean library refuses an operand, with the support and step.
pub fn carve(supports: &[Support], views: &[ViewRelief]) -> Result<Pieces, CarveError> {
    let carved: Vec<Carved> = (0..supports.len()).into_par_iter().map(|s| carve_support(supports, s, views)).collect::<Result<_, _>>()?;
    let unite = |parts: Vec<Manifold>, step| {
        let parts: Vec<Manifold> = parts.into_iter().filter(|m| !m.is_empty()).collect();
        checked(union(parts), "forest", step)
    };
    let whole = unite(carved.iter().map(|c| c.whole.clone()).collect(), "uniting the pillars")?;
    let bare = unite(carved.iter().map(|c| c.bare.clone()).collect(), "uniting the bare pillars")?;
    let mut reliefs = Vec::new();
    for v in 0..views.len() {
        let parts = carved.iter().flat_map(|c| c.blocks.iter().filter(|b| b.0 == v).map(|b| b.1.clone())).collect();
        reliefs.push(mesh_of(&unite(parts, "uniting a view's reliefs")?));
    }
    Ok(Pieces {
        whole: mesh_of(&whole),
        bare: mesh_of(&bare),
        reliefs,
        filled: carved.iter().map(|c| c.filled).sum(),
        dropped: carved.iter().map(|c| c.dropped).sum(),
    })
}

/// One support with its reliefs.
struct Carved {
    whole: Manifold,
    bare: Manifold,
    blocks: Vec<(usize, Manifold)>,
    filled: usize,
    dropped: usize,
}

fn carve_support(supports: &[Support], s: usize, views: &[ViewRelief]) -> Result<Carved, CarveError> {
    let support = &supports[s];
    let mut bare = checked(manifold(&support.mesh), &support.name, "reading the support")?;
    let mut blocks = Vec::new();
    let (mut filled, mut dropped) = (0, 0);
    for (v, view) in views.iter().enumerate() {
        let cells: Vec<u32> = cells_on(view, s as u32);
        let Some(slab) = view.groups.slabs[s].filter(|_| !cells.is_empty()) else { continue };
        let back = |q: DVec2| slab.plane(view.map.plane.direction(q), slab.backing());
        let made = block(view.map, &cells, &view.relief.depth, back);
        filled += made.filled;
        dropped += made.dropped;
        let hollow = checked(hollow(view, &slab, s as u32, &cells), &support.name, "shaping the carving")?;
        bare = checked(bare.difference(&hollow), &support.name, "carving")?;
        blocks.push((v, checked(manifold(&made.mesh), &support.name, "reading a relief")?));
    }
    let mut whole = bare.clone();
    for (_, block) in &blocks {
        whole = checked(whole.union(block), &support.name, "adding a relief")?;
        bare = checked(bare.difference(block), &support.name, "fitting a relief")?;
    }
    Ok(Carved { whole, bare, blocks, filled, dropped })
}

fn cells_on(view: &ViewRelief, support: u32) -> Vec<u32> {
    let on = |c: &usize| view.map.cells[*c].support == Some(support) && view.relief.depth[*c].is_some();
    (0..view.map.cells.len()).filter(on).map(|c| c as u32).collect()
}

/// The solid of rays in front of the relief that is taken out of the support.
fn hollow(view: &ViewRelief, slab: &Slab, support: u32, cells: &[u32]) -> Manifold {
    let scale = slab.plane(view.map.plane.forward, 0.0);
    let relief = outlines(view.map, cells, scale);
    let seen: Vec<u32> = (0..view.map.cells.len() as u32).filter(|c| view.map.cells[*c as usize].support == Some(support)).collect();
    let seen = outlines(view.map, &seen, scale);
    let core = offset(&relief, -BED_MM);
    let rim = offset(&relief, RIM_MM).overlay(&offset(&seen, -RIM_OVERLAP_MM), OverlayRule::Difference, FillRule::NonZero);
    let shape = core.overlay(&rim, OverlayRule::Union, FillRule::NonZero);
    let polygons: Vec<Vec<Vec2>> =
        shape.into_iter().flatten().map(|ring| ring.into_iter().map(|p| Vec2::new(p[0], p[1])).collect()).collect();
    let floor = (slab.backing() + slab.deepest()) / 2.0;
    // The prism's bottom becomes the far end: (right, up, towards the eye) is right-handed.
    Manifold::extrude(&polygons, 1.0, 0, 0.0, Vec2::new(1.0, 1.0)).warp(|v| {
        let q = DVec2::new(v.x, v.y) / scale;
        let offset = if v.z < 0.5 { floor } else { -slab.front() - CLEAR_MM };
        let p = view.map.plane.point(q, slab.plane(view.map.plane.direction(q), offset));
        *v = Vec3::new(p.x, p.y, p.z);
    })
}

type Rings = Vec<Vec<[f64; 2]>>;

/// The boundary of a set of cells as closed rings, scaled to millimetres at the support.
fn outlines(map: &ViewMap, cells: &[u32], scale: f64) -> Rings {
    let mut next: std::collections::BTreeMap<u32, Vec<u32>> = std::collections::BTreeMap::new();
    for c in cells {
        let cell = &map.cells[*c as usize];
        for k in 0..3 {
            if map.neighbours[*c as usize][k].is_none_or(|n| cells.binary_search(&n).is_err()) {
                next.entry(cell.corners[k]).or_default().push(cell.corners[(k + 1) % 3]);
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = next.iter().next() {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(ends) = next.get_mut(&at) {
            let to = ends.pop().expect("points without a way on are removed");
            if ends.is_empty() {
                next.remove(&at);
            }
            ring.push((map.points[at as usize] * scale).to_array());
            at = to;
        }
        rings.push(ring);
    }
    rings
}

fn offset(rings: &[Vec<[f64; 2]>], by: f64) -> Rings {
    let clean = rings.to_vec().simplify_shape(FillRule::NonZero);
    clean.outline(&OutlineStyle::new(by).line_join(LineJoin::Bevel)).into_iter().flatten().collect()
}

fn union(parts: Vec<Manifold>) -> Manifold {
    use manifold_rust::csg_tree::CsgNode;
    let leaves = parts.into_iter().map(|m| CsgNode::leaf(m.into_impl())).collect();
    Manifold::from_impl(CsgNode::op_n(OpType::Add, leaves).evaluate())
}

fn checked(solid: Manifold, support: &str, step: &'static str) -> Result<Manifold, CarveError> {
    match solid.status() {
        Error::NoError => Ok(solid),
        error => Err(CarveError { support: support.into(), step, reason: error.to_str().into() }),
    }
}

fn manifold(mesh: &TriMesh) -> Manifold {
    Manifold::from_mesh_gl64(&MeshGL64 {
        num_prop: 3,
        vert_properties: mesh.vertices.iter().flat_map(|v| v.to_array()).collect(),
        tri_verts: mesh.faces.iter().flatten().map(|v| u64::from(*v)).collect(),
        ..MeshGL64::default()
    })
}

fn mesh_of(solid: &Manifold) -> TriMesh {
    let mesh = solid.get_mesh_gl64(-1);
    let vertices = (0..mesh.num_vert()).map(|v| DVec3::from_array(mesh.get_vert_pos(v))).collect();
    let faces = (0..mesh.num_tri()).map(|t| mesh.get_tri_verts(t).map(|v| v as u32)).collect();
    TriMesh { vertices, faces }
}
