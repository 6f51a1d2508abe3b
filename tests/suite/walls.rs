//! Layers that go through walls: what is kept of them, found by rays at the bare support.

use super::shapes::{Outcome, Setting, ball, obj};
use glam::{DVec2, DVec3};
use pillarforest::compile;
use pillarforest::diag::Diagnostic;
use pillarforest::index::{CellId, FacetId, SupportId, VertexId};
use pillarforest::intake::load_model;
use pillarforest::mesh::{Solid, TriMesh};
use pillarforest::scene::{self, Scene};
use pillarforest::viewmap::SupportField;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

const FRONT: f64 = 1.0;
const CORE: f64 = 1.5;

/// A vase of 80 mm with a belly of 30 mm and a wall that gets thinner upwards, from 7 to 4 mm.
fn vase() -> TriMesh {
    const RINGS: u32 = 36;
    const ROWS: u32 = 9;
    let belly = |z: f64| 24.0 + 6.0 * (TAU * z / 90.0 - 0.8).sin();
    let profile: Vec<(f64, f64)> = (0..=ROWS)
        .map(|k| 80.0 * f64::from(k) / f64::from(ROWS))
        .map(|z| (belly(z), z))
        .chain((0..=ROWS).rev().map(|k| {
            let z = 6.0 + 74.0 * f64::from(k) / f64::from(ROWS);
            (belly(z) - 7.0 + 3.0 * z / 80.0, z)
        }))
        .collect();
    let mut mesh = TriMesh {
        vertices: vec![DVec3::ZERO, DVec3::new(0.0, 0.0, 6.0)],
        faces: Vec::new(),
    };
    for (r, z) in &profile {
        let way = |i: u32| DVec2::from_angle(TAU * f64::from(i) / f64::from(RINGS));
        let ring = (0..RINGS).map(|i| (*r * way(i)).extend(*z));
        mesh.vertices.extend(ring);
    }
    let at = |ring: u32, i: u32| VertexId(2 + ring * RINGS + i % RINGS);
    let last = profile.len() as u32 - 1;
    for i in 0..RINGS {
        mesh.faces.push([VertexId(0), at(0, i + 1), at(0, i)]);
        mesh.faces.push([VertexId(1), at(last, i), at(last, i + 1)]);
        for ring in 0..last {
            let [a, b] = [at(ring, i), at(ring, i + 1)];
            let [c, d] = [at(ring + 1, i + 1), at(ring + 1, i)];
            mesh.faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A ball of 26 mm before the vase.
fn scene(depth: &str, steps: &str) -> Scene {
    let text = format!(
        "(models: [(name: \"ball\", file: \"ball.obj\", place: Fit(height: 26, at: (0, -20, 25)))],\n\
         views: [(name: \"front\", eye: (0, -300, 70), look_at: (0, 0, 38), models: [\"ball\"])],\n\
         supports: [Mesh(file: \"vase.obj\", depth: ({depth}))], energy: Normal(steps: {steps}),\n\
         output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64))"
    );
    let read = |name: &str| match name {
        "ball.obj" => Ok::<_, Diagnostic>(obj(&ball(DVec3::ZERO, 20.0, 40))),
        _ => Ok(obj(&vase())),
    };
    let done = scene::resolve(&text, &read).unwrap_or_else(|p| panic!("{p:?}"));
    assert!(done.warnings.is_empty(), "{:?}", done.warnings);
    done.value
}

#[test]
fn reliefs_in_walls_leave_their_core_on_every_ray() {
    let scene = scene(
        &format!("hits: (1, 2), front: {FRONT}, core: {CORE}"),
        "Never",
    );
    let field = SupportField::new(&scene.supports);
    let Outcome { sight, relief, .. } = Setting::of(&scene).solved(scene.relief.energy());
    let map = &sight.image.map;
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
    let (mut rays, mut merged, mut deepest) = (0, 0, 0.0f64);
    for (c, cell) in map.all() {
        let Some(depth) = relief.depth[c] else {
            continue;
        };
        for _ in 0..3 {
            let mut share = [0; 3].map(|_| random.random_range(0.01..1.0));
            let sum: f64 = share.iter().sum();
            share.iter_mut().for_each(|w| *w /= sum);
            let q: DVec2 = (0..3).map(|k| share[k] * map.triangle(c)[k]).sum();
            let z = 1.0 / (0..3).map(|k| share[k] / depth[k]).sum::<f64>();
            let direction = map.plane.direction(q);
            let Some((first, leaves)) = field.wall(SupportId(0), map.plane.eye, direction) else {
                continue;
            };
            // Thin cells are merged away, so that some reach beyond their facet by two micrometres.
            let planes = (
                Some(FacetId::of(first.face)),
                Some(FacetId::of(leaves.face)),
            );
            if planes != (cell.facet, cell.leaves) {
                merged += 1;
                continue;
            }
            let [before, behind] =
                [first.t - z, leaves.t - z].map(|along| along * direction.length());
            assert!(before <= FRONT + 1e-6, "{before} mm before the wall");
            assert!(behind >= CORE - 1e-6, "{behind} mm of the wall are left");
            deepest = deepest.max(-before);
            rays += 1;
        }
    }
    assert!(
        rays > 2000 && merged < rays / 50,
        "{rays} rays, {merged} beside"
    );
    assert!(deepest > 1.0, "{deepest} mm is hardly carved");
}

#[test]
fn a_vase_is_carved_and_printable() {
    let mut errors = Vec::new();
    for depth in ["front: 1, back: 0.5", "hits: (1, 2), front: 1, core: 1.5"] {
        let scene = scene(depth, "Never");
        let build = compile::build(&scene, &|_, _| {}, &|| false)
            .unwrap_or_else(|problems| panic!("{depth}: {problems:?}"));
        assert!(build.failures.is_empty(), "{depth}: {:?}", build.failures);
        let file = |name: &str| {
            &build
                .files
                .iter()
                .find(|f| f.path == name)
                .expect("a file")
                .bytes
        };
        let forest = load_model("forest.stl", file("forest.stl"), false).expect("sound");
        let solid = Solid::new(forest.value).unwrap_or_else(|d| panic!("{depth}: {d:?}"));
        assert_eq!(solid.parts(), 1, "{depth}");
        let report: serde_json::Value = serde_json::from_slice(file("report.json")).expect("JSON");
        errors.push(
            report["views"][0]["normal_error_deg"]["mean"]
                .as_f64()
                .expect("a number"),
        );
    }
    assert!(
        errors[1] < 0.8 * errors[0],
        "more room, less error: {errors:?}"
    );
}

#[test]
fn too_thin_walls_carry_reliefs_on_their_surface() {
    let scene = scene("hits: (1, 2), front: 2, core: 60", "Never");
    let field = SupportField::new(&scene.supports);
    let Outcome { sight, relief, .. } = Setting::of(&scene).solved(scene.relief.energy());
    let map = &sight.image.map;
    let mut deepest = f64::NEG_INFINITY;
    for (c, depth) in CellId::all(relief.depth.len()).zip(&relief.depth) {
        let Some(depth) = depth else { continue };
        let facet = map.cells[c].facet.expect("a support");
        for (z, q) in depth.iter().zip(map.triangle(c)) {
            let direction = map.plane.direction(q);
            let first = field.facet_depth(facet, map.plane.eye, direction);
            deepest = deepest.max((z - first) * direction.length());
        }
    }
    assert!((0.0..=0.05 + 1e-6).contains(&deepest), "{deepest}");
}
