//! The optimised surface as a file for other programs, and what regions of a model do to it.

use crate::shapes::{self, Outcome, Setting, ball, field, sighted};
use glam::{DVec2, DVec3};
use pillarforest::compile::build;
use pillarforest::diag::Diagnostic;
use pillarforest::index::{FaceId, VertexId};
use pillarforest::intake::{Admitted, load_original};
use pillarforest::laplacian::FaceGeometry;
use pillarforest::mesh::{Original, TriMesh};
use pillarforest::mimic::{CurvatureOptions, Depths, Energy, FaceWeight, NormalOptions};
use pillarforest::scene;
use pillarforest::surface::UNBOUNDED;
use pillarforest::view::Marks;
use pillarforest::viewmap::{Image, Target};
use std::sync::Arc;

/// A ball in its file's own place and order: colours, a texture point of its own for every face corner, a stray vertex first,
/// and one vertex twice.
fn model() -> String {
    let mut mesh = ball(DVec3::new(4.0, -3.0, 1.0), 7.0, 8);
    mesh.vertices.insert(0, DVec3::splat(9.0));
    mesh.faces.iter_mut().flatten().for_each(|v| v.0 += 1);
    mesh.vertices.push(mesh.vertices[20]);
    let [twin, last] = [20, mesh.vertices.len() - 1].map(VertexId::new);
    let of_twin = mesh
        .faces
        .iter_mut()
        .find(|f| f.contains(&twin))
        .expect("a face");
    of_twin
        .iter_mut()
        .filter(|v| **v == twin)
        .for_each(|v| *v = last);
    let mut text = String::new();
    for (k, v) in mesh.vertices.iter().enumerate() {
        text += &format!("v {:?} {:?} {:?} {} 0 1\n", v.x, v.y, v.z, k as f64 / 255.0);
    }
    for (f, face) in mesh.faces.iter().enumerate() {
        text += "f";
        for (k, v) in face.iter().enumerate() {
            text += &format!(" {}/{}", v.0 + 1, 3 * f + k + 1);
        }
        text.push('\n');
    }
    for k in 0..3 * mesh.faces.len() {
        text += &format!("vt {} {}\n", (k % 64) as f64 / 64.0, (k / 64) as f64 / 64.0);
    }
    text
}

const SCENE: &str = r#"(
    models: [
        (name: "ball", file: "ball.obj", place: Fit(height: 30, at: (0, 0, 8))),
        (name: "moon", file: "moon.obj", place: Fit(height: 8, at: (9, 0, 38))),
    ],
    views: [(name: "front", eye: (0, -250, 30), models: ["moon", "ball"])],
    pillars: [(shape: Round(radius: 5), height: 50, places: At([(-9, 5), (0.5, -4), (10, 8)]))],
    energy: ENERGY,
    output: (surface: true, plan: false, views: false, lights: false, camouflage: false, report_html: false, picture_size: 64),
)"#;

const EYE: DVec3 = DVec3::new(0.0, -250.0, 30.0);

fn moon() -> String {
    let mut text = String::new();
    let ball = ball(DVec3::ZERO, 1.0, 6);
    ball.vertices
        .iter()
        .for_each(|v| text += &format!("v {:?} {:?} {:?}\n", v.x, v.y, v.z));
    ball.faces
        .iter()
        .for_each(|f| text += &format!("f {} {} {}\n", f[0].0 + 1, f[1].0 + 1, f[2].0 + 1));
    text
}

#[allow(clippy::unnecessary_wraps, reason = "as scenes are read")]
fn read(name: &str) -> Result<Vec<u8>, Diagnostic> {
    Ok(if name == "moon.obj" { moon() } else { model() }.into_bytes())
}

/// Surface files of the scene, as our own reader has them, PLY and OBJ.
struct Written {
    ply: Original,
    obj: Original,
    header: String,
}

impl Written {
    fn scalar(&self, name: &str) -> Vec<f64> {
        self.ply
            .attributes
            .values(name)
            .unwrap_or_else(|| panic!("no {name}"))
    }
}

fn written(energy: &str) -> Written {
    let scene = scene::resolve(&SCENE.replace("ENERGY", energy), &read)
        .expect("a scene")
        .value;
    let build = build(&scene, &|_, _| {}, &|| false).expect("a forest");
    let bytes = |path: &str| {
        let file = build.files.iter().find(|f| f.path == path);
        &file.unwrap_or_else(|| panic!("no {path}")).bytes
    };
    let loaded = |path: &str| {
        let read = load_original(path, bytes(path), false).expect("a mesh");
        let unused: Vec<_> = read
            .warnings
            .iter()
            .filter(|w| w.message.contains("not used"))
            .collect();
        assert!(unused.is_empty(), "{unused:?}");
        read.value.original
    };
    let header = String::from_utf8_lossy(bytes("surface-front.ply"));
    let end = header.find("end_header").expect("a header");
    Written {
        ply: loaded("surface-front.ply"),
        obj: loaded("surface-front.obj"),
        header: header[..end].to_owned(),
    }
}

/// The input: both files appended, vertices in place.
fn input() -> (TriMesh, Original) {
    let scene = scene::resolve(&SCENE.replace("ENERGY", "Normal()"), &read)
        .expect("a scene")
        .value;
    let mut whole = TriMesh::default();
    for (model, text) in scene.views[0].models.iter().zip([moon(), model()]) {
        let Admitted { original, .. } = load_original("m.obj", text.as_bytes(), false)
            .expect("a mesh")
            .value;
        whole.append(&original.mesh.transformed(model.matrix));
    }
    let ball = load_original("m.obj", model().as_bytes(), false)
        .expect("a mesh")
        .value;
    (whole, ball.original)
}

#[test]
fn a_surface_in_one_piece_is_the_input_moved_along_its_rays() {
    let (input, ball) = input();
    let moon_vertices = input.vertices.len() - ball.mesh.vertices.len();
    let moon_faces = input.faces.len() - ball.mesh.faces.len();
    for energy in ["Normal(steps: Never)", "Curvature()"] {
        let out = written(energy);
        assert_eq!(out.ply.mesh.faces, input.faces, "{energy}");
        assert_eq!(out.obj.mesh.faces, input.faces, "{energy}");
        assert_eq!(out.ply.mesh.vertices, out.obj.mesh.vertices);
        let number = |name: &str| out.scalar(name);
        let (lambda, lambda0) = (number("lambda"), number("lambda0"));
        let (least, most) = (number("lambda_min"), number("lambda_max"));
        let (mu, group) = (number("mu"), number("group"));
        let mut bounded = 0;
        for (i, v) in input.vertices.iter().enumerate() {
            assert!((lambda0[i] - v.distance(EYE)).abs() < 1e-9, "vertex {i}");
            let wanted = EYE + lambda[i] / lambda0[i] * (*v - EYE);
            assert!(
                out.ply.mesh.vertices[i].distance(wanted) < 1e-9,
                "vertex {i}"
            );
            let slack = 1e-6;
            assert!(
                least[i] - slack <= lambda[i] && lambda[i] <= most[i] + slack,
                "vertex {i}"
            );
            assert_eq!(
                group[i] < 0.0,
                most[i] == UNBOUNDED && least[i] == 0.0 && mu[i] == 1.0
            );
            bounded += usize::from(group[i] >= 0.0);
            if group[i] >= 0.0 {
                // Scaled back it stands in the layer of a pillar: 5 mm before to 2 mm behind the plane through its axis.
                let p = EYE + (out.ply.mesh.vertices[i] - EYE) / mu[i];
                let inside = |(x, y): (f64, f64)| {
                    let axis = DVec2::new(x, y);
                    let towards = (axis - EYE.truncate()).normalize();
                    let off = (p.truncate() - axis).dot(towards);
                    (-5.0 - 1e-6..=2.0 + 1e-6).contains(&off)
                };
                assert!(
                    [(-9.0, 5.0), (0.5, -4.0), (10.0, 8.0)]
                        .into_iter()
                        .any(inside),
                    "vertex {i} at {p}"
                );
            }
        }
        assert!(bounded > 60, "{bounded} vertices have bounds");
        // The stray vertex took no part.
        assert_eq!(
            (lambda[moon_vertices], group[moon_vertices]),
            (lambda0[moon_vertices], -1.0)
        );
        let indices: Vec<f64> = (0..input.vertices.len()).map(|i| i as f64).collect();
        assert_eq!(number("input_vertex"), indices);
        // The moon has neither colours nor texture points.
        assert_eq!(out.ply.attributes.colours[0], [1.0; 4]);
        assert_eq!(
            out.ply.attributes.colours[moon_vertices..],
            ball.attributes.colours
        );
        let [wanted, ply, obj] =
            [&ball, &out.ply, &out.obj].map(|o| o.attributes.uvs.as_ref().expect("texture points"));
        for (f, corners) in wanted.corners.iter().enumerate() {
            for (k, uv) in corners.iter().enumerate() {
                let point = wanted.points[*uv as usize];
                for found in [ply, obj] {
                    let uv = found.corners[moon_faces + f][k];
                    assert_eq!(found.points[uv as usize], point, "{energy} face {f}");
                }
            }
        }
        assert!(
            out.header
                .contains("comment model ball of file ball.obj: input vertices from 62"),
            "{}",
            out.header
        );
    }
}

#[test]
fn a_torn_surface_tells_where_its_vertices_come_from() {
    let (input, ball) = input();
    let moon_faces = input.faces.len() - ball.mesh.faces.len();
    let out = written("Normal(steps: Allowed())");
    assert!(out.header.contains("cut along tears"), "{}", out.header);
    let from: Vec<VertexId> = out
        .scalar("input_vertex")
        .iter()
        .map(|v| VertexId(*v as u32))
        .collect();
    for (p, i) in out.ply.mesh.vertices.iter().zip(&from) {
        let [ray, own] = [*p - EYE, input.vertices[*i] - EYE];
        assert!(ray.cross(own).length() < 1e-6 * ray.length() * own.length());
    }
    assert!(out.scalar("mu").iter().all(|mu| *mu == 1.0));
    let same_place =
        |v: VertexId, w: VertexId| input.vertices[v].distance(input.vertices[w]) < 1e-9;
    let wanted = ball.attributes.uvs.as_ref().expect("texture points");
    let found = out.ply.attributes.uvs.as_ref().expect("texture points");
    let mut on_ball = 0;
    for (f, face) in out.ply.mesh.faces.iter().enumerate() {
        let at = face.map(|v| from[v]);
        let is_it = |g: &[VertexId; 3]| at.iter().all(|v| g.iter().any(|w| same_place(*v, *w)));
        let g = input
            .faces
            .iter()
            .position(is_it)
            .unwrap_or_else(|| panic!("face {f} is none of the input"));
        if g < moon_faces {
            continue;
        }
        on_ball += 1;
        for (k, v) in at.iter().enumerate() {
            let own = input.faces[g]
                .iter()
                .position(|w| same_place(*v, *w))
                .expect("a corner");
            let uv = wanted.points[wanted.corners[g - moon_faces][own] as usize];
            assert_eq!(found.points[found.corners[f][k] as usize], uv, "face {f}");
        }
    }
    assert!(
        on_ball > 60 && out.ply.mesh.faces.len() > on_ball,
        "{on_ball} faces"
    );
}

const ENERGIES: [Energy; 2] = [
    Energy::Normal(NormalOptions {
        weight: FaceWeight::Area,
        ordering: false,
        reweight: 0,
    }),
    Energy::Curvature(CurvatureOptions {
        ordering: false,
        ..CurvatureOptions::PAPER
    }),
];

/// The tight setting solved with marks made from the vertices' places; its target and depths, and the mean angle by which
/// faces of the right half that the eye sees are turned.
fn solved(energy: Energy, marks: impl Fn(&TriMesh) -> Marks) -> (Target, Depths, f64) {
    let setting = Setting::tight();
    let mut view = setting.view();
    view.models[0].marks = Arc::new(marks(&setting.model));
    let sight = sighted(view, field(&setting.supports));
    let Outcome {
        sight,
        depths,
        relief,
    } = shapes::solved(sight, energy);
    let Image { target, map, .. } = sight.image;
    assert_eq!(
        relief.free.iter().flatten().any(|f| *f),
        target.free.contains(&true)
    );
    let moved = TriMesh {
        vertices: (0..depths.s.len())
            .map(|v| setting.eye + depths.s[v] * (target.mesh.vertices[v] - setting.eye))
            .collect(),
        faces: target.mesh.faces.clone(),
    };
    let mut seen = vec![false; target.mesh.faces.len()];
    for cell in &map.cells {
        if let Some(f) = cell.face {
            seen[f] = true;
        }
    }
    let (mut sum, mut area) = (0.0, 0.0);
    for f in FaceId::all(seen.len()).filter(|f| seen[*f]) {
        if target.mesh.corners(f).iter().all(|p| on_right(*p)) {
            let a = target.mesh.area_vector(f).length();
            sum += a * target.mesh.normal(f).angle_between(moved.normal(f));
            area += a;
        }
    }
    (target, depths, sum / area)
}

fn none(_: &TriMesh) -> Marks {
    Marks::default()
}

#[test]
fn weights_move_the_error_elsewhere_and_equal_ones_change_nothing() {
    for energy in ENERGIES {
        let (_, plain, error) = solved(energy, none);
        let equal = |mesh: &TriMesh| Marks {
            weights: vec![3.0; mesh.vertices.len()],
            free: Vec::new(),
        };
        let (_, same, _) = solved(energy, equal);
        let apart = plain.s.iter().zip(&same.s).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 1e-5, "{energy:?}: {apart}");
        let right = |mesh: &TriMesh| Marks {
            weights: mesh
                .vertices
                .iter()
                .map(|v| if on_right(*v) { 20.0 } else { 1.0 })
                .collect(),
            free: Vec::new(),
        };
        let (target, weighted, turned) = solved(energy, right);
        // What each energy keeps: directions of normals, or curvature.
        let [before, after] = match energy {
            Energy::Normal(_) => [error, turned],
            Energy::Curvature(_) => [&plain, &weighted].map(|d| bent(&target, &d.s)),
            Energy::Linear | Energy::Gradient(_) => panic!("no vertex weights in {energy:?}"),
        };
        assert!(
            after < 0.98 * before,
            "{energy:?}: {before} and weighted {after}"
        );
    }
}

/// The part of the tight setting's ball that is seen on the right.
fn on_right(v: DVec3) -> bool {
    v.x > 0.0 && v.y < -3.0
}

/// The paper's Eq 13 over the vertices on the right, written out.
fn bent(target: &Target, s: &[f64]) -> f64 {
    let mesh = &target.mesh;
    let eye = Setting::tight().eye;
    let mut sums = vec![DVec3::ZERO; s.len()];
    for face in &mesh.faces {
        for k in 0..3 {
            let [a, i, j] = [0, 1, 2].map(|n| face[(k + n) % 3]);
            let [p, q] = [i, j].map(|v| mesh.vertices[v] - mesh.vertices[a]);
            let half_cotangent = p.dot(q) / p.cross(q).length() / 2.0;
            sums[i] += half_cotangent * (s[j] - s[i]) * (mesh.vertices[j] - eye);
            sums[j] += half_cotangent * (s[i] - s[j]) * (mesh.vertices[i] - eye);
        }
    }
    let areas = FaceGeometry::new(mesh).vertex_areas(mesh);
    let right = (0..s.len()).filter(|v| on_right(mesh.vertices[*v]));
    right.map(|v| sums[v].length_squared() / areas[v]).sum()
}

#[test]
fn free_vertices_have_no_bounds_and_a_model_of_them_stays_as_it_is() {
    for energy in ENERGIES {
        let all = |mesh: &TriMesh| Marks {
            weights: Vec::new(),
            free: vec![true; mesh.vertices.len()],
        };
        let (_, depths, error) = solved(energy, all);
        assert!(error < 1e-6, "{energy:?}: {error} rad");
        assert!(
            depths.s.iter().all(|s| (s - 1.0).abs() < 1e-6),
            "{energy:?}"
        );
        assert!(
            depths.mu.iter().all(|mu| *mu == 1.0),
            "{energy:?}: {:?}",
            depths.mu
        );
        let upper = |mesh: &TriMesh| Marks {
            weights: Vec::new(),
            free: mesh.vertices.iter().map(|v| v.x > 0.0).collect(),
        };
        let (_, bounded, pressed) = solved(energy, none);
        let (target, depths, free) = solved(energy, upper);
        assert!(free < 0.7 * pressed, "{energy:?}: {free} of {pressed} rad");
        assert!(target.is_free(VertexId(0)) || target.free.contains(&true));
        assert_ne!(depths.s, bounded.s);
    }
}

#[test]
fn surfaces_are_written_only_if_wanted() {
    let text = SCENE
        .replace("ENERGY", "Normal()")
        .replace("surface: true, ", "");
    let scene = scene::resolve(&text, &read).expect("a scene").value;
    let build = build(&scene, &|_, _| {}, &|| false).expect("a forest");
    assert!(build.files.iter().all(|f| !f.path.starts_with("surface")));
}
