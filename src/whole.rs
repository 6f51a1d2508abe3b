//! Reliefs that are no height fields (paper, "Non-height-field bas-reliefs", Fig 12): a closed mesh deformed as a whole.
//!
//! Takes a view's ordinary groups and gives those of the whole mesh: one group, because it is neither cut nor scaled back piece by
//! piece, with bounds for what is to be held and for nothing else. Afterwards gives the mesh where the depths put it, front, back
//! and all that is hidden, with the model's own faces; and counts what crosses in it, exactly.
//!
//! What is held:
//! - the outline of every component lies on its support, to [`HULL_MM`](crate::support::HULL_MM);
//! - nothing that is seen lies in the support, which would hide it; nor, with [`Bounded::Seen`], before the layer's front;
//! - nothing comes out of the support's far side: hidden vertices whose rays meet it leave the layer's core there;
//! - free vertices are not held to outline or front: they may stand out as far as they like.

use crate::diag::Diagnostic;
use crate::groups::{Bound, Group, Groups, anchor, surface_in, vertex_anchor};
use crate::mesh::{TriMesh, self_intersections};
use crate::mimic::{Depths, Order, sheet_orders};
use crate::support::Slab;
use crate::viewmap::{SupportField, Target, ViewMap};
use glam::DVec3;

/// What is seen stays this far before its support but at outlines, so that it is not lost in it, millimetres.
const FLUSH_MM: f64 = 0.02;

/// What of a whole mesh is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounded {
    /// Its outline on the support.
    Outline,
    /// That, and all that is seen within the layer.
    Seen,
}

/// The groups of a view whose mesh is deformed as a whole, from its ordinary ones.
///
/// # Errors
/// If its models lie before several supports, or before several parts of one.
pub fn whole(
    view: &str,
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
    groups: Groups,
    bounded: Bounded,
) -> Result<Groups, Vec<Diagnostic>> {
    let Some(first) = groups.groups.first() else {
        return Ok(groups);
    };
    let support = first.support;
    one_surface(view, field, &groups.groups).map_err(|e| vec![e])?;
    let Some(slab) = groups.slabs[support as usize] else {
        return Ok(groups);
    };
    let flush = slab.before_datum(FLUSH_MM);
    let kept = |b: &Bound| Bound {
        group: 0,
        lower: if b.drawn || bounded == Bounded::Seen {
            b.lower
        } else {
            0.0
        },
        upper: if b.drawn { b.upper } else { flush * b.upper },
        ..*b
    };
    let (needed, follow) = groups.bounds.split_at(groups.needed);
    let mut bounds: Vec<Bound> = needed.iter().map(kept).collect();
    bounds.extend(free(map, target, field, &slab, &groups, flush));
    bounds.extend(hidden(map, target, field, &slab, support, &bounds));
    let needed = bounds.len();
    bounds.extend(follow.iter().map(kept));
    // Parts beside the support are there all the same: nothing of a whole mesh is cut off.
    let of_cell: Vec<Option<u32>> = map.cells.iter().map(|c| c.face.map(|_| 0)).collect();
    let cells: Vec<u32> = (0..of_cell.len() as u32)
        .filter(|c| of_cell[*c as usize].is_some())
        .collect();
    let group = Group {
        support,
        part: 0,
        component: 0,
        solid_angle_sr: cells.iter().map(|c| map.solid_angle(*c as usize)).sum(),
        cells,
    };
    Ok(Groups {
        groups: vec![group],
        of_cell,
        bounds,
        needed,
        slabs: groups.slabs,
        whole: true,
    })
}

/// An error unless all groups lie on one part of one support.
fn one_surface(view: &str, field: &SupportField, groups: &[Group]) -> Result<(), Diagnostic> {
    let support = groups[0].support;
    let name = |s: u32| &field.supports[s as usize].name;
    if let Some(other) = groups.iter().find(|g| g.support != support) {
        return Err(Diagnostic::error(format!(
            "view \"{view}\": its models lie before {} and {}, but a whole mesh has one support",
            name(support),
            name(other.support)
        ))
        .help("one support behind all of them, or `relief: HeightField`, which cuts the surface"));
    }
    if groups.iter().any(|g| g.part != groups[0].part) {
        return Err(Diagnostic::error(format!(
            "view \"{view}\": {} has several parts behind its models, but a whole mesh is not cut at their edges",
            name(support)
        ))
        .help("a plate or a wave, or `relief: HeightField`, which cuts the surface"));
    }
    Ok(())
}

/// Far bounds of what is seen of free parts: without them the support would hide what goes back behind its outline.
fn free(
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
    slab: &Slab,
    groups: &Groups,
    flush: f64,
) -> Vec<Bound> {
    let mut found: Vec<((u32, [u32; 3]), Bound)> = Vec::new();
    for (c, cell) in map.cells.iter().enumerate() {
        let (Some(_), Some(face)) = (groups.of_cell[c], cell.face) else {
            continue;
        };
        for p in cell.corners {
            let q = map.points[p as usize];
            let (anchor, depth) = anchor(target, face as usize, q);
            if !anchor.is_free(target) {
                continue;
            }
            let surface = surface_in(map, field, slab, c, q);
            let far = slab.bounds(map.plane.direction(q), surface).1;
            let bound = Bound {
                group: 0,
                anchor,
                lower: 0.0,
                upper: flush * far / depth,
                drawn: false,
            };
            let mut terms = anchor.terms();
            let key = match (terms.next(), terms.next()) {
                (Some((v, _)), None) => (u32::MAX, [v as u32; 3]),
                _ => (p, target.mesh.faces[face as usize]),
            };
            found.push((key, bound));
        }
    }
    found.sort_by(|(k, a), (l, b)| k.cmp(l).then(a.upper.total_cmp(&b.upper)));
    found.dedup_by_key(|f| f.0);
    found.into_iter().map(|f| f.1).collect()
}

/// Far bounds of vertices that have none of their own: the support's far side less its core, where their rays meet it.
fn hidden(
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
    slab: &Slab,
    support: u32,
    bounds: &[Bound],
) -> Vec<Bound> {
    let mut held = vec![false; target.mesh.vertices.len()];
    for bound in bounds {
        let mut terms = bound.anchor.terms();
        if let (Some((vertex, _)), None) = (terms.next(), terms.next()) {
            held[vertex] = true;
        }
    }
    let eye = map.plane.eye;
    let far = |v: &usize| {
        let direction = map.plane.direction(target.image[*v]);
        let surface = field.hit_of(support, eye, direction)?;
        let leaves = surface + field.thickness(support, eye, direction);
        let upper = leaves - slab.core() / direction.length();
        let bound = Bound {
            group: 0,
            anchor: vertex_anchor(*v as u32),
            lower: 0.0,
            upper: upper / target.depth[*v],
            drawn: false,
        };
        upper.is_finite().then_some(bound)
    };
    let open = (0..held.len()).filter(|v| !held[*v]);
    open.filter_map(|v| far(&v)).collect()
}

/// The mesh where the depths put it.
pub fn moved(target: &Target, eye: DVec3, depths: &Depths) -> TriMesh {
    let vertices = target.mesh.vertices.iter().zip(&depths.s);
    TriMesh {
        vertices: vertices.map(|(v, s)| eye + *s * (*v - eye)).collect(),
        faces: target.mesh.faces.clone(),
    }
}

/// What crosses in an optimised surface, hidden parts included, before it is cut and scaled back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Crossings {
    /// Events (a vertex inside the image of a face, or two edges that cross in the image) at which a farther sheet comes before a
    /// nearer one.
    pub order_inversions: usize,
    /// Pairs of faces that cut or touch each other beyond what they share.
    pub self_intersections: usize,
    /// The same of the model itself.
    pub in_model: usize,
}

/// More pairs than this are not counted: a surface with so many is no surface.
const MOST_PAIRS: usize = 1_000_000;
/// Sheets less out of order than this are at one place, in log depth: half a nanometre at 400 mm, above what rounding does.
const SAME_DEPTH: f64 = 1e-12;

/// Counts crossings; `mesh` is [`moved`]'s.
pub fn crossings(target: &Target, mesh: &TriMesh, depths: &Depths) -> Crossings {
    let (orders, pairs) = rayon::join(
        || sheet_orders(target, 0.0),
        || [mesh, &target.mesh].map(|m| self_intersections(m, MOST_PAIRS).len()),
    );
    let turned = |o: &&Order| {
        let [front, back] = [o.front, o.back].map(|a| a.relative_depth(&depths.s));
        (front * o.ratio / back).ln() > SAME_DEPTH
    };
    Crossings {
        order_inversions: orders.all.iter().filter(turned).count(),
        self_intersections: pairs[0],
        in_model: pairs[1],
    }
}
