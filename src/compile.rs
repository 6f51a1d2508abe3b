//! The pipeline on one screen: the only module that runs stages on a scene.
//!
//! Takes a resolved [`Scene`], gives the bytes of every output file; touches no file, clock or terminal.
//! Views are independent until the solids are united and run in parallel; nothing depends on the thread count.

use crate::bvh::Bvh;
use crate::carve::{Forest, ViewRelief, carve};
use crate::diag::Diagnostic;
use crate::diagram::plan;
use crate::formats::{Camera, Metadata, Part, write_3mf, write_glb, write_stl};
use crate::geom::ImagePlane;
use crate::groups::{Groups, groups};
use crate::mesh::TriMesh;
use crate::mimic::{Depths, Energy, RowKind, SolveError, depths};
use crate::relief::{Relief, relief};
use crate::render::{Likeness, camera, thumbnail, view_picture};
use crate::report::{Check, ProgramReport, Report, SolidReport, ViewReport};
use crate::scene::Scene;
use crate::support::SupportKind;
use crate::view::View;
use crate::viewmap::{SupportField, Target, ViewMap, view_map};
use rayon::prelude::*;

/// A file to be written, relative to the output directory.
#[derive(Clone, Debug)]
pub struct OutputFile {
    pub path: String,
    pub bytes: Vec<u8>,
}

/// What a finished run gives.
#[derive(Clone, Debug, Default)]
pub struct Build {
    pub files: Vec<OutputFile>,
    /// The last line for the terminal without paths and times:
    /// `27 pillars, 144 x 144 x 95 mm, 158 cm3, watertight; bunny 7.7 deg / skull 9.1 deg` (mean normal errors).
    pub summary: String,
    /// Whether every solid passed our own checks.
    pub printable: bool,
    pub warnings: Vec<Diagnostic>,
}

/// What is wanted of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Everything the scene's output section names.
    All,
    /// Only plan.svg and plan.png.
    Plan,
    /// Only the view pictures (the forest is built for them).
    Pictures,
    /// Nothing is written; everything that can be checked before solving is.
    Check,
}

/// Called as work goes on with the stage's name and the share of the whole run done, 0 to 1. May come from any thread.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

/// Grey of base and bare pillars in coloured files.
const BARE_COLOUR: [u8; 3] = [198, 194, 186];
/// Side of the 3MF's thumbnail, pixels.
const THUMBNAIL_PX: u32 = 512;
/// Gaps below this share of a model are rounding at its outline.
const GAP_SHARE: f64 = 1e-6;

/// Runs the stages that `goal` needs.
///
/// # Errors
/// All errors of the stage that failed, at least one of them.
pub fn run(scene: &Scene, goal: Goal, progress: Progress) -> Result<Build, Vec<Diagnostic>> {
    if goal == Goal::Plan {
        progress("plan", 0.1);
        return Ok(Build { files: plan_files(scene), printable: true, summary: counts(scene), ..Build::default() });
    }
    progress("view maps", 0.02);
    let field = SupportField::new(&scene.supports);
    let sights = all(scene.views.par_iter().map(|v| see(v, &field)))?;
    let mut warnings: Vec<Diagnostic> = sights.iter().flat_map(|s| s.warning(scene, &field)).collect();
    if goal == Goal::Check {
        return Ok(Build { summary: counts(scene), printable: true, warnings, ..Build::default() });
    }
    progress("quadratic programs", 0.15);
    let shapes = all(sights.par_iter().map(|s| s.shape(scene.energy, &field)))?;
    progress("solids", 0.45);
    let reliefs: Vec<ViewRelief> = sights.iter().zip(&shapes).map(|(s, r)| s.relief(&r.relief)).collect();
    let forest = carve(&scene.supports, &reliefs).map_err(|e| vec![Diagnostic::error(e.to_string())])?;
    progress("pictures", 0.75);
    let pictures = pictures(scene, &forest);
    let report = report(scene, &sights, &shapes, &forest, &pictures, &warnings);
    progress("files", 0.9);
    let mut files: Vec<OutputFile> =
        pictures.iter().zip(&scene.views).map(|(p, v)| file(format!("views/{}.png", v.name), p.1.clone())).collect();
    if goal == Goal::All {
        files.retain(|_| scene.output.views);
        files.extend(printable_files(scene, &forest));
        files.extend(scene.output.plan.then(|| plan_files(scene)).into_iter().flatten());
        files.push(file("report.json", report.json().into_bytes()));
    }
    if forest.whole.parts() > 1 {
        warnings.push(Diagnostic::warning(format!("the forest comes apart into {} pieces", forest.whole.parts())));
    }
    Ok(Build { files, summary: summary(scene, &forest, &pictures), printable: forest.whole.parts() == 1, warnings })
}

/// All results, or all errors of all views.
fn all<T: Send>(results: impl ParallelIterator<Item = Result<T, Vec<Diagnostic>>>) -> Result<Vec<T>, Vec<Diagnostic>> {
    let results: Vec<_> = results.collect();
    let (good, bad): (Vec<_>, Vec<_>) = results.into_iter().partition(Result::is_ok);
    if bad.is_empty() { Ok(good.into_iter().flatten().collect()) } else { Err(bad.into_iter().filter_map(Result::err).flatten().collect()) }
}

/// One view before optimisation.
struct Sight<'a> {
    view: &'a View,
    target: Target,
    map: ViewMap,
    groups: Groups,
}

/// One view after it.
struct Shape {
    depths: Depths,
    relief: Relief,
}

fn see<'a>(view: &'a View, field: &SupportField) -> Result<Sight<'a>, Vec<Diagnostic>> {
    let failed = |text: String| vec![Diagnostic::error(format!("view \"{}\": {text}", view.name))];
    let plane = ImagePlane::looking_at(view.eye, view.look_at);
    let mut mesh = TriMesh::default();
    view.models.iter().for_each(|m| mesh.append(&m.mesh));
    let target = Target::new(mesh, &plane).ok_or_else(|| failed("part of its models lies beside or behind the eye".into()))?;
    let map = view_map(plane, &target, field).map_err(|e| failed(e.to_string()))?;
    let groups = groups(&view.name, &map, &target, field)?;
    if groups.groups.is_empty() {
        return Err(failed("no pillar stands behind or in its models, so nothing of them can appear".into()));
    }
    Ok(Sight { view, target, map, groups })
}

impl Sight<'_> {
    /// Solid angles in steradians of the models, and of what of them a support carries.
    fn solid_angles(&self) -> (f64, f64) {
        let of = |c: &usize| self.map.solid_angle(*c);
        let seen: Vec<usize> = (0..self.map.cells.len()).filter(|c| self.map.cells[*c].face.is_some()).collect();
        (seen.iter().map(of).sum(), seen.iter().filter(|c| self.groups.of_cell[**c].is_some()).map(of).sum())
    }

    fn coverage(&self) -> f64 {
        let (whole, carried) = self.solid_angles();
        carried / whole
    }

    /// What of the models no support carries, if it is worth telling.
    fn warning(&self, scene: &Scene, field: &SupportField) -> Option<Diagnostic> {
        let gap = 1.0 - self.coverage();
        let largest = (0..self.map.cells.len())
            .filter(|c| self.map.cells[*c].face.is_some() && self.groups.of_cell[*c].is_none())
            .max_by(|a, b| self.map.solid_angle(*a).total_cmp(&self.map.solid_angle(*b)))?;
        let behind = match self.map.cells[largest].support {
            Some(s) => format!("it meets {}, which carries nothing", field.supports[s as usize].name),
            None => "no pillar stands there, or it is too short".into(),
        };
        let side = self.map.points_mean(self.map.cells[largest].corners);
        let (across, above) = (side.x.atan().to_degrees(), side.y.atan().to_degrees());
        (gap > GAP_SHARE).then(|| {
            Diagnostic::warning(format!(
                "view \"{}\" misses {:.2} % of its models, mostly {:.1} degrees {} and {:.1} degrees {} its line of sight: {behind}",
                self.view.name,
                100.0 * gap,
                across.abs(),
                if across < 0.0 { "left of" } else { "right of" },
                above.abs(),
                if above < 0.0 { "below" } else { "above" },
            ))
            .help(format!("add or raise a pillar there, or move the models; \"{}\" has {} pillars", scene.title, pillars(scene)))
        })
    }

    fn shape(&self, energy: Energy, field: &SupportField) -> Result<Shape, Vec<Diagnostic>> {
        let depths = depths(energy, &self.target, &self.map, field, &self.groups).map_err(|e| vec![self.explain(e, field)])?;
        let relief = relief(&self.map, &self.target, field, &self.groups, &depths);
        Ok(Shape { depths, relief })
    }

    /// A solver's failure in terms of the scene: the pillar and the bounds in conflict.
    fn explain(&self, error: SolveError, field: &SupportField) -> Diagnostic {
        let what = Diagnostic::error(format!("view \"{}\": {error}", self.view.name));
        let SolveError::Infeasible(Some(kind)) = error else { return what };
        let (bound, note) = match kind {
            RowKind::Near(b) => (self.groups.bounds.get(b as usize), "nearest"),
            RowKind::Far(b) => (self.groups.bounds.get(b as usize), "farthest"),
            RowKind::Order(_) => (None, "order"),
        };
        let Some(bound) = bound else { return what.help("sheets of the model must swap their depth order: try `ordering: false`") };
        let support = &field.supports[self.groups.groups[bound.group as usize].support as usize];
        what.label(format!("the {note} depth allowed on {} is in conflict (relative depth {:.5} to {:.5})", support.name, bound.lower, bound.upper))
            .help(format!("give {} a thicker layer (`front`, `back`)", support.name))
    }

    fn relief<'a>(&'a self, relief: &'a Relief) -> ViewRelief<'a> {
        ViewRelief { name: &self.view.name, map: &self.map, groups: &self.groups, relief }
    }
}

/// The picture of every view, with its figures.
fn pictures(scene: &Scene, forest: &Forest) -> Vec<(Likeness, Vec<u8>)> {
    let mesh = forest.whole.mesh();
    let bvh = Bvh::new(mesh);
    scene.views.iter().map(|v| view_picture(v, mesh, &bvh, None, scene.output.picture_size)).collect()
}

fn report(scene: &Scene, sights: &[Sight], shapes: &[Shape], forest: &Forest, pictures: &[(Likeness, Vec<u8>)], warnings: &[Diagnostic]) -> Report {
    let views = sights.iter().zip(shapes).zip(pictures).map(|((sight, shape), (likeness, _))| {
        let solved = &shape.depths.solved;
        ViewReport {
            solid_angle_sr: Some(sight.solid_angles().0),
            coverage: Some(sight.coverage()),
            gaps: Some(sight.map.regions(|c| sight.map.cells[c].face.is_some() && sight.groups.of_cell[c].is_none())),
            groups: Some(sight.groups.groups.len()),
            cells: Some(sight.map.cells.len()),
            clamp_mm: Some(shape.relief.clamp_mm),
            program: Some(ProgramReport {
                variables: solved.variables,
                rows: solved.rows,
                active_rows: solved.active,
                iterations: solved.iterations,
                objective: solved.objective,
                primal_residual: solved.primal_residual,
                dual_residual: solved.dual_residual,
                duality_gap_rel: solved.gap,
            }),
            ..ViewReport::new(sight.view).with_likeness(likeness)
        }
    });
    let repairs = &forest.repairs;
    let check = |name: &str, passed: bool, found: String| Check { name: name.into(), passed, found };
    let checks = vec![
        check("closed, oriented, 2-manifold, free of self-intersection", true, String::new()),
        check("one connected part", forest.whole.parts() == 1, format!("{} parts", forest.whole.parts())),
        check("no relief given up", repairs.dropped_cells == 0, format!("{} cells", repairs.dropped_cells)),
        check("loose crumbs dropped", true, format!("{:.5} mm3", repairs.crumbs_mm3)),
        check("floating reliefs tied by a brace", true, format!("{}", repairs.braces)),
        check("relief corners filled in", true, format!("{}", repairs.filled)),
    ];
    Report {
        scene: scene.title.clone(),
        views: views.collect(),
        solid: Some(SolidReport::new(&forest.whole, checks)),
        warnings: warnings.iter().map(|w| w.message.clone()).collect(),
        ..Report::default()
    }
}

fn parts<'a>(scene: &Scene, forest: &'a Forest) -> Vec<Part<'a>> {
    let mut parts = vec![Part { name: "base and pillars".into(), colour: BARE_COLOUR, solid: &forest.bare }];
    for (view, relief) in scene.views.iter().zip(&forest.reliefs) {
        parts.extend(relief.iter().map(|solid| Part { name: format!("{} reliefs", view.name), colour: view.colour, solid }));
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
        description: format!("A pillar forest of {}: {}", pillars(scene), scene.views.iter().map(|v| v.name.as_str()).collect::<Vec<_>>().join(", ")),
        application: format!("pillarforest {}", env!("CARGO_PKG_VERSION")),
        own: vec![("views".into(), scene.views.len().to_string()), ("pillars".into(), pillars(scene).to_string())],
        ..Metadata::default()
    };
    let three_mf = || {
        let picture = thumbnail(&mesh, &Bvh::new(&mesh), Some(&colours), THUMBNAIL_PX);
        file("forest.3mf", write_3mf(&parts, &meta, Some(&picture)))
    };
    let glb = || file("forest.glb", write_glb(&parts, &scene.views.iter().map(view_camera).collect::<Vec<_>>()));
    let output = &scene.output;
    let mut files = Vec::new();
    files.extend(output.forest_3mf.then(three_mf));
    files.extend(output.forest_stl.then(|| file("forest.stl", write_stl(&forest.whole, &scene.title))));
    files.extend(output.forest_glb.then(glb));
    files
}

fn view_camera(view: &View) -> Camera {
    let (plane, half) = camera(view);
    Camera { name: view.name.clone(), eye: view.eye, look_at: view.eye + plane.forward, fov: 2.0 * half.atan() }
}

fn plan_files(scene: &Scene) -> Vec<OutputFile> {
    let plan = plan(&scene.title, &scene.views, &scene.supports);
    vec![file("plan.svg", plan.svg().into_bytes()), file("plan.png", plan.png(scene.output.plan_width))]
}

fn file(path: impl Into<String>, bytes: Vec<u8>) -> OutputFile {
    OutputFile { path: path.into(), bytes }
}

fn pillars(scene: &Scene) -> usize {
    scene.supports.iter().filter(|s| matches!(s.kind, SupportKind::Pillar { .. })).count()
}

fn counts(scene: &Scene) -> String {
    format!("{} pillars, {} views", pillars(scene), scene.views.len())
}

fn summary(scene: &Scene, forest: &Forest, pictures: &[(Likeness, Vec<u8>)]) -> String {
    let (lo, hi) = forest.whole.bounds();
    let size = hi - lo;
    let likeness: Vec<String> = scene.views.iter().zip(pictures).map(|(v, p)| format!("{} {:.1} deg", v.name, p.0.mean_deg)).collect();
    format!(
        "{} pillars, {:.0} x {:.0} x {:.0} mm, {:.0} cm3, watertight; {}",
        pillars(scene),
        size.x,
        size.y,
        size.z,
        forest.whole.volume_mm3() / 1000.0,
        likeness.join(" / ")
    )
}
