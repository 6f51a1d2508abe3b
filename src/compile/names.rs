//! Which files a goal may write, known before its work.

use super::planning::LAYOUT;
use crate::scene::Scene;

/// All that [`build`](super::build) may write; a name that ends in `/` stands for files in that folder.
pub fn build_names(scene: &Scene) -> Vec<String> {
    let output = &scene.output;
    let mut names = vec!["report.json".to_string()];
    let single = [
        (output.forest_3mf, "forest.3mf"),
        (output.forest_stl, "forest.stl"),
        (output.forest_glb, "forest.glb"),
        (output.report_html, "report.html"),
        (output.camouflage, "camouflage.svg"),
        (output.camouflage, "camouflage.png"),
        (output.split, "layout.svg"),
        (output.split, "split/"),
        (output.split, "split.3mf"),
    ];
    names.extend(
        single
            .iter()
            .filter(|(w, _)| *w)
            .map(|(_, n)| n.to_string()),
    );
    if output.plan {
        names.extend(plan_names(scene));
    }
    let of_views = scene.views.iter().map(|v| &v.name);
    if output.surface {
        names.extend(of_views.clone().map(|v| format!("surface-{v}.ply")));
        names.extend(of_views.map(|v| format!("surface-{v}.obj")));
    }
    names.extend(drawn_names(scene, output.views));
    names
}

/// All that [`plan`](super::plan) may write.
pub fn plan_names(scene: &Scene) -> Vec<String> {
    let mut names = vec!["plan.svg".to_string(), "plan.png".into()];
    names.extend(scene.brief.as_ref().map(|_| LAYOUT.to_string()));
    names
}

/// All that [`pictures`](super::pictures) may write.
pub fn picture_names(scene: &Scene) -> Vec<String> {
    drawn_names(scene, true)
}

/// Pictures of the views if they are wanted, their sections, the turntable, and the layout that was found.
fn drawn_names(scene: &Scene, views: bool) -> Vec<String> {
    let output = &scene.output;
    let mut names: Vec<String> = Vec::new();
    for view in scene.views.iter().map(|v| &v.name) {
        names.extend(views.then(|| format!("views/{view}.png")));
        names.extend(output.lights.then(|| format!("views/{view}-lights.png")));
        names.extend(output.groups.then(|| format!("groups-{view}.svg")));
        names.extend(output.groups.then(|| format!("groups-{view}.png")));
    }
    names.extend(output.turntable.then(|| "turntable.png".to_string()));
    names.extend(scene.brief.as_ref().map(|_| LAYOUT.to_string()));
    names
}
