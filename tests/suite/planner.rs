//! Layouts: right by construction, surveyed exactly, searched deterministically, mended with few changes.

use super::shapes;
use glam::{DVec2, DVec3};
use pillarforest::geom::hull;
use pillarforest::mesh::TriMesh;
use pillarforest::planner::convex::{clipped, part};
use pillarforest::planner::{
    Adjustment, Brief, Care, Ended, FaultKind, Freedom, Matters, Pillar, Planned, Plates, Region,
    Shape, Subject, Survey, Watch, plan, repair, start,
};
use pillarforest::view::View;
use pillarforest::words::planner::no_layout;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// A box `width` wide and deep and `height` high, 10 mm above the base.
fn block(width: f64, height: f64) -> TriMesh {
    let half = width / 2.0;
    let square = [(-half, -half), (half, -half), (half, half), (-half, half)].map(DVec2::from);
    shapes::prism(&square, 10.0, 10.0 + height)
}

fn view(number: usize, eye: DVec3, mesh: TriMesh) -> View {
    shapes::view(&format!("v{number}"), eye, mesh, [0; 3])
}

fn round(radius: f64) -> Shape {
    Shape {
        profile: (0..64)
            .map(|i| radius * DVec2::from_angle(TAU * f64::from(i) / 64.0))
            .collect(),
        round: true,
        reach: radius,
        heights: [90.0, 90.0],
        layer: shapes::flat_layer(5.0, 2.0, 1.0),
        written: format!("Round(radius: {radius})"),
    }
}

fn disc(radius: f64) -> Region {
    Region::new(
        (0..96)
            .map(|i| radius * DVec2::from_angle(TAU * f64::from(i) / 96.0))
            .collect(),
    )
}

fn brief(views: usize, region: Region, tries: u64) -> Brief {
    Brief {
        region,
        shapes: vec![round(4.0)],
        allowed: 1,
        gap: 0.5,
        care: Care::found(0.4, Plates::ANY),
        count: [1, 200],
        given: Vec::new(),
        seed: 1,
        tries,
        seconds: 60.0,
        hidden_from_deg: 10.0,
        matters: Matters {
            camouflage: 1.0,
            tolerance: 1.0,
            pillars: 0.0,
            spread: 0.0,
        },
        tolerance_mm: vec![0.0; views],
        freedom: Freedom::NONE,
    }
}

const PATIENT: Watch = Watch {
    progress: &|_, _| {},
    stop: &|| false,
};

/// Eyes all around, at uneven angles, distances and heights, none above the pillars.
fn uneven(rng: &mut Pcg64Mcg, n: usize, width: f64) -> Vec<View> {
    (0..n)
        .map(|i| {
            let turn = TAU * (i as f64 + rng.random_range(-0.15..0.15)) / n as f64;
            let distance = rng.random_range(220.0..600.0);
            let eye = (distance * DVec2::from_angle(turn)).extend(rng.random_range(5.0..85.0));
            view(i, eye, block(width, width))
        })
        .collect()
}

fn subjects(views: &[View]) -> Vec<Subject> {
    views
        .iter()
        .map(|v| Subject::in_plan(v, &v.target()))
        .collect()
}

#[test]
fn any_number_of_eyes_has_a_start_without_faults() {
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    for n in 1..=12 {
        let width = (150.0 / n as f64).clamp(14.0, 40.0);
        let views = uneven(&mut rng, n, width);
        let all = subjects(&views);
        let all: Vec<&Subject> = all.iter().collect();
        let brief = brief(n, disc(75.0), 0);
        let begun = start(&all, &brief);
        assert!(
            begun.is_clear(),
            "{n} eyes: {:?} {:?}",
            begun.stuck,
            begun.clashes
        );
        let survey = Survey::new(&all, &brief, &begun.pillars);
        assert_eq!(survey.faults, [], "{n} eyes");
        assert_eq!(begun.regions.len(), n);
        for (v, region) in begun.regions.iter().enumerate() {
            // Convex, with the eye and all its pillars inside, and apart from the others.
            let corners = region.len();
            for i in 0..corners {
                let (a, b) = (region[i], region[(i + 1) % corners]);
                let inside = |p: DVec2| (b - a).perp_dot(p - a) >= -1e-6;
                assert!(inside(region[(i + 2) % corners]) && inside(views[v].eye.truncate()));
                let own = begun.pillars.iter().filter(|p| p.owner == Some(v));
                assert!(own.map(|p| p.at).all(inside));
            }
            for other in &begun.regions[..v] {
                assert!(part(other, region).room > -1e-6);
            }
        }
    }
}

/// First pillar on a ray in plan, by its polygon, with nothing of the planner's.
fn first_pillar(eye: DVec2, way: DVec2, pillars: &[Pillar], shape: &Shape) -> Option<usize> {
    let mut best = (f64::INFINITY, None);
    for (i, pillar) in pillars.iter().enumerate() {
        let n = shape.profile.len();
        for k in 0..n {
            let (p, q) = (
                pillar.at + shape.profile[k] - eye,
                pillar.at + shape.profile[(k + 1) % n] - eye,
            );
            let side = q - p;
            let det = way.perp_dot(side);
            let (t, u) = (p.perp_dot(side) / det, p.perp_dot(way) / det);
            if (0.0..=1.0).contains(&u) && t > 0.0 && t < best.0 {
                best = (t, Some(i));
            }
        }
    }
    best.1
}

#[test]
fn what_eyes_meet_agrees_with_rays() {
    let mut rng = Pcg64Mcg::seed_from_u64(11);
    let views = uneven(&mut rng, 3, 60.0);
    let all = subjects(&views);
    let all: Vec<&Subject> = all.iter().collect();
    let brief = brief(3, disc(75.0), 0);
    for _ in 0..20 {
        let mut pillars: Vec<Pillar> = Vec::new();
        while pillars.len() < 25 {
            let at = DVec2::new(rng.random_range(-65.0..65.0), rng.random_range(-65.0..65.0));
            if pillars.iter().all(|p| p.at.distance(at) > 8.5) {
                let owner = Some(rng.random_range(0..3));
                pillars.push(Pillar {
                    at,
                    shape: 0,
                    owner,
                    fixed: false,
                    given: None,
                });
            }
        }
        let survey = Survey::new(&all, &brief, &pillars);
        for (v, subject) in all.iter().enumerate() {
            let [a, b] = subject.range();
            let (mut uncovered, mut foreign) = (0.0, 0.0);
            let n = 2000;
            for k in 0..n {
                let bearing = a + (b - a) * (f64::from(k) + 0.5) / f64::from(n);
                let found =
                    first_pillar(subject.o, subject.way(bearing), &pillars, &brief.shapes[0]);
                let run = survey.skylines[v]
                    .runs
                    .iter()
                    .find(|r| r.from <= bearing && bearing <= r.to)
                    .unwrap();
                // Circles are a hair larger than their polygons.
                let edge = (bearing - run.from).min(run.to - bearing) * 400.0;
                assert!(
                    run.obstacle == found || edge < 0.05,
                    "{:?} {found:?} {edge}",
                    run.obstacle
                );
                uncovered += f64::from(u8::from(found.is_none()));
                foreign += f64::from(u8::from(found.is_some_and(|i| pillars[i].owner != Some(v))));
            }
            let distance = (subject.middle.truncate() - subject.o).length();
            let of = |kind: FaultKind| {
                survey
                    .faults
                    .iter()
                    .filter(|f| f.view == Some(v) && f.kind == kind)
                    .count()
            };
            assert_eq!(
                of(FaultKind::Uncovered) > 0,
                uncovered * (b - a) * distance / f64::from(n) > 0.06,
                "{uncovered}"
            );
            assert_eq!(of(FaultKind::Foreign) > 0, foreign > 0.0);
        }
    }
}

#[test]
fn a_survey_that_follows_changes_is_the_one_made_anew() {
    let mut rng = Pcg64Mcg::seed_from_u64(23);
    let views = uneven(&mut rng, 3, 60.0);
    let all = subjects(&views);
    let all: Vec<&Subject> = all.iter().collect();
    let mut square = round(4.0);
    square.profile = shapes::ring(DVec2::ZERO, 4.0, 4);
    square.round = false;
    let brief = Brief {
        shapes: vec![round(4.0), square],
        allowed: 2,
        ..brief(3, disc(75.0), 0)
    };
    let random = |rng: &mut Pcg64Mcg| Pillar {
        at: DVec2::new(rng.random_range(-70.0..70.0), rng.random_range(-70.0..70.0)),
        shape: rng.random_range(0..2),
        owner: Some(rng.random_range(0..3)),
        fixed: false,
        given: None,
    };
    let mut pillars: Vec<Pillar> = (0..30).map(|_| random(&mut rng)).collect();
    let mut survey = Survey::new(&all, &brief, &pillars);
    for _ in 0..60 {
        let old = pillars.clone();
        for _ in 0..rng.random_range(1..4) {
            let i = rng.random_range(0..pillars.len());
            match rng.random_range(0..4) {
                0 => pillars.push(random(&mut rng)),
                1 => _ = pillars.swap_remove(i),
                2 => pillars[i].at += DVec2::new(rng.random_range(-1.0..1.0), 0.3),
                _ => pillars[i] = random(&mut rng),
            }
        }
        let most = old.len().max(pillars.len());
        let changed: Vec<usize> = (0..most)
            .filter(|i| old.get(*i) != pillars.get(*i))
            .collect();
        survey = survey.after(&all, &brief, &pillars, &changed);
        assert_eq!(survey, Survey::new(&all, &brief, &pillars));
    }
}

#[test]
fn a_plan_is_sound_better_than_its_start_and_the_same_again() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let views = uneven(&mut rng, 3, 40.0);
    let brief = Brief {
        matters: Matters {
            tolerance: 0.0,
            ..brief(3, disc(75.0), 0).matters
        },
        ..brief(3, disc(75.0), 12_000)
    };
    let found = plan(&views, &brief, PATIENT).unwrap();
    sound(&views, &brief, &found);
    let (first, last) = (&found.frames[0], found.frames.last().unwrap());
    assert!(
        last.hidden_deg > first.hidden_deg + 5.0,
        "{} {}",
        first.hidden_deg,
        last.hidden_deg
    );
    assert!(found.frames.windows(2).all(|f| f[0].tries <= f[1].tries));
    assert!(found.trade.iter().filter(|t| t.chosen).count() == 1);
    assert!(
        found
            .trade
            .windows(2)
            .all(|t| t[0].tolerance_mm <= t[1].tolerance_mm)
    );
    let alone = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    assert_eq!(
        alone.install(|| plan(&views, &brief, PATIENT).unwrap()),
        found
    );
    let other = plan(&views, &Brief { seed: 2, ..brief }, PATIENT).unwrap();
    assert_ne!(other.pillars, found.pillars);
}

/// Surveys a plan anew, with its models as it changed them.
fn sound(views: &[View], brief: &Brief, found: &Planned) {
    let posed: Vec<View> = views
        .iter()
        .zip(&found.adjustments)
        .map(|(v, a)| pillarforest::planner::posed(v, a))
        .collect();
    let all = subjects(&posed);
    let all: Vec<&Subject> = all.iter().collect();
    assert_eq!(Survey::new(&all, brief, &found.pillars).faults, []);
    assert!(
        found
            .worth
            .iter()
            .all(|w| w.coverage == 1.0 && w.conflicts == 0)
    );
    assert_eq!(found.heights.len(), found.pillars.len());
}

#[test]
fn eyes_that_look_down_over_pillars_have_a_layout_too() {
    let high = |n: usize, turn: f64, distance: f64, z: f64| {
        view(
            n,
            (distance * DVec2::from_angle(turn)).extend(z),
            block(24.0, 24.0),
        )
    };
    let views = [
        high(0, 0.0, 250.0, 220.0),
        high(1, 2.0, 300.0, 40.0),
        high(2, 3.3, 280.0, 160.0),
        high(3, 4.6, 500.0, 20.0),
    ];
    let brief = brief(4, disc(75.0), 200);
    sound(&views, &brief, &plan(&views, &brief, PATIENT).unwrap());
    // Rays that look down meet their pillars below the top and above the base.
    let found = plan(&views, &brief, PATIENT).unwrap();
    let target = views[0].target();
    for pillar in found.pillars.iter().filter(|p| p.owner == Some(0)) {
        let distance = pillar.at.distance(views[0].eye.truncate());
        let seen = target.vertices.iter().map(|v| {
            let slope = (v.z - 220.0) / v.truncate().distance(views[0].eye.truncate());
            220.0 + slope * distance
        });
        assert!(seen.into_iter().all(|z| z > -1.0 && z < 91.0));
    }
}

#[test]
fn the_wanted_tolerance_holds_wherever_reliefs_lie() {
    let mut rng = Pcg64Mcg::seed_from_u64(8);
    let views = uneven(&mut rng, 2, 40.0);
    let wanted = Brief {
        tolerance_mm: vec![1.0, 0.8],
        ..brief(2, disc(75.0), 2000)
    };
    let found = plan(&views, &wanted, PATIENT).unwrap();
    sound(&views, &wanted, &found);
    for (worth, least) in found.worth.iter().zip(&wanted.tolerance_mm) {
        assert!(worth.tolerance_mm[1] >= *least && worth.tolerance_mm[0] > worth.tolerance_mm[1]);
    }
}

#[test]
fn a_search_that_is_stopped_still_gives_a_sound_layout() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let views = uneven(&mut rng, 3, 40.0);
    let brief = brief(3, disc(75.0), 1_000_000);
    let found = plan(
        &views,
        &brief,
        Watch {
            progress: &|_, _| {},
            stop: &|| true,
        },
    )
    .unwrap();
    assert_eq!(found.ended, Ended::Stopped);
    assert!(found.tries < 100_000);
    sound(&views, &brief, &found);
}

#[test]
fn a_search_with_nothing_left_to_find_ends_early() {
    let views = [view(0, DVec3::new(300.0, 0.0, 40.0), block(30.0, 30.0))];
    let mut brief = brief(1, disc(40.0), 400);
    let first = plan(&views, &brief, PATIENT).unwrap();
    brief.given = first
        .pillars
        .iter()
        .enumerate()
        .map(|(i, p)| Pillar {
            fixed: true,
            given: Some(i),
            ..*p
        })
        .collect();
    brief.count = [1, first.pillars.len()];
    brief.tries = 200_000;
    let found = plan(&views, &brief, PATIENT).unwrap();
    assert_eq!(found.ended, Ended::Converged);
    assert!(found.tries < brief.tries / 5, "{} tries", found.tries);
    let places = |pillars: &[Pillar]| -> Vec<DVec2> { pillars.iter().map(|p| p.at).collect() };
    assert_eq!(places(&found.pillars), places(&first.pillars));
}

#[test]
fn fixed_pillars_stay_and_the_rest_is_found() {
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let views = uneven(&mut rng, 2, 36.0);
    let fixed = |x: f64, y: f64| Pillar {
        at: DVec2::new(x, y),
        shape: 0,
        owner: None,
        fixed: true,
        given: None,
    };
    // In the middle of everything.
    let given = vec![fixed(0.0, 0.0), fixed(20.0, 10.0), fixed(-15.0, 30.0)];
    let brief = Brief {
        given: given.clone(),
        ..brief(2, disc(75.0), 2000)
    };
    let found = plan(&views, &brief, PATIENT).unwrap();
    sound(&views, &brief, &found);
    for (old, new) in given.iter().zip(&found.pillars) {
        assert!(new.fixed && new.at == old.at);
    }
    assert!(found.changes.is_empty());
}

#[test]
fn shapes_heights_and_counts_are_kept_to() {
    let mut rng = Pcg64Mcg::seed_from_u64(9);
    let views = uneven(&mut rng, 2, 30.0);
    let square = |side: f64| {
        let half = side / 2.0;
        let profile = [(-half, -half), (half, -half), (half, half), (-half, half)]
            .map(DVec2::from)
            .to_vec();
        Shape {
            profile,
            round: false,
            reach: half * 2f64.sqrt(),
            heights: [45.0, 90.0],
            ..round(4.0)
        }
    };
    let brief = Brief {
        shapes: vec![
            square(7.0),
            Shape {
                heights: [45.0, 90.0],
                ..round(3.5)
            },
        ],
        allowed: 2,
        count: [10, 14],
        ..brief(2, disc(75.0), 4000)
    };
    let found = plan(&views, &brief, PATIENT).unwrap();
    sound(&views, &brief, &found);
    assert!((10..=14).contains(&found.pillars.len()));
    assert!(found.heights.iter().all(|h| (45.0..=90.0).contains(h)));
    // Models end at 40 mm: no pillar has to be as high as it may be.
    assert!(
        found.heights.iter().all(|h| *h < 70.0),
        "{:?}",
        found.heights
    );
}

#[test]
fn models_change_only_within_their_limits() {
    let mut rng = Pcg64Mcg::seed_from_u64(6);
    let views = uneven(&mut rng, 2, 30.0);
    let freedom = Freedom {
        turn: 0.2,
        scale: 1.1,
        shift: 3.0,
    };
    let brief = Brief {
        freedom,
        ..brief(2, disc(75.0), 3000)
    };
    let found = plan(&views, &brief, PATIENT).unwrap();
    sound(&views, &brief, &found);
    assert!(found.adjustments.iter().any(|a| *a != Adjustment::NONE));
    for a in &found.adjustments {
        assert!(a.turn.abs() <= 0.2 && a.shift.abs().max_element() <= 3.0);
        assert!((1.0 / 1.1 - 1e-4..=1.1 + 1e-4).contains(&a.scale));
    }
}

#[test]
fn eyes_in_each_others_way_are_told_with_what_would_do() {
    let near = |n: usize, y: f64| view(n, DVec3::new(250.0, y, 48.0), block(60.0, 50.0));
    let views = [near(0, 0.0), near(1, 25.0)];
    let found = plan(&views, &brief(2, disc(71.0), 500), PATIENT).unwrap_err();
    assert!(
        found
            .clashes
            .iter()
            .all(|c| c.views == [0, 1] && c.mm > 0.0)
    );
    let problems = no_layout(&views, &found);
    let text = &problems[0].message;
    assert!(
        text.contains("\"v0\"") && text.contains("\"v1\"") && text.contains(" mm"),
        "{text}"
    );
    assert!(!problems[0].help.is_empty());
    // A model too high for the pillars.
    let tall = [view(0, DVec3::new(250.0, 0.0, 48.0), block(30.0, 130.0))];
    let found = plan(&tall, &brief(1, disc(71.0), 500), PATIENT).unwrap_err();
    let problems = no_layout(&tall, &found);
    assert!(
        problems[0].message.contains("beyond the ends"),
        "{}",
        problems[0].message
    );
    // The change it offers does.
    let offered = problems[0]
        .help
        .iter()
        .find_map(|h| h.split_once("all models at "))
        .unwrap()
        .1;
    let scale: f64 = offered.split(' ').next().unwrap().parse().unwrap();
    let smaller = pillarforest::planner::posed(
        &tall[0],
        &Adjustment {
            scale: scale - 0.01,
            ..Adjustment::NONE
        },
    );
    plan(&[smaller], &brief(1, disc(71.0), 500), PATIENT).unwrap();
}

#[test]
fn a_layout_out_of_order_is_mended_with_few_changes() {
    let mut rng = Pcg64Mcg::seed_from_u64(12);
    let views = uneven(&mut rng, 3, 36.0);
    let whole = plan(&views, &brief(3, disc(75.0), 0), PATIENT).unwrap();
    let mut given: Vec<Pillar> = whole
        .pillars
        .iter()
        .map(|p| Pillar {
            owner: None,
            given: None,
            ..*p
        })
        .collect();
    let own = Brief {
        care: Care::given(Plates::ANY),
        gap: 0.2,
        given: given.clone(),
        ..brief(3, disc(75.0), 60_000)
    };
    let same = repair(&views, &own, PATIENT).unwrap();
    assert!(same.changes.is_empty() && same.tries == 0);
    // One pillar steps aside and leaves a gap.
    let aside = (given[2].at - views[0].eye.truncate()).normalize().perp();
    given[2].at += 3.0 * aside;
    let broken = Brief {
        given: given.clone(),
        ..own
    };
    let mended = repair(&views, &broken, PATIENT).unwrap();
    sound(&views, &broken, &mended);
    assert!(
        (1..=2).contains(&mended.changes.len()),
        "{:?}",
        mended.changes
    );
    let kept = mended
        .pillars
        .iter()
        .filter(|p| given.iter().any(|g| g.at == p.at))
        .count();
    assert!(kept >= given.len() - 2);
}

/// Upright bars, 6 mm wide with 6 mm between them, and the stretches of bearings at which an eye sees each.
fn bars(eye: DVec3) -> (View, Vec<[f64; 2]>) {
    let (mut vertices, mut faces, mut stretches) = (Vec::new(), Vec::new(), Vec::new());
    for k in -3..=3 {
        let at = 12.0 * f64::from(k);
        let foot = [(-3.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-3.0, 2.0)];
        let foot = foot.map(|(x, y)| DVec2::new(at + x, y));
        let bar = shapes::prism(&foot, 10.0, 60.0);
        let before = vertices.len() as u32;
        vertices.extend(bar.vertices);
        faces.extend(bar.faces.iter().map(|f| f.map(|v| before + v.0)));
        let bearings = foot.map(|p| DVec2::Y.angle_to(p - eye.truncate()));
        stretches.push([
            bearings.into_iter().fold(f64::INFINITY, f64::min),
            bearings.into_iter().fold(f64::NEG_INFINITY, f64::max),
        ]);
    }
    (view(0, eye, TriMesh::new(vertices, faces)), stretches)
}

/// Widths of what cuts between pillars leave of the bars, millimetres on pillars, if less than a printed wall.
fn plates(views: &[View], bars: &[[f64; 2]], brief: &Brief, pillars: &[Pillar]) -> Vec<f64> {
    let all = subjects(views);
    let all: Vec<&Subject> = all.iter().collect();
    let skyline = &Survey::new(&all, brief, pillars).skylines[0];
    let cuts = skyline.runs.windows(2).filter(|w| w[0].to == w[1].from);
    let widths = cuts.flat_map(|w| {
        let nearest = [w[0].obstacle, w[1].obstacle].map(|i| skyline.shadows[i.unwrap()].distance);
        let beside = bars
            .iter()
            .flat_map(move |[a, b]| [w[0].to - a, b - w[0].to]);
        beside.map(move |mm| mm * nearest[0].min(nearest[1]))
    });
    widths.filter(|mm| (0.0..0.65).contains(mm)).collect()
}

/// Letters have upright edges: a cut just beside one leaves a plate that no printer makes.
#[test]
fn no_cut_of_a_found_layout_leaves_a_plate_too_thin_to_print() {
    let (view, bars) = bars(DVec3::new(0.0, -280.0, 50.0));
    let views = [view];
    let thin = |care: Care, seed: u64| -> Vec<f64> {
        let brief = Brief {
            care,
            seed,
            ..brief(1, disc(60.0), 2000)
        };
        let planned = plan(&views, &brief, PATIENT).unwrap();
        plates(&views, &bars, &brief, &planned.pillars)
    };
    let careless: Vec<f64> = (1..=5)
        .flat_map(|seed| thin(Care::found(0.4, Plates::ANY), seed))
        .collect();
    assert!(careless.len() >= 3, "{careless:?}");
    let printed = Plates {
        thinnest: 0.7,
        missed: 25.0,
    };
    for seed in 1..=5 {
        assert_eq!(thin(Care::found(0.4, printed), seed), [0.0; 0]);
    }
}

#[test]
fn strips_between_convex_regions_are_as_wide_as_can_be() {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let mut cloud = |middle: DVec2, radius: f64| {
        let points = (0..12).map(|_| {
            middle + radius * DVec2::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
        });
        hull(points.collect())
    };
    for k in 0..60 {
        let a = cloud(DVec2::ZERO, 3.0);
        let b = cloud(4.0 * DVec2::from_angle(f64::from(k)), 3.0);
        let found = part(&a, &b);
        // The least overlap, or the largest gap, over all directions.
        let width = |way: DVec2| {
            let far = a
                .iter()
                .map(|p| p.dot(way))
                .fold(f64::NEG_INFINITY, f64::max);
            b.iter().map(|p| p.dot(way)).fold(f64::INFINITY, f64::min) - far
        };
        let best = (0..3600).map(|i| width(DVec2::from_angle(TAU * f64::from(i) / 3600.0)));
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        assert!((found.room - best).abs() < 0.01, "{} {best}", found.room);
        assert!((width(found.normal) - found.room).abs() < 1e-9);
    }
    let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(DVec2::from);
    let left = clipped(&square, DVec2::X, 0.5);
    assert_eq!(pillarforest::geom::polygon_area(&left), 1.0);
}
