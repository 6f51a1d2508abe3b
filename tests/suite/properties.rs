//! Random small scenes: a build never panics, and its certificates never lie.
//!
//! Each scene is made twice over: by the program, and by rays of another kind at the scene's meshes and at the files of the
//! finished forest (see `dense`). What the second finds bounds what the first may claim. `PROPTEST_CASES` asks for more scenes,
//! `FUZZ_SEED` for others.

use crate::dense::{Hits, Raster, allowed};
use crate::fuzz::{asked, files, hash};
use crate::shapes::{CUBE_FACES, ball, ring, wavy};
use glam::{DVec2, DVec3};
use pillarforest::compile::{self, Build};
use pillarforest::diag::Diagnostic;
use pillarforest::formats::{NamedMesh, read_bodies};
use pillarforest::geom::to_segment;
use pillarforest::index::VertexId;
use pillarforest::kinds::ReliefKind;
use pillarforest::mesh::TriMesh;
use pillarforest::scene::{self, Scene};
use pillarforest::support::{Support, SupportKind};
use pillarforest::view::View;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::str::from_utf8;

/// Scenes of an ordinary run of the tests, of either kind.
const CASES: u32 = 6;
/// Steps of making a failing scene smaller.
const SHRINKS: usize = 24;
/// Rays along a side of each view's raster: their sums are good to about a part in `SIDE` of the outlines' length.
const SIDE: usize = 240;
/// Allowed difference of shares between rays and certificates.
const SAMPLING: f64 = 0.015;
/// The same for what reaches the viewer: the seams of reliefs, a tenth of a millimetre, belong to nobody.
const SEAMS: f64 = 0.03;
/// Smaller shares of the models would be told as 0.00 %: that is no failure.
const LEAST_SHARE: f64 = 0.5e-4;
/// Finished surfaces lie in their layers to within this, millimetres: what certificates call on the relief.
const ON_RELIEF: f64 = 0.06;
/// Square arc-minutes of a steradian.
const ARCMIN2: f64 = 11_818_102.86;

// ---- Scenes ----

#[derive(Clone, Debug)]
struct Body {
    kind: u8,
    largest: f64,
    at: (f64, f64, f64),
}

#[derive(Clone, Debug)]
struct Looker {
    turn: f64,
    distance: f64,
    height: f64,
    bodies: Vec<Body>,
}

#[derive(Clone, Debug)]
struct Post {
    shape: String,
    at: (f64, f64),
    height: f64,
    surface: bool,
}

#[derive(Clone, Debug)]
struct Choices {
    front: f64,
    back: f64,
    energy: u8,
    ordering: bool,
    contested: u8,
}

/// What a scene says besides places, with layers of such fronts.
fn choices(front: Range<f64>) -> impl Strategy<Value = Choices> {
    (front, 0.1..1.0, 0u8..4, prop::bool::weighted(0.8), 0u8..3).prop_map(
        |(front, back, energy, ordering, contested)| Choices {
            front,
            back,
            energy,
            ordering,
            contested,
        },
    )
}

#[derive(Clone, Debug)]
struct Draft {
    posts: Vec<Post>,
    lookers: Vec<Looker>,
    choices: Choices,
    base: bool,
    /// Arc-minutes: narrower gaps are not told.
    seen: u8,
}

/// Scenes where anything may stand anywhere: models beside their pillars, pillars in each other's sight.
fn wild() -> impl Strategy<Value = Draft> {
    let body = (0u8..5, 8.0..24.0, (-8.0..8.0, -8.0..8.0, 0.0..12.0))
        .prop_map(|(kind, largest, at)| Body { kind, largest, at });
    let looker = (
        0.0..360.0,
        prop_oneof![70.0..400.0, Just(2000.0)],
        0.0..60.0,
        prop::collection::vec(body, 1..3),
    )
        .prop_map(|(turn, distance, height, bodies)| Looker {
            turn,
            distance,
            height,
            bodies,
        });
    let post = (
        0u8..3,
        2.0..5.0,
        (-1.5..1.5, -1.5..1.5),
        18.0..40.0,
        0.0..360.0,
        prop::bool::weighted(0.25),
    )
        .prop_map(|(kind, size, at, height, turn, surface)| Post {
            shape: match kind {
                0 => round(size),
                1 => rectangle(size, 1.5 * size, turn),
                _ => format!("Polygon(sides: 5, radius: {size:.3}, turn: {turn:.3})"),
            },
            at,
            height,
            surface,
        });
    (
        prop::collection::vec(post, 2..7),
        prop::collection::vec(looker, 1..4),
        choices(0.5..4.0),
        prop::bool::weighted(0.9),
    )
        .prop_map(|(mut posts, lookers, choices, base)| {
            for (k, post) in posts.iter_mut().enumerate() {
                post.at.0 += 12.0 * ((k % 3) as f64 - 1.0);
                post.at.1 += 12.0 * ((k / 3) as f64 - 0.5);
            }
            Draft {
                posts,
                lookers,
                choices,
                base,
                seen: 0,
            }
        })
}

fn round(radius: f64) -> String {
    format!("Round(radius: {radius:.3}, facets: 24)")
}

fn rectangle(width: f64, depth: f64, turn: f64) -> String {
    format!("Rectangle(width: {width:.3}, depth: {depth:.3}, turn: {turn:.3})")
}

/// Scenes as people make them: before every eye a model amid two rows of pillars that cover it, each in the gaps of the other; the
/// rows of several eyes stand around the middle.
fn aimed() -> impl Strategy<Value = Draft> {
    let looker = (
        -15.0..15.0_f64,
        160.0..400.0_f64,
        20.0..70.0_f64,
        (0u8..5, 14.0..26.0_f64, 8.0..12.0_f64),
    );
    (
        prop::collection::vec(looker, 1..4),
        0.0..360.0_f64,
        (0u8..3, 3.0..4.5_f64, prop::bool::weighted(0.2)),
        choices(1.0..4.0),
    )
        .prop_map(|(views, first, (kind, size, surface), choices)| {
            let (mut posts, mut lookers) = (Vec::new(), Vec::new());
            let out = match views.len() {
                1 => 0.0,
                2 => 16.0,
                _ => 30.0,
            };
            for (v, &(lean, distance, height, (body, largest, lift))) in views.iter().enumerate() {
                let turn = first + lean + 360.0 / views.len() as f64 * v as f64;
                let ahead = DVec2::from_angle(turn.to_radians());
                let at = out * ahead;
                lookers.push(Looker {
                    turn,
                    distance,
                    height,
                    bodies: vec![Body {
                        kind: body,
                        largest,
                        at: (at.x, at.y, lift),
                    }],
                });
                let pitch = 1.5 * size;
                let columns = (1.2 * largest / pitch).ceil() as i32 + 2;
                posts.extend((0..columns).map(|k| {
                    let side = (f64::from(k) - f64::from(columns - 1) / 2.0) * pitch;
                    let row = if k % 2 == 0 { size } else { -size };
                    let place = at + side * ahead.perp() + row * ahead;
                    Post {
                        shape: match kind {
                            0 => round(size),
                            1 => rectangle(2.0 * size, 1.6 * size, turn + 90.0),
                            _ => format!(
                                "Polygon(sides: 8, radius: {:.3}, turn: {turn:.3})",
                                1.08 * size
                            ),
                        },
                        at: (place.x, place.y),
                        height: lift + largest + 8.0,
                        surface,
                    }
                }));
            }
            Draft {
                posts,
                lookers,
                choices,
                base: true,
                seen: 1,
            }
        })
}

impl Draft {
    fn text(&self) -> String {
        let (mut models, mut views, mut pillars) = (String::new(), String::new(), String::new());
        for (v, looker) in self.lookers.iter().enumerate() {
            let mut names = String::new();
            for (m, body) in looker.bodies.iter().enumerate() {
                let (x, y, z) = body.at;
                let _ = writeln!(
                    models,
                    "    (name: \"m{v}-{m}\", file: \"{}.obj\", place: Fit(largest: {:.3}, at: ({x:.3}, {y:.3}, {z:.3}))),",
                    body.kind, body.largest
                );
                let _ = write!(names, "\"m{v}-{m}\", ");
            }
            let eye = looker.distance * DVec2::from_angle(looker.turn.to_radians());
            let _ = writeln!(
                views,
                "    (name: \"v{v}\", eye: ({:.3}, {:.3}, {:.3}), models: [{names}]),",
                eye.x, eye.y, looker.height
            );
        }
        for Post {
            shape,
            at,
            height,
            surface,
        } in &self.posts
        {
            let depth = if *surface {
                ", depth: (from: Surface)"
            } else {
                ""
            };
            let _ = writeln!(
                pillars,
                "    (shape: {shape}, height: {height:.3}, places: At([({:.3}, {:.3})]){depth}),",
                at.0, at.1
            );
        }
        let Choices {
            front,
            back,
            ordering,
            ..
        } = self.choices;
        let energy = match self.choices.energy {
            0 => format!("Curvature(ordering: {ordering})"),
            1 => format!("Normal(steps: Never, ordering: {ordering})"),
            _ => format!("Normal(ordering: {ordering})"),
        };
        let contested = ["First", "Largest", "Error"][self.choices.contested as usize];
        let base = if self.base {
            "Disc(facets: 24)"
        } else {
            "None"
        };
        format!(
            "(\n  seen: {},\n  models: [\n{models}  ],\n  views: [\n{views}  ],\n  pillars: [\n{pillars}  ],\n  depth: (front: {front:.3}, back: {back:.3}),\n  \
             energy: {energy},\n  contested: {contested},\n  base: {base},\n  output: (forest_glb: false, plan: false, views: false, \
             lights: false, camouflage: false, picture_size: 64),\n)\n",
            self.seen
        )
    }
}

/// OBJ text of the model `<kind>.obj`.
fn model(name: &str) -> Result<Vec<u8>, Diagnostic> {
    let mesh = match name {
        "0.obj" => ball(DVec3::ZERO, 10.0, 6),
        "1.obj" => wavy(10.0, 0.25),
        "2.obj" => cuboid(DVec3::new(20.0, 12.0, 16.0)),
        "3.obj" => {
            let mut two = ball(DVec3::new(0.0, 0.0, 0.0), 8.0, 6);
            two.append(&ball(DVec3::new(3.0, -11.0, 4.0), 4.0, 5));
            two
        }
        "4.obj" => crate::shapes::prism(&ring(DVec2::ZERO, 6.0, 7), 0.0, 20.0),
        _ => return Err(Diagnostic::error(format!("no file {name}"))),
    };
    let mut text = String::new();
    for v in &mesh.vertices {
        let _ = writeln!(text, "v {} {} {}", v.x, v.y, v.z);
    }
    for [VertexId(a), VertexId(b), VertexId(c)] in &mesh.faces {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    Ok(text.into_bytes())
}

fn cuboid(size: DVec3) -> TriMesh {
    let corner =
        |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) * size;
    TriMesh::new((0..8).map(corner).collect(), CUBE_FACES)
}

// ---- The test ----

/// What became of a scene.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Refused,
    Built,
    BuiltWhole,
}

#[test]
fn wild_scenes_never_panic_and_their_certificates_hold() {
    random_scenes(wild(), |[_, built, whole], all| 4 * (built + whole) >= all);
}

#[test]
fn scenes_that_aim_build_whole_and_their_certificates_hold() {
    random_scenes(aimed(), |[_, _, whole], all| 2 * whole >= all);
}

/// As many as `PROPTEST_CASES` says, from `FUZZ_SEED` if there is one. `enough` says of the numbers of those that were refused, built
/// and built whole whether they are what is wanted.
fn random_scenes(scenes: impl Strategy<Value = Draft>, enough: impl Fn([usize; 3], usize) -> bool) {
    let cases = asked("PROPTEST_CASES").unwrap_or(CASES);
    let seed: u64 = asked("FUZZ_SEED").unwrap_or_default();
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let (mut ends, mut wrong) = (Vec::new(), Vec::new());
    for case in 0..cases {
        let mut tree = scenes.new_tree(&mut runner).expect("a scene");
        match tried(&tree.current().text()) {
            Ok(end) => ends.push(end),
            Err(why) => {
                println!("case {case}: {why}\n{}", tree.current().text());
                wrong.push(kept(&smallest(&mut tree, why)));
            }
        }
    }
    let count = |end: End| ends.iter().filter(|e| **e == end).count();
    let counts = [End::Refused, End::Built, End::BuiltWhole].map(count);
    println!(
        "{cases} scenes, FUZZ_SEED={seed}: refused, built with failures, built whole: {counts:?}"
    );
    assert!(
        wrong.is_empty(),
        "FUZZ_SEED={seed}; these scenes are in the corpus now:\n{}",
        wrong.join("\n\n")
    );
    assert!(
        enough(counts, cases as usize),
        "too few scenes of FUZZ_SEED={seed} were built: {counts:?}"
    );
}

/// The smallest scene on the way that still fails, with the reason.
fn smallest(tree: &mut impl ValueTree<Value = Draft>, why: String) -> (Draft, String) {
    let mut found = (tree.current(), why);
    for _ in 0..SHRINKS {
        let more = match tried(&tree.current().text()) {
            Err(why) => {
                found = (tree.current(), why);
                tree.simplify()
            }
            Ok(_) => tree.complicate(),
        };
        if !more {
            break;
        }
    }
    found
}

fn kept_scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/forests")
}

/// What is wrong with a scene, which is in the corpus from now on.
fn kept((draft, why): &(Draft, String)) -> String {
    let text = draft.text();
    let path = kept_scenes().join(format!("wrong-{:016x}.ron", hash(text.as_bytes())));
    fs::write(&path, text).expect("a kept scene");
    format!("{}: {why}", path.display())
}

#[test]
fn kept_scenes_never_panic_and_their_certificates_hold() {
    let wrong = files(&kept_scenes())
        .into_iter()
        .filter_map(|(path, text)| {
            let why = tried(from_utf8(&text).expect("a scene")).err()?;
            Some(format!("{}: {why}", path.display()))
        });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Builds a scene and holds the result against the rays.
fn tried(text: &str) -> Result<End, String> {
    let run = || {
        let scene = scene::resolve(text, &model)?.value;
        let build = compile::build(&scene, &|_, _| {}, &|| false)?;
        Ok((scene, build))
    };
    let result: Result<(Scene, Build), Vec<Diagnostic>> =
        catch_unwind(AssertUnwindSafe(run)).map_err(|_| "a panic".to_owned())?;
    match result {
        Err(problems) => {
            let told = problems.iter().all(|p| !p.message.trim().is_empty());
            let stopped = problems.iter().any(Diagnostic::is_error);
            told_first("refused", &problems, text);
            match told && stopped {
                true => Ok(End::Refused),
                false => Err(format!("errors that say nothing: {problems:?}")),
            }
        }
        Ok((scene, build)) => {
            let lies = lies(&scene, &build);
            told_first("built with failures", &build.failures, text);
            match (lies.is_empty(), build.failures.is_empty()) {
                (false, _) => Err(lies.join("\n")),
                (true, false) => Ok(End::Built),
                (true, true) => Ok(End::BuiltWhole),
            }
        }
    }
}

/// For those who look at the output: why a scene is not whole.
fn told_first(end: &str, problems: &[Diagnostic], text: &str) {
    if let Some(first) = problems.iter().find(|p| p.is_error()) {
        println!("{end}: {}\n{text}", first.message);
    }
}

fn bytes<'a>(build: &'a Build, path: &str) -> &'a [u8] {
    let file = build.files.iter().find(|f| f.path == path);
    &file.unwrap_or_else(|| panic!("no {path}")).bytes
}

/// Everything that does not fit together.
fn lies(scene: &Scene, build: &Build) -> Vec<String> {
    let report: Value = serde_json::from_slice(bytes(build, "report.json")).expect("JSON");
    let stl = read_bodies("f.stl", bytes(build, "forest.stl")).expect("an STL");
    let parts = read_bodies("f.3mf", bytes(build, "forest.3mf")).expect("a 3MF");
    let whole = &stl.value[0].mesh;
    let mut found = verdict(scene, build, &report);
    found.extend(open_edges(whole).map(|n| format!("{n} open or twisted edges in forest.stl")));
    for (v, view) in scene.views.iter().enumerate() {
        let certificate = &report["views"][v]["certificate"];
        let seen = Looked::at(scene, view, whole, &parts.value);
        let wrong = seen.against(scene, certificate);
        found.extend(wrong.into_iter().map(|w| format!("{}: {w}", view.name)));
    }
    found
}

/// Edges that do not have exactly one face on each side; `None` if there are none. Vertices are equal if their bits are.
fn open_edges(mesh: &TriMesh) -> Option<usize> {
    let bits = |v: VertexId| mesh.vertices[v].to_array().map(|x| (x + 0.0).to_bits());
    let mut sides: Vec<_> = (mesh.faces.iter())
        .flat_map(|f| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])])
        .map(|(a, b)| {
            let (a, b) = (bits(a), bits(b));
            if a < b { (a, b, false) } else { (b, a, true) }
        })
        .collect();
    sides.sort_unstable();
    let groups = sides.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1));
    let bad = groups
        .filter(|g| !matches!(g, [(_, _, false), (_, _, true)]))
        .count();
    (bad > 0).then_some(bad)
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or(f64::NAN)
}

/// Square arc-minutes of the listed things that are `wanted`.
fn listed(list: &Value, wanted: impl Fn(&Value) -> bool) -> f64 {
    let items = list.as_array().into_iter().flatten();
    items
        .filter(|i| wanted(i))
        .map(|i| number(i, "arcmin2"))
        .sum()
}

/// The largest share of the models that a certificate says is lost for one cause.
fn worst_cause(certificate: &Value) -> f64 {
    let gaps = certificate["gaps"].as_array().expect("a list of gaps");
    let of = |cause: &Value| listed(&certificate["gaps"], |g| g["cause"] == *cause);
    let shares = gaps.iter().map(|g| of(&g["cause"]));
    shares.fold(0.0, f64::max) / (solid_angle(certificate) * ARCMIN2)
}

/// Of all models of a view, as its certificate claims; steradians.
fn solid_angle(certificate: &Value) -> f64 {
    let models = certificate["models"].as_array().into_iter().flatten();
    models.map(|m| number(m, "solid_angle_sr")).sum()
}

/// `ok` must follow from the certificates, and from nothing else.
fn verdict(scene: &Scene, build: &Build, report: &Value) -> Vec<String> {
    let ordered = scene.relief.energy().ordering();
    let views = report["views"].as_array().into_iter().flatten();
    let certificates: Vec<&Value> = views.map(|v| &v["certificate"]).collect();
    let holds = |c: &&Value| {
        number(c, "bound_violation_mm") <= 1e-6
            && number(c, "clamp_mm") <= 1e-6
            && (!ordered || number(c, "order_inversions") == 0.0)
            && ["duality_gap_rel", "primal_residual", "dual_residual"]
                .iter()
                .all(|k| number(c, k) <= 1e-6)
            && worst_cause(c) < LEAST_SHARE
            && c["conflicts"].as_array().is_some_and(Vec::is_empty)
            && number(c, "contested_left_arcmin2") == 0.0
    };
    let whole = number(&report["solid"], "parts") == 1.0;
    let mut prints = report["print"].as_array().into_iter().flatten();
    let a_warning = |check: &Value| {
        ["overhang", "slenderness", "bed"]
            .map(Value::from)
            .contains(&check["check"])
    };
    let printable = prints.all(|check| check["ok"] == true || a_warning(check));
    let proved = certificates.len() == scene.views.len() && certificates.iter().all(holds);
    let wanted = proved && whole && printable;
    let mut found = Vec::new();
    if report["ok"].as_bool() != Some(wanted) || build.failures.is_empty() != wanted {
        found.push(format!(
            "ok is {}, but certificates say {wanted}",
            report["ok"]
        ));
    }
    if report["failures"].as_array().map(Vec::len) != Some(build.failures.len()) {
        found.push("report and build tell of different failures".to_owned());
    }
    found
}

// ---- One view by rays ----

/// What an eye meets: its models, the bare supports, the finished forest, and that in parts.
struct Looked {
    raster: Raster,
    models: TriMesh,
    /// By face of the models.
    target: Hits,
    bare: Hits,
    whole: Hits,
    parts: Hits,
    own: Hits,
}

/// Where a ray that meets a pillar with corners at `depth`, on a side turned from it by more than 70 degrees, meets the planes of those that
/// are not; the nearest.
fn before_corner(support: &Support, eye: DVec3, direction: DVec3, depth: f64) -> Option<f64> {
    let SupportKind::Pillar { profile, round, .. } = &support.kind else {
        return None;
    };
    let (o, way) = (eye.truncate(), direction.truncate());
    let side = |k: usize| (profile[k], profile[(k + 1) % profile.len()]);
    let outward = |k: usize| -(side(k).1 - side(k).0).perp().normalize();
    let facing = |k: usize| {
        let middle = side(k).0.midpoint(side(k).1);
        (o - middle).normalize().dot(outward(k))
    };
    let met = |k: usize| outward(k).dot(side(k).0 - o) / outward(k).dot(way);
    let hit = (0..profile.len()).min_by(|a, b| {
        let off = |k: usize| to_segment(o + depth * way, side(k).0, side(k).1);
        off(*a).total_cmp(&off(*b))
    })?;
    let flat = 70f64.to_radians().cos();
    let fronts = (0..profile.len()).filter(|k| facing(*k) >= flat).map(met);
    let nearest = fronts.filter(|t| *t > 0.0).reduce(f64::min)?;
    (!round && facing(hit) < flat).then_some(nearest)
}

impl Looked {
    fn at(scene: &Scene, view: &View, whole: &TriMesh, parts: &[NamedMesh]) -> Self {
        let target = view.target();
        let raster = Raster::over(view.eye, view.look_at, &target, SIDE);
        let supports = scene.supports.iter().enumerate();
        let own_name = format!("{} reliefs", view.name);
        let own = parts.iter().filter(|p| p.name == own_name);
        Self {
            target: raster.cast_faces(&target),
            bare: raster.cast(supports.map(|(k, s)| (k as u32, &s.mesh))),
            whole: raster.cast([(0, whole)]),
            parts: raster.cast(parts.iter().enumerate().map(|(k, p)| (k as u32, &p.mesh))),
            own: raster.cast(own.map(|p| (0, &p.mesh))),
            raster,
            models: target,
        }
    }

    /// Solid angle of the rays that are `wanted`, steradians.
    fn sum(&self, wanted: impl Fn(usize) -> bool) -> f64 {
        let rays = (0..self.raster.count()).filter(|r| wanted(*r));
        rays.map(|r| self.raster.weight(r)).sum()
    }

    /// The layer the relief of a ray must lie in; `None` if the ray misses the models or meets nothing that carries.
    fn layer(&self, scene: &Scene, ray: usize) -> Option<(f64, f64)> {
        let support = scene.supports.get(self.bare.owner[ray] as usize)?;
        let direction = self.raster.direction(ray);
        let (eye, surface) = (self.raster.eye, self.bare.depth[ray]);
        let (near, far) = allowed(support, eye, direction, surface)?;
        // Along a side that the eye looks along a layer begins where it does before the sides that look at the eye.
        let before = before_corner(support, eye, direction, surface)
            .and_then(|front| allowed(support, eye, direction, front));
        let near = before.map_or(near, |(before, _)| before.min(near));
        self.target.depth[ray].is_finite().then_some((near, far))
    }

    fn against(&self, scene: &Scene, certificate: &Value) -> Vec<String> {
        let layers: Vec<Option<(f64, f64)>> = (0..self.raster.count())
            .map(|r| self.layer(scene, r))
            .collect();
        let mut found = self.coverage(&layers, certificate);
        found.extend(self.reaching(&layers, certificate));
        found.extend(self.order(scene, &layers, certificate));
        found
    }

    /// Solid angle and coverage, gap by gap.
    fn coverage(&self, layers: &[Option<(f64, f64)>], certificate: &Value) -> Vec<String> {
        let seen = self.sum(|r| self.target.depth[r].is_finite());
        let claimed = solid_angle(certificate);
        let mut found = Vec::new();
        if (claimed / seen - 1.0).abs() > SAMPLING {
            found.push(format!("solid angle {claimed:.3e} sr, rays say {seen:.3e}"));
        }
        let whole = claimed * ARCMIN2;
        let gaps = &certificate["gaps"];
        let all = listed(gaps, |_| true) + number(certificate, "small_gaps_arcmin2");
        let coverage = number(certificate, "coverage");
        if (coverage + all / whole - 1.0).abs() > 1e-6 {
            found.push(format!(
                "coverage {coverage} and gaps {} do not make one",
                all / whole
            ));
        }
        let given_up = |g: &Value| matches!(g["cause"].as_str(), Some("other_view" | "infeasible"));
        let possible = self.sum(|r| layers[r].is_some()) / seen;
        let claimed = coverage + listed(gaps, given_up) / whole;
        if (claimed - possible).abs() > SAMPLING {
            found.push(format!(
                "supports carry {claimed:.4}, rays say {possible:.4}"
            ));
        }
        found
    }

    /// What reaches the viewer: rays that meet the view's own relief first, in its layer.
    fn reaching(&self, layers: &[Option<(f64, f64)>], certificate: &Value) -> Vec<String> {
        let seen = self.sum(|r| self.target.depth[r].is_finite());
        let long = |r: usize| self.raster.direction(r).length();
        let off = |r: usize, a: f64, b: f64| (a - b).abs() * long(r);
        let own = |r: usize| {
            layers[r].is_some()
                && self.own.depth[r].is_finite()
                && off(r, self.own.depth[r], self.whole.depth[r]) < ON_RELIEF
        };
        let outside = |r: usize| {
            let (near, far) = layers[r].unwrap_or_default();
            (near - self.whole.depth[r]).max(self.whole.depth[r] - far) * long(r)
        };
        let mut found = Vec::new();
        let met = self.sum(own);
        let stray = self.sum(|r| own(r) && outside(r) > ON_RELIEF);
        // Beside a support carved back for another view, rays go on to reliefs on the next one, or to ties behind what was carved.
        let whole = solid_angle(certificate);
        let carved =
            listed(&certificate["gaps"], |g| g["cause"] == "other_view") / (whole * ARCMIN2);
        if stray > 0.01 * met + (0.002 + 0.02 * carved) * seen {
            let worst = (0..self.raster.count()).filter(|r| own(*r));
            let worst = worst.max_by(|a, b| outside(*a).total_cmp(&outside(*b)));
            let told = worst.map(|r| {
                let point = self.raster.eye + self.whole.depth[r] * self.raster.direction(r);
                format!("by up to {:.3} mm at {point:.2}", outside(r))
            });
            found.push(format!(
                "{:.4} of the relief lies outside of its layer, {}",
                stray / met,
                told.unwrap_or_default()
            ));
        }
        let reaching = number(certificate, "reaching");
        let by_rays = self.sum(|r| own(r) && outside(r) <= ON_RELIEF) / seen;
        if (reaching - by_rays).abs() > SEAMS {
            found.push(format!(
                "{reaching:.4} reaches the viewer, rays say {by_rays:.4}"
            ));
        }
        let differs =
            self.sum(|r| off(r, self.whole.depth[r], self.parts.depth[r]) > ON_RELIEF) / seen;
        if differs > 0.01 {
            found.push(format!("STL and 3MF differ over {differs:.4} of the view"));
        }
        found
    }

    /// How much farther away ray `a` meets the models than its neighbour `b`; 0 if a plane of their faces goes through both: a
    /// steep slope is no step.
    fn sheets(&self, a: usize, b: usize) -> f64 {
        let depth = &self.target.depth;
        let joined = |from: usize, to: usize| {
            let there = (self.raster).plane_depth(&self.models, self.target.owner[from], to);
            there.is_nan() || (there - depth[to]).abs() <= JUMP
        };
        if !depth[a].is_finite() || !depth[b].is_finite() || joined(a, b) || joined(b, a) {
            return 0.0;
        }
        depth[a] - depth[b]
    }

    /// Where neighbouring rays meet sheets of the model far apart, on one support, the farther must not come first.
    fn order(
        &self,
        scene: &Scene,
        layers: &[Option<(f64, f64)>],
        certificate: &Value,
    ) -> Vec<String> {
        let ordered = scene.relief.energy().ordering();
        // A torn piece along a contour may be narrower than the rays' distance, and only it has an order with what lies behind.
        let torn = matches!(scene.relief, ReliefKind::Torn(..));
        if torn || !ordered || number(certificate, "order_inversions") > 0.0 {
            return Vec::new();
        }
        let side = self.raster.side;
        let shows = |r: usize| {
            let on = (self.own.depth[r] - self.whole.depth[r]).abs() < ON_RELIEF;
            layers[r].is_some() && on
        };
        let turned = |(a, b): (usize, usize)| {
            let apart = self.sheets(a, b);
            let step = self.whole.depth[a] - self.whole.depth[b];
            let same = self.bare.owner[a] == self.bare.owner[b];
            same && shows(a) && shows(b) && apart.abs() > JUMP && step * apart.signum() < -TURNED
        };
        let inside = |r: &usize| !(r + 1).is_multiple_of(side) && r + side < self.raster.count();
        let pairs = (0..self.raster.count())
            .filter(inside)
            .flat_map(|r| [(r, r + 1), (r, r + side)]);
        let found: Vec<(usize, usize)> = pairs.filter(|p| turned(*p)).collect();
        // Corners at steps may be filled in, which certificates count.
        let filled = number(certificate, "filled_arcmin2") / ARCMIN2;
        let filled = filled / self.raster.weight(self.raster.count() / 2);
        if found.len() <= FEW + 2 * filled as usize {
            return Vec::new();
        }
        let told = found.iter().take(4).map(|(a, b)| {
            let point = |r: usize, hits: &Hits| {
                let p = self.raster.eye + hits.depth[r] * self.raster.direction(r);
                format!("{p:.2}")
            };
            let [p, q] = [*a, *b].map(|r| [point(r, &self.target), point(r, &self.whole)]);
            let [[p, u], [q, v]] = [p, q];
            format!("\n    models at {p} and {q}, forest at {u} and {v}")
        });
        vec![format!(
            "{} pairs of rays meet far parts of the models before near ones, {filled:.1} rays are filled in:{}",
            found.len(),
            told.collect::<String>()
        )]
    }
}

/// Neighbouring rays that meet the models this far apart meet two sheets of them, millimetres.
const JUMP: f64 = 2.5;
/// Reliefs turned by less may be the slope between two rays, millimetres.
const TURNED: f64 = 0.3;
/// Pairs that may be the ends of steps.
const FEW: usize = 3;
