//! The pictures of a finished forest, and the figures they give.

use super::built::Built;
use super::output::OutputFile;
use crate::kinds::Optimised;
use crate::render::{
    LightLikeness, Likeness, ViewPictures, light_pictures, turntable, view_pictures,
};
use crate::scene::Scene;
use crate::view::View;
use rayon::prelude::*;

/// One view's pictures (PNG) and figures.
pub(crate) struct Pictures {
    pub likeness: Likeness,
    pub view: ViewPictures,
    /// In real light, if the scene wants it.
    pub lights: Option<(Vec<LightLikeness>, Vec<u8>)>,
}

/// The pictures of every view.
pub(crate) fn drawn(built: &Built) -> Vec<Pictures> {
    let (mesh, bvh, output) = (built.forest.whole.mesh(), &built.bvh, &built.scene.output);
    let of_view = |(v, shape): (&View, &dyn Optimised)| {
        let steps = shape.steps().map(|(lines, all)| (lines, *all));
        let (likeness, view) = view_pictures(v, mesh, bvh, None, steps, output.picture_size);
        Pictures {
            likeness,
            view,
            lights: (output.lights).then(|| light_pictures(v, mesh, bvh)),
        }
    };
    let shapes = built.shapes.par_iter().map(AsRef::as_ref);
    let views = built.scene.views.par_iter().zip(shapes);
    views.map(of_view).collect()
}

/// `turntable.png`, if it is wanted.
pub(crate) fn turntable_file(built: &Built) -> Option<OutputFile> {
    let output = &built.scene.output;
    let view = built.scene.views.first().filter(|_| output.turntable)?;
    let solid = built.forest.whole.mesh();
    let strip = turntable(view, solid, &built.bvh, output.picture_size);
    Some(OutputFile::new("turntable.png", strip))
}

/// `views/<view>.png` if `views` are wanted, and `views/<view>-lights.png` if they were drawn.
pub(crate) fn picture_files(scene: &Scene, pictures: &[Pictures], views: bool) -> Vec<OutputFile> {
    let mut files = Vec::new();
    for (view, drawn) in scene.views.iter().zip(pictures) {
        let name = &view.name;
        files.extend(
            views.then(|| OutputFile::new(format!("views/{name}.png"), drawn.view.sheet.clone())),
        );
        let sheet = |(_, png): &(_, Vec<u8>)| {
            OutputFile::new(format!("views/{name}-lights.png"), png.clone())
        };
        files.extend(drawn.lights.as_ref().map(sheet));
    }
    files
}
