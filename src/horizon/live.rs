//! The horizon itself: built once, then kept true while obstacles come, go and move.

use super::obstacle::{Impact, Obstacle};
use super::shadow::Shadow;
use super::viewpoint::Viewpoint;
use std::f64::consts::TAU;

/// A stretch of bearings over which the viewpoint meets the same obstacle first, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    pub from: f64,
    pub to: f64,
    /// Position in the caller's list; `None` where the view is free.
    pub obstacle: Option<usize>,
}

impl Run {
    pub fn width(&self) -> f64 {
        self.to - self.from
    }
}

/// What a viewpoint sees over some spans of bearings; see the module.
///
/// Obstacles stay with the caller, as a list in which `None` lets all rays pass; a horizon keeps their shadows, the tangents in
/// order, and what is met between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Horizon {
    viewpoint: Viewpoint,
    /// Index: obstacle; `None` of those that let all rays pass, or hold the viewpoint.
    shadows: Vec<Option<Shadow>>,
    /// Rising.
    spans: Vec<Sweep>,
}

/// One span of bearings, with all that is met there.
#[derive(Clone, Debug, PartialEq)]
struct Sweep {
    ends: [f64; 2],
    /// Bearings strictly inside at which shadows begin or end, rising; as often as there are such shadows.
    tangents: Vec<f64>,
    /// What is met between neighbouring tangents: tiles the span, each of some width.
    stretches: Vec<Run>,
}

/// A shadow as it lies on a span: obstacle and bearings.
#[derive(Clone, Copy)]
struct ShadowImage {
    index: usize,
    from: f64,
    to: f64,
}

impl Horizon {
    /// Builds it from nothing. Spans are disjoint and rise, within a turn to either side of ahead.
    pub fn new(viewpoint: Viewpoint, spans: &[[f64; 2]], obstacles: &[Option<Obstacle>]) -> Self {
        let mut horizon = Self {
            viewpoint,
            shadows: Vec::new(),
            spans: Vec::new(),
        };
        horizon.look_from(viewpoint, spans, obstacles);
        horizon
    }

    /// Moves the viewpoint. All bearings are others then: nothing is kept but the memory.
    pub fn look_from(
        &mut self,
        viewpoint: Viewpoint,
        spans: &[[f64; 2]],
        obstacles: &[Option<Obstacle>],
    ) {
        self.viewpoint = viewpoint;
        self.shadows.clear();
        let shadow = |o: &Option<Obstacle>| o.as_ref().and_then(|o| shadow(&viewpoint, o));
        self.shadows.extend(obstacles.iter().map(shadow));
        self.spans.resize_with(spans.len(), Sweep::empty);
        for (span, ends) in self.spans.iter_mut().zip(spans) {
            span.begin(*ends);
            for shadow in self.shadows.iter().flatten() {
                let images = images(&viewpoint, shadow, *ends);
                span.tangents.extend(images.flatten());
            }
            span.tangents.retain(|t| ends[0] < *t && *t < ends[1]);
            span.tangents.sort_unstable_by(f64::total_cmp);
            span.look(*ends, &viewpoint, &self.shadows, obstacles);
        }
    }

    /// Follows a change of one obstacle: moved, of another footprint, added, or taken away. Only the stretches that its old and its
    /// new shadow meet are looked at again.
    ///
    /// `obstacles` is the list as it is now. After several changes it is called for each, in any order; after the last call, the
    /// horizon is that of the list.
    pub fn update(&mut self, index: usize, obstacles: &[Option<Obstacle>]) {
        let known = self.shadows.len().max(obstacles.len());
        self.shadows.resize(known, None);
        let now = obstacles.get(index).and_then(Option::as_ref);
        let new = now.and_then(|o| shadow(&self.viewpoint, o));
        let old = self.shadows.get_mut(index).and_then(Option::take);
        for (shadow, comes) in [(old, false), (new, true)] {
            let Some(shadow) = shadow else {
                continue;
            };
            if comes {
                self.shadows[index] = Some(shadow);
            }
            for span in &mut self.spans {
                for [from, to] in images(&self.viewpoint, &shadow, span.ends) {
                    for tangent in [from, to] {
                        span.set_tangent(tangent, comes);
                    }
                    span.look([from, to], &self.viewpoint, &self.shadows, obstacles);
                }
            }
        }
        // Those that are gone from the end of the list.
        while self.shadows.len() > obstacles.len() && self.shadows.last() == Some(&None) {
            self.shadows.pop();
        }
    }

    pub fn viewpoint(&self) -> &Viewpoint {
        &self.viewpoint
    }

    /// The runs of each span, rising; those of one span join without gaps, and no two neighbours among them are on the same obstacle.
    pub fn runs(&self) -> impl Iterator<Item = Run> {
        self.spans.iter().flat_map(|span| {
            span.stretches
                .chunk_by(|a, b| a.obstacle == b.obstacle)
                .map(|same| Run {
                    to: same[same.len() - 1].to,
                    ..same[0]
                })
        })
    }

    /// The same cut at all tangents, those of hidden obstacles too, span by span.
    pub fn stretches(&self) -> impl Iterator<Item = &[Run]> {
        self.spans.iter().map(|span| span.stretches.as_slice())
    }

    /// Which obstacle a bearing meets first, and where. `None` where the view is free, and beside the spans.
    pub fn first(&self, bearing: f64, obstacles: &[Option<Obstacle>]) -> Option<(usize, Impact)> {
        let within = |s: &&Sweep| s.ends[0] <= bearing && bearing <= s.ends[1];
        let stretches = &self.spans.iter().find(within)?.stretches;
        let after = stretches.partition_point(|s| s.to < bearing);
        let index = stretches.get(after)?.obstacle?;
        let obstacle = obstacles.get(index)?.as_ref()?;
        Some((index, obstacle.entry(&self.viewpoint.ray(bearing))?))
    }

    /// Width over which the obstacle is met first: radians, or millimetres at infinity.
    pub fn angle_of(&self, index: usize) -> f64 {
        self.width(|obstacle| obstacle == Some(index))
    }

    /// Share of all spans at which some obstacle is met; 1 if there is no width.
    pub fn coverage(&self) -> f64 {
        let all = self.width(|_| true);
        if all > 0.0 {
            self.width(|obstacle| obstacle.is_some()) / all
        } else {
            1.0
        }
    }

    fn width(&self, counts: impl Fn(Option<usize>) -> bool) -> f64 {
        let counted = self.runs().filter(|r| counts(r.obstacle));
        counted.map(|r| r.width()).sum()
    }
}

impl Sweep {
    fn empty() -> Self {
        Self {
            ends: [0.0, 0.0],
            tangents: Vec::new(),
            stretches: Vec::new(),
        }
    }

    /// Free throughout, without tangents.
    fn begin(&mut self, ends: [f64; 2]) {
        let [from, to] = ends;
        let free = Run {
            from,
            to,
            obstacle: None,
        };
        self.ends = ends;
        self.tangents.clear();
        self.stretches.clear();
        self.stretches.extend((from < to).then_some(free));
    }

    /// A shadow begins or ends here now, or does no longer.
    fn set_tangent(&mut self, tangent: f64, comes: bool) {
        if !(self.ends[0] < tangent && tangent < self.ends[1]) {
            return;
        }
        let at = self
            .tangents
            .partition_point(|t| t.total_cmp(&tangent).is_lt());
        if comes {
            self.tangents.insert(at, tangent);
        } else {
            self.tangents.remove(at);
        }
    }

    /// Looks again at all stretches that a shadow between two bearings meets or touches, as tangents now cut them.
    fn look(
        &mut self,
        [from, to]: [f64; 2],
        viewpoint: &Viewpoint,
        shadows: &[Option<Shadow>],
        obstacles: &[Option<Obstacle>],
    ) {
        let first = self.stretches.partition_point(|s| s.to < from);
        let end = self.stretches.partition_point(|s| s.from <= to);
        if first >= end {
            return;
        }
        // These two stay: the shadow's own tangents lie between them.
        let (lo, hi) = (self.stretches[first].from, self.stretches[end - 1].to);
        let within =
            self.tangents.partition_point(|t| *t <= lo)..self.tangents.partition_point(|t| *t < hi);
        let borders = self.tangents[within].iter().copied();
        let mut images = images_over(viewpoint, shadows, self.ends, [lo, hi]);
        images.sort_unstable_by(|a, b| a.from.total_cmp(&b.from));
        let (mut coming, mut here) = (images.into_iter().peekable(), Vec::<ShadowImage>::new());
        let mut fresh: Vec<Run> = Vec::with_capacity(borders.len() + 1);
        let mut from = lo;
        for to in borders.chain([hi]) {
            if to <= from {
                continue;
            }
            while let Some(image) = coming.next_if(|i| i.from < to) {
                here.push(image);
            }
            here.retain(|i| i.to > from);
            let obstacle = nearest((from + to) / 2.0, &here, viewpoint, obstacles);
            fresh.push(Run { from, to, obstacle });
            from = to;
        }
        self.stretches.splice(first..end, fresh);
    }
}

/// The obstacle that a bearing meets first; the earlier one of equals.
fn nearest(
    bearing: f64,
    images: &[ShadowImage],
    viewpoint: &Viewpoint,
    obstacles: &[Option<Obstacle>],
) -> Option<usize> {
    let ray = viewpoint.ray(bearing);
    let mut first: Option<(f64, usize)> = None;
    let across = images
        .iter()
        .filter(|i| i.from <= bearing && bearing <= i.to);
    for image in across {
        let Some(Some(obstacle)) = obstacles.get(image.index) else {
            continue;
        };
        if let Some(impact) = obstacle.entry(&ray) {
            let this = (impact.distance, image.index);
            if first.is_none_or(|best| this < best) {
                first = Some(this);
            }
        }
    }
    first.map(|f| f.1)
}

/// The shadow of an obstacle that counts.
fn shadow(viewpoint: &Viewpoint, obstacle: &Obstacle) -> Option<Shadow> {
    Some(Shadow::new(viewpoint, obstacle)).filter(|s| !s.is_around())
}

/// All shadows as they lie on a part of a span with these ends.
fn images_over(
    viewpoint: &Viewpoint,
    shadows: &[Option<Shadow>],
    ends: [f64; 2],
    [lo, hi]: [f64; 2],
) -> Vec<ShadowImage> {
    let mut list = Vec::new();
    for (index, shadow) in shadows.iter().enumerate() {
        let Some(shadow) = shadow else {
            continue;
        };
        let images = images(viewpoint, shadow, ends).filter(|[from, to]| *from < hi && *to > lo);
        list.extend(images.map(|[from, to]| ShadowImage { index, from, to }));
    }
    list
}

/// Where a shadow lies on a span: of a place, bearings a turn apart are the same direction.
fn images(
    viewpoint: &Viewpoint,
    shadow: &Shadow,
    [lo, hi]: [f64; 2],
) -> impl Iterator<Item = [f64; 2]> + use<> {
    let turns = match viewpoint {
        Viewpoint::At { .. } => -1..=1,
        Viewpoint::Infinity { .. } => 0..=0,
    };
    let (from, to) = (shadow.from, shadow.to);
    turns
        .map(move |k| f64::from(k) * TAU)
        .map(move |by| [from + by, to + by])
        .filter(move |[from, to]| *from < hi && *to > lo)
}
