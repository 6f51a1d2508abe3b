//! What every view claims: patches of cells on one support, and which of them are in each other's way.

use super::frustum::Frustum;
use crate::geom::ImagePlane;
use crate::groups::{Groups, layer_at};
use crate::mesh::boxes::{Box3, BoxTree};
use crate::support::{Slab, SupportKind};
use crate::viewmap::{SupportField, ViewMap};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// A view before its depths are found.
#[derive(Clone, Copy)]
pub struct Claim<'a> {
    pub name: &'a str,
    pub map: &'a ViewMap,
    pub groups: &'a Groups,
}

/// How far from the eye a cell's relief may begin, where its sight ends, and where the relief's backing ends:
/// millimetres along the slab's normal.
#[derive(Clone, Copy)]
struct Reach {
    near: f64,
    sight: f64,
    far: f64,
}

/// All cells of one view on one support.
pub struct Patch {
    pub view: u32,
    pub support: u32,
    /// Rising.
    pub cells: Vec<u32>,
    plane: ImagePlane,
    /// Horizontal, from the eye to the support.
    normal: DVec3,
    reach: Vec<Reach>,
    /// Hulls of all its volumes and sight lines.
    volume: Frustum,
    sight: Frustum,
}

/// Two patches of different views, by index, and their cells that are in each other's way, rising.
pub struct Meeting {
    pub patches: [usize; 2],
    pub pairs: Vec<[u32; 2]>,
}

/// The patches of all claims, by view, then support.
pub fn patches(claims: &[Claim], field: &SupportField) -> Vec<Patch> {
    let of_view = |(v, claim): (usize, &Claim)| {
        let mut cells = vec![Vec::new(); field.supports.len()];
        for (c, group) in claim.groups.of_cell.iter().enumerate() {
            if let Some(g) = group {
                cells[claim.groups.groups[*g as usize].support as usize].push(c as u32);
            }
        }
        let filled = cells.into_iter().enumerate().filter(|(_, c)| !c.is_empty());
        filled
            .filter_map(|(s, cells)| patch(claim, field, [v as u32, s as u32], cells))
            .collect::<Vec<_>>()
    };
    claims
        .par_iter()
        .enumerate()
        .map(|(v, claim)| of_view((v, claim)))
        .collect::<Vec<_>>()
        .into_iter()
        .flatten()
        .collect()
}

fn patch(
    claim: &Claim,
    field: &SupportField,
    [view, support]: [u32; 2],
    cells: Vec<u32>,
) -> Option<Patch> {
    let slab = claim.groups.slabs[support as usize]?;
    let plane = claim.map.plane;
    let reach: Vec<Reach> = cells
        .iter()
        .map(|c| reach(claim.map, field, &slab, support, *c))
        .collect();
    let first = claim.map.triangle(cells[0] as usize)[0];
    let (lo, hi) = cells
        .iter()
        .flat_map(|c| claim.map.triangle(*c as usize))
        .fold((first, first), |(lo, hi), q| (lo.min(q), hi.max(q)));
    let rays = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    let rays = rays.map(|q| plane.direction(q));
    let normal = slab.moved(DVec3::ZERO, 1.0);
    let near = reach.iter().map(|r| r.near).fold(f64::INFINITY, f64::min);
    let sight = reach.iter().map(|r| r.sight).fold(0.0, f64::max);
    let far = reach.iter().map(|r| r.far).fold(0.0, f64::max);
    Some(Patch {
        view,
        support,
        cells,
        plane,
        normal,
        reach,
        volume: Frustum::new(plane.eye, &rays, normal, near, far),
        sight: Frustum::new(plane.eye, &rays, normal, 0.0, sight),
    })
}

/// Exact for a flat layer. Over a surface the nearest and the farthest point of the cell count, all over the cell: corners, and
/// upright edges of the support that the cell may hold.
fn reach(map: &ViewMap, field: &SupportField, slab: &Slab, support: u32, cell: u32) -> Reach {
    let from_eye = -slab.offset(map.plane.eye);
    let flat = field.supports[support as usize]
        .layer
        .filter(|_| !slab.follows_surface());
    let (near, sight) = match flat {
        Some(layer) => (-layer.front, slab.deepest()),
        None => surface_reach(map, field, slab, support, cell),
    };
    Reach {
        near: (from_eye + near).max(0.0),
        sight: from_eye + sight,
        far: from_eye + sight.max(slab.backing()),
    }
}

/// Offsets behind the axis plane of the nearest and the farthest point the layer over the surface allows in a cell.
fn surface_reach(
    map: &ViewMap,
    field: &SupportField,
    slab: &Slab,
    support: u32,
    cell: u32,
) -> (f64, f64) {
    let corners = map.triangle(cell as usize);
    let mut found = (f64::INFINITY, f64::NEG_INFINITY);
    for q in corners {
        let (near, far) = layer_at(map, field, slab, support, q);
        found.0 = found.0.min(slab.offset(map.plane.point(q, near)));
        found.1 = found.1.max(slab.offset(map.plane.point(q, far)));
    }
    let front = field.supports[support as usize]
        .layer
        .map_or(0.0, |l| l.front);
    let sides = corners.map(|q| map.plane.direction(q).truncate());
    let middle = sides[0] + sides[1] + sides[2];
    let angles = sides.map(|d| middle.angle_to(d));
    let (left, right) = (
        angles.iter().copied().fold(0.0, f64::max),
        angles.iter().copied().fold(0.0, f64::min),
    );
    if let SupportKind::Pillar { profile, .. } = &field.supports[support as usize].kind {
        let held =
            |p: &&DVec2| (right..=left).contains(&middle.angle_to(**p - map.plane.eye.truncate()));
        let offsets = profile.iter().filter(held);
        let ridge = offsets.map(|p| slab.offset(p.extend(map.plane.eye.z)) - front);
        found.0 = ridge.fold(found.0, f64::min);
    }
    found
}

/// All cells of different views that are in each other's way: the volume of one meets the sight lines of the other.
pub fn meetings(claims: &[Claim], patches: &[Patch]) -> Vec<Meeting> {
    let mut found: Vec<([usize; 2], Vec<[u32; 2]>)> = (0..patches.len())
        .into_par_iter()
        .flat_map_iter(|a| blocked(claims, patches, a))
        .collect();
    found.sort_by_key(|m| m.0);
    let mut merged: Vec<Meeting> = Vec::new();
    for (key, pairs) in found {
        match merged.last_mut().filter(|m| m.patches == key) {
            Some(meeting) => meeting.pairs.extend(pairs),
            None => merged.push(Meeting {
                patches: key,
                pairs,
            }),
        }
    }
    for meeting in &mut merged {
        meeting.pairs.sort_unstable();
        meeting.pairs.dedup();
    }
    merged
}

/// What stands in the sight lines of patch `a`, patch by patch.
fn blocked(claims: &[Claim], patches: &[Patch], a: usize) -> Vec<([usize; 2], Vec<[u32; 2]>)> {
    let seen = &patches[a];
    let others: Vec<usize> = (0..patches.len())
        .filter(|b| patches[*b].view != seen.view && seen.sight.meets(&patches[*b].volume))
        .collect();
    if others.is_empty() {
        return Vec::new();
    }
    let tree = BoxTree::new(&image_boxes(claims, seen));
    let in_way = others.into_iter().filter_map(|b| {
        let pairs = cells_in_way(claims, seen, &tree, &patches[b]);
        let ordered = |[x, y]: [u32; 2]| if a < b { [x, y] } else { [y, x] };
        let pairs: Vec<[u32; 2]> = pairs.into_iter().map(ordered).collect();
        (!pairs.is_empty()).then_some(([a.min(b), a.max(b)], pairs))
    });
    in_way.collect()
}

/// The cells in the image, with the end of their sight as third coordinate.
fn image_boxes(claims: &[Claim], patch: &Patch) -> Vec<Box3> {
    let map = claims[patch.view as usize].map;
    let boxed = |(c, reach): (&u32, &Reach)| {
        let [p, q, r] = map.triangle(*c as usize);
        Box3 {
            lo: p.min(q).min(r).extend(reach.sight),
            hi: p.max(q).max(r).extend(reach.sight),
        }
    };
    patch.cells.iter().zip(&patch.reach).map(boxed).collect()
}

/// Pairs of cells of `seen` and of `other` where the volume of the latter meets the sight of the former.
fn cells_in_way(claims: &[Claim], seen: &Patch, tree: &BoxTree, other: &Patch) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, b) in other.cells.iter().enumerate() {
        let volume = other.volume_of(claims, i);
        if !volume.meets(&seen.sight) {
            continue;
        }
        let Some(query) = shadow(seen, &volume) else {
            continue;
        };
        tree.overlapping(&query, |j| {
            if seen.sight_of(claims, j as usize).meets(&volume) {
                pairs.push([seen.cells[j as usize], *b]);
            }
            true
        });
    }
    pairs
}

/// The part of the image a body covers, with the least distance of it as third coordinate; `None` if it lies behind the eye.
fn shadow(seen: &Patch, body: &Frustum) -> Option<Box3> {
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

impl Patch {
    fn rays(&self, claims: &[Claim], i: usize) -> [DVec3; 3] {
        let map = claims[self.view as usize].map;
        map.triangle(self.cells[i] as usize)
            .map(|q| self.plane.direction(q))
    }

    /// Where the relief of its cell `i` and its backing may be.
    fn volume_of(&self, claims: &[Claim], i: usize) -> Frustum {
        let Reach { near, far, .. } = self.reach[i];
        Frustum::new(
            self.plane.eye,
            &self.rays(claims, i),
            self.normal,
            near,
            far,
        )
    }

    /// The rays that must be free for its cell `i` to be seen.
    fn sight_of(&self, claims: &[Claim], i: usize) -> Frustum {
        let sight = self.reach[i].sight;
        Frustum::new(
            self.plane.eye,
            &self.rays(claims, i),
            self.normal,
            0.0,
            sight,
        )
    }
}
