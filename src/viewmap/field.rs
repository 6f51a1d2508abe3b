//! The supports as one target for rays.

use crate::bvh::{Bvh, Hit};
use crate::index::{FaceId, FacetId, SupportId};
use crate::mesh::TriMesh;
use crate::support::{Datum, Support, SupportKind};
use glam::DVec3;

/// The supports as one target for rays.
pub struct SupportField<'a> {
    pub supports: &'a [Support],
    pub(super) mesh: TriMesh,
    /// Support of every face, and first face of every support.
    pub(super) owner: Vec<SupportId>,
    first: Vec<FaceId>,
    pub(super) bvh: Bvh,
}

impl<'a> SupportField<'a> {
    pub fn new(supports: &'a [Support]) -> Self {
        let mut mesh = TriMesh::default();
        let (mut owner, mut first) = (Vec::new(), Vec::new());
        for (i, support) in supports.iter().enumerate() {
            first.push(FaceId::new(mesh.faces.len()));
            mesh.append(&support.mesh);
            owner.resize(mesh.faces.len(), SupportId::new(i));
        }
        let bvh = Bvh::new(&mesh);
        Self {
            supports,
            mesh,
            owner,
            first,
            bvh,
        }
    }

    /// The first support on a ray and the ray's parameter there.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(SupportId, f64)> {
        self.bvh
            .first_hit(origin, direction)
            .map(|h| (self.owner[h.face], h.t))
    }

    /// The ray's parameter at the plane of a face of the supports; not finite if they are parallel.
    pub fn facet_depth(&self, facet: FacetId, origin: DVec3, direction: DVec3) -> f64 {
        let normal = self.mesh.area_vector(facet.face());
        let corner = self.mesh.corners(facet.face())[0];
        normal.dot(corner - origin) / normal.dot(direction)
    }

    /// As [`Self::first_hit`], of one support, whatever stands before it.
    pub fn hit_of(&self, support: SupportId, origin: DVec3, direction: DVec3) -> Option<f64> {
        self.facet_of(support, origin, direction).map(|f| f.1)
    }

    /// The same with the facet that is hit.
    pub(super) fn facet_of(
        &self,
        support: SupportId,
        origin: DVec3,
        direction: DVec3,
    ) -> Option<(FacetId, f64)> {
        let own = |face: FaceId| self.owner[face] == support;
        let hit = self.bvh.first_hit_where(origin, direction, own);
        hit.map(|h| (FacetId::of(h.face), h.t))
    }

    /// How thick a support is behind where a ray first meets it, in units of the ray's direction; infinite if it never leaves it.
    pub fn thickness(&self, support: SupportId, origin: DVec3, direction: DVec3) -> f64 {
        let found = self.wall(support, origin, direction);
        found.map_or(f64::INFINITY, |(first, leaves)| leaves.t - first.t)
    }

    /// Where a ray first meets a support and where it leaves it again.
    pub fn wall(&self, support: SupportId, origin: DVec3, direction: DVec3) -> Option<(Hit, Hit)> {
        let hits = self.bvh.all_hits(origin, direction).into_iter();
        let mut own = hits.filter(|h| self.owner[h.face] == support);
        let leaves = |face: FaceId| self.mesh.area_vector(face).dot(direction) > 0.0;
        Some((own.next()?, own.find(|h| leaves(h.face))?))
    }

    /// Whether the layer of a support goes through walls.
    pub(super) fn goes_through(&self, support: SupportId) -> bool {
        let layer = self.supports[support].layer;
        layer.is_some_and(|l| l.goes_through())
    }

    /// The part of its support that a face of the supports' mesh belongs to.
    pub fn part(&self, facet: FacetId) -> u32 {
        let support = self.owner[facet];
        self.supports[support].part(FaceId(facet.0 - self.first[support].0))
    }

    /// Whether the layer of the support that a face belongs to follows its surface.
    pub(super) fn is_shell(&self, facet: FacetId) -> bool {
        let layer = self.supports[self.owner[facet]].layer;
        layer.is_some_and(|l| l.datum() == Datum::Surface)
    }

    /// Whether outlines of models are to lie on any support.
    pub(crate) fn holds_outlines(&self) -> bool {
        let mut layers = self.supports.iter().filter_map(|s| s.layer);
        layers.any(|layer| layer.hull)
    }

    /// Top of the base, if there is one.
    pub fn base_top(&self) -> Option<f64> {
        self.supports.iter().find_map(|s| match s.kind {
            SupportKind::Base { top, .. } => Some(top),
            SupportKind::Pillar { .. } | SupportKind::Body { .. } => None,
        })
    }
}
