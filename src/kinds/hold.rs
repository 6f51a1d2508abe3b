//! What of a whole mesh is held, as bounds of one group.

use crate::groups::{Bound, Group, Groups, anchor, vertex_anchor};
use crate::index::{CellId, ComponentId, GroupId, PointId, SupportId, VertexId};
use crate::sight::Sight;
use crate::support::Slab;
use crate::viewmap::Image;

/// What is seen stays this far before its support but at outlines, so that it is not lost in it, millimetres.
const FLUSH_MM: f64 = 0.02;

/// The only group.
const ONLY: GroupId = GroupId(0);

/// What of a whole mesh is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounded {
    /// Its outline on the support.
    Outline,
    /// That, and all that is seen within the layer.
    Seen,
}

/// The sight of a view whose mesh is deformed as a whole: one group, with what is held.
///
/// # Errors
/// If its models lie before several supports, or before several parts of one.
pub(crate) fn held(sight: Sight, bounded: Bounded) -> Result<Sight, MustBeCut> {
    let Sight { image, groups, .. } = &sight;
    let Some(support) = one_surface(&groups.groups)? else {
        return Ok(sight);
    };
    let Some(slab) = groups.slabs[support] else {
        return Ok(sight);
    };
    let flush = slab.before_datum(FLUSH_MM);
    let kept = |b: &Bound| Bound {
        group: ONLY,
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
    bounds.extend(free(&sight, &slab, flush));
    bounds.extend(hidden(image, &slab, support, &bounds));
    let needed = bounds.len();
    bounds.extend(follow.iter().map(kept));
    // Parts beside the support are there all the same: nothing of a whole mesh is cut off.
    let map = &image.map;
    let of_cell: Vec<Option<GroupId>> = map.cells.iter().map(|c| c.face.map(|_| ONLY)).collect();
    let cells: Vec<CellId> = CellId::all(of_cell.len())
        .filter(|c| of_cell[*c].is_some())
        .collect();
    let group = Group {
        support,
        part: 0,
        component: ComponentId(0),
        solid_angle_sr: cells.iter().map(|c| map.solid_angle(*c)).sum(),
        cells,
    };
    let groups = Groups {
        groups: vec![group],
        of_cell,
        bounds,
        needed,
        slabs: groups.slabs.clone(),
    };
    Ok(Sight { groups, ..sight })
}

/// Why a mesh cannot stay whole: it would have to be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MustBeCut {
    /// Its models lie before several supports.
    Supports([SupportId; 2]),
    /// Its models lie before several parts of one.
    Parts(SupportId),
}

/// The support that carries all groups, on one part of it; `None` if there are no groups.
fn one_surface(groups: &[Group]) -> Result<Option<SupportId>, MustBeCut> {
    let Some(first) = groups.first() else {
        return Ok(None);
    };
    if let Some(other) = groups.iter().find(|g| g.support != first.support) {
        return Err(MustBeCut::Supports([first.support, other.support]));
    }
    if groups.iter().any(|g| g.part != first.part) {
        return Err(MustBeCut::Parts(first.support));
    }
    Ok(Some(first.support))
}

/// Far bounds of what is seen of free parts: without them the support would hide what goes back behind its outline.
fn free(sight: &Sight, slab: &Slab, flush: f64) -> Vec<Bound> {
    let Sight { image, groups, .. } = sight;
    let (target, map) = (&image.target, &image.map);
    let mut found: Vec<((PointId, [VertexId; 3]), Bound)> = Vec::new();
    for (c, cell) in map.all() {
        let (Some(_), Some(face)) = (groups.of_cell[c], cell.face) else {
            continue;
        };
        for p in cell.corners {
            let q = map.points[p];
            let (anchor, depth) = anchor(target, face, q);
            if !anchor.is_free(target) {
                continue;
            }
            let surface = image.surface_in(slab, c, q);
            let far = slab.bounds(map.plane.direction(q), surface).1;
            let bound = Bound {
                group: ONLY,
                anchor,
                lower: 0.0,
                upper: flush * far / depth,
                drawn: false,
            };
            let mut terms = anchor.terms();
            let key = match (terms.next(), terms.next()) {
                (Some((v, _)), None) => (PointId(u32::MAX), [v; 3]),
                _ => (p, target.mesh.faces[face]),
            };
            found.push((key, bound));
        }
    }
    found.sort_by(|(k, a), (l, b)| k.cmp(l).then(a.upper.total_cmp(&b.upper)));
    found.dedup_by_key(|f| f.0);
    found.into_iter().map(|f| f.1).collect()
}

/// Far bounds of vertices that have none of their own: the support's far side less its core, where their rays meet it.
fn hidden(image: &Image, slab: &Slab, support: SupportId, bounds: &[Bound]) -> Vec<Bound> {
    let (target, map, field) = (&image.target, &image.map, image.field);
    let mut held = vec![false; target.mesh.vertices.len()];
    for bound in bounds {
        let mut terms = bound.anchor.terms();
        if let (Some((vertex, _)), None) = (terms.next(), terms.next()) {
            held[vertex] = true;
        }
    }
    let eye = map.plane.eye;
    let far = |v: &VertexId| {
        let direction = map.plane.direction(target.image[*v]);
        let surface = field.hit_of(support, eye, direction)?;
        let leaves = surface + field.thickness(support, eye, direction);
        let upper = leaves - slab.core() / direction.length();
        let bound = Bound {
            group: ONLY,
            anchor: vertex_anchor(*v),
            lower: 0.0,
            upper: upper / target.depth[*v],
            drawn: false,
        };
        upper.is_finite().then_some(bound)
    };
    let open = VertexId::all(held.len()).filter(|v| !held[*v]);
    open.filter_map(|v| far(&v)).collect()
}
