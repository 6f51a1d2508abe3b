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
//! tells where to look, the exact one how far the eye may go: moving forward by a third of the way opens a cut three times as wide as the
//! linear form has it. Along a side `1/a` and `1/b` are affine in the image but for the length of the ray, so that its ends are the
//! worst to second order.
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
//! It cannot move, but turn about the object; angles are told as from the reading distance `R` ([`READING_MM`]). A cut between depths `a`
//! and `b` then opens by `|n . e| |b - a| / R^2` for an eye at `R` that moves by `e`, which is turned by `e / R`. Coming nearer, an eye
//! sees what parallel rays do not: at the distance `D`, a cut that lies `x` beside the line of sight, across itself, opens by
//! `x |b - a| / D^2`. From where that is ten arc-minutes at the worst cut on the forest is one picture. Two eyes are not judged.

mod confirm;
mod sides;

pub use confirm::{Opened, opened};

use crate::bvh::Bvh;
use crate::geom::{ImagePlane, READING_MM};
use crate::mesh::TriMesh;
use crate::relief::Relief;
use crate::steps::UNSEEN_RAD;
use crate::support::Support;
use crate::view::View;
use crate::viewmap::{Target, ViewMap};
use glam::DVec3;
use serde::Serialize;
use sides::{Side, critical, least, sides};

/// An opening that does not break the picture yet, radians: ten arc-minutes, a third of the moon.
pub const ONE_PICTURE_RAD: f64 = 5.0 * UNSEEN_RAD;
/// Between the pupils of grown-up people, millimetres: the mean is 63, most lie between 54 and 74.
pub const EYES_MM: f64 = 65.0;
/// Halvings of the interval in which a distance lies: from metres to thousandths of a millimetre.
const HALVINGS: usize = 20;
/// Sides that open by less than this share of the worst one's rate are not looked at exactly: an eye would have to come four times
/// nearer to a cut for it to open sixteen times as fast.
const FAR_FROM_WORST: f64 = 1.0 / 16.0;
/// The exact movement is at most this times the linear one: by then the eye has moved by more than half its distance.
const SLOWER: f64 = 1.5;
/// The eyes are never brought nearer to the nearest piece than this share of its distance.
const NEAREST_SHARE: f64 = 0.1;
/// As from the reading distance, how far an eye at infinity is followed, millimetres: by 60 degrees, where all but edges of a relief is gone.
const MOST_TURNED_MM: f64 = 1.732 * READING_MM;
/// Farther than this the two eyes are not sought, millimetres: a kilometre.
const FARTHEST_MM: f64 = 1e6;

/// Movements of an eye, millimetres to either side; none if no cut would ever open. Of an eye at infinity those of one at the reading
/// distance that turns as far, by 60 degrees at most, and none along the line of sight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Movement {
    /// Along the image's right, which is level.
    pub side: Option<f64>,
    /// Along the image's up.
    pub up: Option<f64>,
    /// Along the line of sight.
    pub fore: Option<f64>,
}

/// By how much an eye at infinity may turn about what it sees, degrees to either side; none if no cut would ever open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Turn {
    pub side: Option<f64>,
    pub up: Option<f64>,
}

impl Turn {
    /// That of an eye at the reading distance that moves so.
    fn of(moved: &Movement) -> Self {
        let turned = |mm: f64| (mm / READING_MM).atan().to_degrees();
        Self {
            side: moved.side.map(turned),
            up: moved.up.map(turned),
        }
    }
}

/// In which direction an eye moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    Side,
    Up,
    Fore,
}

impl Way {
    pub const ALL: [Self; 3] = [Self::Side, Self::Up, Self::Fore];

    /// Unit vector in space.
    pub fn axis(self, plane: &ImagePlane) -> DVec3 {
        match self {
            Self::Side => plane.right,
            Self::Up => plane.up,
            Self::Fore => plane.forward,
        }
    }
}

/// A place where two pieces meet along a side of the view map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Unit direction from the eye to the side's middle.
    pub direction: DVec3,
    /// Unit normal of the plane through eye and side.
    pub normal: DVec3,
    /// Of both pieces there from the eye, millimetres; the nearer one first.
    pub distances: [f64; 2],
}

impl Cut {
    /// The angle by which the cut opens, or its pieces overlap, if the eye moves by `e`: radians, exactly.
    pub fn opening(&self, e: DVec3) -> f64 {
        parting(self.direction, self.normal, self.distances, e).abs()
    }
}

/// By how much two points in the unit direction `u` part across the plane with the unit normal `n`, if the eye moves by `e`; see
/// the module. Radians, positive if the first is the nearer one and `n . e > 0`.
fn parting(u: DVec3, n: DVec3, distances: [f64; 2], e: DVec3) -> f64 {
    let [a, b] = distances.map(|a| (n.dot(e) / (a * u - e).length()).clamp(-1.0, 1.0).asin());
    a - b
}

/// An angle, worked out and measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Confirmed {
    pub predicted_arcmin: f64,
    pub measured_arcmin: f64,
}

/// Where the allowed movement ends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstCut {
    pub movement: Way,
    /// The opening allowed.
    pub angle_arcmin: f64,
    /// How far the eye moved.
    pub moved_mm: f64,
    /// On the nearer piece.
    pub place_mm: [f64; 3],
    /// Of both pieces; the same twice at a tear.
    pub supports: [String; 2],
    /// In the middle of the side, by the closed form and by rays at the finished forest: what opens if the eye moves one way,
    /// and what is hidden if it moves the other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<Confirmed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overlap: Option<Confirmed>,
    #[serde(skip)]
    pub cut: Cut,
}

/// The certificate of one view.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Tolerance {
    /// Until the worst cut opens by two arc-minutes.
    pub eye_tolerance_mm: Movement,
    /// Until it opens by ten.
    pub one_picture_mm: Movement,
    /// The same as angles, of an eye at infinity only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye_tolerance_deg: Option<Turn>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_picture_deg: Option<Turn>,
    /// From the object, from where on an eye sees one picture that was made for an eye at infinity; none if anywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_picture_from_mm: Option<f64>,
    /// From the object, from where two eyes see it as one; none of an eye at infinity.
    pub stereo_distance_mm: Option<f64>,
    pub worst_cuts: Vec<WorstCut>,
}

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
            eye_tolerance_deg: Some(Turn::of(&eye_tolerance_mm)),
            one_picture_deg: Some(Turn::of(&one_picture_mm)),
            one_picture_from_mm: one_picture_from(map, &sides),
            ..found
        };
    }
    Tolerance {
        stereo_distance_mm: stereo_distance(view, map, &sides),
        ..found
    }
}

/// How far the eye may move along `axis` and against it until the worst cut opens by `angle`, and that cut's longest side; both of an
/// eye at infinity as from the reading distance.
fn movement_until(sides: &[Side], map: &ViewMap, axis: DVec3, angle: f64) -> Option<(f64, Side)> {
    let (points, focal) = (map.points.len(), map.plane.focal);
    let angle = angle / focal;
    let rate = |s: &Side| s.normal.dot(axis).abs() * s.excess(0.0);
    let first = critical(sides, points, rate, angle).filter(|c| c.rate > least(&map.plane))?;
    let linear = angle / first.rate;
    let near = sides
        .iter()
        .filter(|s| rate(s) >= FAR_FROM_WORST * first.rate);
    let near: Vec<Side> = near.copied().collect();
    let at = |moved: f64| {
        let open = |s: &Side| s.opening(moved * axis).max(s.opening(-moved * axis));
        critical(&near, points, open, angle).filter(|c| c.rate >= angle)
    };
    // Moving square to the ray opens a little less than linear, moving towards the cut more.
    let (mut low, mut high, mut found) = (0.0, SLOWER * linear, sides[first.side]);
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        match at(middle) {
            Some(worst) => (high, found) = (middle, near[worst.side]),
            None => low = middle,
        }
    }
    Some((high / focal, found))
}

fn worst(
    side: &Side,
    movement: Way,
    moved_mm: f64,
    angle: f64,
    plane: &ImagePlane,
    supports: &[Support],
) -> WorstCut {
    let cut = side.cut();
    WorstCut {
        movement,
        angle_arcmin: arcmin(angle),
        moved_mm,
        place_mm: (plane.eye + cut.distances[0] * cut.direction + 0.0).to_array(),
        supports: side.supports.map(|s| supports[s as usize].name.clone()),
        gap: None,
        overlap: None,
        cut,
    }
}

/// See the module; none if no cut ever opens, or if two eyes see cuts from a kilometre away.
fn stereo_distance(view: &View, map: &ViewMap, sides: &[Side]) -> Option<f64> {
    let nearest = sides
        .iter()
        .map(Side::nearest)
        .fold(f64::INFINITY, f64::min);
    let own = view.eye.distance(view.look_at);
    let opens = |t: f64| {
        let rate = |s: &Side| EYES_MM * s.normal.dot(map.plane.right).abs() * s.excess(t);
        // From farther away everything looks smaller, specks too.
        let speck = ONE_PICTURE_RAD * (own + t) / own;
        critical(sides, map.points.len(), rate, speck).is_some_and(|c| c.rate > ONE_PICTURE_RAD)
    };
    let mut low = (NEAREST_SHARE - 1.0) * nearest;
    if sides.is_empty() || own + low <= 0.0 || !opens(low) {
        return (!sides.is_empty()).then_some((own + low).max(0.0));
    }
    let mut high = own;
    while opens(high) {
        low = high;
        high *= 2.0;
        if high > FARTHEST_MM {
            return None;
        }
    }
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        if opens(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(own + high)
}

/// See the module; none if no cut ever opens.
fn one_picture_from(map: &ViewMap, sides: &[Side]) -> Option<f64> {
    let plane = &map.plane;
    let far = plane.focal * READING_MM;
    // The ray of a side leans from the line of sight as its plane's normal does from the image.
    let beside = |s: &Side| far * s.normal.dot(plane.forward).abs();
    let opens = |distance: f64| {
        let rate = |s: &Side| beside(s) * s.excess(0.0) * (far / distance).powi(2);
        let speck = ONE_PICTURE_RAD * distance / far;
        critical(sides, map.points.len(), rate, speck).is_some_and(|c| c.rate > ONE_PICTURE_RAD)
    };
    let (mut low, mut high) = (1.0, far);
    if !opens(low) {
        return None;
    }
    for _ in 0..2 * HALVINGS {
        let middle = (low * high).sqrt();
        if opens(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}

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

fn arcmin(radians: f64) -> f64 {
    60.0 * radians.to_degrees()
}
