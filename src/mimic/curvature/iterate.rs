//! The nonlinear problem by a sequence of programs, each with the cotangent Laplacian of the last one's surface (Fig 6).
//!
//! Eq 9 takes cotangents and areas from the model. Here every round takes them from the surface of the round before; what is
//! wanted stays the model's curvature over the region of each vertex (`Sheet::rows_on`). The paper does not write its update down;
//! of several that were tried (wanted vectors turned, or of the deformed surface's length) this alone converged on its box.
//! Round 0 is the linearised problem itself.
//!
//! Nothing promises that it converges: cotangents of triangles that became obtuse are far off (so the paper, which found it to work for
//! small regular meshes only), and hidden parts without bounds and with little weight run away first: on the box it wants
//! `hidden_weight: 1`, as the paper's figure has. So the turning of the seen faces, measured without any Laplacian, watches over
//! every round, and where the rounds do not end well the best of them is kept and the ending told.

use super::problem::Problem;
use super::sheet::Sheet;
use crate::index::FaceId;
use crate::mesh::TriMesh;
use crate::mimic::depths::{Depths, seen_solid_angles};
use crate::mimic::iterated::{Ending, Iterated, Round};
use glam::DVec3;

/// Change at which the rounds have converged, as a share of the layer's width: 7 micrometres of 7 mm, less than any printer's
/// resolution.
const SETTLED: f64 = 1e-3;
/// Mean turn over the best one from which a surface runs away: on the box it falls from round to round, and a surface that lost a
/// tenth never came back.
const RUNAWAY: f64 = 1.1;

/// The depths after as many rounds as it takes, from the solution `first` of the linearised problem.
pub(crate) fn iterated(problem: &Problem, first: Depths) -> Depths {
    let gauge = Turn::new(problem);
    let linearised_deg = gauge.mean_deg(&first.s);
    let mut kept = (0, linearised_deg, first.clone());
    let (mut rounds, mut last) = (Vec::new(), first);
    let mut ending = Ending::Unfinished;
    for k in 1..=problem.options.iterate as usize {
        let sheet = Sheet::new(&surface(problem, &last.s), problem.image.map.plane.eye);
        let forms = problem.model.rows_on(&sheet, &last.s);
        let next = problem.solve(&sheet, &forms, &last.s).map(|found| found.0);
        let Some(next) = next.ok().filter(|d| d.s.iter().all(|s| *s > 0.0)) else {
            ending = Ending::Failed;
            break;
        };
        let round = Round {
            change: change(problem, &last.s, &next.s),
            turned_deg: gauge.mean_deg(&next.s),
        };
        rounds.push(round);
        last = next;
        if round.turned_deg > RUNAWAY * kept.1 {
            ending = Ending::Diverged;
            break;
        }
        let converged = round.change <= SETTLED;
        if converged || round.turned_deg < kept.1 {
            kept = (k, round.turned_deg, last.clone());
        }
        if converged {
            ending = Ending::Converged;
            break;
        }
    }
    let (kept, kept_deg, depths) = kept;
    Depths {
        iterated: Some(Iterated {
            allowed: problem.options.iterate,
            rounds,
            ending,
            kept,
            linearised_deg,
            kept_deg,
        }),
        ..depths
    }
}

/// The model moved along the eye's rays.
fn surface(problem: &Problem, s: &[f64]) -> TriMesh {
    let eye = problem.image.map.plane.eye;
    let mesh = &problem.image.target.mesh;
    let moved = mesh
        .vertices
        .iter()
        .zip(s)
        .map(|(v, s)| eye + *s * (*v - eye));
    TriMesh {
        vertices: moved.collect(),
        faces: mesh.faces.clone(),
    }
}

fn change(problem: &Problem, before: &[f64], after: &[f64]) -> f64 {
    let changes = before.iter().zip(after).zip(&problem.visible);
    let seen = changes.filter(|(_, visible)| **visible);
    seen.fold(0.0, |most: f64, ((a, b), _)| most.max((a - b).abs())) / problem.unit
}

/// How far the seen faces are turned.
struct Turn<'a> {
    problem: &'a Problem<'a>,
    /// Seen faces, their normals in the model and solid angles.
    faces: Vec<(FaceId, DVec3, f64)>,
}

impl<'a> Turn<'a> {
    fn new(problem: &'a Problem) -> Self {
        let seen = seen_solid_angles(problem.image);
        let seen = FaceId::all(seen.len())
            .zip(seen)
            .filter(|(_, seen)| *seen > 0.0);
        Self {
            problem,
            faces: seen
                .map(|(f, seen)| (f, problem.image.target.mesh.normal(f), seen))
                .collect(),
        }
    }

    /// Mean angle between the normals of the model and of the surface at relative depths `s`, degrees.
    fn mean_deg(&self, s: &[f64]) -> f64 {
        let moved = surface(self.problem, s);
        let whole: f64 = self.faces.iter().map(|f| f.2).sum();
        let turned = |(f, normal, seen): &(FaceId, DVec3, f64)| {
            seen * moved.normal(*f).angle_between(*normal).to_degrees()
        };
        self.faces.iter().map(turned).sum::<f64>() / whole
    }
}
