//! What comparisons measure without building a solid: the error of the normals of a scene's reliefs.
//!
//! Takes a scene's text with changes, as on the command line; gives the scene, what its eyes see, and for each view the angle
//! between the normals of model and relief. The library has no clock: whoever compares times holds one.

use crate::diag::Diagnostic;
use crate::groups::groups;
use crate::mimic::{Energy, depths};
use crate::relief::{Relief, relief};
use crate::report::NormalError;
use crate::scene::{self, ReadFile, Scene};
use crate::steps::torn;
use crate::view::View;
use crate::viewmap::{SupportField, Target, ViewMap, view_map};
use glam::DVec3;

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

/// What one eye sees; it does not depend on layers and energies.
pub struct MappedView {
    target: Target,
    map: ViewMap,
}

/// Maps all views of a scene.
///
/// # Errors
/// Why a view cannot be mapped.
pub fn mapped(scene: &Scene) -> Result<Vec<MappedView>, String> {
    let field = SupportField::new(&scene.supports);
    let map = |view: &View| {
        let plane = view.plane();
        let target = Target::new(view.target(), &plane).ok_or("models beside the eye")?;
        let map = view_map(plane, &target, &field).map_err(|e| e.to_string())?;
        Ok(MappedView { target, map })
    };
    scene.views.iter().map(map).collect()
}

/// How far the normals of one view's relief are off, degrees over the solid angle of what the eye sees.
///
/// # Errors
/// Why there is no relief.
pub fn relief_errors(scene: &Scene, view: &View, seen: &MappedView) -> Result<NormalError, String> {
    let field = SupportField::new(&scene.supports);
    let MappedView { target, map } = seen;
    let groups = groups(&view.name, map, target, &field).map_err(|p| told(&p))?;
    if let (Energy::Normal(options), Some(steps)) = (scene.energy, &scene.steps) {
        let torn = torn(steps, options, target, map, &field, &groups).map_err(|e| e.to_string())?;
        let relief = relief(&torn.map, &torn.target, &field, &torn.groups, &torn.depths);
        return Ok(normal_errors(&torn.map, &torn.target, &relief));
    }
    let depths = depths(scene.energy, target, map, &groups).map_err(|e| e.to_string())?;
    let relief = relief(map, target, &field, &groups, &depths);
    Ok(normal_errors(map, target, &relief))
}

/// Compares the plane of every cell of a relief with the model's face there.
fn normal_errors(map: &ViewMap, target: &Target, relief: &Relief) -> NormalError {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for (cell, depth) in relief.depth.iter().enumerate() {
        let (Some(depth), Some(face)) = (depth, map.cells[cell].face) else {
            continue;
        };
        let corners = map.triangle(cell);
        let [a, b, c] = [0, 1, 2].map(|k| map.plane.point(corners[k], depth[k]));
        let ray = a - map.plane.eye;
        let made = towards((b - a).cross(c - a), ray);
        let wanted = towards(target.mesh.normal(face as usize), ray);
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

/// `normal`, turned against the ray if it points along it.
fn towards(normal: DVec3, ray: DVec3) -> DVec3 {
    if normal.dot(ray) > 0.0 {
        -normal
    } else {
        normal
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
