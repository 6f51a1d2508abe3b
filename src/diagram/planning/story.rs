//! What all pages of a plan tell of, worked out once.

use crate::diagram::page::circle;
use crate::planner::{Brief, Frame, Pillar, Planned};
use crate::view::View;
use glam::DVec2;
use std::borrow::Cow;

pub(crate) struct Story<'a> {
    pub title: &'a str,
    pub views: &'a [View],
    pub brief: &'a Brief,
    pub planned: &'a Planned,
    /// At least one.
    pub frames: Cow<'a, [Frame]>,
    /// What stands on every view's pillars: the first letter of its name, or its number if two views share one.
    pub keys: Vec<String>,
    /// Whether these are numbers, which names do not tell.
    pub numbered: bool,
    /// Middle and radius of a circle around the region and all pillars.
    pub circle: (DVec2, f64),
    tell: Tell<'a>,
}

/// What is to be written at which places of a frame: its faults, worded by who knows how to talk.
pub type Tell<'a> = &'a dyn Fn(&Frame) -> Vec<(DVec2, String)>;

impl<'a> Story<'a> {
    pub(crate) fn new(
        title: &'a str,
        views: &'a [View],
        (brief, planned): (&'a Brief, &'a Planned),
        tell: Tell<'a>,
    ) -> Self {
        let frames = if planned.frames.is_empty() {
            Cow::Owned(vec![only_frame(planned)])
        } else {
            Cow::Borrowed(planned.frames.as_slice())
        };
        let pillars = frames.iter().flat_map(|f| &f.pillars);
        let outlines = pillars.flat_map(|p| {
            let profile = &brief.shapes[p.shape].profile;
            profile.iter().map(|q| p.at + *q)
        });
        let circle = circle(brief.region.outline().iter().copied().chain(outlines));
        let (keys, numbered) = keys(views);
        Self {
            title,
            views,
            brief,
            planned,
            frames,
            keys,
            numbered,
            circle,
            tell,
        }
    }

    /// Places of a frame's faults, and what they are.
    pub(crate) fn marks(&self, frame: &Frame) -> Vec<(DVec2, String)> {
        (self.tell)(frame)
    }

    pub(crate) fn first(&self) -> &Frame {
        &self.frames[0]
    }

    pub(crate) fn last(&self) -> &Frame {
        &self.frames[self.frames.len() - 1]
    }

    /// Indices of at most `most` frames, evenly spread, the first and the last among them.
    pub(crate) fn picked(&self, most: usize) -> Vec<usize> {
        let last = self.frames.len() - 1;
        let steps = last.min(most.saturating_sub(1));
        let at = |k: usize| (2 * k * last + steps) / (2 * steps).max(1);
        (0..=steps).map(at).collect()
    }

    /// Whether given pillars were moved, taken away or joined by others.
    pub(crate) fn mended(&self) -> bool {
        !self.planned.changes.is_empty()
    }

    /// The owner of a pillar, if it has one.
    pub(crate) fn owner(&self, pillar: &Pillar) -> Option<(&View, &str)> {
        let v = pillar.owner?;
        self.views.get(v).zip(self.keys.get(v).map(String::as_str))
    }
}

/// What there is to show without frames.
fn only_frame(planned: &Planned) -> Frame {
    let least = |of: fn(&crate::planner::Worth) -> f64| {
        planned.worth.iter().map(of).fold(f64::INFINITY, f64::min)
    };
    Frame {
        tries: planned.tries,
        pillars: planned.pillars.clone(),
        runs: Vec::new(),
        faults: Vec::new(),
        hidden_deg: least(|w| w.hidden_deg),
        tolerance_mm: least(|w| w.tolerance_mm[1]),
    }
}

/// The keys, and whether they are numbers.
fn keys(views: &[View]) -> (Vec<String>, bool) {
    let letter = |v: &View| {
        let first = v.name.chars().find(|c| c.is_alphanumeric());
        first.map_or(String::new(), |c| c.to_uppercase().collect())
    };
    let letters: Vec<String> = views.iter().map(letter).collect();
    let mut distinct = letters.clone();
    distinct.sort();
    distinct.dedup();
    if distinct.len() == views.len() && !distinct.iter().any(String::is_empty) {
        return (letters, false);
    }
    ((1..=views.len()).map(|k| k.to_string()).collect(), true)
}
