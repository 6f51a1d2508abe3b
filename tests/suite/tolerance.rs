//! Tolerance of eyes: closed forms against constructions of their own, and against rays at finished solids.

use crate::shapes::{
    EYE, MIDDLE, ORANGE, Outcome, Setting, ball, flat_layer, pillar, prism, view, wavy,
};
use crate::steps::STEPS;
use glam::{DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::carve::{Operand, carve};
use pillarforest::certify::tolerance::{
    EYES_MM, ONE_PICTURE_RAD, Tolerance, Way, confirm, opened, tolerance,
};
use pillarforest::index::SupportId;
use pillarforest::mimic::{Energy, FaceWeight, NormalOptions};
use pillarforest::relief::relief;
use pillarforest::scene::defaults;
use pillarforest::steps::{UNSEEN_RAD, torn};
use pillarforest::support::{Datum, Support, SupportKind};
use pillarforest::viewmap::Image;

const NORMAL: NormalOptions = NormalOptions {
    weight: FaceWeight::Area,
    ordering: true,
    reweight: 0,
};

/// An upright block between two corners on the ground.
fn block(name: &str, lo: DVec2, hi: DVec2) -> Support {
    let profile = vec![lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    Support {
        name: name.into(),
        mesh: prism(&profile, 0.0, 40.0),
        kind: SupportKind::Pillar {
            axis: (lo + hi) / 2.0,
            profile,
            bottom: 0.0,
            top: 40.0,
            round: false,
        },
        layer: Some(flat_layer(2.0, 1.0, 0.5)),
    }
}

impl Setting {
    fn in_one_piece(&self) -> Outcome {
        self.solved(Energy::Normal(NORMAL))
    }
}

impl Outcome {
    fn tolerance(&self) -> Tolerance {
        let Image { view, field, .. } = self.sight.image;
        let (map, target) = (self.map(), self.target());
        tolerance(view, map, target, &self.relief, field.supports)
    }

    /// Depths of a flat relief on one support.
    fn depth_on(&self, support: SupportId) -> f64 {
        let cells = self.map().cells.iter().zip(&self.relief.depth);
        let depths = cells.filter(|(c, _)| c.support == Some(support));
        let depths: Vec<f64> = depths.filter_map(|(_, d)| *d).flatten().collect();
        assert!(depths.iter().all(|d| (d - depths[0]).abs() < 1e-3));
        depths[0]
    }
}

/// A flat plate seen on two blocks, the left one nearer. From the eye the cut between them is upright, `aside` millimetres to the
/// right of the middle where the left block begins, 138 mm away.
fn two_blocks(aside: f64) -> Outcome {
    let model = prism(
        &[
            DVec2::new(-9.0, 0.0),
            DVec2::new(9.0, 0.0),
            DVec2::new(9.0, 2.0),
            DVec2::new(-9.0, 2.0),
        ],
        14.0,
        26.0,
    );
    let left = block("left", DVec2::new(-12.0, -12.0), DVec2::new(aside, -4.0));
    let right = block("right", DVec2::new(-2.0, 6.0), DVec2::new(16.0, 14.0));
    Setting::new(model, vec![left, right]).in_one_piece()
}

/// The horizontal angle between two points on one level ray, whose direction leans from the y axis by `lean`, at distances
/// `a` and `b` along the ground, from an eye that moved by `e`.
fn seen_apart(lean: f64, [a, b]: [f64; 2], e: DVec2) -> f64 {
    let u = DVec2::new(lean.sin(), lean.cos());
    (a * u - e).angle_to(b * u - e).abs()
}

/// The movement along or against `way` at which those points are `angle` apart.
fn moved_until(lean: f64, distances: [f64; 2], way: DVec2, angle: f64) -> f64 {
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        let open = [middle, -middle].map(|m| seen_apart(lean, distances, m * way));
        if open[0].max(open[1]) < angle {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn near(found: f64, wanted: f64, share: f64) {
    assert!(
        (found / wanted - 1.0).abs() < share,
        "{found} instead of {wanted}"
    );
}

#[test]
fn movements_and_distance_are_those_of_two_points_on_a_ray() {
    let aside = 4.0;
    let seen = two_blocks(aside);
    let lean = (aside / 138.0).atan();
    // Depths are along y; at the ends of the cut the rays are longer by 0.1 %.
    let [a, b] = [0, 1].map(|s| seen.depth_on(SupportId(s)) / lean.cos());
    assert!(b - a > 15.0, "{a} {b}");
    let found = seen.tolerance();
    for (angle, movement) in [
        (UNSEEN_RAD, found.eye_tolerance_mm),
        (ONE_PICTURE_RAD, found.one_picture_mm),
    ] {
        let wanted = |way| moved_until(lean, [a, b], way, angle);
        near(movement.side.unwrap(), wanted(DVec2::X), 0.01);
        near(movement.fore.unwrap(), wanted(DVec2::Y), 0.01);
        assert!(movement.up.is_none(), "an upright cut slides: {movement:?}");
    }
    let wide = EYES_MM * lean.cos() * (b - a) / ONE_PICTURE_RAD;
    let back = -(a + b) / 2.0 + ((b - a).powi(2) / 4.0 + wide).sqrt();
    let wanted = EYE.distance(MIDDLE) + back;
    near(found.stereo_distance_mm.unwrap(), wanted, 0.003);
    for worst in &found.worst_cuts {
        let mut names = worst.supports.clone();
        names.sort();
        assert_eq!(names, ["left", "right"]);
        assert!((worst.place_mm[1] - (EYE.y + seen.depth_on(SupportId(0)))).abs() < 0.01);
    }
}

#[test]
fn the_gap_beside_a_nearer_support_is_as_wide_as_a_printed_line() {
    let seen = two_blocks(4.0);
    let operand = || Operand::Relief {
        sight: &seen.sight,
        relief: &seen.relief,
    };
    let volume = |line: f64| {
        let forest = carve(seen.sight.image.field, &[operand()], line).expect("a forest");
        forest.whole.volume_mm3()
    };
    let [fine, usual, coarse] = [0.2, defaults::PRINTER.nozzle, 0.8].map(volume);
    let (less, much_less) = (fine - usual, usual - coarse);
    assert!(
        less > 0.0 && (1.8..2.2).contains(&(much_less / less)),
        "{less} {much_less}"
    );
}

#[test]
fn rays_at_the_solid_measure_what_the_closed_form_says() {
    let seen = two_blocks(4.0);
    let operand = Operand::Relief {
        sight: &seen.sight,
        relief: &seen.relief,
    };
    let forest =
        carve(seen.sight.image.field, &[operand], defaults::PRINTER.nozzle).expect("a forest");
    let mesh = forest.whole.mesh();
    let bvh = Bvh::new(mesh);
    let mut found = seen.tolerance();
    confirm(&mut found, &seen.map().plane, mesh, &bvh);
    assert_eq!(found.worst_cuts.len(), 4);
    for worst in &found.worst_cuts {
        for both in [worst.gap.unwrap(), worst.overlap.unwrap()] {
            near(both.measured_arcmin, both.predicted_arcmin, 0.04);
        }
        if worst.movement == Way::Side {
            near(
                worst.gap.unwrap().predicted_arcmin,
                worst.angle_arcmin,
                0.01,
            );
        }
    }
    let worst = &found.worst_cuts[0];
    let e = worst.moved_mm * worst.movement.axis(&seen.map().plane);
    for share in [1.0, 0.5] {
        let [one, other] = [share, -share].map(|s| opened(&worst.cut, EYE, s * e, mesh, &bvh));
        near(one.gap.max(other.gap), share * UNSEEN_RAD, 0.04);
        near(one.overlap.max(other.overlap), share * UNSEEN_RAD, 0.04);
        // One way the cut opens, the other way it closes.
        assert!(one.gap.min(other.gap) < 0.1 * UNSEEN_RAD);
    }
    let still = opened(&worst.cut, EYE, DVec3::ZERO, mesh, &bvh);
    assert_eq!((still.gap, still.overlap), (0.0, 0.0));
}

#[test]
fn a_model_in_full_depth_opens_nowhere() {
    let mut setting = Setting::roomy();
    // Its waves hide parts of each other.
    setting.model = wavy(12.0, 0.25);
    let found = setting.in_one_piece().tolerance();
    let far = |x: Option<f64>| x.is_none_or(|x| x > 20.0);
    let one = found.one_picture_mm;
    assert!(far(one.side) && far(one.up) && far(one.fore), "{found:?}");
}

#[test]
fn a_support_alone_without_tears_has_no_cut() {
    let setting = Setting::new(
        ball(MIDDLE, 3.0, 12),
        vec![pillar(DVec2::ZERO, 5.0, 48, Datum::Plane)],
    );
    let found = setting.in_one_piece().tolerance();
    assert_eq!(found.eye_tolerance_mm, Default::default());
    assert_eq!(found.stereo_distance_mm, None);
    assert!(found.worst_cuts.is_empty());
}

#[test]
fn tears_open_as_late_as_steps_say() {
    let mut setting = Setting::tight();
    let mut wide = pillar(DVec2::ZERO, 15.0, 64, Datum::Plane);
    wide.layer = setting.supports[0].layer;
    setting.supports = vec![wide];
    let sight = setting.sight();
    let torn = torn(&STEPS, NORMAL, &sight).expect("a torn surface");
    let relief = relief(&torn.sight, &torn.depths);
    let Image { map, target, .. } = &sight.image;
    let view = view("ball", EYE, setting.model.clone(), ORANGE);
    let found = tolerance(&view, map, target, &relief, &setting.supports);
    let of_steps = torn.summary.tolerance_mm.expect("tears");
    let movement = found.eye_tolerance_mm;
    let [side, up, fore] = [movement.side, movement.up, movement.fore].map(Option::unwrap);
    // Moving square to the steepest tear is the worst; it leans somewhere between upright and level.
    for any in [side, up, fore] {
        assert!(any > 0.98 * of_steps, "{movement:?} against {of_steps}");
    }
    assert!(
        side.min(up) < 2.0 * of_steps,
        "{movement:?} against {of_steps}"
    );
}
