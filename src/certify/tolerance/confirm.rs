//! Openings of a finished forest, measured by rays.
//!
//! What an eye that moved should not see is what the eye in its place did not: walls along the rays, backs, what lies behind. A
//! *gap* is the angle over which it does. What it should see but does not is hidden behind a nearer piece: an *overlap* is the
//! angle over which the eye in its place sees what the other does not. Both are the same question with the eyes changing places, asked
//! with a fan of rays across the cut.

use super::found::{Confirmed, Tolerance, arcmin};
use super::rift::Rift;
use crate::bvh::Bvh;
use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use glam::DVec3;

/// Rays of a fan on either side of its middle: an opening is measured to a hundredth of itself.
const RAYS: i32 = 300;
/// Half the fan's width over the opening expected.
const WIDTH: f64 = 3.0;
/// A surface that is met at less than this (the sine of the angle) is a wall along the rays. Rounding to f32 tilts walls by
/// less than a thousandth; the model is seen so flat only at its outlines.
const GRAZING: f64 = 0.01;
/// What hides a point must stand this far before it, millimetres: more than rounding, less than the lowest step.
const BEFORE_MM: f64 = 0.02;

/// Measures the worst cuts by rays at the finished forest, whose `bvh` is given, and writes down what they show.
pub fn confirm(tolerance: &mut Tolerance, plane: &ImagePlane, forest: &TriMesh, bvh: &Bvh) {
    for worst in &mut tolerance.worst_cuts {
        let e = plane.focal * worst.moved_mm * worst.movement.axis(plane);
        let [one, other] = [e, -e].map(|e| opened(&worst.cut, plane.eye, e, forest, bvh));
        let confirmed = |e: DVec3, measured: f64| Confirmed {
            predicted_arcmin: arcmin(plane.focal * worst.cut.opening(e)),
            measured_arcmin: arcmin(plane.focal * measured),
        };
        let (apart, gap, overlap) = if one.gap >= other.gap {
            (e, one.gap, other.overlap)
        } else {
            (-e, other.gap, one.overlap)
        };
        worst.gap = Some(confirmed(apart, gap));
        worst.overlap = Some(confirmed(-apart, overlap));
    }
}

/// What opened at a cut, radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Opened {
    pub gap: f64,
    pub overlap: f64,
}

/// What opens at a cut, as seen by the eye that moved, if it moves from `home` by `e`.
pub fn opened(cut: &Rift, home: DVec3, e: DVec3, forest: &TriMesh, bvh: &Bvh) -> Opened {
    let expected = cut.opening(e);
    if expected.is_nan() || expected <= 0.0 {
        return Opened::default();
    }
    let moved = home + e;
    let edges = cut.distances.map(|a| home + a * cut.direction);
    let seen_from = |from: DVec3| edges.map(|p| (p - from).normalize());
    let witness = Witness { forest, bvh };
    let [a, b] = seen_from(moved);
    let hidden = witness.unseen([home, moved], cut.direction, cut.normal, expected);
    Opened {
        gap: witness.unseen([moved, home], a + b, cut.normal, expected),
        // As wide as the eye that moved would see it.
        overlap: hidden * cut.distances[1] / edges[1].distance(moved),
    }
}

/// The finished forest, ready for rays.
struct Witness<'a> {
    forest: &'a TriMesh,
    bvh: &'a Bvh,
}

impl Witness<'_> {
    /// Over which angle at a cut the first eye sees what the other one does not: the longest run of such rays that begins or ends
    /// within the opening expected around `middle`, in the plane of `middle` and `across`.
    fn unseen(&self, eyes: [DVec3; 2], middle: DVec3, across: DVec3, expected: f64) -> f64 {
        let middle = middle.normalize();
        let across = across.reject_from_normalized(middle).normalize_or_zero();
        let step = WIDTH * expected / f64::from(RAYS);
        let near = (f64::from(RAYS) / WIDTH) as i32;
        let hidden: Vec<bool> = (-RAYS..=RAYS)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * step).sin_cos();
                !self.both_see(eyes, cos * middle + sin * across)
            })
            .collect();
        let mut longest = 0;
        let mut start = -RAYS;
        for run in hidden.chunk_by(|a, b| a == b) {
            let end = start + i32::try_from(run.len()).unwrap_or(i32::MAX);
            if run[0] && start <= near && end >= -near {
                longest = longest.max(run.len());
            }
            start = end;
        }
        longest as f64 * step
    }

    /// Whether the point that the first eye sees in a direction is seen by the other one too.
    fn both_see(&self, [eye, other]: [DVec3; 2], direction: DVec3) -> bool {
        let Some(hit) = self.bvh.first_hit(eye, direction) else {
            return false;
        };
        let sight = eye + hit.t * direction - other;
        let distance = sight.length();
        let towards = sight / distance;
        let facing = -self.forest.normal(hit.face).dot(towards);
        facing > GRAZING && !self.bvh.blocked(other, towards, distance - BEFORE_MM)
    }
}
