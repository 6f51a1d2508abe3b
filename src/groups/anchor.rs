//! Points of a surface as mixes of its vertices, as depths mix on a face.

use crate::geom::barycentric;
use crate::index::{FaceId, VertexId};
use crate::viewmap::Target;
use glam::DVec2;

/// Points nearer to a side of a face than this, in the image, lie on it: 0.1 micrometre at 250 mm, above all rounding and
/// snapping, below the thinnest cell by twenty times.
const ON_SIDE: f64 = 4e-7;

/// A point of the target surface as a mix of its vertices: `1 / s = sum of weight / s_vertex`, weights positive with sum 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    pub vertices: [VertexId; 3],
    pub weights: [f64; 3],
}

impl Anchor {
    /// The vertices that matter with their weights.
    pub fn terms(&self) -> impl Iterator<Item = (VertexId, f64)> {
        let (vertices, weights) = (self.vertices, self.weights);
        (0..3)
            .filter(move |k| weights[*k] > 0.0)
            .map(move |k| (vertices[k], weights[k]))
    }

    /// Whether a free vertex has a share in the point: then it has no bounds.
    pub fn is_free(&self, target: &Target) -> bool {
        !target.free.is_empty() && self.terms().any(|(v, _)| target.is_free(v))
    }

    /// Relative depth of the point from those of all vertices (design: harmonic, because `1/lambda` is linear in the image).
    pub fn relative_depth(&self, s: &[f64]) -> f64 {
        1.0 / self.terms().map(|(v, w)| w / s[v]).sum::<f64>()
    }
}

/// A vertex itself as an anchor.
pub fn vertex_anchor(vertex: VertexId) -> Anchor {
    Anchor {
        vertices: [vertex; 3],
        weights: [1.0, 0.0, 0.0],
    }
}

/// The point `q` of the image on a face as an anchor, with its depth in the model. Points a little outside are drawn in.
pub fn anchor(target: &Target, face: FaceId, q: DVec2) -> (Anchor, f64) {
    let [a, b, c] = target.image_of(face);
    let vertices = target.mesh.faces[face];
    let area = (b - a).perp_dot(c - a).abs();
    let heights = [b.distance(c), c.distance(a), a.distance(b)].map(|side| area / side);
    let mut beta = barycentric(a, b, c, q).to_array();
    (0..3).for_each(|k| {
        beta[k] = if beta[k] * heights[k] > ON_SIDE {
            beta[k]
        } else {
            0.0
        }
    });
    if !beta.iter().sum::<f64>().is_normal() {
        beta = [1.0, 0.0, 0.0];
    }
    let sum: f64 = beta.iter().sum();
    let inverse = [0, 1, 2].map(|k| beta[k] / sum / target.depth[vertices[k]]);
    let total: f64 = inverse.iter().sum();
    (
        Anchor {
            vertices,
            weights: inverse.map(|w| w / total),
        },
        1.0 / total,
    )
}
