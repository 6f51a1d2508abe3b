//! The dual working set and the interior point on the normal equations against the conic solver: the same optima, proved, or nothing.

use crate::shapes::{Setting, ball};
use glam::DVec3;
use pillarforest::laplacian::FaceGeometry;
use pillarforest::mimic::{
    CurvatureOptions, Dual, Energy, Interior, Method, Program, Row, RowKind, Solution, SolveError,
    SolvedBlock, optimality, solve, solve_by,
};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Stiffness of scales, as the curvature energy has it.
const ALPHA: f64 = 2e-9;

/// Programs like those of surfaces: the squared Laplacian of balls of facets, singular, a scale for every ball or two for one,
/// bounds above and below relative to the scales, and a mean to keep.
struct Balls {
    program: Program,
    /// Vertices of one ball.
    each: usize,
    balls: usize,
    /// Scales of every ball.
    scales: usize,
}

impl Balls {
    fn new(balls: usize, scales: usize) -> Self {
        let mesh = ball(DVec3::ZERO, 1.0, 5);
        let each = mesh.vertices.len();
        let variables = balls * (each + scales);
        let mut lap = sprs::TriMat::new((each, each));
        let geometry = FaceGeometry::new(&mesh);
        for (f, face) in mesh.faces.iter().enumerate() {
            for k in 0..3 {
                let (i, j) = (face[(k + 1) % 3].at(), face[(k + 2) % 3].at());
                let c = geometry.cotangents[f][k] / 2.0;
                lap.add_triplet(i, i, c);
                lap.add_triplet(j, j, c);
                lap.add_triplet(i, j, -c);
                lap.add_triplet(j, i, -c);
            }
        }
        let lap: sprs::CsMat<f64> = lap.to_csc();
        let square = &lap * &lap;
        let mut quadratic = sprs::TriMat::new((variables, variables));
        for b in 0..balls {
            for (v, (i, j)) in square.iter().filter(|(_, (i, j))| i <= j) {
                quadratic.add_triplet(b * each + i, b * each + j, *v);
            }
        }
        (balls * each..variables).for_each(|g| quadratic.add_triplet(g, g, ALPHA));
        let mean = |b: usize| {
            let own = b * each..(b + 1) * each;
            (own.map(|i| (i, 1.0 / each as f64)).collect(), 0.0)
        };
        let program = Program {
            variables,
            quadratic: quadratic.to_csc(),
            factor: Vec::new(),
            linear: vec![0.0; variables],
            equalities: (0..balls).map(mean).collect(),
            rows: Vec::new(),
        };
        Self {
            program,
            each,
            balls,
            scales,
        }
    }

    /// Vertex `v` of a ball within `lo ..= hi` of its scale.
    fn bound(&mut self, ball: usize, v: usize, lo: f64, hi: f64) {
        let scale = self.balls * self.each + ball * self.scales + v % self.scales.max(1);
        let n = self.program.rows.len() as u32;
        let v = ball * self.each + v;
        let mut terms = [vec![(v, 1.0)], vec![(v, -1.0)]];
        if self.scales > 0 {
            terms[0].push((scale, -1.0));
            terms[1].push((scale, 1.0));
        }
        let [far, near] = terms;
        let kinds = [RowKind::Far(n), RowKind::Near(n + 1)];
        for ((kind, terms), limit) in kinds.into_iter().zip([far, near]).zip([hi, -lo]) {
            self.program.rows.push(Row { kind, terms, limit });
        }
    }
}

/// All methods' optima are one, and proved.
fn assert_same(program: &Program) -> Solution {
    let whole = Dual::new(program).expect("semidefinite").solve(program);
    let whole = whole.expect("within the limits");
    let a = optimality(program, &whole.u, &whole.z, &whole.y);
    let other = solve(program).expect("feasible");
    let b = other.solved.optimality;
    assert!(
        (a.objective - b.objective).abs() <= 1e-6 * b.objective.abs().max(1e-2),
        "{a:?} against {b:?}"
    );
    assert!(
        a.primal_residual < 1e-7 && a.dual_residual < 1e-8 && a.gap < 1e-8,
        "{a:?}"
    );
    assert_eq!(whole.method, Method::DualWorkingSet);
    assert_eq!(other.solved.method, Method::InteriorPoint);
    assert!(whole.z.iter().all(|z| *z >= 0.0));
    let dual = solve_by(program, Method::DualWorkingSet).expect("feasible");
    assert_eq!(dual.solved.method, Method::DualWorkingSet);
    assert!(apart(&dual.u, &whole.u) < 1e-6);
    let warm = solve_by(program, Method::WarmInterior).expect("feasible");
    let c = warm.solved.optimality;
    assert!(
        (c.objective - b.objective).abs() <= 1e-6 * b.objective.abs().max(1e-2),
        "{c:?} against {b:?}"
    );
    assert!(c.primal_residual < 2e-7 && c.dual_residual < 1e-7, "{c:?}");
    assert_eq!(warm.solved.method, Method::WarmInterior);
    assert!(warm.z.iter().all(|z| *z >= 0.0));
    dual
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

#[test]
fn random_programs_have_one_optimum() {
    let shape = (1usize..4, 0usize..3);
    let bounds = proptest::collection::vec((-0.9f64..0.9, 0.01f64..0.4), 40);
    let mut runner = TestRunner::deterministic();
    runner
        .run(&(shape, bounds), |((balls, scales), bounds)| {
            let mut wanted = Balls::new(balls, scales);
            if scales == 0 {
                // Bounds that are not relative to a scale leave the mean to them.
                wanted.program.equalities.clear();
            }
            // Each at a vertex of its own, so that none contradict each other.
            for (i, (middle, width)) in bounds.iter().enumerate().take(wanted.each) {
                wanted.bound(i % balls, i, middle - width, middle + width);
            }
            let dual = assert_same(&wanted.program);
            let surface = balls * wanted.each;
            let other = solve(&wanted.program).expect("feasible");
            let off = apart(&dual.u[..surface], &other.u[..surface]);
            prop_assert!(off < 1e-3, "{off}");
            Ok(())
        })
        .unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn without_binding_rows_nothing_moves() {
    let mut loose = Balls::new(2, 1);
    (0..20).for_each(|v| loose.bound(v % 2, v, -1.0, 1.0));
    let solution = assert_same(&loose.program);
    assert!(solution.u.iter().all(|u| u.abs() < 1e-9));
    assert_eq!(solution.solved.optimality.active, 0);
    loose.program.rows.clear();
    assert_eq!(assert_same(&loose.program).u.len(), loose.program.variables);
}

#[test]
fn rows_that_say_the_same_do_no_harm() {
    let mut heap = Balls::new(1, 1);
    heap.bound(0, 9, 0.0, 1.0);
    for k in 0..60 {
        // All at one vertex, some to the last digit alike.
        heap.bound(0, 3, 0.5 - 1e-9 * f64::from(k / 2), 2.0);
    }
    heap.bound(0, 11, -0.5, 0.2);
    let solution = assert_same(&heap.program);
    let scale = solution.u[heap.each];
    assert!((solution.u[3] - scale - 0.5).abs() < 1e-7);
}

#[test]
fn a_part_without_bounds_stays_the_model() {
    let mut halved = Balls::new(2, 1);
    (0..12).for_each(|v| halved.bound(0, v, 0.1 * v as f64, 0.1 * v as f64 + 0.05));
    let solution = assert_same(&halved.program);
    let free = &solution.u[halved.each..2 * halved.each];
    assert!(free.iter().all(|u| u.abs() < 1e-9));
    assert!(solution.solved.optimality.active > 5);
}

#[test]
fn parts_hang_together_by_rows_alone() {
    let mut tied = Balls::new(2, 1);
    // One mean for both, as of a block of two components.
    let [a, b]: [Vec<(usize, f64)>; 2] = [0, 1].map(|k| tied.program.equalities[k].0.clone());
    let both = a.into_iter().chain(b).map(|(i, v)| (i, v / 2.0)).collect();
    tied.program.equalities = vec![(both, 0.0)];
    (0..12).for_each(|v| tied.bound(v % 2, v, 0.1 * v as f64, 0.1 * v as f64 + 0.05));
    let order = |v: usize| Row {
        kind: RowKind::Order(v as u32),
        terms: vec![(v, 1.0), (tied.each + v, -1.0)],
        limit: -0.3,
    };
    let orders: Vec<Row> = (0..5).map(order).collect();
    tied.program.rows.extend(orders);
    let solution = assert_same(&tied.program);
    let gaps = (0..5).map(|v| solution.u[tied.each + v] - solution.u[v]);
    assert!(gaps.fold(f64::MAX, f64::min) >= 0.3 - 1e-8);
}

#[test]
fn rows_added_later_give_what_they_give_at_once() {
    let mut grown = Balls::new(2, 2);
    let bound = |balls: &mut Balls, v: usize| {
        let middle = (v * 37 % 11) as f64 / 10.0;
        balls.bound(v % 2, v * 5 % balls.each, middle, middle + 0.1);
    };
    (0..8).for_each(|v| bound(&mut grown, v));
    let mut dual = Dual::new(&grown.program).expect("semidefinite");
    let mut interior = Interior::new(&grown.program).expect("memory");
    let mut last = f64::MIN;
    for step in 1..4 {
        let solution = dual.solve(&grown.program).expect("feasible");
        let SolvedBlock { u, z, y, .. } = &solution;
        let objective = optimality(&grown.program, u, z, y).objective;
        let cold = assert_same(&grown.program);
        assert!(apart(&solution.u, &cold.u) < 1e-6);
        let near = interior.solve(&grown.program, false).expect("feasible");
        let warm = interior.solve(&grown.program, true).expect("feasible");
        assert!(apart(&warm.u, &cold.u) < 1e-4);
        // Short of the optimum is near it, and inside the bounds that it reaches.
        let distance = apart(&near.u, &cold.u);
        assert!((1e-9..0.05).contains(&distance), "{distance}");
        assert!(objective > last);
        last = objective;
        (8 * step..8 * step + 8).for_each(|v| bound(&mut grown, v));
    }
}

#[test]
fn a_contradiction_is_left_to_the_interior_point() {
    let mut torn = Balls::new(1, 1);
    torn.bound(0, 2, 0.0, 0.5);
    torn.bound(0, 2, 1.0, 1.5);
    let mut dual = Dual::new(&torn.program).expect("semidefinite");
    assert!(dual.solve(&torn.program).is_none());
    for method in [
        Method::InteriorPoint,
        Method::DualWorkingSet,
        Method::WarmInterior,
    ] {
        let error = solve_by(&torn.program, method).unwrap_err();
        assert!(
            matches!(&error, SolveError::Infeasible(rows) if !rows.is_empty()),
            "{method:?}: {error:?}"
        );
    }
}

#[test]
fn lines_that_would_fill_the_matrix_are_left_to_the_conic_solver() {
    // Least squares with a given mean: all unknowns are that mean.
    const COUNT: usize = 2000;
    let mut squares = sprs::TriMat::new((COUNT, COUNT));
    (0..COUNT).for_each(|i| squares.add_triplet(i, i, 1.0));
    let share = 1.0 / COUNT as f64;
    let program = Program {
        variables: COUNT,
        quadratic: squares.to_csc(),
        factor: Vec::new(),
        linear: vec![0.0; COUNT],
        equalities: vec![((0..COUNT).map(|v| (v, share)).collect(), 0.25)],
        rows: Vec::new(),
    };
    assert!(Interior::new(&program).is_none());
    let solution = solve_by(&program, Method::WarmInterior).expect("feasible");
    assert!(solution.u.iter().all(|u| (u - 0.25).abs() < 1e-7));
}

#[test]
fn an_indefinite_form_is_refused() {
    let mut bent = Balls::new(1, 0);
    bent.program.quadratic.data_mut()[0] = -1.0;
    assert!(Dual::new(&bent.program).is_none());
}

#[test]
fn surfaces_are_solved_by_the_dual() {
    let variants = [
        CurvatureOptions::PAPER,
        CurvatureOptions {
            ordering: false,
            ..CurvatureOptions::PAPER
        },
        CurvatureOptions {
            scale_invariant: false,
            ..CurvatureOptions::PAPER
        },
        CurvatureOptions {
            mean_curvature: true,
            ..CurvatureOptions::PAPER
        },
    ];
    for setting in [Setting::tight(), Setting::roomy()] {
        for options in variants {
            let solved = setting.solved(Energy::Curvature(options)).depths.solved;
            assert_eq!(solved.method, Method::DualWorkingSet, "{options:?}");
            let proof = solved.optimality;
            let worst = proof
                .gap
                .max(proof.primal_residual)
                .max(proof.dual_residual);
            assert!(worst < 1e-7, "{options:?}: {proof:?}");
        }
    }
}
