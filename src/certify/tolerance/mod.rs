//! How far an eye may move until a cut opens, and from where two eyes see one object.
//!
//! Takes a view's map, its target and its relief (and, to confirm, the finished forest). Gives the movements of the eye, sideways,
//! up and down, and fore and aft, at which the largest gap or overlap at a cut reaches two arc-minutes (nobody sees it) and ten
//! (still one picture), the cuts where that happens, and a distance for two eyes. Changes nothing.
//!
//! # The closed form
//!
//! A side of the view map with ends in the unit directions `u`, `v` spans a plane with the eye; `n = u x v / |u x v|` is its
//! normal. On both sides of it the relief lies in that plane, at distances `a` and `b` from the eye. Seen from an eye that
//! moves by the vector `e`, a point at distance `a` in the direction `u` stands off the plane by the angle
//! `-asin(n . e / |a u - e|)`. So the two edges part by
//!
//! ```text
//! |asin(n . e / |a u - e|) - asin(n . e / |b u - e|)|  =  |n . e| |1/a - 1/b|  to first order in |e| / a
//! ```
//!
//! square to the side; sliding along it opens nothing. That holds for every `e`: sideways (`e` along the image's right), up, and
//! forward, where `n . e` is small because it only grows with the side's distance from the middle of the image. The linear form
//! tells where to look, the exact one how far the eye may go: moving forward by a third of the way opens a cut three times as wide
//! as the linear form has it. Along a side `1/a` and `1/b` are affine in the image but for the length of the ray, so that its ends
//! are the worst to second order.
//!
//! # What counts
//!
//! - *Cuts* are sides between two cells with reliefs: outlines of pillars, and tears. At a contour of the model, distances `A` and
//!   `B` there, the model itself would open by `|1/A - 1/B|`, showing more of itself. There only the excess over the model's opening
//!   counts, and all of the relief's if it turns the order round: `max(0, |1/a - 1/b| - |1/A - 1/B|)`. In a layer thinner than
//!   the model that is usually nothing.
//! - A speck is no gap: cuts of the same opening or more that hang together must be as long as they are wide. So a side counts
//!   only together with its neighbours, however finely the map divides a line.
//! - What other pillars hide or show behind a gap plays no part, nor does the model's outline, where the forest ends.
//!
//! # Two eyes
//!
//! Two eyes `65 mm` apart, in the middle between which the scene's eye stands, see what one eye sees that moves sideways by that.
//! Farther away it opens less. Assumed is that the forest is made anew for an eye that stands back along its line of sight, every
//! piece keeping its place in depth: all distances grow by the same `t`, rays and cuts staying what they are. The distance
//! wanted is the eye's own to what it looks at plus the `t` at which
//! `65 mm |n . right| (1/(a + t) - 1/(b + t))` is ten arc-minutes at the worst cut: about the root of `65 mm |a - b| / angle`.
//!
//! # An eye at infinity
//!
//! It cannot move, but turn about the object; angles are told as from the reading distance `R` ([`READING_MM`]). A cut between
//! depths `a` and `b` then opens by `|n . e| |b - a| / R^2` for an eye at `R` that moves by `e`, which is turned by `e / R`. Coming
//! nearer, an eye sees what parallel rays do not: at the distance `D`, a cut that lies `x` beside the line of sight, across itself,
//! opens by
//! `x |b - a| / D^2`. From where that is ten arc-minutes at the worst cut on the forest is one picture. Two eyes are not judged.

mod confirm;
mod found;
mod rift;
mod room;
mod sides;

pub use confirm::{Opened, confirm, opened};
pub use found::{Confirmed, Movement, Rotation, Tolerance, Way, WorstCut};
pub use rift::Rift;
pub use room::{EYES_MM, ONE_PICTURE_RAD};

use crate::geom::READING_MM;
use crate::relief::Relief;
use crate::steps::UNSEEN_RAD;
use crate::support::Support;
use crate::view::View;
use crate::viewmap::{Target, ViewMap};
use room::{movement_until, one_picture_from, stereo_distance, worst};
use sides::sides;

/// As from the reading distance, how far an eye at infinity is followed, millimetres: by 60 degrees, where all but edges of a relief
/// is gone.
const MOST_TURNED_MM: f64 = 1.732 * READING_MM;

/// Measures a view by the closed form.
pub fn tolerance(
    view: &View,
    map: &ViewMap,
    target: &Target,
    relief: &Relief,
    supports: &[Support],
) -> Tolerance {
    let sides = sides(map, target, relief);
    let plane = &map.plane;
    let mut worst_cuts = Vec::new();
    let mut movement = |angle: f64| {
        let [side, up, fore] = Way::ALL.map(|way| {
            if way == Way::Fore && plane.is_parallel() {
                return None;
            }
            let found = movement_until(&sides, map, way.axis(plane), angle);
            let (moved, side) = found.filter(|f| !plane.is_parallel() || f.0 < MOST_TURNED_MM)?;
            worst_cuts.push(worst(&side, way, moved, angle, plane, supports));
            Some(moved)
        });
        Movement { side, up, fore }
    };
    let eye_tolerance_mm = movement(UNSEEN_RAD);
    let one_picture_mm = movement(ONE_PICTURE_RAD);
    let found = Tolerance {
        eye_tolerance_mm,
        one_picture_mm,
        worst_cuts,
        ..Tolerance::default()
    };
    if plane.is_parallel() {
        return Tolerance {
            eye_tolerance_deg: Some(Rotation::of(&eye_tolerance_mm)),
            one_picture_deg: Some(Rotation::of(&one_picture_mm)),
            one_picture_from_mm: one_picture_from(map, &sides),
            ..found
        };
    }
    Tolerance {
        stereo_distance_mm: stereo_distance(view, map, &sides),
        ..found
    }
}
