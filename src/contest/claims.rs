//! What every view claims: its cells on each support, and which of them are in each other's way.

use super::frustum::Frustum;
use crate::geom::ImagePlane;
use crate::index::{CellId, SupportId, ViewId};
use crate::mesh::boxes::{Box3, BoxTree};
use crate::sight::Sight;
use crate::support::{Slab, SupportKind};
use crate::viewmap::{Image, ViewMap};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// How far from the eye a cell's relief may begin, where its sight ends, and where the relief's backing ends:
/// millimetres along the slab's normal.
#[derive(Clone, Copy)]
struct Reach {
    near: f64,
    sight: f64,
    far: f64,
}

/// All cells of one view on one support.
pub(crate) struct Claim {
    pub view: ViewId,
    pub support: SupportId,
    /// Rising.
    pub cells: Vec<CellId>,
    plane: ImagePlane,
    /// Horizontal, from the eye to the support.
    normal: DVec3,
    reach: Vec<Reach>,
    /// Hulls of all its volumes and sight lines.
    volume: Frustum,
    sight: Frustum,
    /// Its cells in the image, with the end of their sight as third coordinate.
    image: BoxTree,
}

/// Two claims of different views, by rising index, and the cells of each that are in the way of the other, rising.
///
/// Which cell is in the way of which is not kept: where many views share a support, a cell is in the way of dozens of every other view.
pub(crate) struct Meeting {
    pub claims: [usize; 2],
    pub cells: [Vec<CellId>; 2],
}

/// What all views claim, by view, then support.
pub(crate) fn claims(sights: &[Sight]) -> Vec<Claim> {
    let of_view = |(v, sight): (usize, &Sight)| {
        let mut cells = vec![Vec::new(); sight.image.field.supports.len()];
        for (c, group) in sight.groups.of_cell.iter().enumerate() {
            if let Some(g) = group {
                cells[sight.groups.groups[*g].support].push(CellId::new(c));
            }
        }
        let filled = SupportId::all(cells.len()).zip(cells);
        filled
            .filter(|(_, cells)| !cells.is_empty())
            .filter_map(|(s, cells)| claim(sight, ViewId::new(v), s, cells))
            .collect::<Vec<_>>()
    };
    sights
        .par_iter()
        .enumerate()
        .map(of_view)
        .collect::<Vec<_>>()
        .into_iter()
        .flatten()
        .collect()
}

fn claim(sight: &Sight, view: ViewId, support: SupportId, cells: Vec<CellId>) -> Option<Claim> {
    let slab = sight.groups.slabs[support]?;
    let map = &sight.image.map;
    let plane = map.plane;
    let reach: Vec<Reach> = cells
        .iter()
        .map(|c| reach(&sight.image, &slab, support, *c))
        .collect();
    let image = BoxTree::new(&image_boxes(map, &cells, &reach));
    let first = map.triangle(cells[0])[0];
    let (lo, hi) = cells
        .iter()
        .flat_map(|c| map.triangle(*c))
        .fold((first, first), |(lo, hi), q| (lo.min(q), hi.max(q)));
    let rays = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    let rays = rays.map(|q| plane.direction(q));
    let normal = slab.moved(DVec3::ZERO, 1.0);
    let near = reach.iter().map(|r| r.near).fold(f64::INFINITY, f64::min);
    let sight = reach.iter().map(|r| r.sight).fold(0.0, f64::max);
    let far = reach.iter().map(|r| r.far).fold(0.0, f64::max);
    Some(Claim {
        view,
        support,
        cells,
        plane,
        normal,
        reach,
        volume: Frustum::new(plane.eye, &rays, normal, near, far),
        sight: Frustum::new(plane.eye, &rays, normal, 0.0, sight),
        image,
    })
}

/// Exact for a flat layer. Over a surface the nearest and the farthest point of the cell count, all over the cell: corners, and
/// upright edges of the support that the cell may hold.
fn reach(image: &Image, slab: &Slab, support: SupportId, cell: CellId) -> Reach {
    let from_eye = -slab.offset(image.map.plane.eye);
    if slab.is_shell() {
        return shell_reach(image, slab, from_eye, cell);
    }
    let flat = image.field.supports[support]
        .layer
        .filter(|_| !slab.follows_surface());
    let (near, sight) = match flat {
        Some(layer) => (-layer.front, slab.deepest()),
        None => surface_reach(image, slab, support, cell),
    };
    Reach {
        near: (from_eye + near).max(0.0),
        sight: from_eye + sight,
        far: from_eye + sight.max(slab.backing()),
    }
}

/// Of a shell, whose backing follows its surface as the layer does. A cell lies in one facet, so its corners are exact.
fn shell_reach(image: &Image, slab: &Slab, from_eye: f64, cell: CellId) -> Reach {
    let plane = image.map.plane;
    let corners = image.map.triangle(cell);
    let offset = |q: DVec2, depth: f64| from_eye + slab.offset(plane.point(q, depth));
    let mut reach = Reach {
        near: f64::INFINITY,
        sight: 0.0,
        far: 0.0,
    };
    for (k, q) in corners.into_iter().enumerate() {
        let (near, sight) = image.layer_in(slab, cell, k);
        let far = slab.shell_backing(image.surface_in(slab, cell, q), 1.0);
        reach.near = reach.near.min(offset(q, near)).max(0.0);
        reach.sight = reach.sight.max(offset(q, sight));
        reach.far = reach.far.max(offset(q, far.max(sight)));
    }
    reach
}

/// Offsets behind the axis plane of the nearest and the farthest point the layer over the surface allows in a cell.
fn surface_reach(image: &Image, slab: &Slab, support: SupportId, cell: CellId) -> (f64, f64) {
    let (field, map) = (image.field, &image.map);
    let corners = map.triangle(cell);
    let mut found = (f64::INFINITY, f64::NEG_INFINITY);
    for q in corners {
        let (near, far) = image.layer_at(slab, support, q);
        found.0 = found.0.min(slab.offset(map.plane.point(q, near)));
        found.1 = found.1.max(slab.offset(map.plane.point(q, far)));
    }
    let front = field.supports[support].layer.map_or(0.0, |l| l.front);
    let sides = corners.map(|q| map.plane.direction(q).truncate());
    let middle = sides[0] + sides[1] + sides[2];
    let angles = sides.map(|d| middle.angle_to(d));
    let (left, right) = (
        angles.iter().copied().fold(0.0, f64::max),
        angles.iter().copied().fold(0.0, f64::min),
    );
    if let SupportKind::Pillar { profile, .. } = &field.supports[support].kind {
        let held =
            |p: &&DVec2| (right..=left).contains(&middle.angle_to(**p - map.plane.eye.truncate()));
        let offsets = profile.iter().filter(held);
        let ridge = offsets.map(|p| slab.offset(p.extend(map.plane.eye.z)) - front);
        found.0 = ridge.fold(found.0, f64::min);
    }
    found
}

/// All cells of different views that are in each other's way: the volume of one meets the sight lines of the other.
pub(crate) fn meetings(sights: &[Sight], claims: &[Claim]) -> Vec<Meeting> {
    let others = |a: usize| (a + 1..claims.len()).map(move |b| [a, b]);
    let pairs: Vec<[usize; 2]> = (0..claims.len()).flat_map(others).collect();
    let meeting = |pair: &[usize; 2]| {
        let sides = pair.map(|p| Contender::all(&claims[p]));
        let cells = in_way(sights, sides)?;
        Some(Meeting {
            claims: *pair,
            cells,
        })
    };
    pairs.par_iter().filter_map(meeting).collect()
}

/// Some cells of a claim.
pub(crate) struct Contender<'a> {
    claim: &'a Claim,
    /// By number of the cell in the claim.
    among: Vec<bool>,
}

impl<'a> Contender<'a> {
    fn all(claim: &'a Claim) -> Self {
        let among = vec![true; claim.cells.len()];
        Self { claim, among }
    }

    /// Those of `cells` (rising) for which `wanted` holds.
    pub(crate) fn of(claim: &'a Claim, cells: &[CellId], wanted: impl Fn(CellId) -> bool) -> Self {
        let is_among = |c: &CellId| cells.binary_search(c).is_ok() && wanted(*c);
        let among = claim.cells.iter().map(is_among).collect();
        Self { claim, among }
    }
}

/// The cells of two sides that are in each other's way, rising; `None` if there are none.
pub(crate) fn in_way(sights: &[Sight], sides: [Contender; 2]) -> Option<[Vec<CellId>; 2]> {
    let [a, b] = [sides[0].claim, sides[1].claim];
    if a.view == b.view {
        return None;
    }
    let [mut found, mut other] = [&sides[0], &sides[1]].map(|s| vec![false; s.among.len()]);
    if a.sight.meets(&b.volume) {
        block(sights, [&sides[0], &sides[1]], [&mut found, &mut other]);
    }
    if b.sight.meets(&a.volume) {
        block(sights, [&sides[1], &sides[0]], [&mut other, &mut found]);
    }
    let cells = |claim: &Claim, found: &[bool]| {
        let hit = claim.cells.iter().zip(found).filter(|(_, f)| **f);
        hit.map(|(c, _)| *c).collect::<Vec<_>>()
    };
    let cells = [cells(a, &found), cells(b, &other)];
    (!cells[0].is_empty()).then_some(cells)
}

/// Marks the cells where the volume of the second side's meets the sight of the first side's. A pair of which both are marked already is
/// not looked at, so that what is found costs as much as there are cells, not pairs of cells.
fn block(
    sights: &[Sight],
    [seen, body]: [&Contender; 2],
    [blocked, blocking]: [&mut Vec<bool>; 2],
) {
    let (seen, among) = (seen.claim, &seen.among);
    for i in (0..body.among.len()).filter(|i| body.among[*i]) {
        let volume = body.claim.volume_of(sights, i);
        let Some(query) = shadow(seen, &volume) else {
            continue;
        };
        // What covers all of the image would be held against every cell of it.
        if !query.lo.truncate().is_finite() && !volume.meets(&seen.sight) {
            continue;
        }
        seen.image.overlapping(&query, |j| {
            let j = j.at();
            let is_known = !among[j] || (blocked[j] && blocking[i]);
            if !is_known && seen.sight_of(sights, j).meets(&volume) {
                blocked[j] = true;
                blocking[i] = true;
            }
            true
        });
    }
}

/// The cells in the image, with the end of their sight as third coordinate.
fn image_boxes(map: &ViewMap, cells: &[CellId], reach: &[Reach]) -> Vec<Box3> {
    let boxed = |(c, reach): (&CellId, &Reach)| {
        let [p, q, r] = map.triangle(*c);
        Box3 {
            lo: p.min(q).min(r).extend(reach.sight),
            hi: p.max(q).max(r).extend(reach.sight),
        }
    };
    cells.iter().zip(reach).map(boxed).collect()
}

/// The part of the image a body covers, with the least distance of it as third coordinate; `None` if it lies behind the eye.
fn shadow(seen: &Claim, body: &Frustum) -> Option<Box3> {
    let distance = |p: &DVec3| (*p - seen.plane.eye).dot(seen.normal);
    let (least, most) = body
        .points()
        .iter()
        .map(distance)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), d| {
            (lo.min(d), hi.max(d))
        });
    let mut found = Box3 {
        lo: DVec2::INFINITY.extend(least),
        hi: DVec2::NEG_INFINITY.extend(f64::INFINITY),
    };
    for p in body.points() {
        match seen.plane.project(*p) {
            Some(q) => {
                found.lo = found.lo.min(q.extend(least));
                found.hi = found.hi.max(q.extend(f64::INFINITY));
            }
            // A body beside the eye may cover any part of the image.
            None => {
                found.lo = DVec2::NEG_INFINITY.extend(least);
                found.hi = DVec3::INFINITY;
                break;
            }
        }
    }
    (most > 0.0).then_some(found)
}

impl Claim {
    fn rays(&self, sights: &[Sight], i: usize) -> [DVec3; 3] {
        let map = &sights[self.view].image.map;
        map.triangle(self.cells[i]).map(|q| self.plane.direction(q))
    }

    /// Where the relief of its cell `i` and its backing may be.
    fn volume_of(&self, sights: &[Sight], i: usize) -> Frustum {
        let Reach { near, far, .. } = self.reach[i];
        Frustum::new(
            self.plane.eye,
            &self.rays(sights, i),
            self.normal,
            near,
            far,
        )
    }

    /// The rays that must be free for its cell `i` to be seen.
    fn sight_of(&self, sights: &[Sight], i: usize) -> Frustum {
        let sight = self.reach[i].sight;
        Frustum::new(
            self.plane.eye,
            &self.rays(sights, i),
            self.normal,
            0.0,
            sight,
        )
    }
}
