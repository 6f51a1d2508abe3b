//! Thin walls and narrow gaps: two faces that look at each other, or away from each other, from nearby.
//!
//! Points are spread evenly over the surface (systematic sampling by area, placed within their faces by a low-discrepancy
//! sequence). From each a ray goes straight in and another straight out. Where it meets a face that lies nearly opposite (within
//! [`OPPOSITE_DEG`]), the distance is the wall's thickness or the gap's width there; any other face is the far side of a corner.
//!
//! At a lip two faces run together at a sharp angle and are as near as one likes. A lip is no wall: it is held by what lies
//! behind it, and printing blunts it. So a thin place counts as a *wall* only if no thick place of the same side is within
//! [`LIP_MM`] of it; in the same way a narrow place is a *gap* only away from wide ones, not at the bottom of a notch.

use super::check::{LostWalls, Margin, PrintCheck, PrintFinding, PrintLimits};
use crate::bvh::Bvh;
use crate::certify::point::without_minus_zero;
use crate::index::FaceId;
use crate::mesh::{DisjointSets, TriMesh};
use crate::steps::LIP_MM;
use crate::support::{Support, SupportKind};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Two faces are opposite if their normals are at most this far from opposite, degrees. Larger: every corner is a wall. Smaller:
/// curved reliefs on curved pillars have none.
const OPPOSITE_DEG: f64 = 30.0;
/// A sample stands for this much surface, square millimetres, unless there would be more than [`MOST_SAMPLES`].
const SAMPLE_MM2: f64 = 0.25;
const MOST_SAMPLES: f64 = 200_000.0;
/// Smaller walls are not missed, square millimetres of one side. Where a relief ends at a pillar's outline, films of some hundredths
/// of a millimetre are left between two cuts along an eye's rays: up to 16 mm2 on the bundled scenes. They are not printed, and as
/// the eye sees them edge-on it loses nothing. A pillar or plate that is too thin is larger by far.
pub(crate) const MISSED_MM2: f64 = 25.0;
/// Smaller spots where two pillars touch can be cut with a knife, square millimetres.
const FUSED_MM2: f64 = 4.0;
/// Samples of one wall lie within so many of their mean distances.
const LINK: f64 = 1.5;

/// A point of the surface.
struct Sample {
    at: DVec3,
    normal: DVec3,
    /// To an opposite face, millimetres; infinite if there is none.
    inwards: f64,
    outwards: f64,
    /// What lies beyond the gap belongs to another pillar.
    foreign: bool,
}

/// The checks `wall` and `gap`, if they are asked.
pub(crate) fn walls(
    mesh: &TriMesh,
    bvh: &Bvh,
    supports: &[Support],
    limits: &PrintLimits,
) -> Vec<PrintCheck> {
    if limits.wall.is_none() && limits.gap.is_none() {
        return Vec::new();
    }
    let (points, each) = spread(mesh);
    let samples: Vec<Sample> = points
        .par_iter()
        .map(|(face, at)| probe(mesh, bvh, supports, *face, *at))
        .collect();
    let wall = limits.wall.map(|least| wall(&samples, each, least));
    let gap = limits.gap.map(|least| gap(&samples, each, least));
    wall.into_iter().chain(gap).collect()
}

/// Walls are judged by the thickness below which [`MISSED_MM2`] of a single one lie.
fn wall(samples: &[Sample], each: f64, least: Margin) -> PrintCheck {
    let (wanted, vanishing) = (least.wanted, least.limit);
    let thickness = |i: usize| samples[i].inwards;
    let one_side = |count: usize| each * count as f64 / 2.0;
    let thin = away_from_wider(samples, thickness, wanted);
    let link = LINK * each.sqrt();
    let worst = worst(&patches(samples, &thin, link), thickness, MISSED_MM2 / each);
    let films: Vec<usize> = thin
        .into_iter()
        .filter(|i| thickness(*i) < vanishing)
        .collect();
    let pieces = patches(samples, &films, link);
    let largest = pieces.iter().map(Vec::len).max().unwrap_or(0);
    // The largest loss, if no wall is thin enough to be the worst.
    let place = worst
        .or_else(|| pieces.iter().max_by_key(|p| p.len())?.first().copied())
        .map_or(DVec3::ZERO, |i| samples[i].at);
    let value = worst.map_or(wanted, thickness);
    let lost = (!films.is_empty()).then(|| LostWalls {
        area_mm2: one_side(films.len()),
        pieces: pieces.len(),
        largest_mm2: one_side(largest),
    });
    PrintCheck {
        finding: PrintFinding::Wall(lost),
        place: without_minus_zero(place),
        value_mm: value,
        wanted_mm: wanted,
        limit_mm: vanishing,
        ok: value > vanishing,
    }
}

/// Gaps are judged by the width below which [`FUSED_MM2`] of a single one lie.
fn gap(samples: &[Sample], each: f64, least: Margin) -> PrintCheck {
    let (wanted, fused) = (least.wanted, least.limit);
    let width = |i: usize| samples[i].outwards;
    let one_side = |list: &[usize]| each * list.len() as f64 / 2.0;
    let (between, within): (Vec<usize>, Vec<usize>) = away_from_wider(samples, width, wanted)
        .into_iter()
        .partition(|i| samples[*i].foreign);
    let seams = patches(samples, &between, LINK * each.sqrt());
    let worst = worst(&seams, width, FUSED_MM2 / each);
    let closed = |list: Vec<usize>| -> Vec<usize> {
        list.into_iter().filter(|i| width(*i) < fused).collect()
    };
    let (joined, slots) = (closed(between), closed(within));
    let place = worst.map_or(DVec3::ZERO, |i| samples[i].at);
    let value = worst.map_or(wanted, width);
    PrintCheck {
        finding: PrintFinding::Gap {
            joined_mm2: one_side(&joined),
            closed_mm2: one_side(&slots),
        },
        place: without_minus_zero(place),
        value_mm: value,
        wanted_mm: wanted,
        limit_mm: fused,
        ok: value >= fused,
    }
}

/// Of all patches the least value below which `missed` sample areas (on both sides) lie: the sample that has it.
fn worst(patches: &[Vec<usize>], value: impl Fn(usize) -> f64, missed: f64) -> Option<usize> {
    let order = |a: &usize, b: &usize| value(*a).total_cmp(&value(*b)).then(a.cmp(b));
    let of_patch = |patch: &Vec<usize>| {
        let mut patch = patch.clone();
        patch.sort_by(order);
        patch.get((2.0 * missed) as usize).copied()
    };
    patches.iter().filter_map(of_patch).min_by(order)
}

/// Faces and points, and the area that each stands for.
fn spread(mesh: &TriMesh) -> (Vec<(FaceId, DVec3)>, f64) {
    let areas: Vec<f64> = (0..mesh.faces.len())
        .into_par_iter()
        .map(|f| mesh.area_vector(FaceId::new(f)).length() / 2.0)
        .collect();
    let total: f64 = areas.iter().sum();
    let each = SAMPLE_MM2.max(total / MOST_SAMPLES);
    let (mut points, mut before) = (Vec::new(), 0.0);
    for (face, area) in FaceId::all(areas.len()).zip(&areas) {
        before += area;
        // Half a step in, so that a lone face of half a step's area is met.
        while (points.len() as f64 + 0.5) * each < before {
            points.push((face, placed(mesh, face, points.len())));
        }
    }
    (points, each)
}

/// Point number `k` of all, within its face: Roberts' R2 sequence, folded into the triangle.
fn placed(mesh: &TriMesh, face: FaceId, k: usize) -> DVec3 {
    const R2: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_2);
    let p = (DVec2::splat(0.5) + k as f64 * R2).fract();
    let p = if p.x + p.y > 1.0 { 1.0 - p } else { p };
    let [a, b, c] = mesh.corners(face);
    a + p.x * (b - a) + p.y * (c - a)
}

fn probe(mesh: &TriMesh, bvh: &Bvh, supports: &[Support], face: FaceId, at: DVec3) -> Sample {
    let normal = mesh.normal(face);
    let opposite = -OPPOSITE_DEG.to_radians().cos();
    let meet = |direction: DVec3| {
        bvh.first_hit_where(at, direction, |f| f != face)
            .filter(|h| mesh.normal(h.face).dot(normal) < opposite)
            .map(|h| (h.t, at + h.t * direction))
    };
    let out = meet(normal);
    Sample {
        at,
        normal,
        inwards: meet(-normal).map_or(f64::INFINITY, |m| m.0),
        outwards: out.map_or(f64::INFINITY, |m| m.0),
        foreign: out.is_some_and(|m| owner(supports, at) != owner(supports, m.1)),
    }
}

/// The support that a point of the surface belongs to: the nearest pillar, by its axis; the base below the pillars' feet.
fn owner(supports: &[Support], at: DVec3) -> Option<usize> {
    let distance = |s: &Support| match &s.kind {
        SupportKind::Pillar { axis, profile, .. } => {
            let reach = profile
                .iter()
                .map(|p| p.distance(*axis))
                .fold(0.0, f64::max);
            Some(at.truncate().distance(*axis) - reach)
        }
        SupportKind::Base { .. } => None,
        SupportKind::Body { .. } => {
            let (lo, hi) = s.mesh.bounds()?;
            Some(at.distance(at.clamp(lo, hi)))
        }
    };
    let near = supports
        .iter()
        .enumerate()
        .filter_map(|(k, s)| Some((k, distance(s)?)));
    near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|n| n.0)
}

type Bin = (i64, i64, i64);

fn cell(at: DVec3, side: f64) -> Bin {
    let c = (at / side).floor();
    (c.x as i64, c.y as i64, c.z as i64)
}

fn around((x, y, z): Bin) -> impl Iterator<Item = Bin> {
    (0..27).map(move |k| (x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1))
}

/// Samples below a limit that are not near others of the same side above it.
fn away_from_wider(
    samples: &[Sample],
    value: impl Fn(usize) -> f64 + Sync,
    limit: f64,
) -> Vec<usize> {
    let (thin, thick): (Vec<usize>, Vec<usize>) =
        (0..samples.len()).partition(|i| value(*i) < limit);
    // Only cells that a thin sample asks about are filled.
    let mut near: BTreeMap<Bin, Vec<usize>> = BTreeMap::new();
    for i in &thin {
        for c in around(cell(samples[*i].at, LIP_MM)) {
            near.entry(c).or_default();
        }
    }
    for i in thick {
        if let Some(list) = near.get_mut(&cell(samples[i].at, LIP_MM)) {
            list.push(i);
        }
    }
    let is_lip = |i: &usize| {
        let s = &samples[*i];
        let cells = around(cell(s.at, LIP_MM)).filter_map(|c| near.get(&c));
        cells
            .flatten()
            .map(|k| &samples[*k])
            .any(|k| k.at.distance_squared(s.at) < LIP_MM * LIP_MM && k.normal.dot(s.normal) > 0.5)
    };
    thin.into_par_iter().filter(|i| !is_lip(i)).collect()
}

/// Groups of samples that are linked by steps of `link` or less, the largest first.
fn patches(samples: &[Sample], list: &[usize], link: f64) -> Vec<Vec<usize>> {
    let mut cells: BTreeMap<Bin, Vec<usize>> = BTreeMap::new();
    for (k, i) in list.iter().enumerate() {
        cells.entry(cell(samples[*i].at, link)).or_default().push(k);
    }
    let mut sets = DisjointSets::new(list.len());
    for (c, members) in &cells {
        for other in around(*c).filter_map(|c| cells.get(&c)) {
            for (a, b) in members
                .iter()
                .flat_map(|a| other.iter().map(move |b| (*a, *b)))
            {
                let at = |k: usize| samples[list[k]].at;
                if at(a).distance_squared(at(b)) <= link * link {
                    sets.join(a as u32, b as u32);
                }
            }
        }
    }
    let of_set = |set: Vec<usize>| set.into_iter().map(|k| list[k]).collect();
    let mut patches: Vec<Vec<usize>> = sets.members().into_iter().map(of_set).collect();
    patches.sort_by_key(|p| std::cmp::Reverse(p.len()));
    patches
}
