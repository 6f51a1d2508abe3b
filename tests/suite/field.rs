//! Situations from the field, built whole: what people tried first and what they should get.

use super::meshes::cuboid;
use super::shapes::{ball, balls, obj};
use glam::DVec3;
use pillarforest::compile::{self, Build};
use pillarforest::diag::Diagnostic;
use pillarforest::index::VertexId;
use pillarforest::mesh::TriMesh;
use pillarforest::scene;
use serde_json::Value;

const OUTPUT: &str = "output: (forest_glb: false, lights: false, camouflage: false, report_html: false, picture_size: 64)";

/// Upright and level bars as letters have them: an H and an E.
fn letters(which: &str) -> TriMesh {
    let mut all = TriMesh::default();
    let mut bar = |x: [f64; 2], z: [f64; 2]| {
        let size = [x[1] - x[0], 6.0, z[1] - z[0]];
        all.append(&cuboid([x[0], -3.0, z[0]], size));
    };
    bar([0.0, 4.0], [0.0, 24.0]);
    match which {
        "H" => {
            bar([14.0, 18.0], [0.0, 24.0]);
            bar([4.0, 14.0], [10.0, 14.0]);
        }
        _ => [0.0, 10.0, 20.0]
            .iter()
            .for_each(|z| bar([4.0, 16.0], [*z, z + 4.0])),
    }
    all
}

/// A stepped pyramid of seven sides with its tip in front: walls that fall by 9 mm on 1.2 mm, and ledges that hardly do.
fn terraces() -> TriMesh {
    const SIDES: u32 = 7;
    let mut rings = vec![(36.0, 0.0)];
    for k in 0..4 {
        let (radius, y) = (34.8 - 7.7 * f64::from(k), -9.0 - 9.6 * f64::from(k));
        rings.extend([(radius, y), (radius - 6.5, y - 0.6)]);
    }
    let corner = |(radius, y): (f64, f64), i: u32| {
        let angle = (f64::from(i) + 0.3) * std::f64::consts::TAU / f64::from(SIDES);
        DVec3::new(radius * angle.cos(), y, radius * angle.sin())
    };
    let mut mesh = TriMesh::default();
    for ring in &rings {
        mesh.vertices.extend((0..SIDES).map(|i| corner(*ring, i)));
    }
    let last = rings.len() as u32 - 1;
    let (tip, back) = (SIDES * (last + 1), SIDES * (last + 1) + 1);
    mesh.vertices.extend([
        DVec3::new(0.0, rings[last as usize].1 - 1.0, 0.0),
        DVec3::ZERO,
    ]);
    for i in 0..SIDES {
        let next = (i + 1) % SIDES;
        for ring in (0..last).map(|k| k * SIDES) {
            let (a, b) = (ring + i, ring + next);
            mesh.faces.push([a, b, b + SIDES].map(VertexId));
            mesh.faces.push([a, b + SIDES, a + SIDES].map(VertexId));
        }
        mesh.faces
            .push([SIDES * last + i, SIDES * last + next, tip].map(VertexId));
        mesh.faces.push([next, i, back].map(VertexId));
    }
    mesh
}

fn read(name: &str) -> Result<Vec<u8>, Diagnostic> {
    let mesh = match name {
        "ball.obj" => ball(DVec3::ZERO, 20.0, 24),
        // A head with a nose that stands out half its own size.
        "nose.obj" => {
            let mut both = ball(DVec3::ZERO, 20.0, 24);
            both.append(&ball(DVec3::new(0.0, -19.0, 0.0), 6.0, 12));
            both
        }
        "overlapping.obj" => balls(DVec3::new(22.0, -8.0, 6.0)),
        "terraces.obj" => terraces(),
        "h.obj" => letters("H"),
        "e.obj" => letters("E"),
        _ => return Err(Diagnostic::error(format!("no file {name}"))),
    };
    Ok(obj(&mesh))
}

fn built(text: &str) -> Build {
    let scene = scene::resolve(text, &read).unwrap_or_else(|p| panic!("{text}: {p:#?}"));
    compile::build(&scene.value, &|_, _| {}, &|| false).unwrap_or_else(|p| panic!("{text}: {p:#?}"))
}

fn report(build: &Build) -> Value {
    let file = build.files.iter().find(|f| f.path == "report.json");
    serde_json::from_slice(&file.expect("a report").bytes).expect("JSON")
}

fn mean_deg(build: &Build) -> f64 {
    let mean = &report(build)["views"][0]["normal_error_deg"]["mean"];
    mean.as_f64().expect("a mean error")
}

fn warned(build: &Build, words: &str, help: &str) -> bool {
    let fits =
        |d: &Diagnostic| d.message.contains(words) && d.help.iter().any(|h| h.contains(help));
    build.warnings.iter().any(fits)
}

/// A plate with one model, seen from in front.
fn on_plate(model: &str, plate: &str, eye: &str, energy: &str) -> Build {
    built(&format!(
        "(models: [(name: \"m\", file: \"{model}\", place: Fit(height: 36, at: (0, 0, 8)))],\n\
         views: [(name: \"m\", eye: {eye}, models: [\"m\"])], supports: [Plate({plate})], energy: {energy}, {OUTPUT})"
    ))
}

#[test]
fn a_floor_anamorphosis_in_one_piece_is_warned_of_and_torn_it_is_right() {
    let floor = |energy| {
        on_plate(
            "ball.obj",
            "width: 200, height: 200, lean: 90, at: (0, -40, 0), depth: (front: 6)",
            "(0, -400, 160)",
            energy,
        )
    };
    let whole = floor("Normal(steps: Never)");
    assert!(mean_deg(&whole) > 25.0);
    assert!(
        warned(
            &whole,
            "degrees from its models' on average",
            "steps: Allowed()"
        ),
        "{:#?}",
        whole.warnings
    );
    let torn = floor("Normal(steps: Allowed())");
    assert!(mean_deg(&torn) < 6.0, "{} degrees", mean_deg(&torn));
    assert!(!warned(&torn, "on average", ""), "{:#?}", torn.warnings);
}

#[test]
fn what_a_thin_layer_cuts_off_is_told_by_the_build() {
    let coin = |energy| {
        on_plate(
            "nose.obj",
            "width: 60, height: 60, depth: (front: 1.2)",
            "(0, -300, 26)",
            energy,
        )
    };
    let cut = coin("Normal(steps: Never)");
    for help in ["thicker layers", "Curvature()", "steps: Allowed()"] {
        assert!(
            warned(&cut, "lies flat at a limit of its layer", help),
            "{help} in {:#?}",
            cut.warnings
        );
    }
    let bent = coin("Curvature()");
    let share = |build: &Build| report(build)["views"][0]["certificate"]["at_limit"].as_f64();
    assert!(
        share(&bent) < share(&cut),
        "{:?} {:?}",
        share(&bent),
        share(&cut)
    );
}

#[test]
fn parts_that_overlap_keep_their_order_whatever_the_energy_and_the_outline() {
    for outline in ["Free", "OnSupport"] {
        for energy in ["Curvature()", "Normal(steps: Allowed())"] {
            let plate = format!("width: 120, height: 80, depth: (front: 6, outline: {outline})");
            let build = on_plate("overlapping.obj", &plate, "(10, -350, 26)", energy);
            let view = &report(&build)["views"][0];
            let certificate = &view["certificate"];
            assert_eq!(certificate["order_inversions"], 0, "{outline} {energy}");
            let front = certificate["relief_front_mm"].as_f64().expect("a reach");
            assert!(
                (0.0..6.01).contains(&front),
                "{outline} {energy}: {front} mm"
            );
            // A coarse ball's silhouette is a strip that may be too thin to print; that is told, and is no matter of the order.
            let others = build
                .failures
                .iter()
                .filter(|d| !d.message.contains("`wall`"));
            assert_eq!(
                others.count(),
                0,
                "{outline} {energy}: {:#?}",
                build.failures
            );
            if energy.starts_with("Normal") {
                let lines = view["steps"]["lines"].as_u64();
                assert!(lines.is_some_and(|n| n > 0), "{outline}: {lines:?} tears");
                assert!(
                    !warned(&build, "tears had to be given up", ""),
                    "{:#?}",
                    build.warnings
                );
            }
        }
    }
}

fn assert_walls_print(build: &Build) {
    let report = report(build);
    let checks = report["print"].as_array().expect("checks").iter();
    let walls: Vec<&Value> = checks.filter(|c| c["check"] == "wall").collect();
    assert!(
        !walls.is_empty() && walls.iter().all(|c| c["ok"] == true),
        "{walls:?}"
    );
    assert!(build.failures.is_empty(), "{:#?}", build.failures);
}

/// Strips between tears are no knives: the narrowest is what the check of walls wants, also where there are no pillars.
#[test]
fn a_torn_plate_passes_the_check_of_walls() {
    assert_walls_print(&on_plate(
        "nose.obj",
        "width: 60, height: 60, depth: (front: 4)",
        "(40, -300, 60)",
        "Normal(steps: Allowed())",
    ));
}

/// A steep wall that is torn off at its foot would be a knife if it stood before what lies below it.
#[test]
fn steep_walls_are_not_torn_into_knives() {
    let build = on_plate(
        "terraces.obj",
        "width: 50, height: 50, depth: (front: 3)",
        "(0, -350, 25)",
        "Normal(steps: Allowed())",
    );
    assert_walls_print(&build);
    assert!(mean_deg(&build) < 3.0, "{} degrees", mean_deg(&build));
}

#[test]
fn dense_grids_become_one_solid() {
    for (radius, columns, rows, pitch) in [(1.5, 16, 6, 4.0), (0.6, 30, 5, 2.0)] {
        let build = built(&format!(
            "(models: [(name: \"m\", file: \"ball.obj\", place: Fit(height: 30, at: (0, 0, 10)))],\n\
             views: [(name: \"m\", eye: (30, -300, 45), models: [\"m\"])],\n\
             pillars: [(shape: Round(radius: {radius}), height: 50, places: Grid(columns: {columns}, rows: {rows}, pitch: {pitch}))],\n\
             depth: (front: 0.4, back: 0.2, core: 0.2), {OUTPUT})"
        ));
        let solid = &report(&build)["solid"];
        assert_eq!(solid["parts"], 1, "radius {radius}: {solid}");
    }
}

/// Two words for two eyes on pillars that are found: no pillar is left with a plate that does not print.
#[test]
fn two_words_come_out_whole_on_pillars_that_are_found() {
    let build = built(&format!(
        "(models: [(name: \"h\", file: \"h.obj\", place: Fit(height: 40, at: (0, 0, 14))),\n\
                  (name: \"e\", file: \"e.obj\", place: Fit(height: 40, at: (0, 0, 14), facing: (1, 0)))],\n\
         views: [(name: \"h\", eye: (0, -400, 40), models: [\"h\"]), (name: \"e\", eye: (400, 0, 40), models: [\"e\"])],\n\
         pillars: Auto(seed: 1), {OUTPUT})"
    ));
    assert!(build.failures.is_empty(), "{:#?}", build.failures);
    let report = report(&build);
    for view in report["views"].as_array().expect("views") {
        assert_eq!(view["certificate"]["coverage"], 1.0, "{}", view["name"]);
    }
}
