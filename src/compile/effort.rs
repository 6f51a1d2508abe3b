//! How long a build will take, before it begins.

use crate::diag::Diagnostic;
use crate::kinds::ReliefKind;
use crate::mimic::Energy;
use crate::scene::Scene;
use crate::view::View;
use crate::words;

/// Shorter builds are not announced, seconds.
const LONG: f64 = 60.0;
/// Builds of models with `detail` should be shorter than this, seconds.
const SHORT: f64 = 30.0;
/// Values of `detail` to suggest. Below 5000 vertices the form of a scan is lost.
const DETAILS: [usize; 5] = [100_000, 50_000, 20_000, 10_000, 5_000];

/// What to know of a build that takes long on so many threads.
pub fn slow(scene: &Scene, threads: usize) -> Option<Diagnostic> {
    let seconds = |most: usize| seconds(scene, threads, most);
    let all = seconds(usize::MAX);
    if all < LONG {
        return None;
    }
    let models = scene.views.iter().flat_map(|v| &v.models);
    let largest = models.max_by_key(|m| m.mesh.vertices.len())?;
    let vertices = largest.mesh.vertices.len();
    let fewer: Vec<usize> = DETAILS.into_iter().filter(|d| *d < vertices).collect();
    let enough = fewer.iter().find(|d| seconds(**d) < SHORT);
    let detail = enough.or(fewer.last()).map(|d| (*d, seconds(*d)));
    Some(words::effort::slow(all, &largest.name, vertices, detail))
}

/// Seconds of a build whose models have at most so many vertices. Views share the threads; one alone keeps no more than one busy.
fn seconds(scene: &Scene, threads: usize, most: usize) -> f64 {
    let at_once = threads.clamp(1, scene.views.len().max(1));
    let work: f64 = scene.views.iter().map(|v| vertices(v, most) as f64).sum();
    work * per_vertex(&scene.relief) / at_once as f64
}

fn vertices(view: &View, most: usize) -> usize {
    let models = view.models.iter();
    models.map(|m| m.mesh.vertices.len().min(most)).sum()
}

/// Seconds of one core for a vertex of a view, all stages together: of scans of 5000 to 173,000 vertices on a plate and on forests of
/// 20 to 30 pillars (two cores, 2026). Times fall within half and twice of it; an iteration that diverges ends sooner.
fn per_vertex(relief: &ReliefKind) -> f64 {
    match relief {
        ReliefKind::Whole(..) => 5e-4,
        ReliefKind::HeightField(Energy::Curvature(options)) => {
            8e-5 + 6e-5 * f64::from(options.iterate)
        }
        ReliefKind::HeightField(Energy::Linear | Energy::Gradient(_)) => 5e-5,
        ReliefKind::HeightField(Energy::Normal(options)) | ReliefKind::Torn(options, _) => {
            1.1e-4 + 6e-5 * f64::from(options.reweight)
        }
    }
}
