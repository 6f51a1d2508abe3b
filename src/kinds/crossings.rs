//! What crosses in the optimised mesh as a whole, counted exactly.

use crate::mesh::{TriMesh, self_intersections};
use crate::mimic::{Depths, Order, turned_sheets};
use crate::viewmap::Image;

/// The mesh where the depths put it.
pub fn moved(image: &Image, depths: &Depths) -> TriMesh {
    let (target, eye) = (&image.target, image.view.eye);
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
pub fn crossings(image: &Image, mesh: &TriMesh, depths: &Depths) -> Crossings {
    let target = &image.target;
    let turned = |o: &Order| {
        let [front, back] = [o.front, o.back].map(|a| a.relative_depth(&depths.s));
        (front * o.ratio / back).ln() > SAME_DEPTH
    };
    let (order_inversions, pairs) = rayon::join(
        || turned_sheets(target, turned),
        || [mesh, &target.mesh].map(|m| self_intersections(m, MOST_PAIRS).len()),
    );
    Crossings {
        order_inversions,
        self_intersections: pairs[0],
        in_model: pairs[1],
    }
}
