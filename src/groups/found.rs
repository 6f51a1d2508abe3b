//! Finds the groups: connected regions of cells on one part of a support, as far as its layer is connected too.
//!
//! A layer that follows the surface jumps where the support hides a part of itself, behind a ridge or a fold. There the image is
//! connected, but nothing that lies in the layer is: no scale serves both sides, and no face fits into both.

use super::bounds::bounds;
use super::group::{Group, Groups};
use crate::index::{CellId, ComponentId, GroupId, SupportId};
use crate::mesh::face_components;
use crate::support::Slab;
use crate::viewmap::Image;

/// A support that a layer cuts through or leaves too thin, as one eye sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinSupport {
    pub support: SupportId,
    /// What is left behind the layer, millimetres; negative if it reaches through.
    pub behind_mm: f64,
}

/// Groups and bounds of a view.
///
/// # Errors
/// Supports whose layer reaches through them or leaves less than their minimum core, as this eye sees them.
pub fn groups(image: &Image) -> Result<Groups, Vec<ThinSupport>> {
    let Image {
        field, target, map, ..
    } = image;
    let supports = field.supports.iter();
    let slabs: Vec<Option<Slab>> = supports.map(|s| Slab::new(s, map.plane.eye)).collect();
    let component = face_components(&target.mesh);
    let carries = |c: CellId| {
        let cell = map.cells[c];
        let support = cell.support.filter(|s| slabs[*s].is_some())?;
        let part = cell.facet.map_or(0, |f| field.part(f));
        Some((support, part, component[cell.face?]))
    };
    let labels: Vec<Option<Label>> = CellId::all(map.cells.len()).map(carries).collect();
    let (groups, of_cell) = regions(image, &slabs, &labels);
    let groups = Groups {
        groups,
        of_cell,
        bounds: Vec::new(),
        needed: 0,
        slabs,
    };
    let thin = thin_supports(image, &groups);
    if thin.is_empty() {
        Ok(with_bounds(groups, image))
    } else {
        Err(thin)
    }
}

/// The same groups with bounds for the mesh of `image`, which may be a cut one of the same surface.
pub fn with_bounds(groups: Groups, image: &Image) -> Groups {
    let (bounds, needed) = bounds(image, &groups);
    Groups {
        bounds,
        needed,
        ..groups
    }
}

/// The groups without some cells (rising), which are given up: what is left of them falls into connected regions anew.
pub fn without(groups: &Groups, lost: &[CellId], image: &Image) -> Groups {
    let label = |c: CellId| {
        let kept = lost.binary_search(&c).is_err();
        let group = groups.of_cell[c].filter(|_| kept)?;
        let group = &groups.groups[group];
        Some((group.support, group.part, group.component))
    };
    let labels: Vec<Option<Label>> = CellId::all(image.map.cells.len()).map(label).collect();
    let (found, of_cell) = regions(image, &groups.slabs, &labels);
    let left = Groups {
        groups: found,
        of_cell,
        bounds: Vec::new(),
        needed: 0,
        slabs: groups.slabs.clone(),
    };
    with_bounds(left, image)
}

/// Support, part of it, component of the model.
type Label = (SupportId, u32, ComponentId);

/// Flood fill over equal labels.
fn regions(
    image: &Image,
    slabs: &[Option<Slab>],
    labels: &[Option<Label>],
) -> (Vec<Group>, Vec<Option<GroupId>>) {
    let map = &image.map;
    let mut of_cell = vec![None; labels.len()];
    let mut groups = Vec::new();
    for seed in CellId::all(labels.len()) {
        let Some((support, part, component)) = labels[seed].filter(|_| of_cell[seed].is_none())
        else {
            continue;
        };
        let id = GroupId::new(groups.len());
        let mut cells = Vec::new();
        let mut stack = vec![seed];
        of_cell[seed] = Some(id);
        while let Some(c) = stack.pop() {
            cells.push(c);
            for (k, n) in map.neighbours[c].iter().enumerate() {
                let Some(n) = n else { continue };
                if of_cell[*n].is_some() || labels[*n] != labels[seed] {
                    continue;
                }
                let slab = slabs[support].as_ref();
                if slab.is_some_and(|slab| image.layer_goes_on(slab, c, k, *n)) {
                    of_cell[*n] = Some(id);
                    stack.push(*n);
                }
            }
        }
        cells.sort_unstable();
        let solid_angle_sr = cells.iter().map(|c| map.solid_angle(*c)).sum();
        groups.push(Group {
            support,
            part,
            component,
            cells,
            solid_angle_sr,
        });
    }
    (groups, of_cell)
}

/// Supports that are left thinner than their cores, rising.
fn thin_supports(image: &Image, groups: &Groups) -> Vec<ThinSupport> {
    let mut used: Vec<SupportId> = groups.groups.iter().map(|g| g.support).collect();
    used.sort_unstable();
    used.dedup();
    let thin = |support: SupportId| {
        let slab = groups.slabs[support]?;
        // Through walls a layer leaves its core by itself.
        if !slab.is_carved() || slab.goes_through() {
            return None;
        }
        let behind_mm = if slab.is_shell() {
            let on = groups.groups.iter().filter(|g| g.support == support);
            behind(image, &slab, support, on.flat_map(|g| &g.cells))
        } else {
            slab.behind()
        };
        (behind_mm < slab.core()).then_some(ThinSupport { support, behind_mm })
    };
    used.into_iter().filter_map(thin).collect()
}

/// Material left behind a shell's back where it is thinnest, millimetres along rays through the cells' centres.
fn behind<'a>(
    image: &Image,
    slab: &Slab,
    support: SupportId,
    cells: impl Iterator<Item = &'a CellId>,
) -> f64 {
    let (field, map) = (image.field, &image.map);
    let left = |c: &CellId| {
        let q = map.points_mean(map.cells[*c].corners);
        let direction = map.plane.direction(q);
        let surface = image.surface_in(slab, *c, q);
        let thickness = field.thickness(support, map.plane.eye, direction);
        (surface.first + thickness - slab.bounds(direction, surface).1) * direction.length()
    };
    cells.map(left).fold(f64::INFINITY, f64::min)
}
