//! The pictures of a finished forest, and the figures they give.

use super::OutputFile;
use super::files::file;
use super::sight::Shape;
use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::render::{LightLikeness, Likeness, light_pictures, view_picture};
use crate::scene::Scene;
use crate::view::View;

/// One view's pictures (PNG) and figures.
pub struct Pictures {
    pub likeness: Likeness,
    pub view: Vec<u8>,
    /// In real light, if the scene wants it.
    pub lights: Option<(Vec<LightLikeness>, Vec<u8>)>,
}

/// The pictures of every view; `shapes` are the views', `bvh` that of the whole forest.
pub fn pictures(scene: &Scene, shapes: &[Shape], forest: &Forest, bvh: &Bvh) -> Vec<Pictures> {
    let mesh = forest.whole.mesh();
    let of_view = |(v, shape): (&View, &Shape)| {
        let steps = shape.steps.as_ref().map(|(lines, all)| (&lines[..], *all));
        let size = scene.output.picture_size;
        let (likeness, view) = view_picture(v, mesh, bvh, None, steps, size);
        Pictures {
            likeness,
            view,
            lights: (scene.output.lights).then(|| light_pictures(v, mesh, bvh)),
        }
    };
    scene.views.iter().zip(shapes).map(of_view).collect()
}

/// `views/<view>.png` if `views` are wanted, and `views/<view>-lights.png` if they were drawn.
pub fn picture_files(scene: &Scene, pictures: Vec<Pictures>, views: bool) -> Vec<OutputFile> {
    let mut files = Vec::new();
    for (view, drawn) in scene.views.iter().zip(pictures) {
        let name = &view.name;
        files.extend(views.then(|| file(format!("views/{name}.png"), drawn.view)));
        let sheet = |(_, png)| file(format!("views/{name}-lights.png"), png);
        files.extend(drawn.lights.map(sheet));
    }
    files
}
