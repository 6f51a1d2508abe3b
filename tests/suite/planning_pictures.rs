//! Pictures of plans: the sheet, the trade-off, the search as a film and as a strip.

use glam::{DVec2, DVec3};
use pillarforest::diag::Diagnostic;
use pillarforest::diagram::planning;
use pillarforest::planner::survey::survey;
use pillarforest::planner::subject::Subject;
use pillarforest::planner::{
    Adjustment, Brief, Change, Ended, Frame, Freedom, Matters, Pillar, Planned, Shape, Trade, Worth,
};
use pillarforest::scene::{self, Scene};
use pillarforest::steps::UNSEEN_RAD;
use pillarforest::support::SupportKind;
use pillarforest::view::View;
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// A plan as the planner hands it over.
struct Case {
    views: Vec<View>,
    brief: Brief,
    planned: Planned,
}

/// The layout of the four creatures as the end of a search that began with it shaken.
fn creatures() -> Case {
    let scene = four_creatures();
    let (brief, pillars) = brief_of(&scene);
    let subjects: Vec<Subject> = scene.views.iter().map(Subject::new).collect();
    let last = 30;
    let frames = (0..=last).map(|k| {
        let shake = 12.0 * (1.0 - f64::from(k) / f64::from(last)).powi(2);
        let shaken = pillars.iter().enumerate().map(|(i, p)| Pillar {
            at: p.at + shake * DVec2::from_angle(2.4 * i as f64 + 0.1 * f64::from(k)),
            ..*p
        });
        frame(&subjects, &brief, &scene.views, shaken.collect(), 400 * k as u64)
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
            SupportKind::Pillar { axis, profile, top, round, .. } => {
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
                });
            }
        }
    }
    let brief = brief(region, shapes, scene.views.len());
    (brief, pillars)
}

fn brief(region: Vec<DVec2>, shapes: Vec<Shape>, views: usize) -> Brief {
    Brief {
        region,
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
        tolerance_mm: vec![1.0; views],
        freedom: Freedom::NONE,
    }
}

/// A layout with a mark wherever an eye meets none of its own pillars.
fn frame(
    subjects: &[Subject],
    brief: &Brief,
    views: &[View],
    pillars: Vec<Pillar>,
    tries: u64,
) -> Frame {
    let found = survey(subjects, brief, &pillars);
    let mut marks = Vec::new();
    for (v, runs) in found.runs.iter().enumerate() {
        for run in runs {
            let middle = (run.from + run.to) / 2.0;
            let met = run.pillar.map(|i| pillars[i]);
            let name = &views[v].name;
            match met {
                None => {
                    let near = subjects[v].middle.truncate().distance(subjects[v].o);
                    marks.push((subjects[v].point(middle, near), format!("{name} looks past all pillars")));
                }
                Some(p) if p.owner != Some(v) => {
                    let whose = p.owner.map_or("nobody", |o| &views[o].name);
                    marks.push((p.at, format!("{name} meets a pillar of {whose}")));
                }
                Some(_) => {}
            }
        }
    }
    let rate = found.rates.iter().map(|r| r[1]).fold(0.0, f64::max);
    Frame {
        tries,
        hidden_deg: 34.0 + 16.0 * (tries as f64 / 12_000.0).sqrt(),
        tolerance_mm: UNSEEN_RAD / rate,
        pillars,
        runs: found.runs,
        faults: found.faults,
        marks,
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

#[test]
#[ignore]
fn dump() {
    let dir = Path::new("/tmp/pics");
    std::fs::create_dir_all(dir).unwrap();
    let save = |case: &Case, name: &str, title: &str| {
        let t = std::time::Instant::now();
        let sheet = planning::sheet(title, &case.views, &case.brief, &case.planned);
        let write = |f: &str, b: &[u8]| std::fs::write(dir.join(format!("{name}-{f}")), b).unwrap();
        write("sheet.svg", sheet.svg().as_bytes());
        write("sheet.png", &sheet.png(2400));
        let trade = planning::trade(title, &case.brief, &case.planned);
        write("trade.svg", trade.svg().as_bytes());
        write("trade.png", &trade.png(1400));
        let strip = planning::strip(title, &case.views, &case.brief, &case.planned);
        write("strip.svg", strip.svg().as_bytes());
        write("strip.png", &strip.png(2000));
        let film = planning::animation(title, &case.views, &case.brief, &case.planned);
        write("film.svg", film.as_bytes());
        println!("{name} {:?} film {} kB", t.elapsed(), film.len() / 1000);
    };
    save(&creatures(), "four", "Four creatures");
}
