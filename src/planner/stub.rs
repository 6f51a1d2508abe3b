//! Stand-ins for the entry points of the planner until the search is in: a zigzag row before every eye.

use super::{
    Adjustment, Brief, Change, Ended, Frame, Pillar, Planned, Trade, Watch, Worth, subject, survey,
};
use crate::diag::Diagnostic;
use crate::view::View;
use glam::DVec2;
use subject::Subject;

/// Given pillars and one row for every view.
pub fn plan(views: &[View], brief: &Brief, watch: Watch) -> Result<Planned, Vec<Diagnostic>> {
    let subjects: Vec<Subject> = views.iter().map(Subject::new).collect();
    let mut pillars = brief.given.clone();
    for (v, s) in subjects.iter().enumerate() {
        row(s, v, brief, &mut pillars);
    }
    (watch.progress)("start", 1.0);
    let ended = match (watch.stop)() {
        true => Ended::Stopped,
        false => Ended::Tries,
    };
    Ok(finished(&subjects, brief, pillars, ended))
}

/// Pushes pillars along x until they stand apart.
pub fn repair(views: &[View], brief: &Brief, _watch: Watch) -> Result<Planned, Vec<Diagnostic>> {
    let subjects: Vec<Subject> = views.iter().map(Subject::new).collect();
    let (mut pillars, mut changes) = (Vec::<Pillar>::new(), Vec::new());
    for (i, given) in brief.given.iter().enumerate() {
        let reach = |p: &Pillar| brief.shapes[p.shape].reach;
        let mut p = *given;
        while pillars
            .iter()
            .any(|q| q.at.distance(p.at) < reach(q) + reach(&p) + brief.gap)
        {
            p.at.x += 0.5;
        }
        if p.at != given.at {
            changes.push(Change {
                given: Some(i),
                to: Some(p.at),
            });
        }
        pillars.push(p);
    }
    let mut done = finished(&subjects, brief, pillars, Ended::Converged);
    done.changes = changes;
    Ok(done)
}

fn row(s: &Subject, view: usize, brief: &Brief, pillars: &mut Vec<Pillar>) {
    let reach = brief.shapes[0].reach;
    let middle = s.middle.truncate();
    let half = s.width / 2.0 + reach;
    let count = (2.0 * half / (1.6 * reach)).ceil() as i32;
    for k in 0..=count {
        let across = (f64::from(k) - f64::from(count) / 2.0) * 1.6 * reach;
        let depth = if k % 2 == 0 { -1.5 } else { 1.5 } * reach;
        let at: DVec2 = middle + s.ahead.perp() * -across + s.ahead * depth;
        pillars.push(Pillar {
            at,
            shape: 0,
            owner: Some(view),
            fixed: false,
        });
    }
}

fn finished(
    subjects: &[Subject],
    brief: &Brief,
    mut pillars: Vec<Pillar>,
    ended: Ended,
) -> Planned {
    let found = survey::survey(subjects, brief, &pillars);
    for (v, runs) in found.runs.iter().enumerate() {
        for p in runs.iter().filter_map(|r| r.pillar) {
            pillars[p].owner.get_or_insert(v);
        }
    }
    let worth = |v: usize| Worth {
        coverage: 1.0,
        conflicts: 0,
        pillars: pillars.iter().filter(|p| p.owner == Some(v)).count(),
        hidden_deg: 40.0,
        half_likeness_deg: Some(6.0),
        tolerance_mm: [12.0, 3.0],
    };
    Planned {
        heights: pillars
            .iter()
            .map(|p| brief.shapes[p.shape].heights[1])
            .collect(),
        adjustments: vec![Adjustment::NONE; subjects.len()],
        worth: (0..subjects.len()).map(worth).collect(),
        regions: Vec::new(),
        frames: vec![Frame {
            tries: 0,
            runs: found.runs,
            faults: found.faults,
            marks: Vec::new(),
            hidden_deg: 40.0,
            tolerance_mm: 3.0,
            pillars: pillars.clone(),
        }],
        trade: vec![Trade {
            tolerance_mm: 3.0,
            hidden_deg: 40.0,
            chosen: true,
        }],
        tries: brief.tries,
        ended,
        changes: Vec::new(),
        pillars,
    }
}
