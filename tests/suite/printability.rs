//! Print checks against bodies whose figures are known.

use super::shapes::{base, boxes, pillar, prism, ring};
use glam::{DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::certify::printability::{Apart, PrintCheck, PrintLimits, Printed, printability};
use pillarforest::geom::inscribed;
use pillarforest::mesh::{Solid, TriMesh};
use pillarforest::support::{Datum, Support, SupportKind};
use pillarforest::words::print::note;

fn limits() -> PrintLimits {
    PrintLimits::printed(0.4, [100.0, 120.0, 80.0], 10.0, 30.0)
}

fn checks(mesh: TriMesh, supports: &[Support], bodies: &[(String, DVec3)]) -> Vec<PrintCheck> {
    let whole = Solid::new(mesh).unwrap();
    let standing: Vec<TriMesh> = supports.iter().map(|_| whole.mesh().clone()).collect();
    let bvh = Bvh::new(whole.mesh());
    let printed = Printed {
        supports,
        whole: &whole,
        bvh: &bvh,
        standing: &standing,
        bodies,
    };
    printability(&printed, &limits())
}

/// Without a base pillars stand for themselves; what floats does not, however few parts there are.
#[test]
fn what_floats_is_loose_even_where_pillars_stand_apart() {
    let post = |x: f64| (v(x, 0.0, 0.0), v(x + 10.0, 10.0, 30.0));
    let bridge = (v(9.0, 0.0, 5.0), v(21.0, 10.0, 25.0));
    let floating = (v(0.0, 30.0, 12.0), v(4.0, 34.0, 16.0));
    let loose = |bodies: &[(DVec3, DVec3)], apart: Option<Apart>| {
        let whole = Solid::new(boxes(bodies)).unwrap();
        let printed = Printed {
            supports: &[],
            whole: &whole,
            bvh: &Bvh::new(whole.mesh()),
            standing: &[],
            bodies: &[],
        };
        let limits = PrintLimits {
            apart,
            ..PrintLimits::NONE
        };
        found(&printability(&printed, &limits), "part")
    };
    let two = Some(Apart {
        parts: 2,
        foot: 0.0,
    });
    assert!(loose(&[post(0.0), post(20.0)], two).ok);
    let third = loose(&[post(0.0), post(20.0), floating], two);
    assert!(!third.ok && third.place[2] == 14.0, "{third:?}");
    // As many parts as pillars, but one of them is none.
    let joined = loose(&[post(0.0), bridge, post(20.0), floating], two);
    assert!(!joined.ok && joined.place[2] == 14.0, "{joined:?}");
    let three = [post(0.0), post(20.0), post(40.0)];
    assert!(!loose(&three, two).ok, "more than there are supports");
    assert!(!loose(&[post(0.0), post(20.0)], None).ok);
}

fn found(checks: &[PrintCheck], name: &str) -> PrintCheck {
    let check = checks.iter().find(|c| c.finding.name() == name);
    check.unwrap_or_else(|| panic!("no {name}")).clone()
}

fn of(mesh: TriMesh, name: &str) -> PrintCheck {
    found(&checks(mesh, &[], &[]), name)
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-5, "{a}, expected {b}");
}

#[test]
fn a_thin_plate_is_found_with_its_thickness() {
    for (thickness, value, ok) in [(0.5, 0.5, false), (0.8, 0.8, true), (5.0, 0.9, true)] {
        let wall = of(boxes(&[(DVec3::ZERO, v(20.0, thickness, 20.0))]), "wall");
        near(wall.value_mm, value);
        near(wall.wanted_mm, 0.9);
        near(wall.limit_mm, 0.65);
        assert_eq!(wall.ok, ok, "{wall:?}");
    }
}

#[test]
fn a_thin_fin_on_a_block_is_a_wall_and_the_place_is_on_it() {
    let block = (DVec3::ZERO, v(20.0, 20.0, 20.0));
    let fin = (v(19.0, 9.0, 0.0), v(30.0, 9.4, 20.0));
    let wall = of(boxes(&[block, fin]), "wall");
    near(wall.value_mm, 0.4);
    assert!(!wall.ok);
    assert!(wall.place[0] > 20.0, "{wall:?}");
}

#[test]
fn a_sharp_lip_and_a_small_film_are_no_walls() {
    let wedge = [
        DVec2::ZERO,
        DVec2::new(20.0, 0.0),
        DVec2::new(20.0, 20.0 * 0.53),
    ];
    let wall = of(prism(&wedge, 0.0, 40.0), "wall");
    assert!(wall.ok && wall.value_mm >= 0.9, "{wall:?}");
    // 16 square millimetres of film: told, but not missed.
    let block = (DVec3::ZERO, v(20.0, 20.0, 20.0));
    let film = (v(19.0, 9.0, 8.0), v(26.0, 9.1, 11.0));
    let wall = of(boxes(&[block, film]), "wall");
    assert!(wall.ok, "{wall:?}");
    assert!(
        note(&wall, "pillar").contains("will not be printed"),
        "{wall:?}"
    );
}

#[test]
fn the_gap_between_two_pillars_is_measured() {
    for (gap, ok) in [(0.15, true), (0.05, false)] {
        let supports = [
            pillar(DVec2::new(-5.0 - gap / 2.0, 0.0), 5.0, 4, Datum::Plane),
            pillar(DVec2::new(5.0 + gap / 2.0, 0.0), 5.0, 4, Datum::Plane),
        ];
        let left = (v(-10.0, -5.0, -0.5), v(-gap / 2.0, 5.0, 40.0));
        let right = (v(gap / 2.0, -5.0, -0.5), v(10.0, 5.0, 40.0));
        let plate = (v(-12.0, -7.0, -3.0), v(12.0, 7.0, 0.0));
        let all = checks(boxes(&[left, right, plate]), &supports, &[]);
        let check = found(&all, "gap");
        near(check.value_mm, gap);
        assert_eq!(check.ok, ok, "{check:?}");
        near(check.wanted_mm, 0.2);
        assert!(check.place[0].abs() < gap, "{check:?}");
    }
}

#[test]
fn an_arm_reaches_as_far_as_it_stands_out_and_a_bridge_half_as_far() {
    let post = (DVec3::ZERO, v(10.0, 10.0, 30.0));
    let arm = (v(9.0, 0.0, 20.0), v(17.0, 10.0, 30.0));
    let check = of(boxes(&[post, arm]), "overhang");
    near(check.value_mm, 7.0);
    near(check.place[0], 17.0);
    near(check.place[2], 20.0);
    assert!(check.ok && check.value_mm > check.wanted_mm);
    let other = (v(30.0, 0.0, 0.0), v(40.0, 10.0, 30.0));
    let bridge = (v(9.0, 0.0, 20.0), v(31.0, 10.0, 30.0));
    let check = of(boxes(&[post, other, bridge]), "overhang");
    assert!((9.5..10.001).contains(&check.value_mm), "{check:?}");
    let plain = of(boxes(&[post]), "overhang");
    near(plain.value_mm, 0.0);
    let far = of(
        boxes(&[post, (v(9.0, 0.0, 20.0), v(22.0, 10.0, 30.0))]),
        "overhang",
    );
    near(far.value_mm, 12.0);
    assert!(!far.ok);
}

#[test]
fn what_starts_in_mid_air_reaches_its_own_extent() {
    let post = (DVec3::ZERO, v(10.0, 10.0, 30.0));
    let arm = (v(9.0, 0.0, 20.0), v(17.0, 10.0, 30.0));
    // A tooth below the arm holds it once it is printed, but its own end is held by nothing.
    let tooth = (v(13.0, 4.0, 10.0), v(16.0, 8.0, 21.0));
    let check = of(boxes(&[post, arm, tooth]), "overhang");
    near(check.value_mm, 5.0);
    near(check.place[2], 10.0);
    let short = (v(9.0, 0.0, 20.0), v(14.0, 10.0, 30.0));
    let low = (v(13.0, 0.0, 10.0), v(14.0, 10.0, 21.0));
    near(
        of(boxes(&[post, short, low]), "overhang").value_mm,
        101_f64.sqrt(),
    );
}

#[test]
fn a_slim_pillar_and_a_small_bed_fail() {
    let mut slim = pillar(DVec2::ZERO, 1.0, 4, Datum::Plane);
    if let SupportKind::Pillar { top, .. } = &mut slim.kind {
        *top = 90.0;
    }
    let mesh = prism(&ring(DVec2::ZERO, 1.0, 4), 0.0, 90.0);
    let all = checks(mesh, &[slim], &[]);
    let check = found(&all, "slenderness");
    near(check.value_mm, 2f64.sqrt());
    near(check.wanted_mm, 3.0);
    assert!(!check.ok);
    let bed = found(&all, "bed");
    near(bed.value_mm, 90.0);
    near(bed.wanted_mm, 80.0);
    assert!(!bed.ok);
    // Turned it fits.
    let bed = of(boxes(&[(DVec3::ZERO, v(110.0, 90.0, 10.0))]), "bed");
    assert!(bed.ok, "{bed:?}");
    let bed = of(boxes(&[(DVec3::ZERO, v(110.0, 104.0, 10.0))]), "bed");
    near(bed.value_mm, 104.0);
    assert!(!bed.ok);
    // In pieces it is the pieces that count.
    let bodies = [("plate-1".to_owned(), v(99.0, 50.0, 5.0))];
    let large = boxes(&[(DVec3::ZERO, v(300.0, 300.0, 5.0))]);
    assert!(found(&checks(large, &[], &bodies), "bed").ok);
}

#[test]
fn loose_parts_and_hollows_are_told_with_their_size() {
    let whole = (DVec3::ZERO, v(20.0, 20.0, 20.0));
    let crumb = (v(30.0, 0.0, 0.0), v(32.0, 2.0, 1.0));
    let part = of(boxes(&[whole, crumb]), "part");
    near(part.value_mm, 3.0);
    near(part.place[0], 31.0);
    assert!(!part.ok);
    let mut hollow = boxes(&[whole]);
    let mut inner = boxes(&[(v(5.0, 5.0, 5.0), v(11.0, 8.0, 7.0))]);
    inner.faces.iter_mut().for_each(|f| f.swap(0, 1));
    hollow.append(&inner);
    let all = checks(hollow, &[], &[]);
    near(found(&all, "cavity").value_mm, 7.0);
    assert!(!found(&all, "cavity").ok && found(&all, "part").ok);
}

#[test]
fn the_neck_of_a_pillar_carved_from_two_sides_is_its_core() {
    let supports = [pillar(DVec2::ZERO, 5.0, 4, Datum::Plane)];
    let lower = (v(-4.0, -4.0, 0.0), v(4.0, 4.0, 15.0));
    let neck = (v(-4.0, -0.2, 14.0), v(4.0, 0.2, 26.0));
    let upper = (v(-4.0, -4.0, 25.0), v(4.0, 4.0, 40.0));
    let core = found(
        &checks(boxes(&[lower, neck, upper]), &supports, &[]),
        "core",
    );
    assert!((core.value_mm - 0.4).abs() < 0.011, "{core:?}");
    near(core.wanted_mm, 0.5);
    assert!(!core.ok);
    assert!(note(&core, "pillar").contains("3.2 mm2"), "{core:?}");
    assert!((15.0..25.0).contains(&core.place[2]), "{core:?}");
}

#[test]
fn the_inscribed_circle_agrees_with_closed_forms() {
    let sides = |p: &[DVec2]| -> Vec<[DVec2; 2]> {
        (0..p.len()).map(|k| [p[k], p[(k + 1) % p.len()]]).collect()
    };
    let circle = |p: &[DVec2]| inscribed(&sides(p), 1e-4, f64::INFINITY).unwrap();
    let triangle = [DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 3.0)];
    let found = circle(&triangle);
    assert!((found.radius - 1.0).abs() < 1e-4, "{found:?}");
    assert!(found.centre.distance(DVec2::ONE) < 0.02, "{found:?}");
    let hexagon = ring(DVec2::new(3.0, -7.0), 2.0, 6);
    assert!((circle(&hexagon).radius - 3f64.sqrt()).abs() < 1e-4);
    let needle = [
        DVec2::ZERO,
        DVec2::new(20.0, 0.0),
        DVec2::new(20.0, 0.1),
        DVec2::new(0.0, 0.1),
    ];
    assert!((circle(&needle).radius - 0.05).abs() < 2e-3);
    // A ring: the circle lies between the outer and the inner outline.
    let mut holed = sides(&ring(DVec2::ZERO, 10.0, 64));
    holed.extend(sides(&ring(DVec2::ZERO, 6.0, 64)));
    let found = inscribed(&holed, 1e-4, f64::INFINITY).unwrap();
    assert!((found.radius - 2.0).abs() < 0.02, "{found:?}");
    assert!(inscribed(&[], 1e-4, 1.0).is_none());
    assert!(inscribed(&sides(&[DVec2::ZERO, DVec2::X]), 1e-4, 1.0).is_none());
}

#[test]
fn the_same_solid_gives_the_same_figures_on_any_number_of_threads() {
    let supports = [base(ring(DVec2::ZERO, 32.0, 96))];
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mesh = super::shapes::bumpy(12.0);
        pool.install(|| checks(mesh, &supports, &[]))
    };
    assert_eq!(run(1), run(4));
}
