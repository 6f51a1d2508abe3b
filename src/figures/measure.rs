//! What comparisons measure without building a solid: the error of the normals of a scene's reliefs.
//!
//! Takes a scene's text with changes, as on the command line; gives the scene, what its eyes see, and for each view the angle
//! between the normals of model and relief. The library has no clock: whoever compares times holds one.

use crate::diag::Diagnostic;
use crate::geom::against;
use crate::index::CellId;
use crate::relief::Relief;
use crate::report::NormalError;
use crate::scene::{self, ReadFile, Scene};
use crate::sight::Sight;
use crate::view::View;
use crate::viewmap::{Image, SupportField};
use crate::words;

/// The scene with changed values, each as `--set` has it.
///
/// # Errors
/// What is wrong with the scene or the changes, in one line.
pub fn changed<S: AsRef<str>>(text: &str, sets: &[S], read: ReadFile) -> Result<Scene, String> {
    let set = |text: String, set: &S| scene::set(&text, set.as_ref());
    let text = sets.iter().try_fold(text.to_owned(), set);
    let text = text.map_err(|d| d.message)?;
    let done = scene::resolve(&text, read).map_err(|problems| told(&problems))?;
    Ok(done.value)
}

/// The sights of all views of a scene whose supports `field` holds.
///
/// # Errors
/// Why a view cannot be seen.
pub fn sights<'a>(scene: &'a Scene, field: &'a SupportField<'a>) -> Result<Vec<Sight<'a>>, String> {
    let see = |view: &'a View| {
        let sight = Sight::new(view, field);
        sight.map_err(|e| told(&words::sight::unseen(&view.name, field.supports, &e)))
    };
    scene.views.iter().map(see).collect()
}

/// How far the normals of one view's relief are off, degrees over the solid angle of what the eye sees.
///
/// # Errors
/// Why there is no relief.
pub fn relief_errors(scene: &Scene, sight: &Sight) -> Result<NormalError, String> {
    let found = scene.relief.optimised(sight).map_err(|e| e.to_string())?;
    Ok(normal_errors(&sight.image, found.relief()))
}

/// Compares the plane of every cell of a relief with the model's face there.
fn normal_errors(image: &Image, relief: &Relief) -> NormalError {
    let Image { map, target, .. } = image;
    let mut found: Vec<(f64, f64)> = Vec::new();
    for (cell, depth) in CellId::all(relief.depth.len()).zip(&relief.depth) {
        let (Some(depth), Some(face)) = (depth, map.cells[cell].face) else {
            continue;
        };
        let corners = map.triangle(cell);
        let [a, b, c] = [0, 1, 2].map(|k| map.plane.point(corners[k], depth[k]));
        let ray = a - map.plane.eye;
        let made = against((b - a).cross(c - a), ray);
        let wanted = target.mesh.normal_against(face, ray);
        found.push((
            made.angle_between(wanted).to_degrees(),
            map.solid_angle(cell),
        ));
    }
    found.retain(|(angle, _)| angle.is_finite());
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = found.iter().map(|f| f.1).sum();
    let mean = found.iter().map(|(angle, w)| angle * w).sum::<f64>() / all;
    NormalError {
        mean,
        median: below(&found, 0.5 * all),
        p90: below(&found, 0.9 * all),
    }
}

/// The angle at which the weights of ascending `(angle, weight)` have added up to `share`.
fn below(found: &[(f64, f64)], share: f64) -> f64 {
    let mut sum = 0.0;
    let reached = found.iter().find(|(_, w)| {
        sum += w;
        sum >= share
    });
    reached.or(found.last()).map_or(0.0, |f| f.0)
}

/// Messages in one line.
fn told(problems: &[Diagnostic]) -> String {
    let messages: Vec<&str> = problems.iter().map(|p| p.message.as_str()).collect();
    messages.join("; ")
}
