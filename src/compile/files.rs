//! The bytes of every output file.

use super::built::Built;
use super::certificates::Certificates;
use super::elsewhere::{camouflage_files, rooms};
use super::headline::{carriers, pillars};
use super::output::OutputFile;
use super::pictures::turntable_file;
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
use crate::view::View;
use rayon::prelude::*;

/// Grey of base and bare pillars in coloured files.
pub(crate) const BARE_COLOUR: [u8; 3] = [198, 194, 186];
/// Side of the 3MF's thumbnail, pixels.
const THUMBNAIL_PX: u32 = 512;

/// Everything but the report and the views' pictures; `pieces` are the files of a forest in pieces.
pub(crate) fn forest_files(
    built: &Built,
    pieces: Vec<OutputFile>,
    certificates: &Certificates,
) -> Vec<OutputFile> {
    let (scene, output) = (built.scene, &built.scene.output);
    let printable = || printable_files(scene, &built.forest);
    let surfaces = || surface_files(scene, &built.shapes);
    let sections = || section_files(scene, &built.shapes);
    let plan = || match output.plan {
        true => plan_files(scene, &rooms(&certificates.views)),
        false => Vec::new(),
    };
    let camouflage = || camouflage_files(scene, &certificates.camouflage);
    let turned = || turntable_file(built).into_iter().collect();
    let before: [FileMaker; 4] = [&printable, &surfaces, &sections, &turned];
    let after: [FileMaker; 2] = [&plan, &camouflage];
    let (mut files, rest) = rayon::join(|| all(&before), || all(&after));
    files.extend(pieces);
    files.extend(rest);
    files
}

/// Makes some of the files.
type FileMaker<'a> = &'a (dyn Fn() -> Vec<OutputFile> + Sync);

/// Files of several jobs, side by side.
fn all(jobs: &[FileMaker]) -> Vec<OutputFile> {
    jobs.par_iter().flat_map_iter(|job| job()).collect()
}

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

fn printable_files(scene: &Scene, forest: &Forest) -> Vec<OutputFile> {
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
    let output = &scene.output;
    let three_mf = || {
        let picture = thumbnail(&mesh, &Bvh::new(&mesh), Some(&colours), THUMBNAIL_PX);
        let bytes = write_3mf(&parts, &meta, Some(&picture));
        vec![OutputFile::new("forest.3mf", bytes)]
    };
    let stl = || {
        let bytes = write_stl(&forest.whole, &scene.title);
        vec![OutputFile::new("forest.stl", bytes)]
    };
    let glb = || {
        let cameras: Vec<Camera> = scene.views.iter().map(view_camera).collect();
        vec![OutputFile::new("forest.glb", write_glb(&parts, &cameras))]
    };
    let jobs: [(bool, FileMaker); 3] = [
        (output.forest_3mf, &three_mf),
        (output.forest_stl, &stl),
        (output.forest_glb, &glb),
    ];
    let wanted: Vec<FileMaker> = jobs.iter().filter(|j| j.0).map(|j| j.1).collect();
    all(&wanted)
}

/// The optimised surfaces as PLY and OBJ, if they are wanted.
fn surface_files(scene: &Scene, shapes: &[Box<dyn Optimised + '_>]) -> Vec<OutputFile> {
    let mut files = Vec::new();
    let views = scene.views.iter().zip(shapes);
    for (view, shape) in views.filter(|_| scene.output.surface) {
        let surface = &shape.surface();
        let path = |extension| format!("surface-{}.{extension}", view.name);
        files.push(OutputFile::new(path("ply"), write_surface_ply(surface)));
        files.push(OutputFile::new(path("obj"), write_surface_obj(surface)));
    }
    files
}

/// Sections of every view as SVG and PNG, if they are wanted.
pub(crate) fn section_files(scene: &Scene, shapes: &[Box<dyn Optimised + '_>]) -> Vec<OutputFile> {
    let views = scene.views.iter().zip(shapes.iter().map(AsRef::as_ref));
    let sheet = |(view, shape): (&View, &dyn Optimised)| {
        let sheet = groups_sheet(&view.name, &shape.section());
        let path = |extension| format!("groups-{}.{extension}", view.name);
        [
            OutputFile::new(path("svg"), sheet.svg().into_bytes()),
            OutputFile::new(path("png"), sheet.png(scene.output.plan_width)),
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
pub(crate) fn plan_files(scene: &Scene, rooms: &[Option<f64>]) -> Vec<OutputFile> {
    let plan = plan(&scene.title, &scene.views, &scene.supports, rooms);
    vec![
        OutputFile::new("plan.svg", plan.svg().into_bytes()),
        OutputFile::new("plan.png", plan.png(scene.output.plan_width)),
    ]
}
