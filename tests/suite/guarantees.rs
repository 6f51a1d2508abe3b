//! What is promised on every ray: bounds, depth orders, optimality, independence of the file's order.

use crate::shapes::{MIDDLE, Outcome, Setting, ball, extent, wavy};
use glam::{DVec2, DVec3};
use ndarray::{Array1, Array2};
use pillarforest::certify::layer::{bound_violation_mm, order_inversions};
use pillarforest::geom::barycentric;
use pillarforest::index::{CellId, FaceId, GroupId, VertexId};
use pillarforest::laplacian::FaceGeometry;
use pillarforest::mesh::TriMesh;
use pillarforest::mesh::gate::gate;
use pillarforest::mimic::{
    CurvatureOptions, Energy, FaceWeight, NormalOptions, Program, Row, RowKind, optimality, solve,
};
use pillarforest::relief::Relief;
use pillarforest::support::{Datum, SupportKind};
use pillarforest::viewmap::SupportField;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

const ENERGIES: [Energy; 2] = [
    Energy::Normal(NormalOptions {
        weight: FaceWeight::Area,
        ordering: true,
        reweight: 0,
    }),
    Energy::Curvature(CurvatureOptions::PAPER),
];

/// A ball with deep waves, parts of which hide each other, and a little ball before it.
fn contoured(datum: Datum) -> Setting {
    let mut setting = Setting::tight();
    setting.model = wavy(12.0, 0.25);
    let little = ball(MIDDLE + DVec3::new(2.0, -16.0, 2.0), 3.0, 8);
    setting.model.append(&little);
    for layer in setting.supports.iter_mut().filter_map(|s| s.layer.as_mut()) {
        layer.extent = extent(datum, layer.back());
    }
    setting
}

/// A fixed sequence of numbers between 0 and 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Barycentric coordinates of a point of a triangle.
    fn inside(&mut self) -> [f64; 3] {
        let (a, b) = (self.next(), self.next());
        let (a, b) = if a + b > 1.0 {
            (1.0 - a, 1.0 - b)
        } else {
            (a, b)
        };
        [a, b, 1.0 - a - b]
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

#[test]
fn reliefs_stay_in_their_layers_on_every_ray() {
    for (energy, datum) in [
        (ENERGIES[0], Datum::Plane),
        (ENERGIES[1], Datum::Plane),
        (ENERGIES[0], Datum::Surface),
    ] {
        let setting = contoured(datum);
        let solved = setting.solved(energy);
        let clamp = solved.relief.clamp_mm;
        assert!(clamp < 1e-6, "{energy:?}: clamped by {clamp} mm");
        let field = SupportField::new(&setting.supports);
        let told = bound_violation_mm(&solved.sight, &solved.relief);
        assert!(told < 1e-6, "{told} mm");
        let mut numbers = Numbers(1);
        let (mut rays, mut off) = (0, 0);
        let depth = &solved.relief.depth;
        for (c, corners) in CellId::all(depth.len()).zip(depth) {
            let (Some(z), Some(s)) = (corners, solved.map().cells[c].support) else {
                continue;
            };
            let support = &setting.supports[s];
            let SupportKind::Pillar { axis, .. } = &support.kind else {
                panic!("pillars carry reliefs")
            };
            let layer = support.layer.expect("a layer");
            let towards = *axis - setting.eye.truncate();
            for _ in 0..8 {
                let beta = numbers.inside();
                let triangle = solved.map().triangle(c);
                let q: DVec2 = (0..3).map(|k| beta[k] * triangle[k]).sum();
                let depth = 1.0 / (0..3).map(|k| beta[k] / z[k]).sum::<f64>();
                let direction = solved.map().plane.direction(q);
                // How far the relief stands behind what its layer is measured from, millimetres at the axis.
                let behind = match datum {
                    Datum::Plane => {
                        let p = setting.eye + depth * direction;
                        (p.truncate() - *axis).dot(towards.normalize())
                    }
                    Datum::Surface => {
                        let Some((hit, t)) = field.first_hit(setting.eye, direction) else {
                            continue;
                        };
                        if hit != s {
                            continue;
                        }
                        (depth / t - 1.0) * towards.length()
                    }
                };
                rays += 1;
                off += usize::from(!(-layer.front - 1e-6..=layer.back() + 1e-6).contains(&behind));
            }
        }
        // Merging cells thinner than 0.002 mm may leave a ray on the next facet of a surface.
        let most = if datum == Datum::Surface {
            rays / 500
        } else {
            0
        };
        assert!(
            rays > 2000 && off <= most,
            "{energy:?} {datum:?}: {off} of {rays}"
        );
    }
}

/// Rays through random points of random faces on which two sheets of one support have changed places, of all with two.
fn inverted(setting: &Setting, solved: &Outcome, rays: usize) -> (usize, usize) {
    let (target, map, groups) = (solved.target(), solved.map(), solved.groups());
    let (field, depths) = (SupportField::new(&setting.supports), &solved.depths);
    let mut seen: Vec<(FaceId, GroupId)> = Vec::new();
    for (c, cell) in map.all() {
        if let (Some(f), Some(g)) = (cell.face, groups.of_cell[c]) {
            seen.push((f, g));
        }
    }
    seen.sort_unstable();
    seen.dedup();
    let depth_on = |face: FaceId, q: DVec2, s: &dyn Fn(VertexId) -> f64| {
        let [a, b, c] = target.image_of(face);
        let beta = barycentric(a, b, c, q).to_array();
        let v = target.mesh.faces[face];
        let inverse: f64 = (0..3)
            .map(|k| beta[k] / (s(v[k]) * target.depth[v[k]]))
            .sum();
        (beta.iter().all(|x| *x > 1e-6)).then_some(1.0 / inverse)
    };
    let mut numbers = Numbers(7);
    let (mut wrong, mut met) = (0, 0);
    for _ in 0..rays {
        let (face, _) = seen[numbers.below(seen.len())];
        let (beta, corners) = (numbers.inside(), target.image_of(face));
        let q: DVec2 = (0..3).map(|k| beta[k] * corners[k]).sum();
        let Some((support, _)) = field.first_hit(setting.eye, map.plane.direction(q)) else {
            continue;
        };
        let here: Vec<(f64, f64)> = seen
            .iter()
            .filter(|(_, g)| groups.groups[*g].support == support)
            .filter_map(|(f, g)| {
                let model = depth_on(*f, q, &|_| 1.0)?;
                let made = depth_on(*f, q, &|v| depths.s[v])?;
                Some((model, made / depths.mu[*g]))
            })
            .collect();
        for (i, a) in here.iter().enumerate() {
            for b in &here[i + 1..] {
                // Sheets closer than a ten thousandth of their depth touch in the model.
                if (a.0 - b.0).abs() > 2e-4 * a.0 {
                    met += 1;
                    wrong += usize::from((a.0 - b.0) * (a.1 - b.1) < -1e-6 * (a.0 - b.0).abs());
                }
            }
        }
    }
    (wrong, met)
}

#[test]
fn sheets_keep_their_order_on_every_ray() {
    let setting = contoured(Datum::Plane);
    let with = setting.solved(ENERGIES[0]);
    assert_eq!(with.depths.solved.broken, 0, "{:?}", with.depths.solved);
    assert_eq!(order_inversions(&with.sight, &with.relief), 0);
    let (wrong, met) = inverted(&setting, &with, 3000);
    assert!(met > 300 && wrong == 0, "{wrong} of {met}");
    // The same count must find what is wrong when nothing keeps the order.
    let free = Energy::Normal(NormalOptions {
        weight: FaceWeight::Area,
        ordering: false,
        reweight: 0,
    });
    let without = setting.solved(free);
    let (wrong, met) = inverted(&setting, &without, 3000);
    assert!(wrong > 10, "{wrong} of {met}");
    assert!(order_inversions(&without.sight, &without.relief) > 10);
}

#[test]
fn a_certificate_finds_what_is_wrong_with_a_relief() {
    let setting = Setting::tight();
    let solved = setting.solved(ENERGIES[0]);
    let violation = |relief: &Relief| bound_violation_mm(&solved.sight, relief);
    assert_eq!(violation(&solved.relief), 0.0);
    let cell = solved
        .relief
        .depth
        .iter()
        .position(Option::is_some)
        .expect("a relief");
    let mut moved = solved.relief.clone();
    if let Some(z) = &mut moved.depth[cell] {
        z[0] += 10.0;
    }
    let told = violation(&moved);
    assert!((7.0..13.1).contains(&told), "{told} mm");
}

/// A mesh whose vertices and faces stand in another order.
fn shuffled(mesh: &TriMesh, seed: u64) -> TriMesh {
    let mut numbers = Numbers(seed);
    let mut shuffle = |n: usize| {
        let mut order: Vec<usize> = (0..n).collect();
        (1..n)
            .rev()
            .for_each(|i| order.swap(i, numbers.below(i + 1)));
        order
    };
    let (vertices, faces) = (shuffle(mesh.vertices.len()), shuffle(mesh.faces.len()));
    let mut number = vec![VertexId(0); vertices.len()];
    VertexId::all(vertices.len())
        .zip(&vertices)
        .for_each(|(new, old)| number[*old] = new);
    TriMesh {
        vertices: vertices.iter().map(|v| mesh.vertices[*v]).collect(),
        faces: faces
            .iter()
            .map(|f| {
                let [a, b, c] = mesh.faces[*f].map(|v| number[v]);
                [[a, b, c], [b, c, a], [c, a, b]][f % 3]
            })
            .collect(),
    }
}

#[test]
fn the_order_of_a_file_does_not_matter() {
    let mut setting = contoured(Datum::Plane);
    let models = [0, 3, 11].map(|seed| {
        let mesh = if seed == 0 {
            setting.model.clone()
        } else {
            shuffled(&setting.model, seed)
        };
        gate(mesh).expect("a sound model").mesh
    });
    assert_ne!(shuffled(&setting.model, 3).faces, setting.model.faces);
    let reliefs = models.map(|model| {
        setting.model = model;
        ENERGIES.map(|energy| setting.solved(energy).relief)
    });
    for relief in &reliefs[1..] {
        for (a, b) in relief.iter().zip(&reliefs[0]) {
            assert_eq!(a.depth.len(), b.depth.len());
            for (a, b) in a.depth.iter().zip(&b.depth) {
                let far = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-6;
                let moved = a.iter().flatten().zip(b.iter().flatten()).any(far);
                assert!(a.is_some() == b.is_some() && !moved, "{a:?} {b:?}");
            }
        }
    }
}

/// A small program of the kind that surfaces give: the Dirichlet energy of a ball of facets, bounds on its vertices.
fn program(limits: &[f64]) -> Program {
    let mesh = ball(DVec3::ZERO, 1.0, 5);
    let n = mesh.vertices.len();
    let geometry = FaceGeometry::new(&mesh);
    let mut quadratic = sprs::TriMat::new((n, n));
    for (f, face) in mesh.faces.iter().enumerate() {
        for k in 0..3 {
            let (i, j) = (face[(k + 1) % 3].at(), face[(k + 2) % 3].at());
            let c = geometry.cotangents[f][k];
            quadratic.add_triplet(i, i, c);
            quadratic.add_triplet(j, j, c);
            quadratic.add_triplet(i.min(j), i.max(j), -c);
        }
    }
    (0..n).for_each(|i| quadratic.add_triplet(i, i, 1e-3));
    let rows = limits.iter().enumerate().map(|(r, limit)| {
        let v = r / 2 % n;
        let w = (v * 7 + 3) % n;
        let terms = match r % 4 {
            0 => vec![(v, 1.0)],
            1 => vec![(v, -1.0)],
            _ => vec![(v, 1.0), (w, -1.0)],
        };
        Row {
            kind: RowKind::Far(r as u32),
            terms,
            limit: *limit,
        }
    });
    Program {
        variables: n,
        quadratic: quadratic.to_csc(),
        factor: Vec::new(),
        linear: (0..n).map(|i| ((i * 37 % 11) as f64 - 5.0) / 3.0).collect(),
        equalities: Vec::new(),
        rows: rows.collect(),
    }
}

/// The optimum by least distance programming (Lawson & Hanson 1974, chapter 23): the Cholesky factor turns the objective into a
/// distance, and the nearest point of a polyhedron is a problem of nonnegative least squares.
fn least_distance(program: &Program) -> f64 {
    let n = program.variables;
    let mut l = Array2::<f64>::zeros((n, n));
    for (value, (i, j)) in &program.quadratic {
        l[(i, j)] = *value;
        l[(j, i)] = *value;
    }
    for j in 0..n {
        for k in 0..j {
            for i in j..n {
                l[(i, j)] -= l[(i, k)] * l[(j, k)];
            }
        }
        let root = l[(j, j)].sqrt();
        (j..n).for_each(|i| l[(i, j)] /= root);
    }
    // L x = b.
    let forward = |b: Vec<f64>| {
        let mut x = b;
        for i in 0..n {
            (0..i).for_each(|k| x[i] -= l[(i, k)] * x[k]);
            x[i] /= l[(i, i)];
        }
        x
    };
    // w = L'u + L^-1 q; a'u <= b becomes (L^-1 a)'w <= b + (L^-1 a)'(L^-1 q).
    let shift = forward(program.linear.clone());
    let rows = program.rows.len();
    let mut matrix = Array2::<f64>::zeros((n + 1, rows));
    for (r, row) in program.rows.iter().enumerate() {
        let mut a = vec![0.0; n];
        row.terms.iter().for_each(|(j, v)| a[*j] += v);
        let g = forward(a);
        let dot: f64 = g.iter().zip(&shift).map(|(a, b)| a * b).sum();
        (0..n).for_each(|i| matrix[(i, r)] = -g[i]);
        matrix[(n, r)] = -(row.limit + dot);
    }
    let mut wanted = Array1::<f64>::zeros(n + 1);
    wanted[n] = 1.0;
    let (z, _) = nnls::nnls(matrix.view(), wanted.view());
    let residual = matrix.dot(&z) - &wanted;
    let w: Vec<f64> = (0..n).map(|i| -residual[i] / residual[n]).collect();
    let square = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
    (square(&w) - square(&shift)) / 2.0
}

#[test]
fn two_solvers_find_the_same_optimum_and_the_certificate_proves_it() {
    let limits = proptest::collection::vec(0.02f64..0.6, 120);
    let mut runner = TestRunner::deterministic();
    runner
        .run(&limits, |limits| {
            let program = program(&limits);
            let solution = solve(&program).expect("0 satisfies all rows");
            let proof = solution.solved.optimality;
            let other = least_distance(&program);
            let relative = (proof.objective - other).abs() / other.abs();
            prop_assert!(relative < 1e-6, "{} against {other}", proof.objective);
            prop_assert!(proof.active > 0 && proof.primal_residual < 1e-7);
            prop_assert!(proof.dual_residual < 1e-6 && proof.gap < 1e-6, "{proof:?}");
            // Not the optimum: the gap tells, and is no smaller than what is lost.
            let shrunk: Vec<f64> = solution.u.iter().map(|u| 0.9 * u).collect();
            let worse = optimality(&program, &shrunk, &solution.z, &solution.y);
            prop_assert!(worse.objective > proof.objective);
            prop_assert!(worse.dual_residual > 1e-3, "{worse:?}");
            Ok(())
        })
        .unwrap_or_else(|e| panic!("{e}"));
}
