//! The paper's variants of its energy, and what it compares itself with: identities, closed forms, one program in two forms.

use crate::shapes::{
    MIDDLE, Outcome, Setting, ball, bumpy, extent, flat_layer, pillar, prism, wavy,
};
use glam::{DMat3, DVec2, DVec3};
use pillarforest::certify::layer::{bound_violation_mm, order_inversions, share_at_limit};
use pillarforest::geom::solid_angle;
use pillarforest::index::{CellId, FaceId, VertexId};
use pillarforest::kinds::{ReliefKind, height_field_depths};
use pillarforest::laplacian::FaceGeometry;
use pillarforest::mesh::TriMesh;
use pillarforest::mimic::{
    CurvatureForm, CurvatureOptions, Ending, Energy, FaceWeight, GradientOptions, NormalOptions,
    RowKind, SolveError,
};
use pillarforest::support::{Datum, Layer, Support, SupportKind};
use pillarforest::words::iterated::unsettled;
use pillarforest::words::likeness::plateau;

const PAPER: CurvatureOptions = CurvatureOptions::PAPER;
const ABSOLUTE: CurvatureOptions = CurvatureOptions {
    scale_invariant: false,
    ..PAPER
};
const BENT: CurvatureOptions = CurvatureOptions {
    mean_curvature: true,
    ..PAPER
};
const CONIC: CurvatureOptions = CurvatureOptions {
    form: CurvatureForm::Conic,
    ..PAPER
};
const ITERATED: CurvatureOptions = CurvatureOptions {
    iterate: 30,
    // As in the paper's Fig 6.
    hidden_weight: 1.0,
    ..PAPER
};

const NORMAL: NormalOptions = NormalOptions {
    weight: FaceWeight::Area,
    ordering: true,
    reweight: 0,
};

fn gradient(compression: f64) -> Energy {
    Energy::Gradient(GradientOptions { compression })
}

/// All of them.
fn energies() -> Vec<Energy> {
    let curvatures = [PAPER, ABSOLUTE, BENT, CONIC, ITERATED];
    let mut all = vec![Energy::Normal(NORMAL), Energy::Linear, gradient(5.0)];
    all.extend(curvatures.map(Energy::Curvature));
    all
}

/// An upright plate across the y axis, 12 mm thick.
fn plate(layer: Layer) -> Support {
    let profile = [(-50.0, -6.0), (50.0, -6.0), (50.0, 6.0), (-50.0, 6.0)].map(DVec2::from);
    Support {
        name: "plate".into(),
        mesh: prism(&profile, -30.0, 70.0),
        kind: SupportKind::Pillar {
            axis: DVec2::ZERO,
            profile: profile.to_vec(),
            bottom: -30.0,
            top: 70.0,
            round: false,
        },
        layer: Some(layer),
    }
}

/// A model before a plate whose layer is `thickness` thick, 5 : 2 before and behind its middle plane.
fn on_plate(model: TriMesh, thickness: f64) -> Setting {
    let layer = flat_layer(thickness * 5.0 / 7.0, thickness * 2.0 / 7.0, 0.0);
    let mut setting = Setting::new(model, vec![plate(layer)]);
    setting.eye = DVec3::new(0.0, -300.0, 20.0);
    setting
}

/// A box of 1538 vertices about a point: six sides of 16 x 16 squares, an edge towards the eye, a little tilted.
fn divided_box(half: f64) -> TriMesh {
    let n: i32 = 16;
    let mut places: Vec<[i32; 3]> = Vec::new();
    let mut faces = Vec::new();
    let mut at = |p: [i32; 3]| {
        let found = places.iter().position(|q| *q == p);
        found.unwrap_or_else(|| {
            places.push(p);
            places.len() - 1
        }) as u32
    };
    for (axis, side) in (0..3).flat_map(|a| [(a, 0), (a, n)]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut corner = |di: i32, dj: i32| {
                let mut p = [0; 3];
                (p[axis], p[u], p[v]) = (side, i + di, j + dj);
                at(p)
            };
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            // Outwards on both sides, diagonals mirrored.
            faces.extend(match side {
                0 => [[a, c, b], [a, d, c]],
                _ => [[a, b, c], [a, c, d]],
            });
        }
    }
    let turn = DMat3::from_rotation_x(0.35) * DMat3::from_rotation_z(0.7);
    let place = |p: &[i32; 3]| {
        let p = p.map(|x| half * (2.0 * f64::from(x) / f64::from(n) - 1.0));
        MIDDLE + turn * DVec3::from_array(p)
    };
    TriMesh::new(places.iter().map(place).collect(), faces)
}

#[test]
fn iterating_converges_on_the_box() {
    let setting = on_plate(divided_box(12.0), 6.0);
    assert_eq!(setting.model.vertices.len(), 1538);
    let depths = setting.solved(Energy::Curvature(ITERATED)).depths;
    let iterated = depths.iterated.expect("rounds");
    assert_eq!(iterated.ending, Ending::Converged, "{iterated:?}");
    assert_eq!(iterated.kept, iterated.rounds.len());
    assert_eq!(unsettled("test", &iterated), None);
    // As in the paper's Fig 6 normals come closer.
    assert!(
        iterated.kept_deg < 0.97 * iterated.linearised_deg,
        "{iterated:?}"
    );
    let changes: Vec<f64> = iterated.rounds.iter().map(|r| r.change).collect();
    assert!(changes[changes.len() - 1] <= 1e-3 && changes[0] > 1e-2);
    let proof = depths.solved.optimality;
    assert!(proof.gap.max(proof.dual_residual) < 1e-6, "{proof:?}");
}

#[test]
fn an_iteration_that_fails_says_so_and_keeps_its_best_round() {
    // Little weight on hidden parts, deep waves, a thin layer: triangles become obtuse at once.
    let setting = on_plate(wavy(12.0, 0.25), 1.0);
    let light = CurvatureOptions {
        hidden_weight: 0.01,
        ..ITERATED
    };
    let linearised = setting.solved(Energy::Curvature(CurvatureOptions {
        iterate: 0,
        ..light
    }));
    assert_eq!(linearised.depths.iterated, None);
    let depths = setting.solved(Energy::Curvature(light)).depths;
    let iterated = depths.iterated.expect("rounds");
    assert_ne!(iterated.ending, Ending::Converged, "{iterated:?}");
    assert!(unsettled("test", &iterated).is_some());
    let least = iterated.rounds.iter().map(|r| r.turned_deg);
    let least = least.fold(iterated.linearised_deg, f64::min);
    assert_eq!(iterated.kept_deg, least);
    if iterated.kept == 0 {
        assert_eq!(depths.s, linearised.depths.s);
    }
}

/// Eq 7 by its definition, vertex by vertex, weights Eq 13 of the hidden part; `scaled`: with its last factor; `bent`: over the mean
/// curvatures.
fn curvature_energy(
    outcome: &Outcome,
    s: &[f64],
    hidden: &[bool],
    scaled: bool,
    bent: bool,
) -> f64 {
    let mesh = &outcome.target().mesh;
    let geometry = FaceGeometry::new(mesh);
    let areas = geometry.vertex_areas(mesh);
    let laplacian = |at: &dyn Fn(usize) -> DVec3| {
        let mut sums = vec![DVec3::ZERO; mesh.vertices.len()];
        for (f, face) in mesh.faces.iter().enumerate() {
            for k in 0..3 {
                let (i, j) = (face[(k + 1) % 3].at(), face[(k + 2) % 3].at());
                let flow = geometry.cotangents[f][k] / 2.0 * (at(j) - at(i));
                sums[i] += flow / areas[i];
                sums[j] -= flow / areas[j];
            }
        }
        sums
    };
    let ray = |i: usize| mesh.vertices[i] - outcome.map().plane.eye;
    let model = laplacian(&ray);
    let moved = laplacian(&|i| s[i] * ray(i));
    let term = |i: usize| {
        let wanted = if scaled { s[i] * model[i] } else { model[i] };
        let w = if hidden[i] { PAPER.hidden_weight } else { 1.0 };
        let h = if bent { model[i].length() / 2.0 } else { 1.0 };
        w * w * areas[i] * (moved[i] - wanted).length_squared() / (h * h)
    };
    (0..s.len()).map(term).sum()
}

/// Vertices of which the eye sees less than half, by the faces around them that are turned to it.
fn hidden(outcome: &Outcome) -> Vec<bool> {
    let (mesh, map) = (&outcome.target().mesh, outcome.map());
    let mut shares = vec![0.0; mesh.vertices.len()];
    let mut add = |face: FaceId, share: f64| {
        let corners = mesh.faces[face];
        corners.iter().for_each(|v| shares[*v] += share);
    };
    for (c, cell) in map.all() {
        if let Some(face) = cell.face {
            add(face, 2.0 * map.solid_angle(c));
        }
    }
    for face in FaceId::all(mesh.faces.len()) {
        let [a, b, c] = mesh.corners(face).map(|p| p - map.plane.eye);
        add(face, -solid_angle(a, b, c).max(0.0));
    }
    shares.iter().map(|s| *s <= 0.0).collect()
}

#[test]
fn with_a_loose_layer_the_model_itself_is_the_result() {
    // The attenuation of gradients changes the surface whatever the layer.
    let all = energies().into_iter();
    for energy in all.filter(|e| !matches!(e, Energy::Gradient(_))) {
        let outcome = Setting::roomy().solved(energy);
        let seen = outcome.map().cells.iter().filter_map(|c| c.face);
        let corners = seen.flat_map(|f| outcome.target().mesh.faces[f]);
        let s = corners.map(|v| outcome.depths.s[v]);
        let (lo, hi) = s.fold((f64::MAX, f64::MIN), |(lo, hi), s| (lo.min(s), hi.max(s)));
        assert!(hi / lo - 1.0 < 1e-3, "{energy:?}: {lo} to {hi}");
    }
}

#[test]
fn every_energy_keeps_every_bound() {
    let plate = on_plate(bumpy(12.0), 3.0);
    for setting in [Setting::tight(), plate] {
        for energy in energies() {
            let outcome = setting.solved(energy);
            let relief = &outcome.relief;
            let outside = bound_violation_mm(&outcome.sight, relief);
            assert!(outside < 1e-6, "{energy:?}: {outside} mm");
            assert!(relief.clamp_mm < 1e-6, "{energy:?}: {} mm", relief.clamp_mm);
            let claimed = outcome.depths.solved.not_an_optimum.is_none();
            let baseline = matches!(energy, Energy::Linear | Energy::Gradient(_));
            assert_eq!(claimed, !baseline, "{energy:?}");
        }
    }
}

#[test]
fn plateaus_are_counted_by_what_the_eye_sees_of_them() {
    let Outcome { sight, relief, .. } = on_plate(bumpy(12.0), 3.0).solved(Energy::Linear);
    let map = &sight.image.map;
    // Every carried cell at a depth between the limits of its layer: 0 is the near one, 1 the far one.
    let moved = |to: &dyn Fn(CellId) -> f64| {
        let mut moved = relief.clone();
        for (c, cell) in map.all() {
            let Some(slab) = cell.support.and_then(|s| sight.groups.slabs[s].as_ref()) else {
                continue;
            };
            moved.depth[c] = moved.depth[c].map(|_| {
                [0, 1, 2].map(|k| {
                    let (near, far) = sight.image.layer_in(slab, c, k);
                    near + to(c) * (far - near)
                })
            });
        }
        share_at_limit(&sight, &moved)
    };
    assert_eq!(moved(&|_| 0.5), 0.0);
    assert_eq!([moved(&|_| 0.0), moved(&|_| 1.0)], [1.0, 1.0]);
    let is_left = |c: CellId| map.triangle(c).iter().all(|q| q.x < 0.0);
    let carried = map.all().filter(|(c, _)| relief.depth[*c].is_some());
    let angles: Vec<(f64, bool)> = carried
        .map(|(c, _)| (map.solid_angle(c), is_left(c)))
        .collect();
    let all: f64 = angles.iter().map(|a| a.0).sum();
    let left: f64 = angles.iter().filter(|a| a.1).map(|a| a.0).sum();
    let share = moved(&|c| if is_left(c) { 1.0 } else { 0.3 });
    assert!(
        left > 0.3 * all && (share - left / all).abs() < 1e-12,
        "{share}"
    );

    let in_one_piece = ReliefKind::HeightField(Energy::Normal(NORMAL));
    let told = |share| plateau("left", share, &in_one_piece);
    assert_eq!(told(0.02), None);
    assert!(told(0.21).is_some_and(|d| d.message.contains("21 % of its relief lies flat")));
}

/// Two balls of which the nearer hides part of the other, as two groups on one plate.
fn two_balls() -> Setting {
    let mut model = ball(MIDDLE, 10.0, 10);
    model.append(&ball(MIDDLE + DVec3::new(6.0, -24.0, 5.0), 7.0, 10));
    on_plate(model, 4.0)
}

#[test]
fn the_curvature_energy_keeps_separate_parts_in_order() {
    let setting = two_balls();
    let inversions = |ordering| {
        let energy = Energy::Curvature(CurvatureOptions { ordering, ..PAPER });
        let outcome = setting.solved(energy);
        assert_eq!(outcome.sight.groups.groups.len(), 2);
        assert_eq!(
            outcome.depths.solved.broken, 0,
            "{:?}",
            outcome.depths.solved
        );
        assert!(bound_violation_mm(&outcome.sight, &outcome.relief) < 1e-6);
        order_inversions(&outcome.sight, &outcome.relief)
    };
    let free = inversions(false);
    assert!(free > 10, "{free} places where nothing keeps the order");
    assert_eq!(inversions(true), 0);
}

#[test]
fn bounds_that_contradict_each_other_are_not_kept_at_the_eye() {
    // A flat face as large as three round pillars, in a layer that follows them and is thinner than they are round.
    let places = [-8.0, 0.0, 8.0].map(|x| DVec2::new(x, 20.0));
    let supports = places.map(|at| {
        let mut support = pillar(at, 4.0, 48, Datum::Surface);
        support.layer = support.layer.map(|layer| Layer {
            extent: extent(Datum::Surface, 0.1),
            front: 0.3,
            ..layer
        });
        support
    });
    let setting = Setting::new(bumpy(10.0), supports.to_vec());
    let found = height_field_depths(Energy::Curvature(PAPER), &setting.sight());
    let Err(SolveError::Infeasible(rows)) = found else {
        panic!("{:?}", found.map(|d| d.mu));
    };
    assert!(
        rows.iter()
            .any(|r| matches!(r, RowKind::Near(_) | RowKind::Far(_)))
    );
}

#[test]
fn every_variant_is_the_optimum_of_its_own_energy() {
    let setting = on_plate(bumpy(12.0), 4.0);
    let variants = [PAPER, ABSOLUTE, BENT];
    let outcomes = variants.map(|o| setting.solved(Energy::Curvature(o)));
    let hidden = hidden(&outcomes[0]);
    for (own, o) in variants.iter().enumerate() {
        let value = |s: &[f64]| {
            curvature_energy(
                &outcomes[0],
                s,
                &hidden,
                o.scale_invariant,
                o.mean_curvature,
            )
        };
        let areas = FaceGeometry::new(&setting.model).vertex_areas(&setting.model);
        let total: f64 = areas.iter().sum();
        let levelled = |s: &[f64]| -> Vec<f64> {
            let mean = s.iter().zip(&areas).map(|(s, a)| s * a).sum::<f64>() / total;
            // Bounds scale with their mu, so that every energy may choose the scale; one that is scale invariant has a gauge.
            let scale = if o.scale_invariant { 1.0 / mean } else { 1.0 };
            s.iter().map(|s| s * scale).collect()
        };
        let best = value(&levelled(&outcomes[own].depths.s));
        for other in &outcomes {
            let least = value(&levelled(&other.depths.s));
            assert!(
                best <= least * (1.0 + 1e-4),
                "{o:?}: {best} against {least}"
            );
        }
        // Up to the gauge only an energy that is not scale invariant prefers a scale.
        let model = vec![1.0; areas.len()];
        let larger: Vec<f64> = model.iter().map(|s| 1.1 * s).collect();
        assert!(value(&model) < 1e-20);
        assert_eq!(value(&larger) < 1e-20, o.scale_invariant, "{o:?}");
        if !o.scale_invariant {
            let at = |t: f64| {
                let s: Vec<f64> = outcomes[own].depths.s.iter().map(|s| t * s).collect();
                value(&s)
            };
            assert!(at(1.001) > best && at(0.999) > best, "{best}");
        }
    }
}

#[test]
fn absolute_bounds_give_the_best_that_lies_in_the_layer_itself() {
    let setting = on_plate(bumpy(12.0), 3.0);
    let absolute = CurvatureOptions {
        group_scales: false,
        ..PAPER
    };
    let [free, held] = [PAPER, absolute].map(|o| setting.solved(Energy::Curvature(o)));
    assert_eq!(free.groups().groups.len(), 1);
    assert_eq!(held.depths.mu, [1.0]);
    assert!(held.relief.clamp_mm < 1e-6);
    // Scaled back, what a free scale gave lies in the same bounds, so that it is no better there; nor is the other in the free one's gauge.
    let hidden = hidden(&free);
    let value = |s: &[f64]| curvature_energy(&free, s, &hidden, true, false);
    let scaled = |s: &[f64], by: f64| s.iter().map(|s| s * by).collect::<Vec<f64>>();
    let areas = FaceGeometry::new(&setting.model).vertex_areas(&setting.model);
    let mean = |s: &[f64]| {
        s.iter().zip(&areas).map(|(s, a)| s * a).sum::<f64>() / areas.iter().sum::<f64>()
    };
    let back = scaled(&free.depths.s, 1.0 / free.depths.mu[0]);
    let [best, other] = [value(&held.depths.s), value(&back)];
    assert!(best <= other * (1.0 + 1e-6), "{best} against {other}");
    let levelled = scaled(&held.depths.s, 1.0 / mean(&held.depths.s));
    let [best, other] = [value(&free.depths.s), value(&levelled)];
    assert!(best <= other * (1.0 + 1e-4), "{best} against {other}");
}

#[test]
fn the_conic_form_has_the_same_optimum() {
    let settings = [
        Setting::tight(),
        on_plate(bumpy(12.0), 3.0),
        on_plate(divided_box(12.0), 6.0),
    ];
    for setting in settings {
        let [plain, conic] = [PAPER, CONIC].map(|o| setting.solved(Energy::Curvature(o)).depths);
        let [a, b] = [&plain, &conic].map(|d| d.solved.optimality.objective);
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
        let proof = conic.solved.optimality;
        let worst = proof
            .gap
            .max(proof.primal_residual)
            .max(proof.dual_residual);
        assert!(worst < 1e-6, "{proof:?}");
        let apart = plain.s.iter().zip(&conic.s).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-4);
    }
}

#[test]
fn linear_compression_is_a_linear_function_of_depth() {
    let thickness = 3.0;
    let setting = on_plate(ball(MIDDLE, 12.0, 24), thickness);
    let outcome = setting.solved(Energy::Linear);
    let (near, far) = (300.0 - thickness * 5.0 / 7.0, 300.0 + thickness * 2.0 / 7.0);
    // Of every bound: the model's depth there, and the relief's.
    let points: Vec<(f64, f64)> = outcome
        .groups()
        .bounds
        .iter()
        .map(|b| {
            let depth = far / b.upper;
            let s = b.anchor.relative_depth(&outcome.depths.s);
            (depth, depth * s / outcome.depths.mu[b.group])
        })
        .collect();
    let (lo, hi) = points.iter().fold((f64::MAX, f64::MIN), |(lo, hi), p| {
        (lo.min(p.0), hi.max(p.0))
    });
    for (depth, found) in points {
        let wanted = near + (depth - lo) / (hi - lo) * (far - near);
        // Between vertices depths are mixed as they are on flat faces.
        assert!(
            (found - wanted).abs() < 2e-3 * thickness,
            "{depth}: {found} not {wanted}"
        );
    }
    let touched = outcome.relief.depth.iter().flatten().flatten();
    let (front, back) = touched.fold((f64::MAX, f64::MIN), |(lo, hi), z| (lo.min(*z), hi.max(*z)));
    assert!(
        (front - near).abs() < 1e-4 && (back - far).abs() < 1e-4,
        "{front} {back}"
    );
}

/// A ridge that runs upwards: 24 mm wide, the left side rising by `left` mm for every mm, the right side falling by `right`.
fn ridge(left: f64, right: f64) -> TriMesh {
    let (n, m) = (24, 12);
    let mut mesh = TriMesh::default();
    for (i, j) in (0..=m).flat_map(|j| (0..=n).map(move |i| (i, j))) {
        let x = f64::from(i) - f64::from(n) / 2.0;
        let rise = if x < 0.0 {
            left * (x + 12.0)
        } else {
            left * 12.0 - right * x
        };
        mesh.vertices
            .push(MIDDLE + DVec3::new(x, -rise, f64::from(j) - 6.0));
    }
    let at = |i: i32, j: i32| VertexId((j * (n + 1) + i) as u32);
    for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        mesh.faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        mesh.faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    mesh
}

#[test]
fn gradients_that_are_not_attenuated_give_linear_compression() {
    let setting = on_plate(ridge(0.4, 0.2), 2.0);
    let [linear, gradient] = [Energy::Linear, gradient(0.0)].map(|e| setting.solved(e));
    let depths =
        |o: &Outcome| -> Vec<f64> { o.relief.depth.iter().flatten().flatten().copied().collect() };
    let apart = depths(&linear).into_iter().zip(depths(&gradient));
    let apart = apart.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(apart < 1e-5, "{apart} mm");
}

#[test]
fn gradients_are_attenuated_by_their_logarithm() {
    let (steep, gentle) = (0.8, 0.1);
    for alpha in [0.0, 3.0, 20.0] {
        let outcome = on_plate(ridge(steep, gentle), 1.0).solved(gradient(alpha));
        let depth = |x: f64| {
            let near = |v: &DVec3| (v.x - x).abs() < 1e-9 && (v.z - MIDDLE.z).abs() < 1e-9;
            let v = outcome
                .target()
                .mesh
                .vertices
                .iter()
                .position(near)
                .expect("a vertex");
            outcome.target().depth[v] * outcome.depths.s[v] / outcome.depths.mu[0]
        };
        // Away from the ridge and from the rim.
        let found = (depth(-8.0) - depth(-4.0)) / (depth(8.0) - depth(4.0));
        let attenuated = |g: f64| {
            if alpha > 0.0 {
                (alpha * g).ln_1p() / alpha
            } else {
                g
            }
        };
        let wanted = attenuated(steep) / attenuated(gentle);
        // The eye is at 30 times the ridge's height: slopes seen from it differ a little from the plane's.
        assert!(
            (found / wanted - 1.0).abs() < 0.12,
            "{alpha}: {found} not {wanted}"
        );
    }
}
