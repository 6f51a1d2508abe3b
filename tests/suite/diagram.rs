//! The plan: two-dimensional visibility, and the page made of it.

use crate::golden;
use crate::shapes::{self, base, grove, pillar, prism, ring, view};
use glam::{DMat4, DVec2, DVec3};
use pillarforest::diagram::plan;
use pillarforest::diagram::vista::{Grain, Vista, horizon, obstacles};
use pillarforest::horizon::Horizon;
use pillarforest::support::{Datum, Support, SupportKind};
use pillarforest::view::View;
use proptest::prelude::*;

/// An eye at the origin that looks along x at a plate 100 mm away, 20 mm wide.
fn plate_view() -> View {
    let plate = [
        DVec2::new(100.0, -10.0),
        DVec2::new(101.0, -10.0),
        DVec2::new(101.0, 10.0),
        DVec2::new(100.0, 10.0),
    ];
    view(
        "plate",
        DVec3::new(0.0, 0.0, 5.0),
        prism(&plate, 0.0, 10.0),
        shapes::ORANGE,
    )
}

/// A pillar with a square profile between two corners.
fn block(lo: DVec2, hi: DVec2) -> Support {
    let mut support = pillar((lo + hi) / 2.0, 1.0, 4, Datum::Plane);
    if let SupportKind::Pillar { profile, .. } = &mut support.kind {
        *profile = vec![lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    }
    support
}

/// What the view's eye meets, and how that is drawn.
fn look(view: &View, supports: &[Support]) -> (Horizon, Vista) {
    let obstacles = obstacles(supports);
    let horizon = horizon(view, &obstacles);
    let vista = Vista::of(&horizon, &obstacles, Grain::Step(0.01));
    (horizon, vista)
}

fn width(horizon: &Horizon) -> f64 {
    horizon.runs().map(|r| r.width()).sum()
}

#[test]
fn a_wall_in_front_covers_all_and_nothing_covers_nothing() {
    let wall = block(DVec2::new(50.0, -30.0), DVec2::new(52.0, 30.0));
    let (horizon, _) = look(&plate_view(), &[wall]);
    assert!((horizon.coverage() - 1.0).abs() < 1e-6);
    assert!((width(&horizon) - 2.0 * 0.1f64.atan()).abs() < 1e-6);
    assert_eq!(look(&plate_view(), &[]).0.coverage(), 0.0);
}

#[test]
fn half_a_wall_covers_half() {
    let half = block(DVec2::new(50.0, 0.0), DVec2::new(52.0, 30.0));
    let coverage = look(&plate_view(), &[half]).0.coverage();
    assert!((coverage - 0.5).abs() < 1e-6, "{coverage}");
}

#[test]
fn what_stands_behind_is_not_seen() {
    let walls = [
        block(DVec2::new(80.0, -30.0), DVec2::new(82.0, 30.0)),
        block(DVec2::new(50.0, -30.0), DVec2::new(52.0, 30.0)),
    ];
    let (horizon, _) = look(&plate_view(), &walls);
    assert_eq!(horizon.angle_of(0), 0.0);
    assert!(horizon.angle_of(1) > 0.0);
}

#[test]
fn the_room_of_a_relief_lies_between_its_front_and_back_planes() {
    let supports = [pillar(DVec2::new(60.0, 1.0), 4.0, 64, Datum::Plane)];
    let (_, vista) = look(&plate_view(), &supports);
    let sector = vista.sectors().find(|s| s.obstacle == Some(0)).unwrap();
    let (room, line) = vista.constrained(sector, &supports).unwrap();
    let axis = DVec2::new(60.0, 1.0);
    let depth = |p: &DVec2| (*p - axis).dot(axis.normalize());
    let (front, back) = room.split_at(room.len() / 2);
    assert!(front.iter().all(|p| (depth(p) + 2.0).abs() < 1e-9));
    assert!(back.iter().all(|p| (depth(p) - 1.0).abs() < 1e-9));
    assert!(line.iter().all(|p| depth(p).abs() < 1e-9));
}

/// Distance of the first profile edge on a ray, the slow and simple way.
fn nearest(supports: &[Support], eye: DVec2, direction: DVec2) -> f64 {
    let mut best = f64::INFINITY;
    for support in supports {
        let SupportKind::Pillar { profile, .. } = &support.kind else {
            continue;
        };
        for (k, &p) in profile.iter().enumerate() {
            let edge = profile[(k + 1) % profile.len()] - p;
            let det = direction.perp_dot(edge);
            let (t, s) = (
                (p - eye).perp_dot(edge) / det,
                (p - eye).perp_dot(direction) / det,
            );
            if t > 0.0 && (0.0..=1.0).contains(&s) {
                best = best.min(t);
            }
        }
    }
    best
}

fn turned(view: &View, supports: &[Support], angle: f64) -> (View, Vec<Support>) {
    let matrix = DMat4::from_rotation_z(angle);
    let flat = |p: &DVec2| matrix.transform_point3(p.extend(0.0)).truncate();
    let mut view = view.clone();
    (view.eye, view.look_at) = (
        matrix.transform_point3(view.eye),
        matrix.transform_point3(view.look_at),
    );
    view.models
        .iter_mut()
        .for_each(|m| m.mesh = m.mesh.transformed(matrix));
    let turn = |support: &Support| {
        let mut support = support.clone();
        if let SupportKind::Pillar { axis, profile, .. } = &mut support.kind {
            *axis = flat(axis);
            profile.iter_mut().for_each(|p| *p = flat(p));
        }
        support
    };
    (view, supports.iter().map(turn).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Runs tile the width, every hit is the nearest one, and turning the scene changes nothing.
    #[test]
    fn sight_agrees_with_single_rays(cells in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.4..2.5f64, 3..20usize), 40), angle in 0.0..6.0f64) {
        // One pillar to a cell of a grid: they never touch.
        let place = |k: usize, u: f64, v: f64| DVec2::new(20.0 + 8.0 * (k % 8) as f64 + 2.9 * u, -18.0 + 8.0 * (k / 8) as f64 + 2.9 * v);
        let supports: Vec<Support> = cells.iter().enumerate().map(|(k, &(u, v, r, n))| pillar(place(k, u, v), r, n, Datum::Plane)).collect();
        let (horizon, vista) = look(&plate_view(), &supports);
        let whole = 2.0 * 0.1f64.atan();
        prop_assert!((width(&horizon) - whole).abs() < 1e-5);
        for k in 0..200 {
            let angle = whole * ((f64::from(k) + 0.37) / 200.0 - 0.5);
            let true_distance = nearest(&supports, DVec2::ZERO, DVec2::from_angle(angle));
            let run = vista.sectors().find(|r| r.hits[0].0 <= angle && angle <= r.hits.last().unwrap().0);
            // None only within a nudge of a tangent.
            let Some(run) = run else { continue };
            prop_assert_eq!(run.obstacle.is_some(), true_distance.is_finite());
            let next = run.hits.iter().position(|h| h.0 >= angle).unwrap().max(1);
            let (a, b) = (run.hits[next - 1], run.hits[next]);
            if run.obstacle.is_some() {
                // Between neighbouring hits the outline is straight.
                let p = vista.point(a.0, a.1);
                let edge = vista.point(b.0, b.1) - p;
                let t = p.perp_dot(edge) / DVec2::from_angle(angle).perp_dot(edge);
                prop_assert!((t - true_distance).abs() < 1e-5 * true_distance, "{} {}", t, true_distance);
            }
        }
        let (turned_view, turned_supports) = turned(&plate_view(), &supports, angle);
        let (other, _) = look(&turned_view, &turned_supports);
        prop_assert!((other.coverage() - horizon.coverage()).abs() < 1e-6);
    }
}

#[test]
fn the_svg_is_well_formed_true_to_scale_and_says_what_it_shows() {
    let (views, supports) = grove();
    let svg = plan("Grove <1> & more", &views, &supports, &[]).svg();
    let mut reader = quick_xml::Reader::from_str(&svg);
    let mut labels = Vec::new();
    loop {
        match reader.read_event().expect("well-formed") {
            quick_xml::events::Event::Eof => break,
            quick_xml::events::Event::Empty(e) => {
                labels.extend(
                    e.try_get_attribute("aria-label")
                        .unwrap()
                        .map(|a| a.unescape_value().unwrap().into_owned()),
                );
            }
            _ => {}
        }
    }
    for wanted in [
        "Grove <1> & more",
        "owl",
        "hare",
        "a \"fish\" & <more>",
        "1",
        "11",
    ] {
        assert!(labels.iter().any(|l| l == wanted), "{wanted} is missing");
    }
    let open = svg.lines().next().unwrap();
    let value = |name: &str| {
        open.split(&format!("{name}=\""))
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .to_owned()
    };
    let (width, view_box) = (value("width"), value("viewBox"));
    assert_eq!(
        width.strip_suffix("mm").unwrap(),
        view_box.split(' ').nth(2).unwrap(),
        "one unit is one millimetre"
    );
    // The base is 64 mm across and so it is on the page.
    let outline = svg
        .lines()
        .find(|l| l.contains("#f1eee6") && l.matches('L').count() > 90)
        .unwrap();
    let xs: Vec<f64> = outline
        .split(['M', 'L'])
        .skip(1)
        .filter_map(|p| p.split(' ').next()?.parse().ok())
        .collect();
    let across =
        xs.iter().copied().fold(f64::MIN, f64::max) - xs.iter().copied().fold(f64::MAX, f64::min);
    assert!((across - 64.0).abs() < 0.01, "{across}");
}

#[test]
fn the_picture_is_the_golden_one() {
    let (views, supports) = grove();
    golden::picture(
        "plan.png",
        &plan("A small grove", &views, &supports, &[]).png(900),
    );
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let (views, supports) = grove();
    let (a, b) = (
        plan("x", &views, &supports, &[]),
        plan("x", &views, &supports, &[]),
    );
    assert_eq!(a.svg(), b.svg());
    assert_eq!(a.png(300), b.png(300));
}

#[test]
fn odd_scenes_have_a_plan_too() {
    let (views, supports) = grove();
    let mut inside = views[0].clone();
    inside.eye = DVec3::new(14.0, 9.0, 20.0);
    let mut above = views[0].clone();
    (above.eye, above.look_at) = (DVec3::new(0.0, 0.0, 300.0), DVec3::ZERO);
    let mut blind = views[0].clone();
    blind.models.clear();
    let scenes: [(Vec<View>, Vec<Support>); 5] = [
        (vec![], vec![]),
        (views.clone(), vec![]),
        (vec![], supports.clone()),
        (vec![inside, above, blind], supports),
        (views, vec![base(ring(DVec2::ZERO, 1e-3, 3))]),
    ];
    for (views, supports) in scenes {
        let plan = plan("", &views, &supports, &[]);
        assert!(!plan.svg().contains("NaN") && !plan.svg().contains("inf"));
        assert!(tiny_skia::Pixmap::decode_png(&plan.png(120)).is_ok());
    }
}
