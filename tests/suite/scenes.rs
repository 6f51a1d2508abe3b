//! The bundled scenes, built to the end once each and looked at from several sides; the bundled models.
//!
//! The reference forest is built where `PILLARFOREST_MODELS` names the folder of its models.

use crate::golden;
use glam::DVec3;
use pillarforest::compile::{Build, OutputFile, build, check, plan};
use pillarforest::diag::Diagnostic;
use pillarforest::formats::read_mesh;
use pillarforest::index::FaceId;
use pillarforest::intake::{Inspection, inspect};
use pillarforest::mesh::Solid;
use pillarforest::scene::{self, Scene};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Scenes whose models are not bundled.
const FOREIGN: [&str; 2] = ["planned-reference", "reference-forest"];

struct Built {
    scene: Scene,
    build: Build,
    report: Value,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// File names without ending of all scenes.
fn scene_names() -> Vec<String> {
    let paths = fs::read_dir(root().join("scenes")).unwrap();
    let paths = paths.map(|e| e.unwrap().path());
    let mut names: Vec<String> = paths
        .filter(|p| p.extension().is_some_and(|e| e == "ron"))
        .map(|p| p.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    names
}

fn text(name: &str) -> String {
    fs::read_to_string(root().join(format!("scenes/{name}.ron"))).unwrap()
}

fn resolved(name: &str) -> Scene {
    resolved_from(name, &text(name))
}

fn resolved_from(name: &str, text: &str) -> Scene {
    let outside = std::env::var_os("PILLARFOREST_MODELS").map(PathBuf::from);
    let read = |file: &str| {
        let path = match &outside {
            Some(folder) if FOREIGN.contains(&name) => folder.join(file),
            _ => root().join("scenes").join(file),
        };
        fs::read(&path).map_err(|e| Diagnostic::error(format!("{}: {e}", path.display())))
    };
    scene::resolve(text, &read)
        .unwrap_or_else(|problems| panic!("{name}: {problems:?}"))
        .value
}

fn made(scene: &Scene) -> Build {
    build(scene, &|_, _| {}, &|| false)
        .unwrap_or_else(|problems| panic!("{}: {problems:?}", scene.title))
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(work)
}

/// A scene of the repository with all its files, built once, on two threads.
fn built(name: &str) -> &'static Built {
    static MINIMAL: OnceLock<Built> = OnceLock::new();
    static FOUR: OnceLock<Built> = OnceLock::new();
    static AGAMOGRAPH: OnceLock<Built> = OnceLock::new();
    static PLATE: OnceLock<Built> = OnceLock::new();
    static REFERENCE: OnceLock<Built> = OnceLock::new();
    static PLANNED: OnceLock<Built> = OnceLock::new();
    static PLANNED_REFERENCE: OnceLock<Built> = OnceLock::new();
    let slot = match name {
        "minimal" => &MINIMAL,
        "four-creatures" => &FOUR,
        "agamograph" => &AGAMOGRAPH,
        "plate" => &PLATE,
        "reference-forest" => &REFERENCE,
        "planned-creatures" => &PLANNED,
        "planned-reference" => &PLANNED_REFERENCE,
        _ => panic!("{name} is new: give it a place here and figures under tests/golden"),
    };
    slot.get_or_init(|| {
        let scene = resolved(name);
        let build = with_threads(2, || made(&scene));
        let report = serde_json::from_slice(bytes(&build, "report.json")).unwrap();
        Built {
            scene,
            build,
            report,
        }
    })
}

/// Names of the scenes that can be built here.
fn buildable() -> Vec<String> {
    let outside = std::env::var_os("PILLARFOREST_MODELS").is_some();
    let mut names = scene_names();
    names.retain(|n| outside || !FOREIGN.contains(&n.as_str()));
    names
}

/// Whether the scene has its pillars found.
fn is_planned(name: &str) -> bool {
    name.starts_with("planned-")
}

fn file<'a>(build: &'a Build, path: &str) -> &'a OutputFile {
    build
        .files
        .iter()
        .find(|f| f.path == path)
        .unwrap_or_else(|| panic!("no {path}"))
}

fn bytes<'a>(build: &'a Build, path: &str) -> &'a [u8] {
    &file(build, path).bytes
}

#[test]
fn every_scene_becomes_one_closed_part_that_shows_its_models() {
    for name in buildable() {
        let Built { build, report, .. } = built(&name);
        assert!(build.failures.is_empty(), "{name}: {:?}", build.failures);
        assert_eq!(report["solid"]["parts"], 1, "{name}");
        for check in report["solid"]["checks"].as_array().unwrap() {
            assert_eq!(check["passed"], true, "{name}: {check}");
        }
        for view in report["views"].as_array().unwrap() {
            let figure = |key: &str| {
                view[key]
                    .as_f64()
                    .unwrap_or_else(|| panic!("{key}: {view}"))
            };
            let error = &view["normal_error_deg"];
            assert!(figure("hit_share") >= 0.9999, "{name}: {view}");
            assert!(
                view["certificate"]["coverage"].as_f64().unwrap() > 0.9999,
                "{name}: {view}"
            );
            assert!(error["mean"].as_f64().unwrap() <= 16.0, "{name}: {view}");
            assert!(error["median"].as_f64().unwrap() <= 10.0, "{name}: {view}");
        }
    }
}

#[test]
fn every_scene_passes_the_print_checks() {
    for name in buildable() {
        let report = &built(&name).report;
        let checks = report["print"].as_array().unwrap();
        // Slenderness and cores are asked of pillars.
        assert!(checks.len() >= 6, "{name}: {checks:?}");
        for check in checks {
            assert_eq!(check["ok"], true, "{name}: {check}");
            for figure in ["value_mm", "wanted_mm", "limit_mm"] {
                assert!(check[figure].as_f64().unwrap() >= 0.0, "{name}: {check}");
            }
        }
    }
}

#[test]
fn every_scene_gives_every_file_and_no_warning() {
    for name in buildable() {
        let Built { scene, build, .. } = built(&name);
        let mut found: Vec<&str> = build.files.iter().map(|f| f.path.as_str()).collect();
        found.sort_unstable();
        let mut wanted: Vec<String> = [
            "forest.3mf",
            "forest.stl",
            "forest.glb",
            "plan.svg",
            "plan.png",
            "camouflage.png",
            "camouflage.svg",
            "report.json",
            "report.html",
        ]
        .map(String::from)
        .to_vec();
        for view in &scene.views {
            wanted.push(format!("views/{}.png", view.name));
            wanted.push(format!("views/{}-lights.png", view.name));
        }
        wanted.extend(is_planned(&name).then(|| "layout.ron".into()));
        wanted.sort_unstable();
        assert_eq!(found, wanted, "{name}");
        assert!(build.warnings.is_empty(), "{name}: {:?}", build.warnings);
        assert!(build.summary.contains("watertight"), "{}", build.summary);
    }
}

#[test]
fn printable_files_pass_our_own_inspection_when_read_back() {
    for name in buildable() {
        let Built {
            scene,
            build,
            report,
        } = built(&name);
        let stl = inspect("forest.stl", bytes(build, "forest.stl"))
            .unwrap()
            .value;
        assert!(stl.printable(), "{name}: {stl}");
        assert_eq!(
            (stl.bodies.len(), stl.bodies[0].parts),
            (1, 1),
            "{name}: {stl}"
        );
        assert_eq!(
            stl.bodies[0].triangles as u64,
            report["solid"]["triangles"].as_u64().unwrap()
        );
        let objects = inspect("forest.3mf", bytes(build, "forest.3mf"))
            .unwrap()
            .value;
        let names: Vec<&str> = objects.bodies.iter().map(|b| b.name.as_str()).collect();
        let mut wanted = vec!["base and pillars".to_owned()];
        wanted.extend(scene.views.iter().map(|v| format!("{} reliefs", v.name)));
        assert_eq!(names, wanted, "{name}");
        for body in &objects.bodies {
            assert!(body.printable, "{name}: {}: {:?}", body.name, body.defects);
        }
        let volume = |o: &Inspection| -> f64 { o.bodies.iter().filter_map(|b| b.volume_mm3).sum() };
        // Reliefs are bedded in their pillars by a hair: the objects together are hardly more than the whole.
        let (whole, parts) = (volume(&stl), volume(&objects));
        assert!(
            (parts / whole - 1.0).abs() < 0.005,
            "{name}: {whole} mm3 in one, {parts} mm3 in parts"
        );
    }
}

#[test]
fn planned_forests_keep_what_their_scenes_ask_for() {
    for name in buildable().iter().filter(|n| is_planned(n)) {
        let Built { scene, report, .. } = built(name);
        let wanted = &scene.brief.as_ref().unwrap().tolerance_mm;
        let curves = report["camouflage"].as_array().unwrap();
        for ((view, wanted), curve) in report["views"]
            .as_array()
            .unwrap()
            .iter()
            .zip(wanted)
            .zip(curves)
        {
            let certificate = &view["certificate"];
            assert!(
                certificate["coverage"].as_f64().unwrap() >= 0.9995,
                "{name}: {view}"
            );
            assert_eq!(
                certificate["conflicts"].as_array().unwrap().len(),
                0,
                "{name}: {view}"
            );
            let tolerance = certificate["eye_tolerance_mm"]["side"].as_f64().unwrap();
            assert!(tolerance >= *wanted, "{name}: {tolerance} {wanted}");
            // Ten degrees off nothing much is left: the same layout of rows in front has 34 to 47 here.
            let points = curve["curve"].as_array().unwrap();
            let off = points.iter().find(|p| p["angle_deg"] == 10.0).unwrap();
            assert!(
                off["mean_error_deg"].as_f64().unwrap() >= 48.0,
                "{name}: {off}"
            );
        }
    }
}

#[test]
fn figures_are_the_golden_ones() {
    // A search may end elsewhere where sines are rounded otherwise: what it finds is held against what it promises instead.
    for name in buildable().iter().filter(|n| !is_planned(n)) {
        let report = &built(name).report;
        let solid = &report["solid"];
        let pick = |from: &Value, keys: &[&str]| -> Value {
            keys.iter().map(|k| from[*k].clone()).collect()
        };
        let views = report["views"].as_array().unwrap().iter().map(|v| {
            json!({
                "name": v["name"],
                "solid_angle_sr": v["solid_angle_sr"],
                "groups": v["groups"],
                "cells": v["cells"],
                "mean_median_p90_deg": pick(&v["normal_error_deg"], &["mean", "median", "p90"]),
            })
        });
        let found = json!({
            "triangles": solid["triangles"],
            "volume_mm3": solid["volume_mm3"],
            "area_mm2": solid["area_mm2"],
            "size_mm": solid["size_mm"],
            "parts": solid["parts"],
            "cavities": solid["cavities"],
            "defects": defects(&built(name).build),
            "views": views.collect::<Value>(),
        });
        golden::figures(&format!("{name}.json"), &found);
    }
}

/// Number of kinds of defects of the mesh that was written.
fn defects(build: &Build) -> usize {
    let found = inspect("forest.stl", bytes(build, "forest.stl")).unwrap();
    let bodies = &found.value.bodies;
    bodies.iter().map(|b| b.defects.len()).sum()
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    let first = &built("minimal").build;
    let second = with_threads(1, || made(&resolved("minimal")));
    assert_eq!(first.summary, second.summary);
    assert_eq!(first.files.len(), second.files.len());
    for (a, b) in first.files.iter().zip(&second.files) {
        assert_eq!(a.path, b.path);
        assert!(a.bytes == b.bytes, "{}", a.path);
    }
}

#[test]
fn pictures_are_the_golden_ones() {
    let mut four = resolved("four-creatures");
    four.output.plan_width = 900;
    let drawn = plan(&four, &|_, _| {}, &|| false).expect("a plan");
    let png = drawn.files.iter().find(|f| f.path == "plan.png");
    golden::picture("four-creatures-plan.png", &png.expect("a plan").bytes);
    golden::picture("owl.png", bytes(&built("minimal").build, "views/owl.png"));
}

/// A row of the table of bundled models: file, size in mm and number of vertices.
fn listed_model(row: &str) -> (&str, DVec3, usize) {
    let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
    let sides: Vec<f64> = cells[2].split(" x ").map(|n| n.parse().unwrap()).collect();
    let vertices = cells[3].replace(',', "").parse().unwrap();
    (
        cells[0].trim_matches('`'),
        DVec3::from_slice(&sides),
        vertices,
    )
}

#[test]
fn bundled_models_are_sound_and_as_listed() {
    let folder = root().join("scenes/models");
    let page = fs::read_to_string(folder.join("README.md")).unwrap();
    let rows = page.lines().filter(|l| l.starts_with("| `"));
    let mut listed: Vec<_> = rows.map(listed_model).collect();
    listed.sort_by_key(|row| row.0);
    let mut found: Vec<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".ply"))
        .collect();
    found.sort();
    let names: Vec<&str> = listed.iter().map(|row| row.0).collect();
    assert_eq!(found, names);
    listed.par_iter().for_each(|&(name, size, vertices)| {
        let bytes = fs::read(folder.join(name)).unwrap();
        assert!(bytes.len() < 3_200_000, "{name}: {} bytes", bytes.len());
        let read = read_mesh(name, &bytes).unwrap();
        assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
        assert_eq!(read.value.vertices.len(), vertices, "{name}");
        assert!(read.value.volume() > 0.0, "{name}");
        let (low, high) = read.value.bounds().unwrap();
        assert!((high - low - size).abs().max_element() <= 0.5, "{name}");
        let foot = (low + high).with_z(2.0 * low.z) * 0.5;
        assert!(foot.length() < 1e-4, "{name} stands at {foot}");
        let solid = Solid::new(read.value).unwrap_or_else(|defects| panic!("{name}: {defects:?}"));
        assert_eq!((solid.parts(), solid.cavities()), (1, 0), "{name}");
    });
}

#[test]
fn the_bundled_box_is_a_plain_cube() {
    let bytes = fs::read(root().join("scenes/models/box.ply")).unwrap();
    let cube = read_mesh("box.ply", &bytes).unwrap().value;
    assert_eq!(cube.vertices.len(), 6 * 16 * 16 + 2);
    assert_eq!(cube.faces.len(), 6 * 16 * 16 * 2);
    assert_eq!((cube.volume(), cube.area()), (64_000.0, 9_600.0));
    for face in FaceId::all(cube.faces.len()) {
        // Halves of squares of 2.5 mm, facing along an axis; the vector has twice the area.
        assert_eq!(cube.area_vector(face).abs().max_element(), 6.25);
        assert_eq!(cube.normal(face).abs().max_element(), 1.0);
    }
}

/// The carving of a square pillar ends beside its sides, which the eye hardly sees.
#[test]
fn no_film_stands_between_a_carving_and_the_side_of_its_pillar() {
    let square = text("minimal").replace("Round(radius: 4)", "Rectangle(width: 8, depth: 8)");
    let build = made(&resolved_from("minimal", &square));
    assert!(build.failures.is_empty(), "{:?}", build.failures);
}

#[test]
fn a_layer_without_core_is_told_with_view_and_pillar() {
    let mut scene = resolved("minimal");
    for support in &mut scene.supports {
        if let Some(layer) = &mut support.layer {
            layer.core = 3.5;
        }
    }
    let problems = check(&scene, &|_, _| {}, &|| false).expect_err("no core is left");
    let pillars = scene.supports.iter().filter(|s| s.layer.is_some());
    for (pillar, problem) in pillars.zip(&problems) {
        assert!(
            problem.message.contains(&pillar.name) && problem.message.contains("\"owl\""),
            "{}",
            problem.message
        );
    }
    assert_eq!(problems.len(), 5);
}
