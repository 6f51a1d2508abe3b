//! Facets that an eye looks along, and what a layer does on them.
//!
//! The side of a pillar with corners may run away from the eye within a hair's breadth of the image, and no face of a model can follow: it
//! would have to be as steep. So a layer that follows a pillar's surface goes on before such a side as it came to its edge, in the plane
//! of the facet from where it came. Its back is still the surface's: there is only more room.

use super::field::SupportField;
use crate::geom::height;
use crate::index::{FaceId, FacetId};
use crate::mesh::face_neighbours;
use crate::support::{Datum, Support, SupportKind};
use glam::DVec3;

/// Facets that are turned by more than this from square to the sight may be too steep to be followed, degrees. Nearer to 90 layers
/// fall as fast as the silhouettes of models, and no depths satisfy them; farther from it reliefs bulge before facets that they
/// could have followed.
const STEEP_DEG: f64 = 70.0;

/// The facets whose planes layers keep to before others. Index: facet.
#[derive(Clone, Debug, Default)]
pub(super) struct Fronts {
    of: Vec<Option<FacetId>>,
}

impl Fronts {
    /// As seen from `eye`.
    pub(super) fn new(field: &SupportField, eye: DVec3) -> Self {
        let follows = |s: &Support| thickness(s).is_some();
        if !field.supports.iter().any(follows) {
            return Self::default();
        }
        let mesh = &field.mesh;
        let least = STEEP_DEG.to_radians().cos();
        let sight = |f: FaceId| mesh.corners(f).into_iter().sum::<DVec3>() / 3.0 - eye;
        // How much a face looks at the eye: the cosine of the angle.
        let facing = |f: FaceId| -mesh.normal(f).dot(sight(f).normalize());
        // Where a surface falls by less over a facet than the layer is thick, faces have room.
        let is_steep = |f: &FaceId| {
            let falls = height(mesh.corners(*f)) * (1.0 - facing(*f).powi(2)).sqrt();
            let thickness = thickness(&field.supports[field.owner[*f]]);
            facing(*f) < least && thickness.is_some_and(|t| falls > t)
        };
        let mut of = vec![None; mesh.faces.len()];
        let (flat, mut waiting): (Vec<FaceId>, Vec<FaceId>) = FaceId::all(of.len())
            .filter(|f| facing(*f) > 0.0)
            .partition(|f| !is_steep(f));
        flat.iter().for_each(|f| of[*f] = Some(FacetId::of(*f)));
        let neighbours = face_neighbours(mesh);
        // From facet to facet, in rounds, so that each is reached from the nearest that is not steep.
        while !waiting.is_empty() {
            let depth = |f: FaceId, front: FacetId| {
                let depth = field.facet_depth(front, eye, sight(f));
                (depth > 0.0 && depth.is_finite()).then_some((depth, front))
            };
            let reached = |f: &FaceId| {
                let around = neighbours[*f].iter().flatten();
                let fronts = around.filter_map(|n| depth(*f, of[*n]?));
                let nearest = fronts.min_by(|a, b| a.0.total_cmp(&b.0));
                nearest.map(|(_, front)| front)
            };
            let found: Vec<(FaceId, Option<FacetId>)> =
                waiting.iter().map(|f| (*f, reached(f))).collect();
            let before = waiting.len();
            waiting = found
                .iter()
                .filter(|f| f.1.is_none())
                .map(|f| f.0)
                .collect();
            found.into_iter().for_each(|(f, front)| of[f] = front);
            if waiting.len() == before {
                break;
            }
        }
        Self { of }
    }

    /// The facet whose plane a layer keeps to before this one, if it is another.
    pub(super) fn before(&self, facet: FacetId) -> Option<FacetId> {
        let front = self.of.get(facet.face().at()).copied().flatten();
        front.filter(|f| *f != facet)
    }
}

/// Of the layer of a pillar with corners that follows its surface, millimetres.
fn thickness(support: &Support) -> Option<f64> {
    let layer = support.layer.filter(|l| l.datum() == Datum::Surface)?;
    let has_corners = matches!(support.kind, SupportKind::Pillar { round: false, .. });
    has_corners.then(|| layer.front + layer.back())
}
