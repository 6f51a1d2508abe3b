//! Where the cameras of the pictures stand and how much they show.

use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::view::View;
use glam::DVec3;

/// The picture's half width over the model's: a little air around it.
pub(super) const MARGIN: f64 = 1.05;

/// The camera of a view's pictures: towards the middle of its models, upright, square, with the tangent of half the
/// field of view so that the models fill the picture but for 5 %.
pub fn camera(view: &View) -> (ImagePlane, f64) {
    let target = view.target();
    let middle = target
        .bounds()
        .map_or(view.look_at, |(lo, hi)| (lo + hi) / 2.0);
    framing(view.eye, &target, middle)
}

/// The same for any eye and mesh: looking at `middle`, with all of the mesh in the picture that lies before the eye.
pub fn framing(eye: DVec3, target: &TriMesh, middle: DVec3) -> (ImagePlane, f64) {
    let plane = ImagePlane::looking_at(eye, middle);
    let reach = target
        .vertices
        .iter()
        .filter_map(|v| plane.project(*v))
        .map(|q| q.abs().max_element())
        .fold(0.0, f64::max);
    (plane, if reach > 0.0 { MARGIN * reach } else { 1.0 })
}
