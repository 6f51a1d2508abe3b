//! Reliefs that are no height fields: closed meshes deformed as a whole.

use super::shapes::{ball, obj};
use glam::DVec3;
use pillarforest::compile::{Build, build, check};
use pillarforest::diag::Diagnostic;
use pillarforest::index::VertexId;
use pillarforest::intake::{load_model, load_original};
use pillarforest::mesh::{Original, Solid, TriMesh, self_intersections};
use pillarforest::scene;
use serde_json::Value;

const EYE: DVec3 = DVec3::new(0.0, -300.0, 30.0);
/// Plate: its face, thickness and the room before it.
const FACE_Y: f64 = 12.0;
const THICK: f64 = 6.0;
const FRONT: f64 = 4.0;

/// A ball of 15 mm, and before part of it one of 7 mm: four sheets on a ray. Both are one file, and nothing of the small ball's back or
/// of what it hides is seen.
fn model() -> TriMesh {
    let mut mesh = ball(DVec3::new(0.0, 0.0, 15.0), 15.0, 12);
    mesh.append(&ball(DVec3::new(9.0, -25.0, 20.0), 7.0, 8));
    mesh
}

/// For a fine nozzle: where outlines lie on the plate, the small ball has a rim of 0.18 mm.
fn text(relief: &str, energy: &str, regions: &str) -> String {
    format!(
        "(models: [(name: \"balls\", file: \"balls.obj\", place: Matrix([(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 10), (0, 0, 0, 1)]), regions: [{regions}])],\n\
         views: [(name: \"front\", eye: (0, -300, 30), models: [\"balls\"])],\n\
         supports: [Plate(width: 60, height: 60, thickness: {THICK}, at: (0, {FACE_Y}, 0), depth: (front: {FRONT}))],\n\
         relief: {relief}, energy: {energy}, printer: (nozzle: 0.1),\n\
         output: (surface: true, plan: false, forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    )
}

fn build_of(mesh: &TriMesh, text: &str) -> Build {
    let read = |_: &str| Ok::<_, Diagnostic>(obj(mesh));
    let scene = scene::resolve(text, &read).unwrap_or_else(|p| panic!("{p:?}\n{text}"));
    build(&scene.value, &|_, _| {}, &|| false).unwrap_or_else(|p| panic!("{p:?}\n{text}"))
}

fn bytes<'a>(build: &'a Build, path: &str) -> &'a [u8] {
    let file = build.files.iter().find(|f| f.path == path);
    &file.unwrap_or_else(|| panic!("no {path}")).bytes
}

fn report(build: &Build) -> Value {
    serde_json::from_slice(bytes(build, "report.json")).expect("JSON")
}

fn certificate(build: &Build) -> Value {
    report(build)["views"][0]["certificate"].clone()
}

fn surface(build: &Build) -> Original {
    let path = "surface-front.ply";
    load_original(path, bytes(build, path), false)
        .expect("a mesh")
        .value
        .original
}

/// The front ball's vertices stand after those of the one behind.
fn of_front_ball(mesh: &TriMesh) -> std::ops::Range<usize> {
    ball(DVec3::ZERO, 15.0, 12).vertices.len()..mesh.vertices.len()
}

#[test]
fn whole_meshes_stay_closed_in_order_and_within_bounds() {
    let mesh = model();
    for (relief, energy) in [
        ("Whole(bounded: Seen)", "Curvature()"),
        ("Whole(bounded: Seen)", "Normal()"),
        ("Whole(bounded: Outline)", "Normal()"),
    ] {
        let build = build_of(&mesh, &text(relief, energy, ""));
        assert!(build.failures.is_empty(), "{relief}: {:?}", build.failures);
        let found = certificate(&build);
        assert_eq!(found["order_inversions"], 0, "{relief} {energy}");
        assert_eq!(found["crossings"]["self_intersections"], 0);
        assert!(found["bound_violation_mm"].as_f64().expect("a number") <= 1e-6);
        let moved = surface(&build).mesh;
        assert_eq!(moved.faces, mesh.faces, "{relief} {energy}");
        assert!(self_intersections(&moved, 10).is_empty());
        Solid::new(moved.clone()).unwrap_or_else(|d| panic!("{relief} {energy}: {d:?}"));
        let (lo, hi) = moved.bounds().expect("vertices");
        assert!(hi.y <= FACE_Y + THICK - 0.9, "{relief} {energy}: {hi}");
        let seen = relief.contains("Seen");
        assert!(
            !seen || lo.y >= FACE_Y - FRONT - 1e-5,
            "{relief} {energy}: {lo}"
        );
        for (v, old) in moved.vertices.iter().zip(&mesh.vertices) {
            let ray = (*old + 10.0 * DVec3::Z - EYE).normalize();
            assert!(
                (*v - EYE).normalize().distance(ray) < 1e-6,
                "{v} left its ray"
            );
        }
        let forest = load_model("forest.stl", bytes(&build, "forest.stl"), false);
        let forest = Solid::new(forest.expect("a file").value).expect("a solid");
        assert_eq!(forest.parts(), 1);
        let plate = 60.0 * 60.0 * THICK;
        assert!(
            forest.volume_mm3() > plate + 300.0,
            "{}",
            forest.volume_mm3()
        );
    }
}

#[test]
fn without_ordering_sheets_cross_and_are_counted() {
    let mesh = model();
    for (relief, energy) in [
        ("Whole()", "Curvature(ordering: false)"),
        ("Whole()", "Normal(ordering: false)"),
    ] {
        let build = build_of(&mesh, &text(relief, energy, ""));
        let found = certificate(&build);
        let moved = surface(&build).mesh;
        let pairs = self_intersections(&moved, 1_000_000).len();
        assert!(pairs > 20, "{relief} {energy}: {pairs}");
        assert_eq!(found["crossings"]["self_intersections"], pairs);
        assert_eq!(found["crossings"]["in_model"], 0);
        assert!(found["order_inversions"].as_u64().expect("a count") > 20);
        let forest = load_model("forest.stl", bytes(&build, "forest.stl"), false);
        assert_eq!(
            Solid::new(forest.expect("a file").value)
                .expect("sound all the same")
                .parts(),
            1
        );
    }
}

#[test]
fn height_fields_tell_what_crosses_in_their_whole_surface() {
    let build = build_of(
        &model(),
        &text("HeightField", "Curvature(ordering: false)", ""),
    );
    let crossings = &certificate(&build)["crossings"];
    assert!(crossings["self_intersections"].as_u64().expect("a count") > 0);
    let build = build_of(&model(), &text("HeightField", "Normal(steps: Never)", ""));
    assert_eq!(
        certificate(&build)["crossings"],
        Value::Null,
        "no whole surface"
    );
}

#[test]
fn free_parts_leave_the_layer() {
    let mesh = model();
    let free = "(shape: Ball(centre: (9, -25, 20), radius: 7.1), free: true)";
    for energy in ["Curvature()", "Normal()"] {
        let build = build_of(&mesh, &text("Whole()", energy, free));
        let moved = surface(&build).mesh;
        let stands_off = |v: &DVec3| FACE_Y - v.y;
        let of_ball = moved.vertices[of_front_ball(&mesh)].iter().map(stands_off);
        let most = of_ball.fold(0.0, f64::max);
        // 14 mm thick, a little smaller on its way to the plate.
        assert!(most > FRONT + 7.0, "{energy}: {most}");
        let rest = moved.vertices[..of_front_ball(&mesh).start].iter();
        assert!(rest.map(stands_off).fold(0.0, f64::max) <= FRONT + 1e-5);
        assert_eq!(certificate(&build)["crossings"]["self_intersections"], 0);
    }
}

#[test]
fn the_order_of_vertices_in_the_file_does_not_matter() {
    let mesh = model();
    let n = mesh.vertices.len();
    // 7 has no factor in common with the number of vertices.
    assert_ne!(n % 7, 0);
    let place = |v: VertexId| VertexId::new((7 * v.at() + 3) % n);
    let mut shuffled = mesh.clone();
    for v in VertexId::all(n) {
        shuffled.vertices[place(v)] = mesh.vertices[v];
    }
    shuffled
        .faces
        .iter_mut()
        .flatten()
        .for_each(|v| *v = place(*v));
    shuffled.faces.reverse();
    let scene = text("Whole()", "Normal()", "");
    let [a, b] = [&mesh, &shuffled].map(|m| build_of(m, &scene));
    assert!(bytes(&a, "forest.stl") == bytes(&b, "forest.stl"));
}

#[test]
fn what_cannot_stay_whole_is_refused() {
    let mut open = model();
    open.faces.pop();
    let read = |mesh: &TriMesh| {
        let bytes = obj(mesh);
        move |_: &str| Ok::<_, Diagnostic>(bytes.clone())
    };
    let problems =
        scene::resolve(&text("Whole()", "Normal()", ""), &read(&open)).expect_err("open");
    assert!(
        problems
            .iter()
            .any(|p| p.is_error() && p.message.contains("is not closed: 3 of its edges")),
        "{problems:?}"
    );
    for (supports, wanted) in [
        (
            "Strips(count: 3, width: 15, height: 60, at: (0, 12, 0))",
            "one support",
        ),
        ("Stairs(steps: 4, width: 60)", "several parts"),
    ] {
        let scene = text("Whole()", "Normal()", "");
        let start = scene.find("Plate(").expect("a plate");
        let end = scene[start..].find("))]").expect("its end") + start + 2;
        let scene = format!("{}{supports}{}", &scene[..start], &scene[end..]);
        let scene = scene::resolve(&scene, &read(&model())).unwrap_or_else(|p| panic!("{p:?}"));
        let problems = check(&scene.value, &|_, _| {}, &|| false).expect_err(supports);
        assert!(
            problems.iter().any(|p| p.message.contains(wanted)),
            "{problems:?}"
        );
    }
}
