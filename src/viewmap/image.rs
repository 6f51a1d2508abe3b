//! One eye's models on the supports: what stages before the groups know of a view, as one value.

use super::arrange::GRIDS;
use super::field::SupportField;
use super::map::{Cell, ViewMap, ViewMapError};
use super::seen::view_map;
use super::steep::Fronts;
use super::target::Target;
use crate::index::{CellId, FacetId, SupportId};
use crate::ladder::Ladder;
use crate::support::{Hits, Slab};
use crate::view::View;
use glam::{DVec2, DVec3};

/// A layer that differs by more than this where two facets meet has jumped, millimetres: rounding and merged cells leave less.
const JUMP_MM: f64 = 0.05;

/// A view with its models projected, the supports, and the map of what it sees of both.
pub struct Image<'a> {
    pub view: &'a View,
    pub field: &'a SupportField<'a>,
    pub target: Target,
    pub map: ViewMap,
    fronts: Fronts,
}

impl<'a> Image<'a> {
    /// # Errors
    /// If the models do not lie before the eye, nothing of them is seen, or the image cannot be triangulated.
    pub fn new(view: &'a View, field: &'a SupportField<'a>) -> Result<Self, ViewMapError> {
        let plane = view.plane();
        let target = Target::new(view.target(), &plane).ok_or(ViewMapError::BesideEye)?;
        let target = target.marked(view.marks());
        Ok(Self {
            map: view_map(plane, &target, field)?,
            fronts: Fronts::new(field, plane.eye),
            view,
            field,
            target,
        })
    }

    /// Which of its snapping grids held.
    pub fn ladder(&self) -> Ladder {
        let view = Some(self.view.name.as_str());
        Ladder::new(
            "snapping grid of a view map",
            view,
            self.map.grid,
            GRIDS.len(),
        )
    }

    /// The same surface cut along lines that the eye cannot see.
    pub fn cut(&self, target: Target, map: ViewMap) -> Self {
        Self {
            target,
            map,
            fronts: self.fronts.clone(),
            ..*self
        }
    }

    /// Smallest and largest depth (along the image plane's forward axis) the layer of `support` allows on the ray `q`.
    pub fn layer_at(&self, slab: &Slab, support: SupportId, q: DVec2) -> (f64, f64) {
        let (field, plane) = (self.field, &self.map.plane);
        let direction = plane.direction(q);
        let on_plane = slab.plane(direction, 0.0);
        if !slab.follows_surface() {
            return slab.bounds(direction, Hits::at(on_plane));
        }
        if slab.goes_through()
            && let Some((first, leaves)) = field.wall(support, plane.eye, direction)
        {
            let (first, leaves) = (first.t, Some(leaves.t));
            let leaves = leaves.filter(|l| slab.has_room(first, *l));
            return slab.bounds(direction, Hits { first, leaves });
        }
        // At the outline the ray may just miss the support: the datum plane is where a pillar's surface ends there.
        let (facet, surface) = field.facet_of(support, plane.eye, direction).unzip();
        self.bounds(
            slab,
            facet,
            direction,
            Hits::at(surface.unwrap_or(on_plane)),
        )
    }

    /// Smallest and largest depth of a layer on a facet: it begins before that, or before the facet whose plane it keeps to.
    fn bounds(
        &self,
        slab: &Slab,
        facet: Option<FacetId>,
        direction: DVec3,
        hits: Hits,
    ) -> (f64, f64) {
        let (near, far) = slab.bounds(direction, hits);
        let front = facet.and_then(|f| self.fronts.before(f)).map(|front| {
            let eye = self.map.plane.eye;
            let surface = self.field.facet_depth(front, eye, direction);
            slab.bounds(direction, Hits::at(surface)).0
        });
        // A plane that the ray meets behind the eye is not before anything.
        let front = front.filter(|f| *f > 0.0);
        (front.map_or(near, |f| near.min(f)), far)
    }

    /// The same at corner `k` of a cell, whose part of the support is one plane: the inverses of both are affine over the cell.
    /// Where an outline of the model is to lie on the support, at its corners there is hardly any room.
    pub fn layer_in(&self, slab: &Slab, cell: CellId, k: usize) -> (f64, f64) {
        let q = self.map.triangle(cell)[k];
        let direction = self.map.plane.direction(q);
        let surface = self.surface_in(slab, cell, q);
        let Cell { facet, outline, .. } = self.map.cells[cell];
        slab.on_datum(direction, surface)
            .filter(|_| outline[k])
            .unwrap_or_else(|| self.bounds(slab, facet, direction, surface))
    }

    /// Whether a layer goes on across side `k` of a cell into the cell `next` beyond. Where one fold of a surface hides another it jumps.
    pub(crate) fn layer_goes_on(&self, slab: &Slab, cell: CellId, k: usize, next: CellId) -> bool {
        let corners = self.map.triangle(cell);
        let middle = corners[k].midpoint(corners[(k + 1) % 3]);
        let depth = |c: CellId| slab.shell_backing(self.surface_in(slab, c, middle), 0.0);
        !slab.is_shell() || (depth(cell) - depth(next)).abs() < JUMP_MM
    }

    /// Where the ray `q` meets a layer's datum, in the plane that the support is in a cell; and where it leaves the wall behind, if
    /// the layer goes through that and all of the cell has room: over a cell it has if its corners do.
    pub fn surface_in(&self, slab: &Slab, cell: CellId, q: DVec2) -> Hits {
        let map = &self.map;
        let at = |f: FacetId, q: DVec2| {
            self.field
                .facet_depth(f, map.plane.eye, map.plane.direction(q))
        };
        let Some(facet) = map.cells[cell].facet.filter(|_| slab.follows_surface()) else {
            return Hits::at(slab.plane(map.plane.direction(q), 0.0));
        };
        let leaves = map.cells[cell].leaves.filter(|_| slab.goes_through());
        let roomy = |f: &FacetId| {
            let corners = map.triangle(cell);
            corners
                .iter()
                .all(|q| slab.has_room(at(facet, *q), at(*f, *q)))
        };
        Hits {
            first: at(facet, q),
            leaves: leaves.filter(roomy).map(|f| at(f, q)),
        }
    }
}
