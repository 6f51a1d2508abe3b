//! How little of a model is recognised from elsewhere: likeness from rings of eyes around it.
//!
//! Takes a view, the finished forest and the height of its base. Gives the likeness of the forest to the view's target at
//! angles up to 180 degrees from the view's eye. Changes nothing. Deterministic: eyes run in parallel, each on its own.
//!
//! # The eyes
//!
//! The view's eye is turned about the vertical axis through the middle `c` of the target's box, by every one of
//! [`ANGLES_DEG`] to both sides, as it is and raised and lowered by 15 degrees about `c` (its distance to `c` stays). Lowered eyes
//! that would look from below the base's top are left out, and raised ones within 5 degrees of the zenith. Every eye looks at `c`
//! with the target filling its frame, as in the views' pictures, at `SIDE x SIDE` rays.
//!
//! # Likeness
//!
//! With `theta` the angle between the normals of target and forest on one ray, over the rays `T` that meet the target and the rays
//! `F` that meet the forest, base and all pillars included:
//!
//! ```text
//! agreement  = mean over T of max(0, 1 - theta / 90 degrees), 0 where the forest is missed
//! overlap    = |T and F| / |T or F|
//! likeness   = agreement * overlap
//! ```
//!
//! Agreement falls in proportion to the error instead of with its cosine: a cosine still grants two thirds to the 48 degrees
//! or so by which unrelated surfaces that both face the eye differ, and would tell little from nothing. Where no error is above
//! 90 degrees, agreement is 1 minus the mean error over 90 degrees.
//! The likeness at an angle is that of the most telling eye there: to either side, at any height. The eye in its
//! place sees less than full likeness too, as base and bare pillars are in its frame; what counts is what is left of that.

use crate::bvh::Bvh;
use crate::geom::half_angle;
use crate::mesh::TriMesh;
use crate::render::{angle_deg, framing};
use crate::view::View;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Angles from the view's eye, degrees.
pub const ANGLES_DEG: [f64; 15] = [
    1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0, 150.0, 180.0,
];
/// By how much eyes are raised about the target's middle, degrees.
const RAISED_DEG: [f64; 3] = [0.0, 15.0, -15.0];
/// Eyes are not raised beyond this elevation, degrees: looking straight down there is no upright image.
const STEEPEST_DEG: f64 = 85.0;
/// Rays across the frame. On the reference forest mean errors are within 1.2 degrees of those at 128 rays, by another program; the time
/// grows with the square.
const SIDE: usize = 72;

/// What is left of a view's likeness at one angle from its eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    pub angle_deg: f64,
    /// From the most telling eye at that angle, and its factors.
    pub likeness: f64,
    pub agreement: f64,
    pub overlap: f64,
    /// Angle between the normals, 90 where the forest is missed: mean of the eyes to both sides at the eye's own height.
    pub mean_error_deg: f64,
}

/// The camouflage of one view.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Camouflage {
    pub view: String,
    /// Where the likeness has fallen to half of what the view's eye sees; none if it never does.
    pub half_likeness_deg: Option<f64>,
    /// Beyond that: where most likeness is left, and how much.
    pub worst_off_view_deg: Option<f64>,
    pub worst_likeness: Option<f64>,
    /// By rising angle from 0, which is the view's eye.
    pub curve: Vec<CurvePoint>,
}

/// Measures one view. No eye stands below `floor` (mm) but the view's own and those at its height.
pub fn camouflage(view: &View, forest: &TriMesh, forest_bvh: &Bvh, floor: f64) -> Camouflage {
    let target = view.whole_target();
    let pair = Comparison {
        target: &target,
        target_bvh: &Bvh::new(&target),
        forest,
        forest_bvh,
    };
    let middle = target
        .bounds()
        .map_or(view.look_at, |(lo, hi)| (lo + hi) / 2.0);
    let rings = rings(view.eye, middle, floor);
    let eyes: Vec<DVec3> = rings.iter().flat_map(Ring::eyes).collect();
    let seen: Vec<Resemblance> = eyes
        .par_iter()
        .map(|eye| pair.likeness(*eye, middle))
        .collect();
    let mut rest = &seen[..];
    let curve: Vec<CurvePoint> = rings
        .iter()
        .map(|ring| {
            let (of_ring, others) = rest.split_at(ring.eyes().count());
            rest = others;
            ring.point(of_ring)
        })
        .collect();
    let values: Vec<(f64, f64)> = curve.iter().map(|p| (p.angle_deg, p.likeness)).collect();
    let half_likeness_deg = half_angle(&values);
    let worst = half_likeness_deg.and_then(|half| largest_beyond(&values, half));
    Camouflage {
        view: view.name.clone(),
        half_likeness_deg,
        worst_off_view_deg: worst.map(|w| w.0),
        worst_likeness: worst.map(|w| w.1),
        curve,
    }
}

/// The point of largest value beyond an angle; the first of equals.
pub fn largest_beyond(curve: &[(f64, f64)], angle: f64) -> Option<(f64, f64)> {
    let beyond = curve.iter().copied().filter(|p| p.0 > angle);
    beyond.reduce(|best, p| if p.1 > best.1 { p } else { best })
}

/// The eyes at one angle.
struct Ring {
    angle_deg: f64,
    /// At the eye's own height: one or two.
    level: Vec<DVec3>,
    /// Raised and lowered.
    others: Vec<DVec3>,
}

impl Ring {
    fn eyes(&self) -> impl Iterator<Item = DVec3> {
        self.level.iter().chain(&self.others).copied()
    }

    /// `seen` by the ring's eyes, in their order.
    fn point(&self, seen: &[Resemblance]) -> CurvePoint {
        let best = seen
            .iter()
            .copied()
            .fold(Resemblance::default(), |best, s| {
                if s.product() > best.product() {
                    s
                } else {
                    best
                }
            });
        let level = &seen[..self.level.len()];
        CurvePoint {
            angle_deg: self.angle_deg,
            likeness: best.product(),
            agreement: best.agreement,
            overlap: best.overlap,
            mean_error_deg: level.iter().map(|s| s.mean_error_deg).sum::<f64>()
                / level.len() as f64,
        }
    }
}

/// The view's own eye and the rings around `middle`, by rising angle.
fn rings(eye: DVec3, middle: DVec3, floor: f64) -> Vec<Ring> {
    let offset = eye - middle;
    let level = offset.truncate();
    let turned = |deg: f64, raised: f64| {
        let elevation = offset.z.atan2(level.length()) + raised.to_radians();
        let way = DVec2::from_angle(deg.to_radians()).rotate(level.normalize_or(DVec2::X));
        let (sin, cos) = elevation.sin_cos();
        let stand = middle + offset.length() * (cos * way).extend(sin);
        let allowed = stand.z > floor && elevation.abs() <= STEEPEST_DEG.to_radians();
        (raised == 0.0 || allowed).then_some(stand)
    };
    let ring = |angle: &f64| {
        // Half-way round both sides are one.
        let sides = if *angle < 180.0 {
            &[1.0, -1.0][..]
        } else {
            &[1.0][..]
        };
        let at = |raised: f64| sides.iter().filter_map(move |s| turned(s * angle, raised));
        Ring {
            angle_deg: *angle,
            level: at(RAISED_DEG[0]).collect(),
            others: RAISED_DEG[1..].iter().flat_map(|r| at(*r)).collect(),
        }
    };
    let own = Ring {
        angle_deg: 0.0,
        level: vec![eye],
        others: Vec::new(),
    };
    [own]
        .into_iter()
        .chain(ANGLES_DEG.iter().map(ring))
        .collect()
}

/// What one eye sees.
#[derive(Clone, Copy, Debug, Default)]
struct Resemblance {
    agreement: f64,
    overlap: f64,
    mean_error_deg: f64,
}

impl Resemblance {
    fn product(&self) -> f64 {
        self.agreement * self.overlap
    }
}

/// Target and forest, ready for rays.
struct Comparison<'a> {
    target: &'a TriMesh,
    target_bvh: &'a Bvh,
    forest: &'a TriMesh,
    forest_bvh: &'a Bvh,
}

impl Comparison<'_> {
    fn likeness(&self, eye: DVec3, middle: DVec3) -> Resemblance {
        let (plane, half) = framing(eye, self.target, middle);
        let side = SIDE as f64;
        let (mut wanted, mut both, mut either) = (0usize, 0usize, 0usize);
        let (mut agreement, mut error) = (0.0, 0.0);
        for k in 0..SIDE * SIDE {
            let x = (k % SIDE) as f64 + 0.5 - side / 2.0;
            let y = side / 2.0 - (k / SIDE) as f64 - 0.5;
            let direction = plane
                .direction(DVec2::new(x, y) * (2.0 * half / side))
                .normalize();
            let target = self.target_bvh.first_hit(eye, direction);
            let forest = self.forest_bvh.first_hit(eye, direction);
            either += usize::from(target.is_some() || forest.is_some());
            let Some(target) = target else { continue };
            wanted += 1;
            both += usize::from(forest.is_some());
            let deg = forest.map_or(90.0, |f| {
                let wanted = self.target.normal_against(target.face, direction);
                angle_deg(wanted, self.forest.normal(f.face))
            });
            error += deg;
            agreement += (1.0 - deg / 90.0).max(0.0);
        }
        let share = |sum: f64, of: usize| if of > 0 { sum / of as f64 } else { 0.0 };
        Resemblance {
            agreement: share(agreement, wanted),
            overlap: share(both as f64, either),
            mean_error_deg: share(error, wanted),
        }
    }
}
