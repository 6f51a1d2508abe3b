//! Camouflage: what is known of forests that are their models, that are not there, and that are flat.

use crate::scene::CUBE;
use crate::shapes::{BLUE, MIDDLE, ORANGE, ball, bumpy, prism, ring, view};
use glam::{DMat4, DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::certify::camouflage::{ANGLES_DEG, Camouflage, camouflage, largest_beyond};
use pillarforest::compile::{self, Build, build};
use pillarforest::diag::Diagnostic;
use pillarforest::diagram::curves::{Curve, curves};
use pillarforest::geom::half_angle;
use pillarforest::mesh::TriMesh;
use pillarforest::scene;
use std::f64::consts::FRAC_PI_2;

const FAR: DVec3 = DVec3::new(0.0, -600.0, 20.0);

fn of(model: &TriMesh, forest: &TriMesh) -> Camouflage {
    let view = view("ball", FAR, model.clone(), ORANGE);
    camouflage(&view, forest, &Bvh::new(forest), 0.0)
}

#[test]
fn the_model_itself_is_recognised_from_everywhere() {
    let model = bumpy(12.0);
    let found = of(&model, &model);
    assert_eq!(found.curve.len(), 1 + ANGLES_DEG.len());
    for point in &found.curve {
        assert!(point.likeness > 1.0 - 1e-9, "{point:?}");
        assert!(point.mean_error_deg < 1e-6, "{point:?}");
    }
    assert_eq!(found.half_likeness_deg, None);
    assert_eq!(found.worst_off_view_deg, None);
}

#[test]
fn nothing_is_like_nothing() {
    let elsewhere = ball(DVec3::new(0.0, 0.0, 9000.0), 1.0, 4);
    for forest in [elsewhere, TriMesh::default()] {
        let found = of(&bumpy(12.0), &forest);
        for point in &found.curve {
            assert_eq!(point.likeness, 0.0, "{point:?}");
            assert_eq!(point.mean_error_deg, 90.0, "{point:?}");
        }
        assert_eq!(found.half_likeness_deg, None);
    }
}

/// A disc that stands upright before the eye.
fn disc(radius: f64) -> TriMesh {
    let lying = prism(&ring(DVec2::ZERO, radius, 96), -0.05, 0.05);
    let matrix = DMat4::from_translation(MIDDLE) * DMat4::from_rotation_x(FRAC_PI_2);
    lying.transformed(matrix)
}

#[test]
fn a_disc_looks_like_a_ball_by_half_and_only_from_before_and_behind() {
    let radius = 12.0;
    let found = of(&ball(MIDDLE, radius, 60), &disc(radius));
    let at = |deg: f64| *found.curve.iter().find(|p| p.angle_deg == deg).unwrap();
    // The angle between the normals is asin(r / R) at a distance r from the middle: 45 degrees in the mean over the disc.
    for deg in [0.0, 180.0] {
        assert!((at(deg).mean_error_deg - 45.0).abs() < 1.5, "{:?}", at(deg));
        assert!((at(deg).agreement - 0.5).abs() < 0.02, "{:?}", at(deg));
        assert!(at(deg).overlap > 0.97, "{:?}", at(deg));
    }
    // An ellipse of half width cos 60 degrees covers half of the circle.
    assert!((at(60.0).overlap - 0.5).abs() < 0.03, "{:?}", at(60.0));
    assert!(at(90.0).likeness < 0.01, "{:?}", at(90.0));
    let half = found.half_likeness_deg.unwrap();
    assert!((30.0..60.0).contains(&half), "{half}");
    assert_eq!(found.worst_off_view_deg, Some(180.0));
    assert_eq!(found.worst_likeness, Some(at(180.0).likeness));
}

#[test]
fn the_half_is_interpolated_and_the_worst_lies_beyond() {
    let curve = [(0.0, 0.8), (1.0, 0.7), (2.0, 0.5), (5.0, 0.2), (10.0, 0.45)];
    assert!((half_angle(&curve).unwrap() - 3.0).abs() < 1e-12);
    assert_eq!(largest_beyond(&curve, 3.0), Some((10.0, 0.45)));
    assert_eq!(half_angle(&[(0.0, 0.8), (1.0, 0.4)]), Some(1.0));
    assert_eq!(half_angle(&curve[..3]), None);
    assert_eq!(half_angle(&[(0.0, 0.0), (1.0, 0.0)]), None);
    assert_eq!(half_angle(&[]), None);
    assert_eq!(largest_beyond(&curve, 10.0), None);
}

#[test]
fn one_thread_and_three_give_the_same_curve() {
    let (model, forest) = (bumpy(12.0), disc(10.0));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| of(&model, &forest))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn no_eye_looks_from_below_the_floor() {
    // A lid below hides the ball from lowered eyes: they would see nothing of it.
    let mut forest = bumpy(12.0);
    forest.append(&prism(&ring(DVec2::ZERO, 900.0, 48), -30.0, -29.0));
    let found = of(&bumpy(12.0), &forest);
    let overlap = |p: &pillarforest::certify::camouflage::CurvePoint| p.overlap;
    // All eyes left stand above the lid, and see the ball before it or beside it.
    assert!(found.curve.iter().all(|p| p.agreement > 1.0 - 1e-9));
    assert!(found.curve.iter().map(overlap).all(|o| o > 0.3));
}

#[test]
fn the_plot_names_every_view_with_its_angles() {
    let curve = |name: &str, colour| Curve {
        name: name.into(),
        colour,
        points: vec![(0.0, 0.6), (5.0, 0.3), (45.0, 0.1), (180.0, 0.2)],
        half_deg: Some(5.0),
        worst: Some((180.0, 0.2)),
    };
    let list = [curve("owl", ORANGE), curve("a <fish>", BLUE)];
    let drawing = curves("Two of them", &list);
    let svg = drawing.svg("Two of them");
    for wanted in [
        "owl",
        "a &lt;fish&gt;",
        "5.0°",
        "180°",
        "0.60",
        "0.20",
        "half",
    ] {
        let label = format!("aria-label=\"{wanted}\"");
        assert!(svg.contains(&label), "{wanted}");
    }
    for odd in [
        vec![],
        vec![Curve {
            points: vec![(0.0, 0.0), (1.0, 0.0)],
            half_deg: None,
            worst: None,
            ..list[0].clone()
        }],
    ] {
        let svg = curves("", &odd).svg("");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
    assert_eq!(&drawing.png(600)[1..4], b"PNG");
}

/// A cube in two blocks.
const TWO_BLOCKS: &str = r#"(
    models: [(name: "cube", file: "cube.obj", place: Fit(height: 20, spin: 30, at: (0, 0, 15)))],
    views: [(name: "front", eye: (0, -300, 40), models: ["cube"])],
    pillars: [(shape: Rectangle(width: 24, depth: 12), height: 60, places: At([(-12, -8), (12, 8)]))],
    output: (lights: false, views: false, picture_size: 64),
)"#;

fn built(text: &str) -> (Build, serde_json::Value) {
    let read = |_: &str| -> Result<Vec<u8>, Diagnostic> { Ok(CUBE.into()) };
    let scene = scene::resolve(text, &read).expect("a scene").value;
    let build = build(&scene, &|_, _| {}, &|| false).expect("a forest");
    let file = build.files.iter().find(|f| f.path == "report.json");
    let report = serde_json::from_slice(&file.expect("a report").bytes).unwrap();
    (build, report)
}

#[test]
fn a_scene_may_do_without_camouflage_but_not_without_tolerance() {
    let (plain, report) = built(&scene::set(TWO_BLOCKS, "output.camouflage=false").unwrap());
    assert!(plain.files.iter().all(|f| !f.path.contains("camouflage")));
    assert!(report.get("camouflage").is_none());
    let (full, report) = built(TWO_BLOCKS);
    let pictures = full
        .files
        .iter()
        .filter(|f| f.path.starts_with("camouflage."));
    assert_eq!(pictures.count(), 2);
    let camouflage = report["camouflage"].as_array().unwrap();
    assert_eq!(camouflage.len(), 1);
    assert_eq!(camouflage[0]["view"], "front");
    let first = &camouflage[0]["curve"][0];
    let own = report["views"][0]["normal_error_deg"]["mean"]
        .as_f64()
        .unwrap();
    assert_eq!(first["angle_deg"], 0.0);
    assert!((first["mean_error_deg"].as_f64().unwrap() - own).abs() < 1.0);
    let view = &report["views"][0]["certificate"];
    let [unseen, one] = ["eye_tolerance_mm", "one_picture_mm"].map(|k| view[k]["side"].as_f64());
    // Five times as far but for specks, which may be longer.
    let ratio = one.unwrap() / unseen.unwrap();
    assert!((4.8..10.0).contains(&ratio), "{unseen:?} {one:?}");
    assert!(view["stereo_distance_mm"].as_f64().unwrap() > 300.0);
    let gap = &view["worst_cuts"][0]["gap"];
    let [predicted, measured] = ["predicted_arcmin", "measured_arcmin"].map(|k| gap[k].as_f64());
    assert!(
        (measured.unwrap() / predicted.unwrap() - 1.0).abs() < 0.06,
        "{gap}"
    );
    // The disc at the eye and what it means.
    let plan = full.files.iter().find(|f| f.path == "plan.svg").unwrap();
    assert!(String::from_utf8_lossy(&plan.bytes).contains("disc at an eye"));
    let read = |_: &str| -> Result<Vec<u8>, Diagnostic> { Ok(CUBE.into()) };
    let scene = scene::resolve(TWO_BLOCKS, &read).expect("a scene").value;
    let bare = compile::plan(&scene, &|_, _| {}, &|| false).expect("a plan");
    let bare = &bare.files[0];
    assert!(!String::from_utf8_lossy(&bare.bytes).contains("disc at an eye"));
}
