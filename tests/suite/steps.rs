//! Torn surfaces: what tearing gains, and every promise that is made about it.

use crate::shapes::{MIDDLE, Setting, ball, wavy};
use glam::{DVec2, DVec3};
use pillarforest::groups::anchor;
use pillarforest::index::{CellId, VertexId};
use pillarforest::mesh::TriMesh;
use pillarforest::mimic::{Energy, FaceWeight, NormalOptions};
use pillarforest::relief::{Relief, relief};
use pillarforest::steps::{Prefer, StepLimits, StepOptions, Torn, torn};
use pillarforest::viewmap::{Image, ViewMap};

const NORMAL: NormalOptions = NormalOptions {
    weight: FaceWeight::Area,
    ordering: true,
    reweight: 0,
};
pub(crate) const STEPS: StepOptions = StepOptions {
    limits: StepLimits {
        least_mm: 0.1,
        highest_mm: None,
        tolerance_mm: None,
    },
    most: None,
    price: 30.0,
    narrowest_mm: 0.4,
    prefer: Prefer::Tolerance,
};

/// Sheets of one support whose depths in the model differ by more than this meet in a contour, millimetres.
const CONTOUR_MM: f64 = 0.02;

/// A ball with deep waves that hide parts of each other, and a little ball before it.
fn contoured() -> Setting {
    let mut setting = Setting::tight();
    setting.model = wavy(12.0, 0.25);
    let little = ball(MIDDLE + DVec3::new(2.0, -16.0, 2.0), 3.0, 10);
    setting.model.append(&little);
    setting
}

fn settings() -> [Setting; 2] {
    [Setting::tight(), contoured()]
}

fn limited(highest_mm: Option<f64>, tolerance_mm: Option<f64>) -> StepOptions {
    let limits = StepLimits {
        highest_mm,
        tolerance_mm,
        ..STEPS.limits
    };
    StepOptions { limits, ..STEPS }
}

fn torn_with(setting: &Setting, steps: &StepOptions) -> (Torn<'static>, Relief) {
    let torn = torn(steps, NORMAL, &setting.sight()).expect("a torn surface");
    let relief = relief(&torn.sight, &torn.depths);
    (torn, relief)
}

/// Mean angle between the model and a relief, degrees, by solid angle.
fn error_deg(image: &Image, relief: &Relief) -> f64 {
    let Image { target, map, .. } = image;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (c, depth) in CellId::all(relief.depth.len()).zip(&relief.depth) {
        let (Some(depth), Some(face)) = (depth, map.cells[c].face) else {
            continue;
        };
        let corners = map.triangle(c);
        let [p, q, r] = [0, 1, 2].map(|k| map.plane.point(corners[k], depth[k]));
        let normal = target.mesh.normal(face);
        let turned = (q - p).cross(r - p);
        let angle = turned
            .cross(normal)
            .length()
            .atan2(turned.dot(normal).abs());
        let sr = map.solid_angle(c);
        sum += sr * angle.to_degrees();
        weight += sr;
    }
    sum / weight
}

fn torn_error(setting: &Setting, steps: &StepOptions) -> f64 {
    let (torn, relief) = torn_with(setting, steps);
    error_deg(&torn.sight.image, &relief)
}

fn whole_error(setting: &Setting) -> f64 {
    let whole = setting.solved(Energy::Normal(NORMAL));
    error_deg(&whole.sight.image, &whole.relief)
}

/// Sides between two cells with reliefs on one support: both cells, and for both ends which corners of theirs lie there.
fn sides(map: &ViewMap, relief: &Relief) -> Vec<([CellId; 2], [[usize; 2]; 2])> {
    let mut sides = Vec::new();
    let carried = |c: &CellId| relief.depth[*c].is_some();
    for c in CellId::all(map.cells.len()).filter(carried) {
        for k in 0..3 {
            let Some(n) = map.neighbours[c][k] else {
                continue;
            };
            if n < c || !carried(&n) || map.cells[c].support != map.cells[n].support {
                continue;
            }
            let ends = [k, (k + 1) % 3].map(|k| {
                let corners = map.cells[n].corners.iter();
                let of_n = { corners }.position(|p| *p == map.cells[c].corners[k]);
                [k, of_n.expect("the side's end")]
            });
            sides.push(([c, n], ends));
        }
    }
    sides
}

#[test]
fn torn_surfaces_keep_the_normals() {
    // The deep waves have faces that are steeper than the layer is thick.
    for (setting, most) in settings().into_iter().zip([1.0, 1.5]) {
        let (whole, torn) = (whole_error(&setting), torn_error(&setting, &STEPS));
        assert!(
            whole > 5.0 && torn < most,
            "{whole} degrees whole, {torn} torn"
        );
    }
}

#[test]
fn every_corner_stays_in_its_layer() {
    for setting in settings() {
        let (torn, relief) = torn_with(&setting, &STEPS);
        let map = &torn.sight.image.map;
        assert!(relief.clamp_mm < 1e-6, "clamped by {} mm", relief.clamp_mm);
        for (c, depth) in CellId::all(relief.depth.len()).zip(&relief.depth) {
            let (Some(depth), Some(support)) = (depth, map.cells[c].support) else {
                continue;
            };
            let slab = torn.sight.groups.slabs[support].expect("a layer");
            for (q, z) in map.triangle(c).into_iter().zip(depth) {
                let (near, far) = torn.sight.image.layer_at(&slab, support, q);
                assert!(
                    (near - 1e-9..=far + 1e-9).contains(z),
                    "{z} not in {near} to {far}"
                );
            }
        }
    }
}

#[test]
fn sheets_keep_their_order_along_contours() {
    let (torn, relief) = torn_with(&contoured(), &STEPS);
    let Image { map, target, .. } = &torn.sight.image;
    let model = |c: CellId, k: usize| {
        let cell = &map.cells[c];
        let q = map.points[cell.corners[k]];
        let face = cell.face.expect("a relief shows a face");
        anchor(target, face, q).1
    };
    let depth = |c: CellId, k: usize| relief.depth[c].expect("a relief")[k];
    let (mut met, mut worst) = (0, f64::MIN);
    for ([c, n], ends) in sides(map, &relief) {
        for [k, l] in ends {
            let gap = model(n, l) - model(c, k);
            if gap.abs() > CONTOUR_MM {
                met += 1;
                worst = worst.max((depth(c, k) - depth(n, l)) * gap.signum());
            }
        }
    }
    assert!(met > 100, "{met} ends of contours");
    assert!(
        worst < 1e-6,
        "a front sheet lies {worst} mm behind its back sheet"
    );
}

/// Steps at vertices of the cut mesh: depths of both copies for corners of two patches that meet along a side.
fn steps_at_vertices(torn: &Torn, relief: &Relief) -> Vec<f64> {
    let Image { map, target, .. } = &torn.sight.image;
    let mesh = &target.mesh;
    let mut steps = Vec::new();
    for ([c, n], _) in sides(map, relief) {
        let faces = [c, n].map(|c| map.cells[c].face.expect("a relief shows a face"));
        let group = |c: CellId| torn.sight.groups.of_cell[c];
        if faces[0] == faces[1] || group(c) != group(n) {
            continue;
        }
        for v in mesh.faces[faces[0]] {
            for w in mesh.faces[faces[1]] {
                if v != w && mesh.vertices[v] == mesh.vertices[w] {
                    steps.push(target.depth[v] * (torn.depths.s[v] - torn.depths.s[w]).abs());
                }
            }
        }
    }
    steps
}

#[test]
fn no_step_is_lower_than_the_least() {
    for setting in settings() {
        for least_mm in [0.05, 0.1, 0.4] {
            let limits = StepLimits {
                least_mm,
                ..STEPS.limits
            };
            let (torn, relief) = torn_with(&setting, &StepOptions { limits, ..STEPS });
            let steps = steps_at_vertices(&torn, &relief);
            let lowest = steps.iter().fold(f64::MAX, |a, b| a.min(*b));
            assert!(steps.len() > 20, "{} steps", steps.len());
            // Beyond the bounded part of a face its plane may come before the layer.
            assert!(
                lowest > 0.995 * least_mm,
                "{lowest} mm instead of {least_mm}"
            );
        }
    }
}

#[test]
fn no_step_is_higher_than_the_highest() {
    for setting in settings() {
        let mut costs = Vec::new();
        for highest in [0.3, 0.8, 2.0] {
            let (torn, relief) = torn_with(&setting, &limited(Some(highest), None));
            let error = error_deg(&torn.sight.image, &relief);
            // Limits are depths, heights of lines distances on rays.
            for line in &torn.lines {
                for (height, ray) in line.height_mm.iter().zip(&line.ends) {
                    let depth = height / ray.length();
                    assert!(depth <= highest + 1e-6, "{depth} mm instead of {highest}");
                }
            }
            costs.push((torn.summary.lines, error));
        }
        for pair in costs.windows(2) {
            assert!(pair[0].0 > pair[1].0 || pair[0].1 > pair[1].1, "{costs:?}");
        }
    }
}

#[test]
fn the_eye_may_move_as_far_as_wanted() {
    for setting in settings() {
        for wanted in [5.0, 20.0, 100.0] {
            let (torn, _) = torn_with(&setting, &limited(None, Some(wanted)));
            let tolerance = torn.summary.tolerance_mm;
            assert!(
                tolerance.is_none_or(|t| t >= wanted * (1.0 - 1e-6)),
                "{tolerance:?} instead of {wanted}"
            );
        }
    }
}

#[test]
fn there_are_no_more_lines_than_wanted() {
    for setting in settings() {
        let free = torn_with(&setting, &STEPS).0.summary.lines;
        assert!(free > 8, "{free} lines");
        for most in [0, 1, 4, 8] {
            let options = StepOptions {
                most: Some(most),
                ..STEPS
            };
            let (torn, _) = torn_with(&setting, &options);
            assert!(
                torn.summary.lines <= most as usize,
                "{} lines instead of {most}",
                torn.summary.lines
            );
            assert!(most > 0 || torn.lines.is_empty());
        }
    }
}

#[test]
fn steps_are_lower_for_tolerance_than_for_camouflage() {
    for setting in settings() {
        let mean = |prefer| {
            torn_with(&setting, &StepOptions { prefer, ..STEPS })
                .0
                .summary
                .mean_mm
        };
        let (low, high) = (mean(Prefer::Tolerance), mean(Prefer::Camouflage));
        assert!(low <= high, "{low} mm for tolerance, {high} for camouflage");
    }
}

#[test]
fn runs_and_numbers_of_threads_give_the_same_bits() {
    let setting = Setting::tight();
    let bits = || {
        let (torn, _) = torn_with(&setting, &STEPS);
        let bits: Vec<u64> = torn.depths.s.iter().map(|s| s.to_bits()).collect();
        (bits, torn.sight.image.target.mesh.faces, torn.lines)
    };
    let first = bits();
    assert!(first == bits(), "two runs differ");
    for threads in [1, 4] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        assert!(
            first == pool.expect("a pool").install(bits),
            "{threads} threads differ"
        );
    }
}

/// The same surface with its vertices and faces in another order, and every face begun at another corner.
fn shuffled(mesh: &TriMesh, seed: u64) -> TriMesh {
    let order = |count: usize, salt: u64| {
        let key = |i: &usize| {
            (*i as u64 ^ salt)
                .wrapping_mul(0x9E37_79B9_7F4A_7C15)
                .rotate_left(29)
        };
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|i| key(i).wrapping_mul(0xBF58_476D_1CE4_E5B9));
        order
    };
    let from = order(mesh.vertices.len(), seed);
    let mut to = vec![VertexId(0); from.len()];
    VertexId::all(from.len())
        .zip(&from)
        .for_each(|(new, old)| to[*old] = new);
    let face = |f: usize| [0, 1, 2].map(|k| to[mesh.faces[f][(k + f) % 3]]);
    TriMesh {
        vertices: from.iter().map(|v| mesh.vertices[*v]).collect(),
        faces: order(mesh.faces.len(), seed + 1)
            .into_iter()
            .map(face)
            .collect(),
    }
}

#[test]
fn the_order_of_the_models_faces_hardly_matters() {
    for setting in settings() {
        let figures = |setting: &Setting| {
            let (torn, relief) = torn_with(setting, &STEPS);
            (
                torn.summary.pieces as f64,
                error_deg(&torn.sight.image, &relief),
            )
        };
        let (pieces, error) = figures(&setting);
        for seed in [1, 99] {
            let other = Setting {
                model: shuffled(&setting.model, seed),
                supports: setting.supports.clone(),
                ..setting
            };
            let (p, e) = figures(&other);
            assert!(
                (p - pieces).abs() <= 2.0 + 0.1 * pieces,
                "{p} pieces instead of {pieces}"
            );
            // Where knives are not allowed the cost is no metric, and the sweeps end in one of several places.
            let most = 0.05 + 0.1 * error;
            assert!((e - error).abs() < most, "{e} degrees instead of {error}");
        }
    }
}

#[test]
fn what_fits_is_not_torn() {
    let (torn, relief) = torn_with(&Setting::roomy(), &STEPS);
    let error = error_deg(&torn.sight.image, &relief);
    assert!(torn.lines.is_empty(), "{} lines", torn.lines.len());
    assert_eq!((torn.summary.lines, torn.summary.highest_mm), (0, 0.0));
    assert!(error < 0.05, "{error} degrees");
}

/// A rectangle of two faces, leaning back so far that no pillar's layer holds its part of it.
#[test]
fn a_face_steeper_than_the_layer_is_no_error() {
    let lean = DVec2::new(40.0, 20.0);
    let corner = |x: f64, z: f64| MIDDLE + DVec3::new(x, (x * lean.x + z * lean.y) / 24.0, z);
    let mut setting = Setting::tight();
    setting.model = TriMesh::new(
        vec![
            corner(-12.0, -10.0),
            corner(12.0, -10.0),
            corner(12.0, 10.0),
            corner(-12.0, 10.0),
        ],
        [[0, 1, 2], [0, 2, 3]],
    );
    let (torn, relief) = torn_with(&setting, &STEPS);
    let (error, whole) = (error_deg(&torn.sight.image, &relief), whole_error(&setting));
    assert!(error <= whole + 0.1, "{error} degrees torn, {whole} whole");
}
