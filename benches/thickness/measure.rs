//! The stages from a scene to its reliefs, and the error of the reliefs' normals.

use glam::DVec3;
use pillarforest::diag::Diagnostic;
use pillarforest::relief::Relief;
use pillarforest::scene::Scene;
use pillarforest::sight::Sight;
use pillarforest::view::View;
use pillarforest::viewmap::{Image, SupportField};
use pillarforest::words::sight::unseen;

/// Error of the normals in degrees over the solid angle of what the eye sees: mean, median, and what 90 % lie below.
pub type Errors = [f64; 3];

/// How far the normals of one view's relief are off.
pub fn errors(scene: &Scene, view: &View, field: &SupportField) -> Result<Errors, String> {
    let sight = Sight::new(view, field);
    let sight = sight.map_err(|e| told(&unseen(&view.name, field.supports, &e)))?;
    let shape = scene.relief.optimised(&sight).map_err(|e| e.to_string())?;
    Ok(normal_errors(&sight.image, shape.relief()))
}

/// Compares the plane of every cell of a relief with the model's face there.
fn normal_errors(image: &Image, relief: &Relief) -> Errors {
    let Image { target, map, .. } = image;
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
