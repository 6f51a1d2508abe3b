//! Searches by halving: how far an eye may go, and how near two eyes may come.

use super::found::{Way, WorstCut, arcmin};
use super::sides::{CutSide, critical, least};
use crate::geom::{ImagePlane, READING_MM};
use crate::steps::UNSEEN_RAD;
use crate::support::Support;
use crate::view::View;
use crate::viewmap::ViewMap;
use glam::DVec3;

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
/// Farther than this the two eyes are not sought, millimetres: a kilometre.
const FARTHEST_MM: f64 = 1e6;

/// How far the eye may move along `axis` and against it until the worst cut opens by `angle`, and that cut's longest side; both of an
/// eye at infinity as from the reading distance.
pub(crate) fn movement_until(
    sides: &[CutSide],
    map: &ViewMap,
    axis: DVec3,
    angle: f64,
) -> Option<(f64, CutSide)> {
    let (points, focal) = (map.points.len(), map.plane.focal);
    let angle = angle / focal;
    let rate = |s: &CutSide| s.normal.dot(axis).abs() * s.excess(0.0);
    let first = critical(sides, points, rate, angle).filter(|c| c.rate > least(&map.plane))?;
    let linear = angle / first.rate;
    let near = sides
        .iter()
        .filter(|s| rate(s) >= FAR_FROM_WORST * first.rate);
    let near: Vec<CutSide> = near.copied().collect();
    let at = |moved: f64| {
        let open = |s: &CutSide| s.opening(moved * axis).max(s.opening(-moved * axis));
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

pub(crate) fn worst(
    side: &CutSide,
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
        supports: side.supports.map(|s| supports[s].name.clone()),
        gap: None,
        overlap: None,
        cut,
    }
}

/// See the module; none if no cut ever opens, or if two eyes see cuts from a kilometre away.
pub(crate) fn stereo_distance(view: &View, map: &ViewMap, sides: &[CutSide]) -> Option<f64> {
    let nearest = sides
        .iter()
        .map(CutSide::nearest)
        .fold(f64::INFINITY, f64::min);
    let own = view.eye.distance(view.look_at);
    let opens = |t: f64| {
        let rate = |s: &CutSide| EYES_MM * s.normal.dot(map.plane.right).abs() * s.excess(t);
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
pub(crate) fn one_picture_from(map: &ViewMap, sides: &[CutSide]) -> Option<f64> {
    let plane = &map.plane;
    let far = plane.focal * READING_MM;
    // The ray of a side leans from the line of sight as its plane's normal does from the image.
    let beside = |s: &CutSide| far * s.normal.dot(plane.forward).abs();
    let opens = |distance: f64| {
        let rate = |s: &CutSide| beside(s) * s.excess(0.0) * (far / distance).powi(2);
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
