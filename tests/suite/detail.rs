//! Smaller forms of models: what simplifying keeps, and what scenes make of it.

use super::meshes::cuboid;
use super::shapes::{CUBE_FACES, ball};
use glam::DVec3;
use pillarforest::bvh::Bvh;
use pillarforest::diag::Diagnostic;
use pillarforest::index::{FaceId, VertexId};
use pillarforest::intake::load_model;
use pillarforest::mesh::{Edges, Simplified, Solid, TriMesh, simplified};
use pillarforest::scene::{self, Quality, Scene, at_quality};

fn small(mesh: &TriMesh, most: usize) -> Simplified {
    let small = simplified(mesh, most).expect("surfaces");
    assert_eq!(
        simplified(mesh, most).as_ref(),
        Some(&small),
        "the same twice"
    );
    assert!(small.vertices.is_sorted_by(|a, b| a < b));
    for (own, from) in small.mesh.vertices.iter().zip(&small.vertices) {
        assert_eq!(*own, mesh.vertices[*from], "where it was");
    }
    small
}

/// Mean angle between the normals of a mesh and those of its smaller form where rays along them meet it, degrees.
fn mean_error(mesh: &TriMesh, small: &TriMesh) -> f64 {
    let bvh = Bvh::new(small);
    let (mut sum, mut count) = (0.0, 0.0);
    for face in FaceId::all(mesh.faces.len()).step_by(17) {
        let [a, b, c] = mesh.corners(face);
        let (at, normal) = ((a + b + c) / 3.0, mesh.normal(face));
        let hits = [1.0, -1.0].map(|way| bvh.first_hit(at + 2.0 * way * normal, -way * normal));
        let near = hits.into_iter().flatten();
        if let Some(hit) = near.min_by(|a, b| (a.t - 2.0).abs().total_cmp(&(b.t - 2.0).abs())) {
            sum += small.normal(hit.face).angle_between(normal).to_degrees();
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn closed_meshes_stay_closed_at_the_wanted_number() {
    let ball = ball(DVec3::new(500.0, 0.0, -300.0), 20.0, 60);
    for most in [1000, 300, 40] {
        let small = small(&ball, most).mesh;
        assert_eq!(small.vertices.len(), most);
        let solid = Solid::new(small).unwrap_or_else(|defects| panic!("{most}: {defects:?}"));
        assert_eq!((solid.parts(), solid.mesh().faces.len()), (1, 2 * most - 4));
        let lost = 1.0 - solid.mesh().volume() / ball.volume();
        assert!((0.0..25.0 / most as f64).contains(&lost), "{most}: {lost}");
    }
    assert_eq!(small(&ball, ball.vertices.len()).mesh, ball);
    // No closed part becomes flat.
    assert!(small(&ball, 1).mesh.vertices.len() >= 4);
}

#[test]
fn bundled_models_keep_their_normals() {
    for (name, most, error) in [("hare", 10_000, 8.0), ("cow", 6_000, 5.0)] {
        let path = format!("{}/scenes/models/{name}.ply", env!("CARGO_MANIFEST_DIR"));
        let bytes = std::fs::read(path).expect("a bundled model");
        let mesh = load_model("model.ply", &bytes, false).expect("sound").value;
        let small = small(&mesh, most).mesh;
        assert_eq!(small.vertices.len(), most, "{name}");
        let found = mean_error(&mesh, &small);
        assert!(found < error, "{name}: {found} degrees");
        Solid::new(small).unwrap_or_else(|defects| panic!("{name}: {defects:?}"));
    }
}

/// A sheet of 20 x 20 squares of 1 mm, bent along y.
fn sheet() -> TriMesh {
    let mut mesh = TriMesh::default();
    for j in 0..=20 {
        for i in 0..=20 {
            let (x, y) = (f64::from(i), f64::from(j));
            mesh.vertices.push(DVec3::new(x, y, 0.02 * y * y));
        }
    }
    for j in 0..20 {
        for i in 0..20 {
            let a = 21 * j + i;
            mesh.faces
                .extend([[a, a + 1, a + 22], [a, a + 22, a + 21]].map(|f| f.map(VertexId)));
        }
    }
    mesh
}

#[test]
fn borders_stay_where_they_are() {
    let sheet = sheet();
    let small = small(&sheet, 60).mesh;
    assert_eq!(small.vertices.len(), 60);
    let on_border = |p: DVec3| [p.x, p.y].iter().any(|c| *c == 0.0 || *c == 20.0);
    let edges = Edges::new(&small);
    let mut length = 0.0;
    for sides in edges.iter().filter(|sides| sides.len() == 1) {
        let [a, b] = [sides[0].low, sides[0].high].map(|v| small.vertices[v]);
        assert!(on_border(a) && on_border(b), "{a} {b}");
        length += a.truncate().distance(b.truncate());
    }
    assert!(
        (length - 80.0).abs() < 1e-9,
        "round the square once: {length}"
    );
    let (lo, hi) = small.bounds().expect("vertices");
    assert_eq!((lo, hi), sheet.bounds().expect("vertices"));
}

#[test]
fn surfaces_that_touch_go_on_touching() {
    // Two cubes with an edge in common, all sides cut into 32 faces: four faces meet at each of four edges.
    let mut mesh = TriMesh::default();
    for shift in [DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)] {
        let corner =
            |k: u32| shift + DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        let cube = TriMesh::new((0..8).map(corner).collect(), CUBE_FACES);
        mesh.append(&quartered(&quartered(&cube)));
    }
    let mesh = load_model("cubes.obj", &obj(&mesh), false)
        .expect("a model")
        .value;
    assert_eq!(mesh.vertices.len(), 2 * 98 - 5);
    let shared = |mesh: &TriMesh| {
        Edges::new(mesh)
            .iter()
            .filter(|sides| sides.len() == 4)
            .count()
    };
    assert_eq!(shared(&mesh), 4);
    let small = small(&mesh, 8).mesh;
    assert_eq!(shared(&small), 4);
    assert!(small.vertices.len() < 40, "{}", small.vertices.len());
}

/// Every face cut into four at the middles of its sides.
fn quartered(mesh: &TriMesh) -> TriMesh {
    let mut cut = TriMesh::default();
    for face in FaceId::all(mesh.faces.len()) {
        let [a, b, c] = mesh.corners(face);
        let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
        for triangle in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            cut.append(&TriMesh::new(triangle.to_vec(), [[0, 1, 2]]));
        }
    }
    cut
}

/// A ball by longitude and latitude with bumps, all of needles.
fn needles(meridians: u32, parallels: u32) -> TriMesh {
    let point = |i: u32, j: u32| {
        let t = std::f64::consts::PI * f64::from(i) / f64::from(parallels);
        let u = std::f64::consts::TAU * f64::from(j % meridians) / f64::from(meridians);
        let radius = 20.0 * (1.0 + 0.05 * (9.0 * t).sin() * (7.0 * u).cos());
        radius * DVec3::new(t.sin() * u.cos(), t.sin() * u.sin(), t.cos())
    };
    let mut mesh = TriMesh::default();
    mesh.vertices.push(point(0, 0));
    for i in 1..parallels {
        mesh.vertices.extend((0..meridians).map(|j| point(i, j)));
    }
    mesh.vertices.push(point(parallels, 0));
    let last = mesh.vertices.len() as u32 - 1;
    let at = |i: u32, j: u32| 1 + (i - 1) * meridians + j % meridians;
    let mut faces = Vec::new();
    for j in 0..meridians {
        faces.push([0, at(1, j), at(1, j + 1)]);
        faces.push([last, at(parallels - 1, j + 1), at(parallels - 1, j)]);
        for i in 1..parallels - 1 {
            faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    TriMesh::new(mesh.vertices, faces)
}

/// The largest distance of a vertex of the mesh from its smaller form along the ray from the middle of both, millimetres.
fn farthest(mesh: &TriMesh, small: &TriMesh) -> f64 {
    let bvh = Bvh::new(small);
    let off = |v: &DVec3| {
        let hit = bvh
            .first_hit(DVec3::ZERO, *v)
            .expect("it goes around its middle");
        (hit.t - 1.0).abs() * v.length()
    };
    mesh.vertices.iter().step_by(7).map(off).fold(0.0, f64::max)
}

#[test]
fn needles_go_before_the_form_does() {
    let full = needles(2000, 20);
    let small = simplified(&full, 3000).expect("surfaces").mesh;
    assert_eq!(small.vertices.len(), 3000);
    // A chord over a bump between two of its meridians is about as far off.
    let off = farthest(&full, &small);
    assert!(off < 0.15, "{off} mm of 40");
}

#[test]
fn no_form_is_given_up_for_a_number() {
    let full = needles(200, 60);
    let small = small(&full, 10).mesh;
    assert!(small.vertices.len() > 10);
    let off = farthest(&full, &small);
    println!("{} vertices, {off} mm off", small.vertices.len());
    assert!(
        off < 0.15 * 40.0,
        "{off} mm with {} vertices",
        small.vertices.len()
    );
}

#[test]
fn models_that_cannot_be_smaller_say_how_many_vertices_they_keep() {
    let mut rows = TriMesh::default();
    for k in 0..30 {
        let x = f64::from(k % 6) * 6.0;
        rows.append(&cuboid([x, 0.0, f64::from(k / 6) * 7.0], [4.0; 3]));
    }
    let read = |_: &str| Ok::<_, Diagnostic>(obj(&rows));
    let done = scene::resolve(&text("detail: 100, ", ""), &read).expect("a scene");
    let kept = done.value.views[0].models[0].mesh.vertices.len();
    let words = format!("keeps {kept} vertices, more than `detail: 100`");
    let told = |d: &Diagnostic| {
        d.message.contains(&words)
            && d.place.is_some()
            && d.help.iter().any(|h| h.contains("a larger `detail`"))
    };
    assert!(
        kept > 100 && done.warnings.iter().any(told),
        "{words}: {:?}",
        done.warnings
    );
}

fn obj(mesh: &TriMesh) -> Vec<u8> {
    let vertices = mesh.vertices.iter().map(|v| {
        let red = if v.z > 0.0 { 1 } else { 0 };
        format!("v {} {} {} {red} 0 1\n", v.x, v.y, v.z)
    });
    let face = |f: &[VertexId; 3]| format!("f {} {} {}\n", f[0].0 + 1, f[1].0 + 1, f[2].0 + 1);
    vertices
        .chain(mesh.faces.iter().map(face))
        .collect::<String>()
        .into_bytes()
}

fn text(scene: &str, model: &str) -> String {
    format!(
        "({scene}models: [(name: \"ball\", file: \"ball.obj\", {model}place: Fit(height: 40), regions: [(shape: Ball(centre: (0, 0, 20), radius: 9), weight: 3)])],\n\
         views: [(name: \"front\", eye: (0, -300, 20), models: [\"ball\"])],\n\
         supports: [Plate(width: 80, height: 70, at: (0, 20, 0))],\n\
         output: (surface: true))"
    )
}

fn good(scene: &str, model: &str) -> Scene {
    let read = |_: &str| Ok::<_, Diagnostic>(obj(&ball(DVec3::ZERO, 20.0, 40)));
    let done = scene::resolve(&text(scene, model), &read);
    let done = done.unwrap_or_else(|problems| panic!("{problems:?}"));
    assert!(done.warnings.is_empty(), "{:?}", done.warnings);
    done.value
}

#[test]
fn scenes_say_how_many_vertices_models_may_have() {
    let whole = &good("", "").views[0].models[0];
    let full = whole.mesh.vertices.len();
    for (scene, model, count) in [
        ("detail: 300, ", "", 300),
        ("", "detail: 200, ", 200),
        ("detail: 300, ", "detail: 200, ", 200),
        ("detail: 150, ", "detail: 200, ", 150),
        ("detail: 100000, ", "", full),
    ] {
        let scene = good(scene, model);
        let model = &scene.views[0].models[0];
        assert_eq!(model.mesh.vertices.len(), count);
        assert_eq!(model.matrix, whole.matrix, "placed by the whole model");
        // A closed surface has two faces for every vertex, less four.
        let of_all = format!(
            "ball.obj; made from {} of its {} faces",
            2 * count - 4,
            2 * full - 4
        );
        let source = if count < full { &of_all } else { "ball.obj" };
        assert_eq!(model.source(), source);
        let original = model.original.as_ref().expect("from a file");
        assert_eq!(original.mesh.vertices.len(), count);
        let lowered = original.lowered_from.as_ref().map(|from| from.vertices);
        assert_eq!(lowered, (count < full).then_some(full));
        // Regions and colours follow.
        for (v, point) in original.mesh.vertices.iter().enumerate() {
            let at = original.vertex_of[v].expect("used");
            let inside = point.distance(DVec3::new(0.0, 0.0, 20.0)) <= 9.0;
            assert_eq!(model.marks.weights[at], if inside { 3.0 } else { 1.0 });
            let red = f64::from(u8::from(point.z > 0.0));
            assert_eq!(original.attributes.colours[v], [red, 0.0, 1.0, 1.0]);
        }
        // What is drawn and measured against is the model as its file has it.
        assert_eq!(scene.views[0].whole_target(), whole.mesh);
    }
}

#[test]
fn qualities_change_a_few_fields_and_nothing_finer() {
    let scene = "(title: \"t\")";
    assert_eq!(at_quality(scene, Quality::Normal), scene);
    let draft = at_quality(scene, Quality::Draft);
    assert!(draft.contains("detail: 10000"), "{draft}");
    for part in ["picture_size: 320", "lights: false", "camouflage: false"] {
        assert!(draft.contains(part), "{draft}");
    }
    let coarse = "(detail: 500, output: (picture_size: 64, lights: true))";
    let draft = at_quality(coarse, Quality::Draft);
    assert_eq!(
        draft,
        "(detail: 500, output: (picture_size: 64, lights: false, camouflage: false))"
    );
    let last = at_quality("(output: (picture_size: 64))", Quality::Final);
    assert_eq!(last, "(output: (picture_size: 1024))");
    let large = "(output: (picture_size: 2000))";
    assert_eq!(at_quality(large, Quality::Final), large);
    assert_eq!(at_quality("no scene", Quality::Draft), "no scene");
}
