//! Reliefs that are no height fields (paper, "Non-height-field bas-reliefs", Fig 12): a closed mesh deformed as a whole.
//!
//! Neither cut nor scaled back piece by piece: one group, with bounds for what is to be held and for nothing else. It is built where
//! the depths put it, front, back and all that is hidden, with the model's own faces.
//!
//! - Conditions: hidden faces count too; bounds alone have rows from the start.
//! - Bounds: the outline of every component lies on its support, to [`HULL_MM`](crate::support::HULL_MM); nothing that is seen lies in
//!   the support, which would hide it, nor, with [`Bounded::Seen`](super::Bounded::Seen), before the layer's front; nothing comes
//!   out of the support's far side: hidden vertices whose rays meet it leave the layer's core there; free vertices are held to
//!   neither outline nor front.
//! - Order: of all sheets, seen or hidden.
//! - Solid: the mesh itself, united with its support.
//! - Certificate: bounds at every vertex, hidden ones included; order at all events of the whole mesh.

use super::crossings::{Crossings, crossings, moved};
use super::optimised::Optimised;
use crate::carve::Operand;
use crate::groups::{Bound, anchor};
use crate::index::CellId;
use crate::mesh::TriMesh;
use crate::mimic::{
    Depths, Energy, FirstRows, Keeping, Orders, SolveError, TakingPart, depths, sheet_orders,
};
use crate::relief::Relief;
use crate::sight::Sight;
use crate::viewmap::{Cell, Image};

/// How far apart sheets are to stay, millimetres: a thousand times what f32 resolves at 100 mm, and far below what is printed.
const SHEETS_APART_MM: f64 = 0.01;

/// Bounds that only hold an outline are a tenth of a millimetre wide: the unit is a few millimetres all the same.
const LEAST_UNIT: f64 = 0.01;

/// A view's mesh after optimisation.
pub struct WholeMesh<'a> {
    sight: &'a Sight<'a>,
    depths: Depths,
    relief: Relief,
    mesh: TriMesh,
    crossings: Crossings,
}

impl<'a> WholeMesh<'a> {
    /// # Errors
    /// As [`depths`].
    pub fn new(energy: Energy, sight: &'a Sight<'a>) -> Result<Self, SolveError> {
        let orders = if energy.ordering() {
            sheet_orders(&sight.image.target, SHEETS_APART_MM)
        } else {
            Orders::default()
        };
        let keeping = Keeping {
            faces: TakingPart::All,
            orders,
            first: FirstRows::BoundsAlone,
            least_unit: LEAST_UNIT,
        };
        let depths = scaled_back(depths(energy, sight, &keeping)?);
        let mesh = moved(&sight.image, &depths);
        Ok(Self {
            relief: seen(sight, &depths),
            crossings: crossings(&sight.image, &mesh, &depths),
            sight,
            depths,
            mesh,
        })
    }
}

/// Depths with the scale of the only group applied.
fn scaled_back(depths: Depths) -> Depths {
    let mu = depths.mu.first().copied().unwrap_or(1.0);
    Depths {
        s: depths.s.iter().map(|s| s / mu).collect(),
        mu: vec![1.0; depths.mu.len()],
        ..depths
    }
}

/// What is seen of the mesh: nothing is clamped, because the mesh itself is built, and its bounds are looked at there.
fn seen(sight: &Sight, depths: &Depths) -> Relief {
    let Image { target, map, .. } = &sight.image;
    let of_cell = |(c, cell): (CellId, &Cell)| {
        let (group, face) = (sight.groups.of_cell[c]?, cell.face?);
        Some(cell.corners.map(|p| {
            let (anchor, depth) = anchor(target, face, map.points[p]);
            depth * anchor.relative_depth(&depths.s) / depths.mu[group]
        }))
    };
    Relief {
        depth: map.all().map(of_cell).collect(),
        clamp_mm: 0.0,
        free: vec![[true; 3]; map.cells.len()],
    }
}

impl Optimised for WholeMesh<'_> {
    fn sight(&self) -> &Sight<'_> {
        self.sight
    }

    fn depths(&self) -> &Depths {
        &self.depths
    }

    fn relief(&self) -> &Relief {
        &self.relief
    }

    fn operand(&self) -> Operand<'_> {
        Operand::Mesh {
            name: self.sight.name(),
            support: self.sight.groups.groups[0].support,
            mesh: &self.mesh,
        }
    }

    fn bound_violation_mm(&self) -> f64 {
        violation_mm(self.sight, &self.depths)
    }

    fn order_inversions(&self) -> usize {
        self.crossings.order_inversions
    }

    fn crossings(&self) -> Option<Crossings> {
        Some(self.crossings)
    }
}

/// How far a mesh that stays whole leaves its bounds anywhere, hidden vertices included, millimetres along the ray.
fn violation_mm(sight: &Sight, depths: &Depths) -> f64 {
    let Sight { image, groups, .. } = sight;
    let (target, eye) = (&image.target, image.view.eye);
    let outside = |bound: &Bound| {
        let s = bound.anchor.relative_depth(&depths.s) / depths.mu[bound.group];
        let away = bound.anchor.terms();
        let away = away.map(|(v, _)| target.mesh.vertices[v].distance(eye));
        (bound.lower - s).max(s - bound.upper) * away.fold(0.0, f64::max)
    };
    groups.bounds.iter().map(outside).fold(0.0, f64::max)
}
