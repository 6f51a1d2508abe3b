//! Which part of a section its panels show, and where they lie on the page.

use super::chains::{chains, rooms, surface};
use super::values::Section;
use glam::DVec2;

pub(crate) const WIDTH: f64 = 297.0;
pub(crate) const EDGE: f64 = 10.0;
const GAP: f64 = 6.0;
pub(crate) const PANEL: f64 = (WIDTH - 2.0 * EDGE - 2.0 * GAP) / 3.0;
/// Least and greatest height of a panel.
const HEIGHTS: [f64; 2] = [50.0, 150.0];
/// Above the panels: heading, and labels with their leaders.
pub(crate) const HEAD: f64 = 27.0;
pub(crate) const LABELS: f64 = 13.0;

/// Supports are shown this share of the rest's size beyond it.
const AROUND: f64 = 0.3;

/// The part of the section that a panel shows, and where on the page.
#[derive(Clone, Copy)]
pub(crate) struct Window {
    /// Of the section, millimetres.
    pub lo: DVec2,
    pub hi: DVec2,
    /// Page millimetres for one of the section.
    pub scale: f64,
    pub left: f64,
}

impl Window {
    pub(crate) fn new(section: &Section) -> Self {
        let mut points: Vec<DVec2> = section
            .model
            .iter()
            .flat_map(|o| o.points.clone())
            .collect();
        let scaled = |k: usize| section.groups[k].mu;
        let drawn = [
            rooms(section, |_| 1.0),
            rooms(section, scaled),
            chains(section, |s| Some(surface(s))),
        ];
        points.extend(drawn.into_iter().flatten().flat_map(|c| c.points));
        let corners = |points: &[DVec2]| {
            let all = || points.iter().copied();
            (
                all().fold(DVec2::INFINITY, DVec2::min),
                all().fold(DVec2::NEG_INFINITY, DVec2::max),
            )
        };
        let (lo, hi) = corners(&points);
        let carriers = section.supports.iter().filter(|s| s.1);
        let around: Vec<DVec2> = carriers.flat_map(|s| s.0.points.clone()).collect();
        let (low, high) = corners(&around);
        let more = AROUND * (hi - lo).max_element();
        let (mut lo, mut hi) = (lo.min(low.max(lo - more)), hi.max(high.min(hi + more)));
        // Rays stay inside up to the far side, so that labels stand above what they name.
        let slopes = points.iter().map(|p| p.x / p.y);
        lo.x = slopes.clone().map(|s| s * hi.y).fold(lo.x, f64::min);
        hi.x = slopes.map(|s| s * hi.y).fold(hi.x, f64::max);
        let air = 0.04 * (hi - lo).max_element().max(1e-6);
        lo -= air;
        hi += air;
        lo.y = lo.y.max(0.0);
        Self::fitted(lo, hi)
    }

    /// As large as it goes into a panel; what is left over shows more of the section.
    fn fitted(mut lo: DVec2, mut hi: DVec2) -> Self {
        let size = hi - lo;
        let scale = (PANEL / size.x).min(HEIGHTS[1] / size.y);
        let wider = (PANEL / scale - size.x).max(0.0) / 2.0;
        lo.x -= wider;
        hi.x += wider;
        hi.y += (HEIGHTS[0] / scale - size.y).max(0.0);
        Self {
            lo,
            hi,
            scale,
            left: EDGE,
        }
    }

    pub(crate) fn panel(&self, k: usize) -> Self {
        Self {
            left: EDGE + k as f64 * (PANEL + GAP),
            ..*self
        }
    }

    pub(crate) fn height(&self) -> f64 {
        self.scale * (self.hi.y - self.lo.y)
    }

    pub(crate) fn top() -> f64 {
        HEAD + LABELS
    }

    pub(crate) fn bottom(&self) -> f64 {
        Self::top() + self.height()
    }

    pub(crate) fn place(&self, p: DVec2) -> DVec2 {
        let at = self.scale * DVec2::new(p.x - self.lo.x, self.hi.y - p.y);
        DVec2::new(self.left, Self::top()) + at
    }

    pub(crate) fn places(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|p| self.place(*p)).collect()
    }

    /// The part of a line between two points that is shown.
    pub(crate) fn clipped(&self, a: DVec2, b: DVec2) -> Option<[DVec2; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for k in 0..2 {
            let (start, way) = (a[k], b[k] - a[k]);
            if way == 0.0 {
                if start < self.lo[k] || start > self.hi[k] {
                    return None;
                }
                continue;
            }
            let [p, q] = [self.lo[k], self.hi[k]].map(|side| (side - start) / way);
            from = from.max(p.min(q));
            to = to.min(p.max(q));
        }
        (from < to).then(|| [a.lerp(b, from), a.lerp(b, to)])
    }

    /// The part of a polygon that is shown (Sutherland & Hodgman).
    pub(crate) fn clipped_polygon(&self, points: &[DVec2]) -> Vec<DVec2> {
        let sides = [
            (0, self.lo.x, 1.0),
            (0, self.hi.x, -1.0),
            (1, self.lo.y, 1.0),
            (1, self.hi.y, -1.0),
        ];
        sides
            .iter()
            .fold(points.to_vec(), |points, (axis, side, sign)| {
                let inside = |p: DVec2| sign * (p[*axis] - side) >= 0.0;
                let mut kept = Vec::new();
                for (k, b) in points.iter().enumerate() {
                    let a = points[(k + points.len() - 1) % points.len()];
                    if inside(a) != inside(*b) {
                        kept.push(a.lerp(*b, (side - a[*axis]) / (b[*axis] - a[*axis])));
                    }
                    if inside(*b) {
                        kept.push(*b);
                    }
                }
                kept
            })
    }
}
