//! Eyes at infinity: parallel rays, layers, invariance along the view, exact copies where there is room, and what a build tells.

use super::shapes::{
    MIDDLE, ORANGE, Outcome, ball, boxes, bumpy, field, obj, pillar, sighted,
    solved as solved_from, view,
};
use glam::{DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::certify::layer::bound_violation_mm;
use pillarforest::compile::{self, Build};
use pillarforest::diag::Diagnostic;
use pillarforest::geom::{FAR_MM, ImagePlane, READING_MM};
use pillarforest::index::{CellId, FaceId, VertexId};
use pillarforest::mesh::TriMesh;
use pillarforest::mimic::{CurvatureOptions, Energy, FaceWeight, GradientOptions, NormalOptions};
use pillarforest::scene::{self, Scene};
use pillarforest::steps::UNSEEN_RAD;
use pillarforest::support::{Datum, Support, SupportKind};
use pillarforest::view::View;
use std::path::Path;

const NORMAL: Energy = Energy::Normal(NormalOptions {
    weight: FaceWeight::Area,
    ordering: true,
    reweight: 0,
});
const CURVATURE: Energy = Energy::Curvature(CurvatureOptions::PAPER);

/// From the front, a little from the right and above.
fn from() -> DVec3 {
    DVec3::new(0.1, -1.0, 0.25).normalize()
}

/// The bumpy ball from infinity, or what stands for it at another distance.
fn far_view(distance: f64) -> View {
    View {
        eye: MIDDLE + distance * from(),
        look_at: MIDDLE,
        orthographic: true,
        ..view("ball", MIDDLE + from(), bumpy(12.0), ORANGE)
    }
}

/// An upright plate whose face is in the middle of the ball, with a layer of 3 mm before it and 1 mm behind.
fn plate() -> Support {
    let text = "(models: [(name: \"b\", file: \"b.obj\")], views: [(name: \"v\", eye: (0, -300, 20), models: [\"b\"])], \
                supports: [Plate(width: 60, height: 60, thickness: 8, at: (0, 0, -10), depth: (front: 3, back: 1))])";
    let read = |_: &str| Ok(obj(&ball(MIDDLE, 12.0, 8)));
    let scene = scene::resolve(text, &read).expect("a scene").value;
    scene.supports[0].clone()
}

fn solved(view: &View, supports: &[Support], energy: Energy) -> Outcome {
    solved_from(sighted(view.clone(), field(supports)), energy)
}

fn moved(mesh: &TriMesh, by: DVec3) -> TriMesh {
    TriMesh {
        vertices: mesh.vertices.iter().map(|v| *v + by).collect(),
        faces: mesh.faces.clone(),
    }
}

/// How far every bounded vertex of the relief stands before a point, along the view, millimetres; NaN without bounds.
fn heights(found: &Outcome, point: DVec3) -> Vec<f64> {
    let mut heights = vec![f64::NAN; found.depths.s.len()];
    for bound in &found.groups().bounds {
        let mut terms = bound.anchor.terms();
        if let (Some((v, _)), None) = (terms.next(), terms.next()) {
            let z = found.target().depth[v] * found.depths.s[v] / found.depths.mu[bound.group];
            heights[v] = found.map().plane.depth(point) - z;
        }
    }
    heights
}

/// The largest difference of two lists, and how many entries both have.
fn apart(a: &[f64], b: &[f64]) -> (f64, usize) {
    let both = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    let both: Vec<f64> = both.filter(|d| !d.is_nan()).collect();
    (both.iter().copied().fold(0.0, f64::max), both.len())
}

#[test]
fn rays_from_infinity_are_parallel_and_images_as_large_as_from_where_one_reads() {
    let plane = far_view(FAR_MM).plane();
    assert!(plane.is_parallel());
    let across = 50.0 / READING_MM;
    for way in [DVec2::X, DVec2::Y, DVec2::new(-0.6, 0.8)] {
        let lean = plane.direction(across * way).angle_between(plane.forward);
        assert!(lean.to_degrees() < 0.0096, "{lean}");
    }
    let point = MIDDLE + 30.0 * plane.right - 20.0 * plane.up;
    let q = plane.project(point).expect("before the eye");
    assert!(q.distance(DVec2::new(30.0, -20.0) / READING_MM) < 1e-12);
    assert!(plane.point(q, plane.depth(point)).distance(point) < 1e-9);
    assert!((plane.scale(plane.depth(point)) - READING_MM).abs() < 1e-6);
    let corners = [MIDDLE, MIDDLE + plane.right, MIDDLE + plane.up];
    let image = corners.map(|p| plane.project(p).expect("before the eye"));
    let wanted = 0.5 / (READING_MM * READING_MM);
    for found in [plane.solid_angle(image), plane.solid_angle_of(corners)] {
        assert!((found / wanted - 1.0).abs() < 1e-8, "{found}");
    }
    let near = ImagePlane::looking_at(MIDDLE + READING_MM * from(), MIDDLE);
    assert!((near.solid_angle_of(corners) / wanted - 1.0).abs() < 1e-4);
}

#[test]
fn rays_from_afar_find_what_rays_from_nearby_find() {
    let bvh = Bvh::new(&bumpy(12.0));
    let plane = far_view(FAR_MM).plane();
    let mut met = 0;
    for k in 0..40_000 {
        let q = DVec2::new(f64::from(k % 200), f64::from(k / 200)) / 200.0 - 0.5;
        let (eye, way) = (plane.eye, plane.direction(0.1 * q));
        let start = 0.9999 * FAR_MM;
        let [far, near] = [eye, eye + start * way].map(|o| bvh.first_hit(o, way));
        assert_eq!(far.map(|h| h.face), near.map(|h| h.face), "{q}");
        let all = bvh.all_hits(eye, way);
        assert_eq!(all.first().map(|h| h.face), far.map(|h| h.face));
        assert_eq!(bvh.blocked(eye, way, 2.0 * FAR_MM), far.is_some());
        if let Some((far, near)) = far.zip(near) {
            met += 1;
            assert!((far.t - start - near.t).abs() < 1e-8);
            assert!(!bvh.blocked(eye, way, far.t - 1e-3));
            assert!(bvh.blocked(eye, way, far.t + 1e-3));
        }
    }
    assert!(met > 20_000, "{met}");
}

#[test]
fn an_orthographic_relief_stays_in_its_layer() {
    let supports = [plate()];
    let SupportKind::Body {
        face: Some(face), ..
    } = supports[0].kind
    else {
        panic!("a plate has a face")
    };
    let gradient = Energy::Gradient(GradientOptions { compression: 1.0 });
    for energy in [NORMAL, CURVATURE, Energy::Linear, gradient] {
        let found = solved(&far_view(FAR_MM), &supports, energy);
        let violation = bound_violation_mm(&found.sight, &found.relief);
        assert!(violation <= 1e-6, "{energy:?}: {violation}");
        assert!(found.relief.clamp_mm <= 1e-6, "{}", found.relief.clamp_mm);
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        let depth = &found.relief.depth;
        for (c, depth) in CellId::all(depth.len()).zip(depth) {
            for (q, z) in found
                .map()
                .triangle(c)
                .into_iter()
                .zip(depth.iter().flatten())
            {
                let out = (found.map().plane.point(q, *z) - face.point).dot(face.normal);
                reach = [reach[0].min(out), reach[1].max(out)];
            }
        }
        // All of it is used, too.
        assert!(
            reach[0] >= -1.0 - 1e-6 && reach[1] <= 3.0 + 1e-6,
            "{reach:?}"
        );
        assert!(reach[1] - reach[0] > 3.9, "{energy:?}: {reach:?}");
    }
}

#[test]
fn moving_everything_along_the_view_changes_nothing() {
    let by = 137.31 * from();
    let still = far_view(FAR_MM);
    let mut shifted = far_view(FAR_MM);
    shifted.eye += by;
    shifted.look_at += by;
    shifted.models[0].mesh = moved(&still.models[0].mesh, by);
    let support = plate();
    let mut other = support.clone();
    other.mesh = moved(&support.mesh, by);
    let SupportKind::Body { face, outline, .. } = &mut other.kind else {
        panic!("a plate is a body")
    };
    face.as_mut().expect("a face").point += by;
    outline.iter_mut().for_each(|p| *p += by.truncate());
    for energy in [NORMAL, CURVATURE] {
        let here = solved(&still, std::slice::from_ref(&support), energy);
        let there = solved(&shifted, std::slice::from_ref(&other), energy);
        let (worst, count) = apart(&heights(&here, MIDDLE), &heights(&there, MIDDLE + by));
        assert!(count > 250, "{count}");
        // Rounding of 3e-11 mm in what is solved, a millionth of a layer in the solution.
        assert!(worst < 2e-4, "{energy:?}: {worst}");
    }
    // Only the models, before the plate or behind: what counts is the shape.
    let mut nearer = still.clone();
    nearer.models[0].mesh = moved(&still.models[0].mesh, by);
    let here = solved(&still, std::slice::from_ref(&support), NORMAL);
    let there = solved(&nearer, std::slice::from_ref(&support), NORMAL);
    let (worst, count) = apart(&heights(&here, MIDDLE), &heights(&there, MIDDLE));
    assert!(count > 250, "{count}");
    // Rays converge by 137 / 300,000: 5 micrometres at the ball's rim.
    assert!(worst < 0.02, "{worst}");
}

#[test]
fn ten_times_nearer_or_farther_is_the_same() {
    let supports = [plate()];
    for (energy, nearer, farther) in [(NORMAL, 0.05, 0.01), (CURVATURE, 0.05, 0.01)] {
        let [near, here, far] = [0.1, 1.0, 10.0].map(|times| {
            let found = solved(&far_view(times * FAR_MM), &supports, energy);
            heights(&found, MIDDLE)
        });
        let ((near, count), (far, _)) = (apart(&near, &here), apart(&far, &here));
        assert!(count > 250, "{count}");
        println!("{energy:?}: {near} {far}");
        assert!(near < nearer && far < farther, "{energy:?}: {near}, {far}");
    }
}

#[test]
fn where_there_is_room_the_relief_is_the_model() {
    let mut support = plate();
    support.layer = support.layer.map(|l| l.resized(40.0, 40.0, 0.0));
    // The body must hold what is carved into it.
    support.mesh = deep_block();
    for energy in [NORMAL, CURVATURE] {
        let found = solved(&far_view(FAR_MM), std::slice::from_ref(&support), energy);
        let bounded = heights(&found, MIDDLE);
        let scale = found.depths.mu[0];
        let place = |v: VertexId| {
            let ray = found.target().mesh.vertices[v] - found.map().plane.eye;
            found.depths.s[v] / scale * ray
        };
        let whole = |f: &&[VertexId; 3]| f.iter().all(|v| !bounded[*v].is_nan());
        let (mut worst, mut count) = (0.0f64, 0);
        for face in found.target().mesh.faces.iter().filter(whole) {
            let [a, b, c] = face.map(place);
            let model = face.map(|v| found.target().mesh.vertices[v]);
            let wanted = (model[1] - model[0]).cross(model[2] - model[0]);
            worst = worst.max((b - a).cross(c - a).angle_between(wanted).to_degrees());
            count += 1;
        }
        println!("{energy:?}: {worst} degrees over {count} faces");
        assert!(
            count > 300 && worst < 0.05,
            "{energy:?}: {worst} degrees, {count} faces"
        );
        assert_eq!(found.groups().groups.len(), 1);
    }
}

/// A block of 100 mm with its face where the plate's is.
fn deep_block() -> TriMesh {
    boxes(&[(DVec3::new(-50.0, -4.0, -50.0), DVec3::new(50.0, 96.0, 90.0))])
}

/// A cube in two blocks, 16 mm one behind the other, seen by parallel rays.
fn blocks(more: &str) -> Scene {
    let text = format!(
        "(models: [(name: \"cube\", file: \"cube.obj\", place: Fit(height: 20, spin: 30, at: (0, 0, 15)))],\n\
         views: [(name: \"front\", from: (0, -2, 0.2), models: [\"cube\"])],\n\
         pillars: [(shape: Rectangle(width: 24, depth: 12), height: 60, places: At([(-12, -8), (12, 8)]))],\n\
         output: (picture_size: 64, surface: true, camouflage: false, lights: false){more})"
    );
    let cube = boxes(&[(DVec3::ZERO, DVec3::splat(10.0))]);
    let read = |_: &str| -> Result<Vec<u8>, Diagnostic> { Ok(obj(&cube)) };
    let done = scene::resolve(&text, &read).unwrap_or_else(|problems| panic!("{problems:?}"));
    assert!(done.warnings.is_empty(), "{:?}", done.warnings);
    done.value
}

fn built(scene: &Scene) -> Build {
    compile::build(scene, &|_, _| {}, &|| false).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn bytes<'a>(build: &'a Build, path: &str) -> &'a [u8] {
    let file = build.files.iter().find(|f| f.path == path);
    &file.unwrap_or_else(|| panic!("no {path}")).bytes
}

fn report(build: &Build) -> serde_json::Value {
    serde_json::from_slice(bytes(build, "report.json")).expect("JSON")
}

#[test]
fn a_direction_makes_a_far_eye_whose_models_face_it() {
    let scene = blocks("");
    let view = &scene.views[0];
    assert!(view.orthographic);
    let towards = DVec3::new(0.0, -2.0, 0.2).normalize();
    assert!(view.from().distance(towards) < 1e-12);
    assert!((view.eye.distance(view.look_at) - FAR_MM).abs() < 1e-6);
    // Turned by 30 degrees from facing the eye squarely, as the scene says.
    let cube = &view.models[0].mesh;
    let turns = FaceId::all(cube.faces.len()).map(|f| cube.normal(f));
    let level = turns.filter(|n| n.z.abs() < 0.5);
    let nearest = level.map(|n| n.angle_between(DVec3::NEG_Y).to_degrees());
    assert!((nearest.fold(f64::INFINITY, f64::min) - 30.0).abs() < 1e-9);
}

#[test]
fn a_build_from_infinity_keeps_its_promises_and_says_what_it_is() {
    let build = built(&blocks(""));
    assert!(build.failures.is_empty(), "{:?}", build.failures);
    let report = report(&build);
    let view = &report["views"][0];
    assert_eq!(view["orthographic"], true);
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    assert!((number(&view["from"][1]) + 1.0 / 1.01f64.sqrt()).abs() < 1e-12);
    let certificate = &view["certificate"];
    assert!(number(&certificate["coverage"]) > 1.0 - 1e-9);
    assert_eq!(number(&certificate["clamp_mm"]), 0.0);
    // What one sees sideways: the blocks' layers are 16 mm apart, 7 mm thick. Unseen until 2 arc-minutes, as from 300 mm.
    let side = number(&certificate["eye_tolerance_mm"]["side"]);
    let until = |step: f64| UNSEEN_RAD * READING_MM * READING_MM / step;
    assert!((until(23.5)..until(8.5)).contains(&side), "{side}");
    let turn = number(&certificate["eye_tolerance_deg"]["side"]);
    assert!((turn - (side / READING_MM).atan().to_degrees()).abs() < 1e-9);
    assert!(certificate["eye_tolerance_mm"]["fore"].is_null());
    let cuts = certificate["worst_cuts"].as_array().expect("cuts");
    for cut in cuts.iter().filter(|c| c["movement"] == "side") {
        let [predicted, measured] =
            ["predicted_arcmin", "measured_arcmin"].map(|k| number(&cut["gap"][k]));
        let wanted = number(&cut["angle_arcmin"]);
        // The worse end of the side decides, and this is its middle.
        assert!((0.7..1.01).contains(&(predicted / wanted)), "{predicted}");
        // The farther relief goes on behind the nearer block by 0.04 mm: half an arc-minute from 300 mm.
        assert!(
            (predicted - 0.7..predicted + 0.2).contains(&measured),
            "{measured}"
        );
    }
    // The cut lies in the middle of the image, where any eye sees the same of it.
    let from = &certificate["one_picture_from_mm"];
    assert!(from.is_null() || number(from) < READING_MM, "{from}");
    let page = std::str::from_utf8(bytes(&build, "report.html")).expect("UTF-8");
    assert!(page.contains("by parallel rays from the direction"));
    let plan = std::str::from_utf8(bytes(&build, "plan.svg")).expect("UTF-8");
    assert!(
        !plan.contains("300.00 m"),
        "no distance of an eye at infinity"
    );
    let surface = String::from_utf8_lossy(bytes(&build, "surface-front.obj")).into_owned();
    assert!(surface.contains("stands for one at infinity"));
}

#[test]
fn pillars_may_serve_an_eye_at_infinity_and_one_in_its_place() {
    let model = |y: f64| ball(DVec3::new(0.0, y, 20.0), 8.0, 16);
    let supports = [-14.0, 14.0].map(|y| pillar(DVec2::new(0.0, y), 10.0, 48, Datum::Plane));
    let behind = View {
        eye: DVec3::new(0.0, 14.0 + FAR_MM, 20.0),
        orthographic: true,
        ..view("behind", DVec3::Y, model(14.0), ORANGE)
    };
    let before = view(
        "before",
        DVec3::new(0.0, -200.0, 20.0),
        model(-14.0),
        ORANGE,
    );
    for view in [&behind, &before] {
        let found = solved(view, &supports, NORMAL);
        assert_eq!(found.groups().groups.len(), 1, "{}", view.name);
        let violation = bound_violation_mm(&found.sight, &found.relief);
        assert!(violation <= 1e-6, "{violation}");
    }
}

#[test]
fn the_bundled_scene_builds() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("scenes/paper/orthographic.ron")).expect("text");
    let read =
        |file: &str| Ok(std::fs::read(root.join("scenes/models").join(file)).expect("a model"));
    let mut scene = scene::resolve(&text, &read).expect("a scene").value;
    (scene.output.camouflage, scene.output.lights) = (false, false);
    let build = built(&scene);
    assert!(build.failures.is_empty(), "{:?}", build.failures);
    assert!(build.warnings.is_empty(), "{:?}", build.warnings);
    let report = report(&build);
    let mean = &report["views"][0]["normal_error_deg"]["mean"];
    assert!(mean.as_f64().expect("a number") < 16.0, "{mean}");
}
