//! Coverage and conflicts: against closed forms, samples of points, and small forests whose answers are known.

use crate::shapes::{
    BLUE, EYE, MIDDLE, ORANGE, ball, base, bumpy, field, flat_layer, pillar, prism, ring, sighted,
    view,
};
use glam::{DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::carve::{Forest, Operand, carve};
use pillarforest::certify::conflicts::{self, Finished, Sharpness, Sighted, Trouble};
use pillarforest::certify::coverage::{Cause, Coverage, coverage};
use pillarforest::contest::{CONTACT_MM, Contested, Frustum, Settlement, contested, settle};
use pillarforest::diag::Diagnostic;
use pillarforest::geom::SQUARE_ARCMIN;
use pillarforest::index::{CellId, ViewId};
use pillarforest::kinds;
use pillarforest::mesh::{Solid, TriMesh};
use pillarforest::relief::{Relief, relief};
use pillarforest::scene::defaults;
use pillarforest::sight::Sight;
use pillarforest::support::{Datum, Support, SupportKind};
use pillarforest::viewmap::SupportField;
use pillarforest::words;
use pillarforest::words::contest::refused;

fn sight(
    name: &str,
    eye: DVec3,
    model: TriMesh,
    field: &'static SupportField<'static>,
) -> Sight<'static> {
    sighted(view(name, eye, model, ORANGE), field)
}

/// Width of a printed line.
const LINE_MM: f64 = defaults::PRINTER.nozzle;
const SHARPNESS: Sharpness = Sharpness {
    line: LINE_MM,
    seen: 1.0,
};

fn coverage_of(sight: &Sight) -> Coverage {
    coverage(sight, &["a", "b"], &[], 0.0)
}

fn carried_arcmin2(sight: &Sight) -> f64 {
    let sum: f64 = sight.groups.groups.iter().map(|g| g.solid_angle_sr).sum();
    sum * SQUARE_ARCMIN
}

fn settled(sights: &[Sight], rule: Contested) -> Settlement {
    settle(sights, rule).expect("no errors by this rule")
}

/// Carries a settlement out.
fn give_up<'a>(sights: Vec<Sight<'a>>, settlement: &Settlement) -> Vec<Sight<'a>> {
    let lost = settlement.lost.iter().cloned();
    sights
        .into_iter()
        .zip(lost)
        .map(|(s, l)| s.without(l))
        .collect()
}

/// Numbers from 0 to 1, the same at every run (Numerical Recipes' generator).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, half: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| half * (2.0 * self.next() - 1.0)))
    }
}

/// A frustum as numbers, for tests that know nothing of its faces.
struct Body {
    eye: DVec3,
    rays: Vec<DVec3>,
    normal: DVec3,
    near: f64,
    far: f64,
}

impl Body {
    /// Near the origin, as thin as cells or as wide as pillars.
    fn random(numbers: &mut Numbers) -> Self {
        let eye = numbers.within(100.0) + DVec3::new(150.0, 0.0, 0.0) * numbers.next();
        let normal = (numbers.within(3.0) - eye).normalize();
        let (side, up) = normal.any_orthonormal_pair();
        let wide = 10f64.powf(-2.5 + 2.0 * numbers.next());
        let first = 6.3 * numbers.next();
        let count = if numbers.next() < 0.5 { 3 } else { 4 };
        let rays = (0..count).map(|k| {
            let turn = first + f64::from(k) * std::f64::consts::TAU / f64::from(count);
            normal + wide * (turn.cos() * side + turn.sin() * up)
        });
        let far = eye.length() + 4.0 * numbers.next();
        let near = if numbers.next() < 0.3 { 0.0 } else { far - 6.0 };
        Self {
            eye,
            rays: rays.collect(),
            normal,
            near,
            far,
        }
    }

    fn frustum(&self) -> Frustum {
        Frustum::new(self.eye, &self.rays, self.normal, self.near, self.far)
    }

    /// How deep a point lies inside, millimetres; negative outside.
    fn depth_of(&self, p: DVec3) -> f64 {
        let d = p - self.eye;
        let along = d.dot(self.normal);
        let n = self.rays.len();
        let sides = (0..n).map(|k| {
            let inwards = self.rays[k].cross(self.rays[(k + 1) % n]).normalize();
            inwards.dot(d) * inwards.dot(self.normal).signum()
        });
        sides.fold((along - self.near).min(self.far - along), f64::min)
    }

    fn point(&self, numbers: &mut Numbers) -> DVec3 {
        let mut weights: Vec<f64> = self.rays.iter().map(|_| numbers.next()).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|w| *w /= sum);
        let ray: DVec3 = self.rays.iter().zip(&weights).map(|(r, w)| *r * *w).sum();
        // Mostly where bodies meet: near the far plane.
        let z = self.far - (self.far - self.near) * numbers.next().powi(2);
        self.eye + z * ray
    }
}

#[test]
fn frusta_meet_where_points_of_both_are_found() {
    let mut numbers = Numbers(7);
    let (mut met, mut unproved, mut apart) = (0, 0, 0);
    for _ in 0..1500 {
        let (a, b) = (Body::random(&mut numbers), Body::random(&mut numbers));
        let meets = a.frustum().meets(&b.frustum());
        assert_eq!(meets, b.frustum().meets(&a.frustum()));
        let deepest = (0..400)
            .flat_map(|_| {
                let (p, q) = (a.point(&mut numbers), b.point(&mut numbers));
                [
                    a.depth_of(q).min(b.depth_of(q)),
                    a.depth_of(p).min(b.depth_of(p)),
                ]
            })
            .fold(f64::NEG_INFINITY, f64::max);
        if meets {
            met += 1;
            unproved += usize::from(deepest <= 0.0);
        } else {
            apart += 1;
            assert!(deepest <= CONTACT_MM, "a common point {deepest} mm inside");
        }
    }
    assert!(met > 200 && apart > 200, "{met} met, {apart} did not");
    // Bodies that share a sliver give few samples the chance to fall into it.
    assert!(
        unproved * 10 < met,
        "{unproved} of {met} without a common point"
    );
}

#[test]
fn frusta_that_touch_do_not_meet() {
    let rays = [(-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
        .map(|(x, z)| DVec3::new(0.01 * x, 1.0, 0.01 * z));
    let upper = Frustum::new(EYE, &[rays[0], rays[1], rays[2]], DVec3::Y, 140.0, 150.0);
    let lower = Frustum::new(EYE, &[rays[1], rays[0], rays[3]], DVec3::Y, 145.0, 155.0);
    assert!(!upper.meets(&lower), "they share a side's plane");
    let behind = Frustum::new(EYE, &[rays[0], rays[1], rays[2]], DVec3::Y, 150.0, 160.0);
    assert!(!upper.meets(&behind), "they share a face");
    let raised = EYE + DVec3::new(0.0, 0.0, 2e-6);
    let into = Frustum::new(raised, &[rays[1], rays[0], rays[3]], DVec3::Y, 145.0, 155.0);
    assert!(
        upper.meets(&into),
        "they overlap by two millionths of a millimetre"
    );
}

/// View "b" looks along -x at a thin pillar beside the sight of view "a"; its layer stands out into that sight, up to x = -3.
fn crossing() -> Vec<Support> {
    let mut thin = pillar(DVec2::new(-9.0, -60.0), 1.5, 48, Datum::Plane);
    thin.layer = Some(flat_layer(6.0, 0.5, 0.2));
    vec![pillar(DVec2::ZERO, 14.0, 96, Datum::Plane), thin]
}

#[test]
fn a_layer_in_the_sight_of_another_view_takes_just_the_rays_it_meets() {
    let supports = crossing();
    let field = field(&supports);
    let block = prism(
        &[
            DVec2::new(-20.0, -66.0),
            DVec2::new(-15.0, -66.0),
            DVec2::new(-15.0, -54.0),
            DVec2::new(-20.0, -54.0),
        ],
        2.0,
        38.0,
    );
    let sights = vec![
        sight("b", DVec3::new(150.0, -60.0, 20.0), block, field),
        sight("a", EYE, ball(MIDDLE, 12.0, 24), field),
    ];
    let settlement = settled(&sights, Contested::First);
    assert!(settlement.lost[0].is_empty());
    // The layer's near end, 153 mm from the eye of "b", is as wide as the pillar's outline there.
    let half = 153.0 * (1.5f64 / 159.0).asin().tan();
    let border = -3.0 / (90.0 + half);
    let lost: Vec<CellId> = settlement.lost[1].iter().map(|l| l.cell).collect();
    let map = &sights[1].image.map;
    let mut tested = [0, 0];
    let of_cell = &sights[1].groups.of_cell;
    for (c, group) in CellId::all(of_cell.len()).zip(of_cell) {
        let left = map
            .triangle(c)
            .iter()
            .map(|q| q.x)
            .fold(f64::INFINITY, f64::min);
        if group.is_none() || (left - border).abs() < 2e-4 {
            continue;
        }
        let taken = lost.binary_search(&c).is_ok();
        assert_eq!(taken, left < border, "cell from {left}, border {border}");
        tested[usize::from(taken)] += 1;
    }
    assert!(tested[0] > 200 && tested[1] > 100, "{tested:?}");
    let contest = &settlement.contests[1][0];
    assert_eq!(
        (contest.with_view.as_str(), contest.lost_by.as_str()),
        ("b", "a")
    );
    assert_eq!(contest.with_support, supports[1].name);
    let sights = give_up(sights, &settlement);
    assert_eq!(contested(&sights), [0.0, 0.0]);
    let coverage = coverage_of(&sights[1]);
    assert!(coverage.gaps.iter().all(|g| g.cause == Cause::OtherView));
    let gaps: f64 = coverage.gaps.iter().map(|g| g.arcmin2).sum();
    assert!((gaps / contest.arcmin2 - 1.0).abs() < 1e-9);
}

/// Two views of one round pillar, a quarter turn apart: a small ball for "a", a large one for "b".
fn sharing(field: &'static SupportField<'static>, heights: [f64; 2]) -> Vec<Sight<'static>> {
    let at = |z: f64| DVec3::new(0.0, 0.0, z);
    let side = DVec3::new(150.0, 0.0, 20.0);
    vec![
        sight("a", EYE, ball(at(heights[0]), 4.0, 12), field),
        sight("b", side, ball(at(heights[1]), 9.0, 16), field),
    ]
}

#[test]
fn views_at_different_heights_of_one_pillar_do_not_meet() {
    let supports = [pillar(DVec2::ZERO, 10.0, 64, Datum::Plane)];
    let field = field(&supports);
    let settlement = settled(&sharing(field, [33.0, 15.0]), Contested::First);
    assert_eq!(settlement.contests, [vec![], vec![]]);
}

#[test]
fn contested_surface_goes_to_the_first_or_to_the_larger_or_to_nobody() {
    let supports = [pillar(DVec2::ZERO, 10.0, 64, Datum::Plane)];
    let field = field(&supports);
    for (rule, loser) in [(Contested::First, 1), (Contested::Largest, 0)] {
        let sights = sharing(field, [20.0, 20.0]);
        let before = [0, 1].map(|v: usize| carried_arcmin2(&sights[v]));
        let settlement = settled(&sights, rule);
        let names = ["a", "b"];
        assert!(settlement.lost[1 - loser].is_empty(), "{rule:?}");
        assert!(!settlement.lost[loser].is_empty(), "{rule:?}");
        for (own, contests) in settlement.contests.iter().enumerate() {
            assert_eq!(contests.len(), 1);
            assert_eq!(contests[0].with_view, names[1 - own]);
            assert_eq!(contests[0].lost_by, names[loser]);
        }
        let sights = give_up(sights, &settlement);
        assert_eq!(contested(&sights), [0.0, 0.0], "{rule:?}");
        let lost = before[loser] - carried_arcmin2(&sights[loser]);
        let coverage = coverage_of(&sights[loser]);
        let owned = coverage.gaps.iter().filter(|g| g.cause == Cause::OtherView);
        let told: f64 = owned.map(|g| g.arcmin2).sum();
        assert!((told / lost - 1.0).abs() < 1e-9, "{told} told, {lost} lost");
        assert_eq!(coverage.gaps[0].view.as_deref(), Some(names[1 - loser]));
        let told = words::coverage::warnings(names[loser], &coverage, "pillar");
        assert!(told[0].message.contains(&supports[0].name), "{told:?}");
    }
    let sights = sharing(field, [20.0, 20.0]);
    let errors = settle(&sights, Contested::Error).expect_err("contested");
    assert_eq!(errors.len(), 1);
    let message = refused(&errors[0]).message;
    for part in [
        "\"a\"",
        "\"b\"",
        &supports[0].name,
        "square arc-minutes",
        " mm",
    ] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn opposite_reliefs_on_the_faces_of_one_plate_do_not_meet() {
    let plate = |thick: f64| {
        let mut support = pillar(DVec2::ZERO, thick, 4, Datum::Surface);
        // A square on its edge, turned to show a face to both eyes.
        let half = thick / 2.0;
        let profile = [(-30.0, -half), (30.0, -half), (30.0, half), (-30.0, half)];
        let profile: Vec<DVec2> = profile.iter().map(|p| DVec2::from(*p)).collect();
        support.mesh = prism(&profile, 0.0, 40.0);
        let SupportKind::Pillar { profile: own, .. } = &mut support.kind else {
            panic!("a pillar")
        };
        *own = profile;
        support
    };
    let meets = |thick: f64| {
        let supports = [plate(thick)];
        let field = field(&supports);
        let model = || ball(MIDDLE, 8.0, 12);
        let sights = [
            sight("a", EYE, model(), field),
            sight("b", DVec3::new(0.0, 150.0, 20.0), model(), field),
        ];
        contested(&sights).iter().sum::<f64>() > 0.0
    };
    // A layer ends 1 mm behind its face, the other's backing 1.8 mm or less behind the middle plane.
    assert!(!meets(6.0));
    assert!(meets(3.0));
}

#[test]
fn a_pillar_that_is_too_short_is_named_with_what_it_lacks() {
    let supports = [pillar(DVec2::ZERO, 5.0, 192, Datum::Plane)];
    let field = field(&supports);
    // A strip 4 mm wide and 25 mm nearer than the axis, whose image ends above the pillar.
    let strip = [(-2.0, -25.0), (2.0, -25.0), (2.0, -24.0), (-2.0, -24.0)];
    let strip: Vec<DVec2> = strip.iter().map(|p| DVec2::from(*p)).collect();
    let sight = sight("a", EYE, prism(&strip, 14.0, 44.0), field);
    let coverage = coverage_of(&sight);
    assert_eq!(coverage.gaps.len(), 1, "{:?}", coverage.gaps);
    let gap = &coverage.gaps[0];
    assert_eq!(gap.cause, Cause::PillarTooShort);
    assert_eq!(gap.support.as_deref(), Some(supports[0].name.as_str()));
    // Where the ray at x / y = u enters the circle of radius 5 around (0, 150), as the eye sees it.
    let enter = |u: f64| {
        let a = 1.0 + u * u;
        (150.0 - (150.0f64.powi(2) - a * (150.0f64.powi(2) - 25.0)).sqrt()) / a
    };
    let (edge, top) = (2.0 / 125.0, 24.0 / 125.0);
    let wanted = 20.0 + top * enter(edge) - 40.0;
    let found = gap.wanted_mm.expect("a height");
    assert!(
        (found - wanted).abs() < 0.005,
        "{found} instead of {wanted}"
    );
    // The solid angle between the pillar's upper edge and the strip's, by a fine sum.
    let (n, mut sum) = (400, 0.0);
    for i in 0..n {
        let u = edge * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
        let low = 20.0 / enter(u);
        for j in 0..n {
            let v = low + (top - low) * (f64::from(j) + 0.5) / f64::from(n);
            let area = 2.0 * edge / f64::from(n) * (top - low) / f64::from(n);
            sum += area / (1.0 + u * u + v * v).powf(1.5);
        }
    }
    let found = gap.arcmin2 / SQUARE_ARCMIN;
    assert!(
        (found / sum - 1.0).abs() < 0.002,
        "{found} sr instead of {sum}"
    );
    assert!(gap.up_deg > 0.0 && gap.right_deg.abs() < 0.5);
    assert!((DVec3::from(gap.place_mm).y + 25.0).abs() < 1e-9);
    let told = |carrier| words::coverage::warnings("a", &coverage, carrier)[0].clone();
    assert!(told("pillar").message.contains("too short"));
    let names_repair = |d: Diagnostic| d.help.iter().any(|h| h.contains("`pillarforest repair`"));
    assert!(names_repair(told("pillar")) && !names_repair(told("support")));
}

#[test]
fn gaps_beside_a_pillar_and_before_the_base_have_their_causes() {
    let supports = [
        pillar(DVec2::ZERO, 5.0, 64, Datum::Plane),
        base(ring(DVec2::ZERO, 60.0, 96)),
    ];
    let field = field(&supports);
    let sight = sight(
        "a",
        DVec3::new(0.0, -150.0, 40.0),
        ball(DVec3::new(0.0, 0.0, 12.0), 11.0, 24),
        field,
    );
    let coverage = coverage_of(&sight);
    let of = |cause: Cause| {
        let gaps = coverage.gaps.iter().filter(move |g| g.cause == cause);
        gaps.map(|g| g.arcmin2).collect::<Vec<_>>()
    };
    let (open, hidden) = (of(Cause::NoPillar), of(Cause::Hidden));
    // Left and right alike, and nothing else.
    assert_eq!((open.len() + hidden.len(), coverage.gaps.len()), (4, 4));
    assert!((open[0] / open[1] - 1.0).abs() < 1e-3, "{open:?}");
    assert!((hidden[0] / hidden[1] - 1.0).abs() < 1e-3, "{hidden:?}");
    let gaps: f64 = coverage.gaps.iter().map(|g| g.arcmin2).sum();
    let whole = coverage.solid_angle_sr() * SQUARE_ARCMIN;
    let all = gaps + coverage.small_gaps_arcmin2 + coverage.share() * whole;
    assert!((all / whole - 1.0).abs() < 1e-9);
    let named = coverage.gaps.iter().filter(|g| g.cause == Cause::Hidden);
    assert!(
        named
            .map(|g| &g.support)
            .all(|s| s.as_deref() == Some("base"))
    );
    assert_eq!(words::coverage::warnings("a", &coverage, "pillar").len(), 2);
}

/// A slit between two pillars is a gap if an eye can make it out, and only counted if not.
#[test]
fn a_slit_narrower_than_what_is_seen_is_counted_and_not_listed() {
    // Seen from 146 mm, an arc-minute measures 0.0425 mm.
    for (slit, is_listed) in [(0.036, false), (0.05, true)] {
        let half = |side: f64| {
            let x = side * (6.0 + slit / 2.0);
            let mut half = pillar(DVec2::ZERO, 5.0, 4, Datum::Plane);
            let corner = |dx: f64, dy: f64| DVec2::new(x + dx, dy);
            let profile = vec![
                corner(-6.0, -4.0),
                corner(6.0, -4.0),
                corner(6.0, 4.0),
                corner(-6.0, 4.0),
            ];
            half.mesh = prism(&profile, 0.0, 40.0);
            if let SupportKind::Pillar {
                axis, profile: own, ..
            } = &mut half.kind
            {
                (*axis, *own) = (DVec2::new(x, 0.0), profile);
            }
            half
        };
        let supports = [half(-1.0), half(1.0)];
        let field = field(&supports);
        let sight = sight("a", EYE, bumpy(9.0), field);
        let found = coverage(&sight, &["a"], &[], 1.0);
        assert_eq!(
            !found.gaps.is_empty(),
            is_listed,
            "{slit}: {:?}",
            found.gaps
        );
        assert_eq!(found.small_gaps > 0, !is_listed, "{slit}");
        assert!(found.share() < 1.0);
        let told = words::coverage::warnings("a", &found, "pillar");
        assert_eq!(told.len(), usize::from(is_listed), "{told:?}");
        assert!(
            told.iter().all(|w| !w.message.contains(" 0.00 %")),
            "{told:?}"
        );
        // Whoever wants to know everything is told.
        let all = coverage(&sight, &["a"], &[], 0.0);
        assert!(!all.gaps.is_empty(), "{slit}");
    }
}

/// The finished forest of some views.
struct Built {
    sights: Vec<Sight<'static>>,
    reliefs: Vec<Relief>,
    forest: Forest,
}

impl Built {
    fn new(sights: Vec<Sight<'static>>) -> Self {
        let of_sight = |s: &Sight| {
            let depths = kinds::height_field_depths(defaults::ENERGY, s).expect("depths");
            relief(s, &depths)
        };
        let reliefs: Vec<Relief> = sights.iter().map(of_sight).collect();
        let views = sights.iter().zip(&reliefs);
        let operands: Vec<Operand> = views
            .map(|(sight, relief)| Operand::Relief { sight, relief })
            .collect();
        let forest = carve(sights[0].image.field, &operands, LINE_MM).expect("a forest");
        Self {
            sights,
            reliefs,
            forest,
        }
    }

    fn sighted(&self, forest: &Forest, v: usize) -> Sighted {
        self.sighted_by(SHARPNESS, forest, v)
    }

    fn sighted_by(&self, sharpness: Sharpness, forest: &Forest, v: usize) -> Sighted {
        let bvh = Bvh::new(forest.whole.mesh());
        let names = self.sights.iter().map(Sight::name).collect();
        let sight = &self.sights[v];
        let finished = Finished::new(forest, &bvh, sight.image.field, names, sharpness);
        let (relief, given_up) = (&self.reliefs[v], &forest.given_up[v]);
        conflicts::sighted(sight, ViewId::new(v), relief, given_up, &finished)
    }
}

#[test]
fn rays_find_a_finished_forest_free_and_a_box_before_it() {
    let places = [(-8.5, 4.0), (0.0, -6.0), (8.5, 10.0)];
    let supports = places.map(|(x, y)| pillar(DVec2::new(x, y), 4.6, 48, Datum::Plane));
    let field = field(&supports);
    let built = Built::new(vec![sight("a", EYE, bumpy(12.0), field)]);
    let free = built.sighted(&built.forest, 0);
    assert_eq!(free.disturbances, []);
    let whole = carried_arcmin2(&built.sights[0]);
    assert!(free.small_arcmin2 < 1e-4 * whole, "{free:?}");
    assert!(free.rays > 10_000);

    // A box whose face of 2 x 3 mm stands 100 mm from the eye, in the middle of its image.
    let face = [(-1.0, -50.0), (1.0, -50.0), (1.0, -49.0), (-1.0, -49.0)];
    let face: Vec<DVec2> = face.iter().map(|p| DVec2::from(*p)).collect();
    let mut mesh = built.forest.whole.mesh().clone();
    mesh.append(&prism(&face, 18.5, 21.5));
    let spoilt = Forest {
        whole: Solid::new(mesh).expect("two bodies"),
        ..built.forest.clone()
    };
    let found = built.sighted(&spoilt, 0);
    assert_eq!(found.disturbances.len(), 1, "{found:?}");
    let blocked = &found.disturbances[0];
    assert_eq!(
        (blocked.trouble, &blocked.with_view),
        (Trouble::Blocked, &None)
    );
    assert!((blocked.place_mm[1] + 50.0).abs() < 1e-4);
    // Solid angle of a rectangle: 4 asin(ab / sqrt((1 + a^2)(1 + b^2))), half sides a and b at distance 1; hairs at its edge
    // of half a line, measured at the relief, do not count. Cells are sampled in parts of half a millimetre, some sixty of them along
    // the edge, each of which is in or out: a tenth of the area at most.
    let hair = LINE_MM / 2.0 / 146.0;
    let solid = |a: f64, b: f64| {
        4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin() * SQUARE_ARCMIN
    };
    let (most, least) = (solid(0.01, 0.015), solid(0.01 - hair, 0.015 - hair));
    let arcmin2 = blocked.arcmin2;
    assert!(
        (0.9 * least..1.1 * most).contains(&arcmin2),
        "{arcmin2} is not {least} to {most}"
    );
    let lost = found.lost_sr[0] * SQUARE_ARCMIN;
    assert!((lost - arcmin2).abs() < 1e-4 * whole);
    assert!(!words::conflicts::warnings("a", &found, "pillar").is_empty());

    // The face is 69 arc-minutes wide, the cells that it covers twice that. Who sees nothing below 300 is told nothing; the sum stays.
    let sharpness = |seen| Sharpness { seen, ..SHARPNESS };
    let unseen = built.sighted_by(sharpness(300.0), &spoilt, 0);
    assert_eq!(unseen.disturbances, []);
    assert!((unseen.small_arcmin2 - free.small_arcmin2 - arcmin2).abs() < 1e-6 * arcmin2);
    assert!(words::conflicts::warnings("a", &unseen, "pillar").is_empty());
    let seen = built.sighted_by(sharpness(40.0), &spoilt, 0);
    assert_eq!(seen.disturbances, found.disturbances);
}

#[test]
fn rays_miss_a_relief_that_is_not_there() {
    let supports = [pillar(DVec2::ZERO, 14.0, 96, Datum::Plane)];
    let field = field(&supports);
    let built = Built::new(vec![sight("a", EYE, bumpy(9.0), field)]);
    let far = prism(&ring(DVec2::new(0.0, 40.0), 3.0, 24), 0.0, 40.0);
    let empty = Forest {
        whole: Solid::new(far).expect("a pillar"),
        reliefs: vec![None],
        ..built.forest.clone()
    };
    let found = built.sighted(&empty, 0);
    assert!(
        found
            .disturbances
            .iter()
            .all(|d| d.trouble == Trouble::Missing)
    );
    let missing: f64 = found.disturbances.iter().map(|d| d.arcmin2).sum();
    assert!((missing / carried_arcmin2(&built.sights[0]) - 1.0).abs() < 1e-9);
}

#[test]
fn after_settling_the_finished_forest_is_free_for_both() {
    let supports = [pillar(DVec2::ZERO, 10.0, 64, Datum::Plane)];
    let field = field(&supports);
    let sights = sharing(field, [22.0, 16.0]);
    let settlement = settled(&sights, Contested::First);
    let sights = give_up(sights, &settlement);
    assert!(carried_arcmin2(&sights[1]) > 0.0);
    let built = Built::new(sights);
    for v in 0..2 {
        let found = built.sighted(&built.forest, v);
        // Hairs of the pillar at the outlines of two small models, and nothing of the other view.
        let whole = carried_arcmin2(&built.sights[v]);
        let wrong = found.disturbances.iter().any(|d| d.with_view.is_some());
        let all: f64 = found.disturbances.iter().map(|d| d.arcmin2).sum();
        assert!(!wrong && all < 0.002 * whole, "view {v}: {found:?}");
    }
}

#[test]
fn models_of_one_view_are_counted_apart() {
    let supports = [pillar(DVec2::new(-8.0, 0.0), 7.0, 64, Datum::Plane)];
    let field = field(&supports);
    let ball_at = |x: f64| ball(DVec3::new(x, 0.0, 20.0), 4.0, 12);
    let mut both = view("a", EYE, ball_at(-8.0), ORANGE);
    both.models
        .extend(view("c", EYE, ball_at(8.0), BLUE).models);
    both.look_at = MIDDLE;
    let coverage = coverage_of(&sighted(both, field));
    let [on, off] = &coverage.models[..] else {
        panic!("two models")
    };
    assert_eq!((on.name.as_str(), off.name.as_str()), ("a", "c"));
    assert!((on.carried_sr / on.solid_angle_sr - 1.0).abs() < 1e-9);
    assert_eq!(off.carried_sr, 0.0);
    assert!((on.solid_angle_sr / off.solid_angle_sr - 1.0).abs() < 1e-3);
    assert!((coverage.share() - 0.5).abs() < 1e-3);
}
