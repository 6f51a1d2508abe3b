//! Plans as the planner hands them over, made by hand: their layouts are surveyed, their searches are invented.

use crate::shapes::{self, flat_layer};
use glam::{DVec2, DVec3};
use pillarforest::diag::Diagnostic;
use pillarforest::planner::{
    Adjustment, Brief, Care, Change, Ended, Frame, Freedom, Matters, Pillar, Planned, Plates,
    Region, Shape, Subject, Survey, Trade, Worth,
};
use pillarforest::scene::{self, Scene};
use pillarforest::steps::UNSEEN_RAD;
use pillarforest::support::SupportKind;
use pillarforest::view::View;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::LazyLock;

/// A plan as the planner hands it over.
#[derive(Clone)]
pub(crate) struct Case {
    pub views: Vec<View>,
    pub brief: Brief,
    pub planned: Planned,
}

/// The layout of the four creatures as the end of a search that began with it shaken.
pub(crate) fn creatures() -> Case {
    static MADE: LazyLock<Case> = LazyLock::new(make_creatures);
    MADE.clone()
}

fn make_creatures() -> Case {
    let scene = four_creatures();
    let (brief, pillars) = brief_of(&scene);
    let subjects: Vec<Subject> = subjects_of(&scene.views);
    let last = 30;
    let frames = (0..=last).map(|k| {
        let shake = 12.0 * (1.0 - f64::from(k) / f64::from(last)).powi(2);
        let shaken = pillars.iter().enumerate().map(|(i, p)| Pillar {
            at: p.at + shake * DVec2::from_angle(2.4 * i as f64 + 0.1 * f64::from(k)),
            ..*p
        });
        frame(&subjects, &brief, shaken.collect(), 400 * k as u64)
    });
    let frames: Vec<Frame> = frames.collect();
    let worth = worth(&scene.views, &frames[frames.len() - 1]);
    let planned = Planned {
        heights: vec![90.0; pillars.len()],
        adjustments: vec![Adjustment::NONE; scene.views.len()],
        worth,
        regions: wedges(&scene.views),
        frames,
        trade: (0..9)
            .map(|k| Trade {
                tolerance_mm: 0.6 * 1.5f64.powi(k),
                hidden_deg: 56.0 - 0.35 * f64::from(k * k),
                chosen: k == 4,
            })
            .collect(),
        tries: 12_000,
        ended: Ended::Converged,
        changes: Vec::new(),
        pillars,
    };
    Case {
        views: scene.views,
        brief,
        planned,
    }
}

fn four_creatures() -> Scene {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let text = std::fs::read_to_string(root.join("four-creatures.ron")).unwrap();
    let read = |file: &str| {
        std::fs::read(root.join(file)).map_err(|e| Diagnostic::error(format!("{file}: {e}")))
    };
    scene::resolve(&text, &read).unwrap().value
}

/// Every pillar belongs to the view after which it is named.
fn brief_of(scene: &Scene) -> (Brief, Vec<Pillar>) {
    let mut shapes: Vec<Shape> = Vec::new();
    let mut pillars = Vec::new();
    let mut region = Vec::new();
    for support in &scene.supports {
        match &support.kind {
            SupportKind::Base { outline, .. } => region = outline.clone(),
            SupportKind::Body { .. } => panic!("{} is no pillar", support.name),
            SupportKind::Pillar {
                axis,
                profile,
                top,
                round,
                ..
            } => {
                let owner = support.name.split('-').next().unwrap();
                if shapes.is_empty() {
                    let profile: Vec<DVec2> = profile.iter().map(|p| *p - *axis).collect();
                    shapes.push(Shape {
                        reach: profile.iter().map(|p| p.length()).fold(0.0, f64::max),
                        profile,
                        round: *round,
                        heights: [*top, *top],
                        layer: support.layer.unwrap(),
                        written: "Round(radius: 4)".into(),
                    });
                }
                pillars.push(Pillar {
                    at: *axis,
                    shape: 0,
                    owner: scene.views.iter().position(|v| v.name == owner),
                    fixed: pillars.len() % 7 == 3,
                    given: None,
                });
            }
        }
    }
    let brief = brief(region, shapes, scene.views.len());
    (brief, pillars)
}

fn brief(region: Vec<DVec2>, shapes: Vec<Shape>, views: usize) -> Brief {
    Brief {
        region: Region::new(region),
        care: Care::found(0.4, Plates::ANY),
        allowed: shapes.len(),
        shapes,
        gap: 0.5,
        count: [0, 300],
        given: Vec::new(),
        seed: 7,
        tries: 12_000,
        seconds: 10.0,
        hidden_from_deg: 10.0,
        matters: Matters {
            camouflage: 1.0,
            tolerance: 1.0,
            pillars: 0.0,
            spread: 0.0,
        },
        tolerance_mm: vec![0.3; views],
        freedom: Freedom::NONE,
    }
}

fn subjects_of(views: &[View]) -> Vec<Subject> {
    let of = |v: &View| Subject::in_plan(v, &v.target());
    views.iter().map(of).collect()
}

/// A layout as surveyed.
fn frame(subjects: &[Subject], brief: &Brief, pillars: Vec<Pillar>, tries: u64) -> Frame {
    let all: Vec<&Subject> = subjects.iter().collect();
    let found = Survey::new(&all, brief, &pillars);
    let rate = found.rates.iter().map(|r| r[1]).fold(0.0, f64::max);
    Frame {
        tries,
        hidden_deg: 34.0 + 16.0 * (tries as f64 / 12_000.0).sqrt(),
        tolerance_mm: UNSEEN_RAD / rate,
        pillars,
        runs: found.skylines.into_iter().map(|s| s.runs).collect(),
        faults: found.faults,
    }
}

/// Tells, in place of a frame's faults, wherever an eye meets none of its own pillars.
pub(crate) fn tell(views: &[View]) -> impl Fn(&Frame) -> Vec<(DVec2, String)> {
    let subjects = subjects_of(views);
    move |frame| {
        let mut marks = Vec::new();
        for (v, runs) in frame.runs.iter().enumerate() {
            for run in runs {
                let middle = (run.from + run.to) / 2.0;
                let met = run.obstacle.map(|i| frame.pillars[i]);
                let name = &views[v].name;
                match met {
                    None => {
                        let near = subjects[v].middle.truncate().distance(subjects[v].o);
                        marks.push((
                            subjects[v].point(middle, near),
                            format!("{name} looks past all pillars"),
                        ));
                    }
                    Some(p) if p.owner != Some(v) => {
                        let whose = p.owner.map_or("nobody", |o| &views[o].name);
                        marks.push((p.at, format!("{name} meets a pillar of {whose}")));
                    }
                    Some(_) => {}
                }
            }
        }
        marks
    }
}

fn worth(views: &[View], last: &Frame) -> Vec<Worth> {
    let of = |v: usize| Worth {
        coverage: 1.0,
        conflicts: 0,
        pillars: last.pillars.iter().filter(|p| p.owner == Some(v)).count(),
        hidden_deg: 50.0 + v as f64,
        half_likeness_deg: (v != 1).then_some(4.0 + v as f64),
        tolerance_mm: [3.1 + v as f64, 1.9 + 0.2 * v as f64],
    };
    (0..views.len()).map(of).collect()
}

/// A wedge of the region around every eye, from the middle.
fn wedges(views: &[View]) -> Vec<Vec<DVec2>> {
    let half = PI / views.len() as f64;
    let wedge = |view: &View| {
        let eye = view.eye.truncate();
        let way = eye.normalize();
        let far = 1.2 * eye.length();
        let corner = |angle: f64| far * DVec2::from_angle(angle).rotate(way);
        vec![DVec2::ZERO, corner(-half), corner(half)]
    };
    views.iter().map(wedge).collect()
}

/// Every view's pillars at random in its wedge of the disc; the search ends where it began.
pub(crate) fn crowd(views: usize, each: usize, name: &str) -> Case {
    let radius = 72.0;
    let list: Vec<View> = (0..views)
        .map(|v| {
            let way = DVec2::from_angle(TAU * v as f64 / views as f64 + 0.3);
            let eye = ((120.0 + 37.0 * (v % 5) as f64) * way).extend(40.0 + 10.0 * v as f64);
            let colours = [
                shapes::ORANGE,
                shapes::BLUE,
                shapes::GREEN,
                [0xcc, 0x79, 0xa7],
                [0xd5, 0x5e, 0x00],
                [0, 0x72, 0xb2],
            ];
            let ball = shapes::ball(DVec3::new(0.0, 0.0, 40.0), 24.0, 8);
            shapes::view(&format!("{name}{}", v + 1), eye, ball, colours[v % 6])
        })
        .collect();
    let small = 2.2;
    let round = shape(shapes::ring(DVec2::ZERO, small, 48), true);
    let brief = brief(shapes::ring(DVec2::ZERO, radius, 96), vec![round], views);
    let pillars: Vec<Pillar> = (0..views * each)
        .map(|i| {
            let k = i / views;
            let turn = TAU * (i % views) as f64 / views as f64 + 0.3;
            let wide = (k as f64 * 0.618_034).fract() - 0.5;
            let far = radius * (0.25 + 0.7 * ((k as f64 + 0.5) / each as f64)).min(0.95);
            Pillar {
                at: far * DVec2::from_angle(turn + 0.9 * TAU / views as f64 * wide),
                shape: 0,
                owner: Some(i % views),
                fixed: i % 11 == 5,
                given: None,
            }
        })
        .collect();
    case(list, brief, pillars, 6)
}

fn shape(profile: Vec<DVec2>, round: bool) -> Shape {
    Shape {
        reach: profile.iter().map(|p| p.length()).fold(0.0, f64::max),
        profile,
        round,
        heights: [90.0, 90.0],
        layer: flat_layer(2.0, 1.0, 0.5),
        written: String::new(),
    }
}

/// A case whose frames all survey the same pillars, shaken less and less.
fn case(views: Vec<View>, brief: Brief, pillars: Vec<Pillar>, steps: u32) -> Case {
    let subjects: Vec<Subject> = subjects_of(&views);
    let frames: Vec<Frame> = (0..=steps)
        .map(|k| {
            let shake = 3.0 * f64::from(steps - k) / f64::from(steps.max(1));
            let shaken = pillars.iter().enumerate().map(|(i, p)| Pillar {
                at: p.at + shake * DVec2::from_angle(2.4 * i as f64),
                ..*p
            });
            frame(&subjects, &brief, shaken.collect(), 1000 * u64::from(k))
        })
        .collect();
    let worth = worth(&views, &frames[frames.len() - 1]);
    let planned = Planned {
        heights: vec![90.0; pillars.len()],
        adjustments: vec![Adjustment::NONE; views.len()],
        worth,
        regions: wedges(&views),
        frames,
        trade: Vec::new(),
        tries: 1000 * u64::from(steps),
        ended: Ended::Tries,
        changes: Vec::new(),
        pillars,
    };
    Case {
        views,
        brief,
        planned,
    }
}

/// A hand-made layout of square and round pillars in an angular region, mended: one pillar moved, one taken away, one put up.
pub(crate) fn mended() -> Case {
    let ball = |x: f64| shapes::ball(DVec3::new(x, 0.0, 30.0), 14.0, 10);
    let mut far = shapes::view(
        "<far> & \"near\"",
        DVec3::new(4.0, -420.0, 60.0),
        ball(0.0),
        shapes::ORANGE,
    );
    far.look_at = DVec3::new(0.0, 0.0, 30.0);
    let near = shapes::view(
        "fellow",
        DVec3::new(44.0, 46.0, 40.0),
        ball(-6.0),
        shapes::BLUE,
    );
    let region = [
        (-40.0, -40.0),
        (40.0, -40.0),
        (40.0, 0.0),
        (10.0, 0.0),
        (10.0, 40.0),
        (-40.0, 40.0),
    ];
    let region = region.map(|(x, y)| DVec2::new(x, y)).to_vec();
    let square = shape(shapes::ring(DVec2::ZERO, 5.0, 4), false);
    let round = shape(shapes::ring(DVec2::ZERO, 3.6, 48), true);
    let mut brief = brief(region, vec![square, round], 2);
    let pillar = |x: f64, y: f64, shape: usize, owner: Option<usize>| Pillar {
        at: DVec2::new(x, y),
        shape,
        owner,
        fixed: false,
        given: None,
    };
    brief.given = vec![
        pillar(-12.0, -20.0, 0, Some(0)),
        pillar(-4.0, -30.0, 1, Some(0)),
        pillar(3.0, -8.0, 0, Some(0)),
        pillar(12.0, -24.0, 1, Some(0)),
        pillar(-8.0, 14.0, 1, Some(1)),
        pillar(4.0, 12.0, 0, Some(1)),
        pillar(-30.0, 30.0, 0, None),
    ];
    brief.given[3].fixed = true;
    let mut pillars = brief.given.clone();
    pillars[2].at = DVec2::new(4.5, -26.0);
    pillars.remove(6);
    pillars.push(pillar(-18.0, 2.0, 1, Some(1)));
    let mut case = case(vec![far, near], brief, pillars.clone(), 0);
    let subjects: Vec<Subject> = subjects_of(&case.views);
    let start = frame(&subjects, &case.brief, case.brief.given.clone(), 0);
    case.planned.frames.insert(0, start);
    case.planned.regions.clear();
    case.planned.changes = vec![
        Change {
            given: Some(2),
            to: Some(pillars[2].at),
        },
        Change {
            given: Some(6),
            to: None,
        },
        Change {
            given: None,
            to: Some(pillars[6].at),
        },
    ];
    case.planned.adjustments[1] = Adjustment {
        turn: -0.1,
        scale: 1.05,
        shift: DVec2::new(1.5, -2.0),
    };
    case.planned.trade = vec![Trade {
        tolerance_mm: 2.0,
        hidden_deg: 41.0,
        chosen: true,
    }];
    case
}

/// Nothing at all.
pub(crate) fn nothing() -> Case {
    let mut case = case(Vec::new(), brief(Vec::new(), Vec::new(), 0), Vec::new(), 0);
    case.planned.frames.clear();
    case
}
