//! Bounds at all corners of all cells.

use super::anchor::anchor;
use super::group::{Bound, Carried, Groups};
use crate::index::{FacetId, GroupId, PointId, VertexId};
use crate::viewmap::Image;

/// Relative depths (of an eye at infinity: `focal` times these) and weights that differ by less are the same: a thousandth of what
/// bounds promise.
const SAME: f64 = 1e-12;

impl Bound {
    /// Whether two bounds at mixes of the same vertices differ by rounding only.
    fn agrees(&self, other: &Bound, focal: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= SAME;
        let level = |a: f64, b: f64| (a - b).abs() <= SAME / focal;
        let weight = |v: VertexId| other.anchor.terms().find(|t| t.0 == v).map_or(0.0, |t| t.1);
        level(self.lower, other.lower)
            && level(self.upper, other.upper)
            && self.anchor.terms().all(|(v, w)| near(w, weight(v)))
    }
}

/// Stands behind all vertices of a key.
const NO_VERTEX: VertexId = VertexId(u32::MAX);

/// The bounds of a view, and how many of them come first because they do not follow from others.
pub(crate) fn bounds(image: &Image, groups: &Groups) -> (Vec<Bound>, usize) {
    let (map, target) = (&image.map, &image.target);
    // One bound for each group, plane of the layer, point and set of vertices: cells that share a corner on a mesh vertex or
    // edge agree there.
    type BoundKey = (GroupId, [Option<FacetId>; 2], PointId, [VertexId; 3]);
    let mut keyed: Vec<(BoundKey, Bound)> = Vec::new();
    for carried in groups.carried(map) {
        let Carried {
            id,
            cell,
            group,
            face,
            slab,
        } = carried;
        for (k, p) in cell.corners.into_iter().enumerate() {
            let q = map.points[p];
            let (anchor, depth) = anchor(target, face, q);
            if anchor.is_free(target) {
                continue;
            }
            let (near, far) = image.layer_in(&slab, id, k);
            let mut key = [0, 1, 2].map(|k| {
                if anchor.weights[k] > 0.0 {
                    anchor.vertices[k]
                } else {
                    NO_VERTEX
                }
            });
            key.sort_unstable();
            let planes = [cell.facet, cell.leaves].map(|f| f.filter(|_| slab.follows_surface()));
            keyed.push((
                (group, planes, p, key),
                Bound {
                    group,
                    anchor,
                    lower: near / depth,
                    upper: far / depth,
                    drawn: slab.draws() && cell.outline[k],
                },
            ));
        }
    }
    // Cells that share a corner agree there, unless merging thin cells has moved it off their side.
    keyed.sort_by(|(k, a), (l, b)| k.cmp(l).then(a.lower.total_cmp(&b.lower)));
    keyed.dedup_by(|(l, b), (k, a)| k == l && a.agrees(b, map.plane.focal));
    needed_first(keyed.into_iter().map(|x| x.1).collect(), groups)
}

/// Bounds, and how many of them come first because they do not follow from others: on a flat layer, those at points between
/// vertices that are all bounded in the same group follow.
fn needed_first(bounds: Vec<Bound>, groups: &Groups) -> (Vec<Bound>, usize) {
    let alone = |b: &Bound| b.anchor.terms().count() == 1;
    let vertex = |b: &Bound| b.anchor.terms().map(|t| t.0).next();
    let mut bounded: Vec<(GroupId, VertexId)> = bounds
        .iter()
        .filter(|b| alone(b))
        .filter_map(|b| Some((b.group, vertex(b)?)))
        .collect();
    bounded.sort_unstable();
    let flat = |b: &Bound| {
        let support = groups.groups[b.group].support;
        groups.slabs[support].is_some_and(|slab| !slab.follows_surface())
    };
    let follows = |b: &Bound| {
        !alone(b)
            && !b.drawn
            && flat(b)
            && b.anchor
                .terms()
                .all(|(v, _)| bounded.binary_search(&(b.group, v)).is_ok())
    };
    let (follow, mut needed): (Vec<Bound>, Vec<Bound>) = bounds.into_iter().partition(follows);
    let count = needed.len();
    needed.extend(follow);
    (needed, count)
}
