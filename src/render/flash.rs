//! A flash: a near point light beside the model, as in the paper's Fig 19, where its light runs from left to right along the relief.
//!
//! Let `h` be the horizontal unit vector from the model to the eye, `r` the eye's right and `W` the model's width along `r`. The flash
//! stands [`BESIDE`]` W` to the left of the model's left edge, [`BEFORE`]` W` in front of its point nearest to the eye (along `h`), at
//! half its height: near enough for light to fall off across the model and to graze the relief, far enough to light its front.
//! Nothing moves it out of a support that happens to stand there.

use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::render::caster::{Caster, Meet, PAPER, Term};
use glam::DVec3;

/// Widths of the model from its left edge to the flash. At 0 it could stand among the supports; at 3 light falls off by less
/// than a half across the model and the flash is but a low sun.
pub const BESIDE: f64 = 1.0;

/// Widths of the model from its nearest point forward to the flash. At 0 it grazes the parts nearest to the eye and does not light
/// them; at 2 it stands as far before the model as beside it, and little is in shadow.
pub const BEFORE: f64 = 0.5;

/// A point light without a size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flash {
    pub place: DVec3,
    /// Distance at which a surface that faces it has the shade 1, millimetres.
    pub unit_mm: f64,
}

impl Flash {
    /// Beside `target` as the eye of `plane` sees it, with the shade 1 at the distance of the vertex nearest to it.
    pub fn beside(plane: &ImagePlane, target: &TriMesh, left: bool) -> Self {
        let to_eye = plane.right.cross(DVec3::Z);
        let aside = if left { -plane.right } else { plane.right };
        let span = |axis: DVec3| {
            let along = target.vertices.iter().map(|v| v.dot(axis));
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
                (lo.min(x), hi.max(x))
            })
        };
        let (inner, outer) = span(aside);
        let (bottom, top) = span(DVec3::Z);
        let width = outer - inner;
        let place = (outer + BESIDE * width) * aside
            + (span(to_eye).1 + BEFORE * width) * to_eye
            + (bottom + top) / 2.0 * DVec3::Z;
        let distances = target.vertices.iter().map(|v| v.distance(place));
        Self {
            place,
            unit_mm: distances.fold(f64::INFINITY, f64::min),
        }
    }

    /// What it does at a place of a body. Brighter than paper is as bright as paper, as on a photograph.
    pub fn light(&self, body: &Caster, meet: &Meet) -> Term {
        let way = self.place - meet.place;
        let Some(l) = way.try_normalize() else {
            return Term {
                free: PAPER,
                open: 1.0,
            };
        };
        let facing = meet.normal.dot(l).max(0.0);
        let free = (facing * (self.unit_mm / way.length()).powi(2)).min(PAPER);
        let open = free == 0.0 || !body.blocked(meet, l, way.length());
        Term {
            free,
            open: f64::from(u8::from(open)),
        }
    }
}
