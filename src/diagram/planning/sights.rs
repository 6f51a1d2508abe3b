//! What the eyes of a frame see, as the plan's ranges are drawn.

use super::story::Story;
use crate::diagram::{Run, Sight};
use crate::planner::{Frame, Run as Stretch, entry};
use glam::DVec2;
use std::f64::consts::PI;

/// Off a run's ends by this, radians: hits the pillar surely, moves a point 1 m away by 1 nm.
const NUDGE: f64 = 1e-9;

/// The sight of view `v`. Outlines of round pillars get `arc` chords a run.
pub fn sight(story: &Story, frame: &Frame, v: usize, arc: usize) -> Sight {
    let view = &story.views[v];
    let eye = view.eye.truncate();
    let mut sight = Sight {
        eye,
        ahead: (view.look_at.truncate() - eye).normalize_or(DVec2::X),
        intervals: Vec::new(),
    };
    let mut end = f64::NAN;
    for run in frame.runs.get(v).map_or(&[][..], Vec::as_slice) {
        let drawn = Run {
            support: run.pillar,
            hits: hits(story, frame, &sight, run, arc),
        };
        match sight.intervals.last_mut().filter(|_| run.from == end) {
            Some(interval) => interval.push(drawn),
            None => sight.intervals.push(vec![drawn]),
        }
        end = run.to;
    }
    sight
}

fn hits(story: &Story, frame: &Frame, sight: &Sight, run: &Stretch, arc: usize) -> Vec<(f64, f64)> {
    let nudge = NUDGE.min((run.to - run.from) / 4.0);
    let (from, to) = (run.from + nudge, run.to - nudge);
    let Some(pillar) = run.pillar.and_then(|i| frame.pillars.get(i)) else {
        return vec![(from, f64::INFINITY), (to, f64::INFINITY)];
    };
    let shape = &story.brief.shapes[pillar.shape];
    let mut bearings = vec![from];
    if shape.round {
        // Closer together towards the tangents, where a circle is steep.
        let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
        let inner = (1..arc).map(|k| middle - half * (PI * k as f64 / arc as f64).cos());
        bearings.extend(inner);
    } else {
        let corners = shape.profile.iter().map(|p| pillar.at + *p - sight.eye);
        let corners = corners.map(|c| sight.ahead.angle_to(c));
        bearings.extend(corners.filter(|b| *b > from && *b < to));
        bearings.sort_by(f64::total_cmp);
    }
    bearings.push(to);
    let distance = |bearing: f64| {
        let way = sight.direction(bearing);
        let met = entry(sight.eye, way, pillar.at, shape).map(|m| m.0);
        // Only rounding misses: the nearest point to the axis will do.
        met.unwrap_or_else(|| way.dot(pillar.at - sight.eye).max(0.0))
    };
    bearings.into_iter().map(|b| (b, distance(b))).collect()
}
