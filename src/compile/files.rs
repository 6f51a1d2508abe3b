//! The bytes of every output file.

use super::OutputFile;
use super::pictures::Pictures;
use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::diagram::plan;
use crate::diagram::section::groups_sheet;
use crate::formats::{
    Camera, Lens, Metadata, Part, write_3mf, write_glb, write_stl, write_surface_obj,
    write_surface_ply,
};
use crate::geom::FAR_MM;
use crate::kinds::Optimised;
use crate::mesh::TriMesh;
use crate::render::{camera, thumbnail};
use crate::scene::Scene;
use crate::support::SupportKind;
use crate::view::View;

/// Grey of base and bare pillars in coloured files.
pub const BARE_COLOUR: [u8; 3] = [198, 194, 186];
/// Side of the 3MF's thumbnail, pixels.
const THUMBNAIL_PX: u32 = 512;

fn parts<'a>(scene: &Scene, forest: &'a Forest) -> Vec<Part<'a>> {
    let mut parts = vec![Part {
        name: "base and pillars".into(),
        colour: BARE_COLOUR,
        solid: &forest.bare,
    }];
    for (view, relief) in scene.views.iter().zip(&forest.reliefs) {
        parts.extend(relief.iter().map(|solid| Part {
            name: format!("{} reliefs", view.name),
            colour: view.colour,
            solid,
        }));
    }
    parts
}

pub fn printable_files(scene: &Scene, forest: &Forest) -> Vec<OutputFile> {
    let parts = parts(scene, forest);
    let (mut mesh, mut colours) = (TriMesh::default(), Vec::new());
    for part in &parts {
        mesh.append(part.solid.mesh());
        colours.resize(mesh.faces.len(), part.colour);
    }
    let meta = Metadata {
        title: scene.title.clone(),
        description: format!(
            "{} by pillarforest: {}",
            carriers(scene),
            scene
                .views
                .iter()
                .map(|v| v.name.as_str())
                .collect::<Vec<_>>()
                .join(", ")
        ),
        application: format!("pillarforest {}", env!("CARGO_PKG_VERSION")),
        own: vec![
            ("views".into(), scene.views.len().to_string()),
            ("pillars".into(), pillars(scene).to_string()),
        ],
        ..Metadata::default()
    };
    let three_mf = || {
        let picture = thumbnail(&mesh, &Bvh::new(&mesh), Some(&colours), THUMBNAIL_PX);
        file("forest.3mf", write_3mf(&parts, &meta, Some(&picture)))
    };
    let glb = || {
        file(
            "forest.glb",
            write_glb(
                &parts,
                &scene.views.iter().map(view_camera).collect::<Vec<_>>(),
            ),
        )
    };
    let output = &scene.output;
    let mut files = Vec::new();
    files.extend(output.forest_3mf.then(three_mf));
    files.extend(
        output
            .forest_stl
            .then(|| file("forest.stl", write_stl(&forest.whole, &scene.title))),
    );
    files.extend(output.forest_glb.then(glb));
    files
}

/// The optimised surfaces as PLY and OBJ, if they are wanted.
pub fn surface_files(scene: &Scene, shapes: &[Box<dyn Optimised + '_>]) -> Vec<OutputFile> {
    let mut files = Vec::new();
    let views = scene.views.iter().zip(shapes);
    for (view, shape) in views.filter(|_| scene.output.surface) {
        let surface = &shape.surface();
        let path = |extension| format!("surface-{}.{extension}", view.name);
        files.push(file(path("ply"), write_surface_ply(surface)));
        files.push(file(path("obj"), write_surface_obj(surface)));
    }
    files
}

/// Sections of every view as SVG and PNG, if they are wanted.
pub fn section_files(scene: &Scene, shapes: &[Box<dyn Optimised + '_>]) -> Vec<OutputFile> {
    let views = scene.views.iter().zip(shapes);
    let sheet = |(view, shape): (&View, &Box<dyn Optimised + '_>)| {
        let sheet = groups_sheet(&view.name, &shape.section());
        let path = |extension| format!("groups-{}.{extension}", view.name);
        [
            file(path("svg"), sheet.svg().into_bytes()),
            file(path("png"), sheet.png(scene.output.plan_width)),
        ]
    };
    views
        .filter(|_| scene.output.groups)
        .flat_map(sheet)
        .collect()
}

/// How far from what is seen the camera of an eye at infinity stands, millimetres: any place outside of all forests will do.
const CAMERA_MM: f64 = 1000.0;

fn view_camera(view: &View) -> Camera {
    let (plane, half) = camera(view);
    let (back, lens) = if view.orthographic {
        (FAR_MM - CAMERA_MM, Lens::Orthographic(half * FAR_MM))
    } else {
        (0.0, Lens::Perspective(2.0 * half.atan()))
    };
    let eye = view.eye + back * plane.forward;
    Camera {
        name: view.name.clone(),
        eye,
        look_at: eye + plane.forward,
        lens,
    }
}

/// `rooms` as in [`plan`].
pub fn plan_files(scene: &Scene, rooms: &[Option<f64>]) -> Vec<OutputFile> {
    let plan = plan(&scene.title, &scene.views, &scene.supports, rooms);
    vec![
        file("plan.svg", plan.svg().into_bytes()),
        file("plan.png", plan.png(scene.output.plan_width)),
    ]
}

pub fn file(path: impl Into<String>, bytes: Vec<u8>) -> OutputFile {
    OutputFile {
        path: path.into(),
        bytes,
    }
}

pub fn pillars(scene: &Scene) -> usize {
    scene
        .supports
        .iter()
        .filter(|s| matches!(s.kind, SupportKind::Pillar { .. }))
        .count()
}

/// What reliefs are carried by: "27 pillars", "1 support", or both.
pub fn carriers(scene: &Scene) -> String {
    let bodies = scene.supports.iter().filter(|s| s.is_body()).count();
    let pillars = pillars(scene);
    let plural = if bodies == 1 { "" } else { "s" };
    match (pillars, bodies) {
        (_, 0) => format!("{pillars} pillars"),
        (0, _) => format!("{bodies} support{plural}"),
        _ => format!("{pillars} pillars, {bodies} other support{plural}"),
    }
}

pub fn counts(scene: &Scene) -> String {
    format!("{}, {} views", carriers(scene), scene.views.len())
}

pub fn summary(scene: &Scene, forest: &Forest, pictures: &[Pictures]) -> String {
    let (lo, hi) = forest.whole.bounds();
    let size = hi - lo;
    let likeness: Vec<String> = scene
        .views
        .iter()
        .zip(pictures)
        .map(|(v, p)| format!("{} {:.1} deg", v.name, p.likeness.mean_deg))
        .collect();
    format!(
        "{}, {:.0} x {:.0} x {:.0} mm, {:.0} cm3, watertight; {}",
        carriers(scene),
        size.x,
        size.y,
        size.z,
        forest.whole.volume_mm3() / 1000.0,
        likeness.join(" / ")
    )
}
