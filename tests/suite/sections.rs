//! Sections of groups: what they cut, by numbers, and what the page says.

use crate::shapes::{EYE, MIDDLE, Outcome, Setting, ball, obj};
use glam::DVec2;
use pillarforest::compile::{Build, build};
use pillarforest::diag::Diagnostic;
use pillarforest::diagram::section::{Section, groups_sheet, section};
use pillarforest::geom::{barycentric, polygon_area};
use pillarforest::index::CellId;
use pillarforest::mimic::{CurvatureOptions, Energy, FaceWeight, NormalOptions};
use pillarforest::scene;

fn cut(setting: &Setting, energy: Energy) -> (Outcome, Section) {
    let out = setting.solved(energy);
    let _model = &out.target().mesh;
    let found = section(&out.sight, &out.depths, &out.relief);
    (out, found)
}

fn energies() -> [Energy; 2] {
    [
        Energy::Normal(NormalOptions {
            weight: FaceWeight::Area,
            ordering: true,
            reweight: 0,
        }),
        Energy::Curvature(CurvatureOptions::PAPER),
    ]
}

#[test]
fn the_surface_lies_within_the_scaled_bounds_and_scaled_back_it_is_the_relief() {
    for energy in energies() {
        let (_, section) = cut(&Setting::tight(), energy);
        let mut scales = Vec::new();
        let mut laid = 0;
        for s in &section.stretches {
            let Some(l) = s.laid else { continue };
            let mu = section.groups[l.group].mu;
            scales.push(mu);
            for k in 0..2 {
                let slack = 1e-5 * s.surface[k];
                assert!(mu * l.near[k] - slack <= s.surface[k], "{s:?} {mu}");
                assert!(s.surface[k] <= mu * l.far[k] + slack, "{s:?} {mu}");
                assert!(
                    (s.surface[k] / mu - l.relief[k]).abs() < slack,
                    "{s:?} {mu}"
                );
            }
            laid += 1;
        }
        assert!(laid > 30, "{laid}");
        scales.sort_by(f64::total_cmp);
        assert!(scales[laid - 1] - scales[0] > 0.01, "scales differ");
    }
}

#[test]
fn every_value_is_that_of_its_ray() {
    let setting = Setting::tight();
    let (out, section) = cut(&setting, energies()[0]);
    let mut end = f64::NEG_INFINITY;
    for s in section.stretches.iter().filter(|s| s.x[1] - s.x[0] > 1e-6) {
        // Cells do not overlap.
        assert!(s.x[0] >= end - 1e-9, "{s:?} {end}");
        end = s.x[1];
        let q = section.cut.ray((s.x[0] + s.x[1]) / 2.0);
        let middle = |v: [f64; 2]| 2.0 / (1.0 / v[0] + 1.0 / v[1]);
        let direction = out.map().plane.direction(q);
        let hit = out
            .target()
            .bvh
            .first_hit(EYE, direction)
            .expect("the model");
        // On faces seen edgewise a ray's rounding moves its hit far.
        let slack = 1e-6 + 1e-3 * (s.model[1] - s.model[0]).abs();
        assert!((middle(s.model) - hit.t).abs() < slack, "{s:?} {hit:?}");
        let Some(l) = s.laid else { continue };
        let cell = CellId::all(out.map().cells.len())
            .find(|c| {
                let [a, b, c] = out.map().triangle(*c);
                barycentric(a, b, c, q).min_element() >= 0.0
            })
            .expect("a cell");
        let group = section.groups[l.group].group;
        assert_eq!(out.groups().of_cell[cell], Some(group));
        let support = out.groups().groups[group].support;
        assert_eq!(
            section.groups[l.group].support,
            setting.supports[support].name
        );
        let slab = out.groups().slabs[support].expect("a layer");
        let (near, far) = out.sight.image.layer_at(&slab, support, q);
        assert!((middle(l.near) - near).abs() < 1e-6 && (middle(l.far) - far).abs() < 1e-6);
        let [a, b, c] = out.map().triangle(cell);
        let beta = barycentric(a, b, c, q).to_array();
        let depth = out.relief.depth[cell].expect("a relief");
        let inverse: f64 = (0..3).map(|k| beta[k] / depth[k]).sum();
        assert!((middle(l.relief) - 1.0 / inverse).abs() < 1e-6);
    }
}

#[test]
fn supports_and_model_are_cut_by_the_plane() {
    const RADIUS: f64 = 12.0;
    let mut setting = Setting::tight();
    setting.model = ball(MIDDLE, RADIUS, 40);
    let (_, section) = cut(&setting, energies()[0]);
    assert!(!section.cut.upright, "pillars stand side by side");
    assert_eq!((section.groups.len(), section.of), (3, 3));
    assert_eq!(section.supports.len(), 3);
    // A prism of 48 sides, cut at the tilt of the plane.
    let (_, away) = section.cut.frame();
    let level = away.truncate().length();
    let prism = 24.0 * 4.6f64.powi(2) * (std::f64::consts::TAU / 48.0).sin();
    for (outline, carries) in &section.supports {
        assert!(outline.closed && *carries);
        let area = polygon_area(&outline.points).abs();
        assert!((area - prism / level).abs() < 1e-6, "{area} {prism}");
    }
    let [outline] = &section.model[..] else {
        panic!("one outline: {}", section.model.len());
    };
    let middle = DVec2::new(0.0, EYE.distance(MIDDLE) * level);
    let radius = (RADIUS.powi(2) - (EYE.distance(MIDDLE) * away.z).powi(2)).sqrt();
    assert!(outline.closed);
    for p in &outline.points {
        assert!(
            (p.distance(middle) - radius).abs() < 0.05,
            "{p} {middle} {radius}"
        );
    }
}

#[test]
fn the_same_view_gives_the_same_page() {
    let page = |name: &str| groups_sheet(name, &cut(&Setting::tight(), energies()[0]).1).svg();
    assert_eq!(page("a"), page("a"));
    assert_ne!(page("a"), page("b"));
}

const SCENE: &str = r#"(
    models: [(name: "ball", file: "ball.obj", place: Fit(height: 30, at: (0, 0, 8)))],
    views: [(name: "front", eye: (0, -250, EYE_Z), models: ["ball"])],
    SUPPORTS,
    energy: Normal(ENERGY),
    output: (groups: true, turntable: true, plan: false, views: false, lights: false, camouflage: false, report_html: false, picture_size: 64),
)"#;

const PILLARS: &str =
    "pillars: [(shape: Round(radius: 5), height: 50, places: At([(-9, 5), (0.5, -4), (10, 8)]))]";
const STAIRS: &str =
    "supports: [Stairs(steps: 5, width: 60, rise: 8, going: 8, depth: (front: 4))]";

fn built(text: &str) -> Build {
    let read =
        |_: &str| -> Result<Vec<u8>, Diagnostic> { Ok(obj(&ball(glam::DVec3::ZERO, 1.0, 12))) };
    let scene = scene::resolve(text, &read).expect("a scene").value;
    build(&scene, &|_, _| {}, &|| false).expect("a forest")
}

fn text(supports: &str, energy: &str, eye_z: &str) -> String {
    SCENE
        .replace("SUPPORTS", supports)
        .replace("ENERGY", energy)
        .replace("EYE_Z", eye_z)
}

fn svg(build: &Build) -> String {
    let file = build.files.iter().find(|f| f.path == "groups-front.svg");
    String::from_utf8(file.expect("a section").bytes.clone()).expect("text")
}

#[test]
fn pages_say_what_they_show() {
    let whole = built(&text(PILLARS, "steps: Never", "30"));
    let page = svg(&whole);
    assert!(page.contains("level from side to side"), "{page}");
    assert!(page.contains("one surface runs through all"));
    let report = whole.files.iter().find(|f| f.path == "report.json");
    assert!(report.is_some());
    assert!(whole.files.iter().any(|f| f.path == "groups-front.png"));
    assert!(whole.files.iter().any(|f| f.path == "turntable.png"));
    let torn = svg(&built(&text(PILLARS, "steps: Allowed()", "30")));
    assert!(torn.contains("The torn surface") && !torn.contains("one surface runs"));
    // Stairs have level treads: only an upright section cuts several.
    let stairs = svg(&built(&text(STAIRS, "steps: Allowed()", "150")));
    assert!(stairs.contains("Upright section"), "{stairs}");
}

#[test]
fn they_are_written_only_if_wanted() {
    let plain = text(PILLARS, "", "30").replace("groups: true, turntable: true, ", "");
    let paths = |b: &Build| b.files.iter().map(|f| f.path.clone()).collect::<Vec<_>>();
    let files = paths(&built(&plain));
    assert!(
        files
            .iter()
            .all(|f| !f.starts_with("groups") && !f.starts_with("turntable")),
        "{files:?}"
    );
}
