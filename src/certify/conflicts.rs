//! Whether anything of another view stands in a view's sight lines, by rays at the finished solid.
//!
//! Takes the finished forest and a view's relief. Rays through every cell that carries a relief must meet the solid where the
//! relief was to be. Gives what is blocked (something stands before it) and what is missing (the ray goes on behind it), as
//! solid angles with places and with what stands there; and what of every model truly reaches the viewer. It knows nothing of
//! layers and groups: a second opinion on what `contest` promises before solving.
//!
//! Cells are sampled in equal parts, so a thing in the way counts to within a part of a cell: half a millimetre at most.

use super::coverage::is_as_wide_as;
use super::point::without_minus_zero;
use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::geom::SQUARE_ARCMIN;
use crate::index::{CellId, FaceId, SupportId, ViewId};
use crate::relief::Relief;
use crate::sight::Sight;
use crate::support::SUNK_MM;
use crate::viewmap::SupportField;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A ray that meets the solid nearer than this to the plane of its cell's relief meets the relief, millimetres. Rounding to
/// f32, mending and levelled steps leave 0.02 mm on real builds, and an outline may lie [`SUNK_MM`] inside its support; anything that
/// could be seen stands out by far more.
pub const ON_RELIEF_MM: f64 = SUNK_MM + 0.02;
/// Disturbances of a smaller share of the models are hairs at edges: summed, not listed. Sound builds leave up to 1e-4 of all
/// together.
pub const DISTURBED_SHARE: f64 = 1e-4;
/// Whatever the models' size: what the eye resolves, square arc-minutes.
const SPECK_ARCMIN2: f64 = 1.0;
/// Sides of the parts a cell is sampled in, millimetres; and the most parts along a side.
const PART_MM: f64 = 0.5;
const MOST_PARTS: usize = 16;
/// Hits of two meshes of the same solid nearer than this are hits of one surface, millimetres: mending moves them by less.
const SAME_MM: f64 = 0.01;
/// Directions in which a disturbed ray is moved, and shares of half a line: strips of relief may be narrower than it.
const AROUND: usize = 8;
const SHARES: [f64; 3] = [0.25, 0.5, 1.0];

/// What is wrong with a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Trouble {
    /// Something stands before the relief.
    Blocked,
    /// Nothing is where the relief should be.
    Missing,
}

/// Rays of one kind that are disturbed by one thing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Disturbance {
    pub trouble: Trouble,
    /// The view whose relief stands in the way; none if a bare support does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub with_view: Option<String>,
    /// The support at the place, or that should carry the missing relief.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support: Option<String>,
    /// Square arc-minutes.
    pub arcmin2: f64,
    /// Where the first of the widest rays meets it, or should have met the relief, millimetres.
    pub place_mm: [f64; 3],
}

/// What rays found of one view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sighted {
    pub rays: usize,
    /// By kind, view and support.
    pub disturbances: Vec<Disturbance>,
    /// Those too small to list.
    pub small_arcmin2: f64,
    /// Rays that meet the view's own relief nearer than planned, where corners at steps were filled in, square arc-minutes:
    /// the model is seen there, with a slope it should not have.
    pub filled_arcmin2: f64,
    /// Steradians of each model blocked or missing, in the order of the view's models.
    pub lost_sr: Vec<f64>,
}

/// The finished forest, ready for rays.
pub struct Finished<'a> {
    field: &'a SupportField<'a>,
    whole: &'a Bvh,
    reliefs: Vec<Option<Bvh>>,
    names: Vec<&'a str>,
    sharpness: Sharpness,
}

/// What is too fine to be made, and what is too fine to be seen.
#[derive(Clone, Copy, Debug)]
pub struct Sharpness {
    /// Width of a printed line, millimetres.
    pub line: f64,
    /// Arc-minutes.
    pub seen: f64,
}

impl<'a> Finished<'a> {
    /// `whole` is that of the whole forest; `names` are the views', in order.
    pub fn new(
        forest: &Forest,
        whole: &'a Bvh,
        field: &'a SupportField<'a>,
        names: Vec<&'a str>,
        sharpness: Sharpness,
    ) -> Self {
        let of_view = |s: &Option<crate::mesh::Solid>| s.as_ref().map(|s| Bvh::new(s.mesh()));
        Self {
            field,
            whole,
            reliefs: forest.reliefs.par_iter().map(of_view).collect(),
            names,
            sharpness,
        }
    }
}

/// What befell a ray, the view whose relief it met, and the support it concerns.
type TroubleKind = (Trouble, Option<ViewId>, Option<SupportId>);

/// A ray that did not meet the relief.
struct Miss {
    cell: CellId,
    sr: f64,
    /// `None`: the view's own relief, nearer than planned.
    kind: Option<TroubleKind>,
    place: DVec3,
}

/// Casts rays through all of a view's cells that carry a relief, but for those `given_up` (rising) by the solids. `own` is the
/// view's index.
///
/// Edges of reliefs are bedded in their supports and lapped behind others, and no printer makes a sliver thinner than its line: a ray
/// that meets the relief if moved sideways by up to half a line of [`Sharpness`] is not disturbed. What is disturbed nowhere as wide as
/// an eye resolves is summed and not listed.
pub fn sighted(
    sight: &Sight,
    own: ViewId,
    relief: &Relief,
    given_up: &[CellId],
    finished: &Finished,
) -> Sighted {
    let cells: Vec<SampledCell> = CellId::all(relief.depth.len())
        .zip(&relief.depth)
        .filter(|(c, _)| given_up.binary_search(c).is_err())
        .filter_map(|(c, depth)| Some(SampledCell::new(sight, c, (*depth)?)))
        .collect();
    let misses: Vec<Miss> = cells
        .par_iter()
        .flat_map_iter(|cell| cell.misses(sight, own, finished))
        .collect();
    let mut found = gathered(&misses, sight, finished);
    let seen_sr: f64 = (sight.image.map.all())
        .filter(|(_, cell)| cell.face.is_some())
        .map(|(c, _)| sight.image.map.solid_angle(c))
        .sum();
    let least = (DISTURBED_SHARE * seen_sr * SQUARE_ARCMIN).max(SPECK_ARCMIN2);
    let small = found.disturbances.extract_if(.., |d| d.arcmin2 < least);
    // Nothing at all sums to -0.
    found.small_arcmin2 += small.map(|d| d.arcmin2).sum::<f64>() + 0.0;
    found.rays = cells.iter().map(|c| c.parts * c.parts).sum();
    let of_model = |faces: std::ops::Range<FaceId>| {
        let lost = misses.iter().filter(|m| {
            let face = sight.image.map.cells[m.cell].face;
            m.kind.is_some() && face.is_some_and(|f| faces.contains(&f))
        });
        lost.map(|m| m.sr).sum()
    };
    found.lost_sr = sight.models().map(|(_, faces)| of_model(faces)).collect();
    found
}

/// Sums over rays with the same trouble.
fn gathered(misses: &[Miss], sight: &Sight, finished: &Finished) -> Sighted {
    let mut troubled: Vec<&Miss> = misses.iter().filter(|m| m.kind.is_some()).collect();
    // Stable: rays of one kind stay in the order of cells.
    troubled.sort_by_key(|m| m.kind);
    let (mut disturbances, mut hairs) = (Vec::new(), 0.0);
    for group in troubled.chunk_by(|a, b| a.kind == b.kind) {
        let Some((trouble, view, support)) = group[0].kind else {
            continue;
        };
        let arcmin2 = group.iter().map(|m| m.sr).sum::<f64>() * SQUARE_ARCMIN;
        let mut cells: Vec<CellId> = group.iter().map(|m| m.cell).collect();
        cells.dedup();
        if !is_as_wide_as(&sight.image.map, &cells, finished.sharpness.seen) {
            hairs += arcmin2;
            continue;
        }
        let widest = group
            .iter()
            .fold(group[0], |w, m| if m.sr > w.sr { m } else { w });
        disturbances.push(Disturbance {
            trouble,
            with_view: view.map(|v| finished.names[v].to_owned()),
            support: support.map(|s| finished.field.supports[s].name.clone()),
            arcmin2,
            place_mm: without_minus_zero(widest.place),
        });
    }
    let filled = misses.iter().filter(|m| m.kind.is_none());
    Sighted {
        disturbances,
        small_arcmin2: hairs,
        filled_arcmin2: filled.map(|m| m.sr).sum::<f64>() * SQUARE_ARCMIN + 0.0,
        ..Sighted::default()
    }
}

/// A cell with its relief.
struct SampledCell {
    index: CellId,
    corners: [DVec2; 3],
    /// `1 / depth` at the corners: affine in the image.
    inverse: [f64; 3],
    /// Unit normal of the relief's plane.
    normal: DVec3,
    /// Parts along a side.
    parts: usize,
}

impl SampledCell {
    fn new(sight: &Sight, c: CellId, depth: [f64; 3]) -> Self {
        let corners = sight.image.map.triangle(c);
        let [p, q, r] = [0, 1, 2].map(|k| sight.image.map.plane.point(corners[k], depth[k]));
        let longest = p.distance(q).max(q.distance(r)).max(r.distance(p));
        Self {
            index: c,
            corners,
            inverse: depth.map(|z| 1.0 / z),
            normal: (q - p).cross(r - p).normalize_or_zero(),
            parts: ((longest / PART_MM).ceil() as usize).clamp(2, MOST_PARTS),
        }
    }

    /// Middles of equal parts as weights of the corners.
    fn samples(&self) -> impl Iterator<Item = [f64; 3]> {
        let n = self.parts;
        let weights = move |i: usize, j: usize, third: f64| {
            let (u, v) = ((i as f64 + third) / n as f64, (j as f64 + third) / n as f64);
            [1.0 - u - v, u, v]
        };
        (0..n).flat_map(move |i| {
            let upright = (0..n - i).map(move |j| weights(i, j, 1.0 / 3.0));
            let inverted = (0..n - i - 1).map(move |j| weights(i, j, 2.0 / 3.0));
            upright.chain(inverted)
        })
    }

    /// Depth of the relief's plane on the ray with these weights, which may lie a little outside.
    fn depth(&self, weights: [f64; 3]) -> f64 {
        1.0 / (0..3).map(|k| weights[k] * self.inverse[k]).sum::<f64>()
    }

    fn misses(&self, sight: &Sight, own: ViewId, finished: &Finished) -> Vec<Miss> {
        let sr = sight.image.map.solid_angle(self.index) / (self.parts * self.parts) as f64;
        self.samples()
            .filter_map(|weights| {
                let q = (0..3).map(|k| weights[k] * self.corners[k]).sum();
                let wanted = self.depth(weights);
                let (kind, place) = self.trouble(sight, own, finished, q, wanted)?;
                Some(Miss {
                    cell: self.index,
                    sr,
                    kind,
                    place,
                })
            })
            .collect()
    }

    /// What is wrong with the ray `q`, on which the relief has depth `wanted`, and where; `None` if nothing is.
    fn trouble(
        &self,
        sight: &Sight,
        own: ViewId,
        finished: &Finished,
        q: DVec2,
        wanted: f64,
    ) -> Option<(Option<TroubleKind>, DVec3)> {
        let plane = sight.image.map.plane;
        let direction = plane.direction(q);
        let hit = finished
            .whole
            .first_hit(plane.eye, direction)
            .map_or(f64::INFINITY, |h| h.t);
        if self.is_on(direction, hit, wanted) || self.is_seam(sight, finished, q, wanted) {
            return None;
        }
        if hit > wanted {
            let support = sight.image.map.cells[self.index].support;
            let kind = (Trouble::Missing, None, support);
            return Some((Some(kind), plane.point(q, wanted)));
        }
        let place = plane.point(q, hit);
        let same = |bvh: &Bvh| {
            let there = bvh.first_hit(plane.eye, direction);
            there.is_some_and(|h| (h.t - hit).abs() * direction.length() < SAME_MM)
        };
        let shows = |v: ViewId| finished.reliefs[v].as_ref().is_some_and(same);
        if shows(own) {
            return Some((None, place));
        }
        let view = ViewId::all(finished.reliefs.len()).find(|v| *v != own && shows(*v));
        // From just before the place: the first support is the one whose surface it is, or that it is carved into.
        let before = plane.point(q, hit - SAME_MM);
        let support = finished.field.first_hit(before, direction).map(|s| s.0);
        let kind = (Trouble::Blocked, view, support);
        Some((Some(kind), place))
    }

    fn is_on(&self, direction: DVec3, hit: f64, wanted: f64) -> bool {
        (hit - wanted).abs() * self.normal.dot(direction).abs() < ON_RELIEF_MM
    }

    /// Whether a ray a hair beside `q` meets the relief.
    fn is_seam(&self, sight: &Sight, finished: &Finished, q: DVec2, wanted: f64) -> bool {
        let plane = sight.image.map.plane;
        let [a, b, c] = self.corners;
        let ways = (0..AROUND).flat_map(|k| SHARES.map(|share| (k, share)));
        ways.into_iter().any(|(k, share)| {
            let turn = std::f64::consts::TAU * k as f64 / AROUND as f64;
            let beside = q + DVec2::from_angle(turn) * share * finished.sharpness.line
                / 2.0
                / plane.scale(wanted);
            let direction = plane.direction(beside);
            let weights = crate::geom::barycentric(a, b, c, beside).to_array();
            let hit = finished.whole.first_hit(plane.eye, direction);
            hit.is_some_and(|h| self.is_on(direction, h.t, self.depth(weights)))
        })
    }
}
