//! Visibility in plan: against single rays, under changes, and from infinity.

use glam::DVec2;
use pillarforest::horizon::{Footprint, Horizon, Obstacle, Ray, Run, Shadow, Viewpoint};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// A body of the tests, with its own outline.
#[derive(Clone, Debug)]
struct Prism {
    at: DVec2,
    /// Radius of the disc, or of the circle around the polygon.
    radius: f64,
    corners: Vec<DVec2>,
}

impl Prism {
    fn new(at: DVec2, radius: f64, sides: usize) -> Self {
        let corner = |k: usize| radius * DVec2::from_angle(0.3 + TAU * k as f64 / sides as f64);
        let corners = if sides < 3 {
            Vec::new()
        } else {
            (0..sides).map(corner).collect()
        };
        Self {
            at,
            radius,
            corners,
        }
    }

    fn obstacle(&self) -> Obstacle<'_> {
        let footprint = if self.corners.is_empty() {
            Footprint::Disc {
                radius: self.radius,
            }
        } else {
            Footprint::Polygon {
                corners: &self.corners,
                inside: DVec2::ZERO,
            }
        };
        Obstacle {
            at: self.at,
            footprint,
        }
    }
}

fn obstacles(bodies: &[Option<Prism>]) -> Vec<Option<Obstacle<'_>>> {
    bodies
        .iter()
        .map(|b| b.as_ref().map(Prism::obstacle))
        .collect()
}

fn eye() -> Viewpoint {
    Viewpoint::At {
        place: DVec2::new(-150.0, 3.0),
        ahead: DVec2::new(1.0, 0.1).normalize(),
    }
}

const SPANS: [[f64; 2]; 3] = [[-0.5, -0.2], [-0.15, 0.2], [0.25, 0.26]];

/// Distance at which a ray first meets a body, another way than the engine's: as roots and as crossings of lines.
fn distance(body: &Prism, ray: &Ray) -> Option<f64> {
    let to = body.at - ray.from;
    if body.corners.is_empty() {
        let (b, c) = (
            to.dot(ray.way),
            to.length_squared() - body.radius * body.radius,
        );
        let root = (b * b - c).sqrt();
        return Some(b - root).filter(|t| *t > ray.start);
    }
    let n = body.corners.len();
    let crossing = |k: usize| {
        let (p, q) = (to + body.corners[k], to + body.corners[(k + 1) % n]);
        let (side, det) = (q - p, ray.way.perp_dot(q - p));
        let (t, s) = (p.perp_dot(side) / det, p.perp_dot(ray.way) / det);
        (t > ray.start && (0.0..=1.0).contains(&s)).then_some(t)
    };
    (0..n).filter_map(crossing).min_by(f64::total_cmp)
}

/// The body that a bearing meets first, looked for among all.
fn first(bodies: &[Option<Prism>], ray: &Ray) -> Option<(usize, f64)> {
    let met = bodies
        .iter()
        .enumerate()
        .filter_map(|(k, b)| Some((k, distance(b.as_ref()?, ray)?)));
    met.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Whether a bearing lies so near to some tangent that rounding decides.
fn is_near_tangent(bodies: &[Option<Prism>], viewpoint: &Viewpoint, bearing: f64) -> bool {
    bodies.iter().flatten().any(|b| {
        let shadow = Shadow::new(viewpoint, &b.obstacle());
        let ends = [shadow.from, shadow.to];
        let near = |e: f64| ((bearing - e + PI).rem_euclid(TAU) - PI).abs() < 1e-9;
        ends.into_iter().any(near)
    })
}

/// Runs tile the spans, neighbours differ, and every dense bearing meets what its run says, where the engine says.
fn agrees_with_rays(
    viewpoint: Viewpoint,
    spans: &[[f64; 2]],
    bodies: &[Option<Prism>],
) -> Result<(), TestCaseError> {
    let list = obstacles(bodies);
    let horizon = Horizon::new(viewpoint, spans, &list);
    let runs: Vec<Run> = horizon.runs().collect();
    for span in spans {
        let own: Vec<&Run> = runs
            .iter()
            .filter(|r| span[0] <= r.from && r.to <= span[1])
            .collect();
        prop_assert_eq!(own[0].from, span[0]);
        prop_assert_eq!(own[own.len() - 1].to, span[1]);
        for pair in own.windows(2) {
            prop_assert_eq!(pair[0].to, pair[1].from);
            prop_assert_ne!(pair[0].obstacle, pair[1].obstacle);
        }
        for k in 0..400 {
            let bearing = span[0] + (span[1] - span[0]) * (f64::from(k) + 0.37) / 400.0;
            if is_near_tangent(bodies, &viewpoint, bearing) {
                continue;
            }
            let run = own.iter().find(|r| r.from <= bearing && bearing <= r.to);
            let wanted = first(bodies, &viewpoint.ray(bearing));
            prop_assert_eq!(run.unwrap().obstacle, wanted.map(|w| w.0), "{}", bearing);
            let met = horizon.first(bearing, &list);
            prop_assert_eq!(met.map(|m| m.0), wanted.map(|w| w.0));
            if let (Some((_, impact)), Some((_, distance))) = (met, wanted) {
                prop_assert!((impact.distance - distance).abs() < 1e-7);
                prop_assert!(impact.normal.dot(viewpoint.ray(bearing).way) < 1e-9);
                prop_assert!((impact.normal.length() - 1.0).abs() < 1e-9);
            }
        }
    }
    let all: f64 = (0..bodies.len()).map(|k| horizon.angle_of(k)).sum();
    let width: f64 = spans.iter().map(|s| s[1] - s[0]).sum();
    prop_assert!((horizon.coverage() * width - all).abs() < 1e-9);
    Ok(())
}

/// Bodies one to a cell of a grid around the origin: none touch. `None` where the last number says so.
fn apart() -> impl Strategy<Value = Vec<Option<Prism>>> {
    let one = (0.0..1.0f64, 0.0..1.0f64, 1.0..5.0f64, 2..9usize, 0..8u8);
    prop::collection::vec(one, 36).prop_map(|list| {
        let body = |(k, (u, v, radius, sides, gone)): (usize, (f64, f64, f64, usize, u8))| {
            let cell = DVec2::new((k % 6) as f64, (k / 6) as f64) * 16.0 - 40.0;
            let at = cell + DVec2::new(u, v) * (16.0 - 2.0 * 5.1) - 2.9;
            (gone > 0).then(|| Prism::new(at, radius, sides))
        };
        list.into_iter().enumerate().map(body).collect()
    })
}

/// A change of a layout: which, and what becomes of it.
#[derive(Clone, Debug)]
enum Edit {
    Put(usize, Option<Prism>),
    Push(Prism),
    /// The last takes its place.
    SwapRemove(usize),
    Look(Viewpoint),
}

fn bodies_anywhere() -> impl Strategy<Value = Prism> {
    // On a coarse grid too, so that tangents coincide.
    let place = prop_oneof![-60.0..60.0f64, (-6..6i32).prop_map(|k| 10.0 * f64::from(k))];
    let at = (place.clone(), place);
    (at, 1.0..9.0f64, 2..7usize).prop_map(|((x, y), r, n)| Prism::new(DVec2::new(x, y), r, n))
}

fn viewpoints() -> impl Strategy<Value = Viewpoint> {
    let place = (-160.0..-20.0f64, -30.0..30.0f64);
    (place, -0.5..0.5f64, 0..4u8).prop_map(|((x, y), turn, far)| {
        let (place, ahead) = (DVec2::new(x, y), DVec2::from_angle(turn));
        match far {
            0 => Viewpoint::Infinity { ahead },
            _ => Viewpoint::At { place, ahead },
        }
    })
}

fn changes() -> impl Strategy<Value = Vec<Edit>> {
    let change = prop_oneof![
        6 => (0..40usize, prop::option::weighted(0.8, bodies_anywhere()))
            .prop_map(|(k, b)| Edit::Put(k, b)),
        2 => bodies_anywhere().prop_map(Edit::Push),
        2 => (0..40usize).prop_map(Edit::SwapRemove),
        1 => viewpoints().prop_map(Edit::Look),
    ];
    prop::collection::vec(change, 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn runs_agree_with_single_rays(bodies in apart()) {
        agrees_with_rays(eye(), &SPANS, &bodies)?;
        let spans = SPANS.map(|s| s.map(|b| 150.0 * b));
        agrees_with_rays(Viewpoint::Infinity { ahead: DVec2::from_angle(1.0) }, &spans, &bodies)?;
    }

    /// From amid the bodies, all around: shadows reach across the direction behind, and some hold the viewpoint.
    #[test]
    fn all_around_too(bodies in apart(), x in -50.0..50.0f64, y in -50.0..50.0f64) {
        let place = DVec2::new(x, y);
        let inside = |b: &Prism| b.at.distance(place) < b.radius + 1e-3;
        let bodies: Vec<Option<Prism>> = bodies.into_iter().map(|b| b.filter(|b| !inside(b))).collect();
        agrees_with_rays(Viewpoint::At { place, ahead: DVec2::Y }, &[[-PI, 0.5], [0.5, PI]], &bodies)?;
    }

    /// Whatever is changed, in whatever order it is told of: the horizon is that of the list, to the bit. Bodies may overlap here.
    #[test]
    fn updates_are_as_good_as_new(bodies in apart(), changes in changes(), together in 1..4usize) {
        let (mut bodies, mut viewpoint) = (bodies, eye());
        let spans = |v: &Viewpoint| match v {
            Viewpoint::At { .. } => SPANS,
            Viewpoint::Infinity { .. } => SPANS.map(|s| s.map(|b| 150.0 * b)),
        };
        let mut live = Horizon::new(viewpoint, &SPANS, &obstacles(&bodies));
        for some in changes.chunks(together) {
            let mut told = Vec::new();
            for change in some {
                match change.clone() {
                    Edit::Put(k, body) if k < bodies.len() => {
                        bodies[k] = body;
                        told.push(k);
                    }
                    Edit::Push(body) => {
                        told.push(bodies.len());
                        bodies.push(Some(body));
                    }
                    Edit::SwapRemove(k) if k < bodies.len() => {
                        bodies.swap_remove(k);
                        told.extend([k, bodies.len()]);
                    }
                    Edit::Look(from) => {
                        viewpoint = from;
                        live.look_from(viewpoint, &spans(&viewpoint), &obstacles(&bodies));
                    }
                    Edit::Put(..) | Edit::SwapRemove(_) => {}
                }
            }
            for k in told.into_iter().rev() {
                live.update(k, &obstacles(&bodies));
            }
            let new = Horizon::new(viewpoint, &spans(&viewpoint), &obstacles(&bodies));
            prop_assert_eq!(&live, &new);
            // `==` takes 0 and -0 for equal; their bits are compared too.
            prop_assert_eq!(format!("{live:?}"), format!("{new:?}"));
        }
    }

    /// With the scene within `r` of the origin, a viewpoint `d` away has bearings times `d` that differ from those at infinity by less
    /// than `2 r^2 / d`, and distances less `d` by as little.
    #[test]
    fn infinity_is_the_limit_of_far_viewpoints(bodies in apart(), angle in 0.0..TAU) {
        let (r, d) = (80.0, 1e8);
        let tolerance = 2.0 * r * r / d;
        let ahead = DVec2::from_angle(angle);
        let near = Viewpoint::At { place: -d * ahead, ahead };
        let far = Viewpoint::Infinity { ahead };
        let list = obstacles(&bodies);
        let [from_near, from_far] = [(near, r / d), (far, r)].map(|(v, half)| {
            let runs: Vec<Run> = Horizon::new(v, &[[-half, half]], &list).runs().collect();
            runs
        });
        // Tangents that nearly coincide may come in another order: such runs are no wider than the tolerance.
        let wide = |runs: &[Run], by: f64| -> Vec<Run> {
            let scaled = runs.iter().map(|r| Run { from: by * r.from, to: by * r.to, ..*r });
            scaled.filter(|r| r.width() > 2.0 * tolerance).collect()
        };
        let (a, b) = (wide(&from_near, d), wide(&from_far, 1.0));
        prop_assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(&b) {
            prop_assert_eq!(a.obstacle, b.obstacle);
            prop_assert!((a.from - b.from).abs() < tolerance && (a.to - b.to).abs() < tolerance);
            let Some(k) = a.obstacle else { continue };
            let middle = (b.from + b.to) / 2.0;
            let at = |v: Viewpoint, bearing: f64| list[k].unwrap().entry(&v.ray(bearing));
            if let (Some(one), Some(other)) = (at(near, middle / d), at(far, middle)) {
                // Along a slanting side, the shift across is one of distance: as much as the side is steep.
                let slant = 1.0 / -other.normal.dot(ahead);
                prop_assert!((one.distance - d - other.distance).abs() < 2.0 * tolerance * (1.0 + slant));
            }
        }
    }
}

#[test]
fn a_viewpoint_inside_an_obstacle_looks_through_it() {
    let holds = |body: Prism| {
        let (own, behind) = (Some(body), Some(Prism::new(DVec2::new(30.0, 0.0), 4.0, 2)));
        let bodies = [own, behind];
        let viewpoint = Viewpoint::At {
            place: DVec2::new(1.0, 0.0),
            ahead: DVec2::X,
        };
        let horizon = Horizon::new(viewpoint, &[[-0.1, 0.1]], &obstacles(&bodies));
        let runs: Vec<Run> = horizon.runs().collect();
        assert_eq!((runs.len(), runs[0].obstacle), (1, Some(1)));
    };
    holds(Prism::new(DVec2::ZERO, 5.0, 2));
    holds(Prism::new(DVec2::ZERO, 5.0, 6));
    holds(Prism::new(DVec2::new(1.0, 0.0), 5.0, 6));
}

#[test]
fn overlaps_are_settled_in_the_middle_of_their_stretch() {
    // Two squares that cross: the front of one, then of the other; the stretch over which both lie is one run.
    let square = |x: f64, y: f64| Some(Prism::new(DVec2::new(x, y), 10.0, 4));
    let bodies = [square(0.0, 4.0), square(3.0, -4.0)];
    let viewpoint = eye();
    let horizon = Horizon::new(viewpoint, &[[-0.4, 0.4]], &obstacles(&bodies));
    for stretch in horizon.stretches().flatten() {
        let middle = (stretch.from + stretch.to) / 2.0;
        let met = first(&bodies, &viewpoint.ray(middle));
        assert_eq!(stretch.obstacle, met.map(|m| m.0));
    }
    let [one, other] =
        [0, 1].map(|k| Shadow::new(&viewpoint, &bodies[k].as_ref().unwrap().obstacle()));
    let runs: Vec<Run> = horizon.runs().collect();
    assert_eq!(runs[0].to, one.from.min(other.from));
    assert_eq!(runs[runs.len() - 1].from, one.to.max(other.to));
}

/// How long a change takes: prints microseconds. Run it alone, optimised, with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn moves_are_quick() {
    for n in [30usize, 200] {
        let place = |k: usize| {
            let at = DVec2::new((k % 20) as f64, (k / 20) as f64);
            DVec2::new(9.0, 14.0) * at + 3.0 * DVec2::from_angle(2.4 * k as f64)
                - DVec2::new(90.0, 70.0)
        };
        let bodies: Vec<Option<Prism>> = (0..n)
            .map(|k| Some(Prism::new(place(k * 200 / n), 3.0, 2)))
            .collect();
        let list = obstacles(&bodies);
        let spans = [[-0.6, 0.6]];
        let mut live = Horizon::new(eye(), &spans, &list);
        let mut moved = list.clone();
        let rounds = 20_000;
        let begun = std::time::Instant::now();
        for k in 0..rounds {
            let i = (7 * k) % n;
            let by = 0.5 * DVec2::from_angle(k as f64);
            moved[i] = list[i].map(|o| Obstacle { at: o.at + by, ..o });
            live.update(i, &moved);
        }
        let update = begun.elapsed().as_secs_f64() / f64::from(rounds as u32);
        let begun = std::time::Instant::now();
        let anew = rounds / 20;
        let mut width = 0.0;
        for _ in 0..anew {
            width += Horizon::new(eye(), &spans, &moved).coverage();
        }
        let build = begun.elapsed().as_secs_f64() / f64::from(anew as u32);
        assert_eq!(live, Horizon::new(eye(), &spans, &moved));
        println!(
            "{n} obstacles: {:.2} us a move, {:.2} us anew (covered {:.2})",
            1e6 * update,
            1e6 * build,
            width / anew as f64
        );
    }
}
