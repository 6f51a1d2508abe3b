//! The stages from a scene to its reliefs, and the error of the reliefs' normals.

use glam::DVec3;
use pillarforest::diag::Diagnostic;
use pillarforest::groups::groups;
use pillarforest::mimic::{Energy, depths};
use pillarforest::relief::{Relief, relief};
use pillarforest::scene::Scene;
use pillarforest::steps::torn;
use pillarforest::view::View;
use pillarforest::viewmap::{SupportField, Target, ViewMap, view_map};

/// What one eye sees.
pub struct Seen {
    target: Target,
    map: ViewMap,
}

/// Error of the normals in degrees over the solid angle of what the eye sees: mean, median, and what 90 % lie below.
pub type Errors = [f64; 3];

/// Maps all views of a scene.
pub fn seen(scene: &Scene) -> Result<Vec<Seen>, String> {
    let field = SupportField::new(&scene.supports);
    let map = |view: &View| {
        let plane = view.plane();
        let target = Target::new(view.target(), &plane).ok_or("models beside the eye")?;
        let map = view_map(plane, &target, &field).map_err(|e| e.to_string())?;
        Ok(Seen { target, map })
    };
    scene.views.iter().map(map).collect()
}

/// The relief of one view, and how far its normals are off.
pub fn errors(scene: &Scene, view: &View, seen: &Seen) -> Result<Errors, String> {
    let field = SupportField::new(&scene.supports);
    let Seen { target, map } = seen;
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
fn normal_errors(map: &ViewMap, target: &Target, relief: &Relief) -> Errors {
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
    let whole: f64 = found.iter().map(|f| f.1).sum();
    let mean = found.iter().map(|(angle, w)| angle * w).sum::<f64>() / whole;
    [mean, below(&found, 0.5 * whole), below(&found, 0.9 * whole)]
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
pub fn told(problems: &[Diagnostic]) -> String {
    let messages: Vec<&str> = problems.iter().map(|p| p.message.as_str()).collect();
    messages.join("; ")
}
