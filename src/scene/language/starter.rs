//! What `init` writes for models of one's own: a commented scene with an eye for each of them, and pillars that are found.

use crate::mesh::TriMesh;
use crate::scene::defaults;
use glam::DVec3;
use std::fmt::Write;

/// A model to begin with.
#[derive(Clone, Debug, PartialEq)]
pub struct StarterModel {
    pub name: String,
    /// As the scene is to name it.
    pub file: String,
    /// Axes of the file, as scenes name them.
    pub up: &'static str,
    pub front: &'static str,
    /// Why these.
    pub reason: &'static str,
    /// Extents along the file's axes.
    extent: DVec3,
    vertices: usize,
}

/// As many models as have their largest size; more share the same ground.
const ROOMY: usize = 4;
/// Largest side of a model, radius of the ground and distance of the eyes for up to [`ROOMY`] models, millimetres: those of four
/// creatures that show what a forest can do. Larger ones stand in each other's sight, smaller ones lose their detail to the nozzle.
const SIZE: f64 = 70.0;
const GROUND: f64 = 71.0;
const EYE: f64 = 250.0;
/// What every further model adds to the ground, and what a common printer has room for, millimetres.
const MORE_GROUND: f64 = 13.0;
const MOST_GROUND: f64 = 120.0;
/// Height of the eyes and of the models' middles, and the least height of their undersides, millimetres: pillars are 90 mm high.
const EYE_HEIGHT: f64 = 48.0;
const MIDDLE: f64 = 46.0;
const LOWEST: f64 = 8.0;
/// Finer models than this are simplified: a forest of 70 mm shows no more, and a first build should not take many minutes.
const DETAIL: usize = 40_000;

impl StarterModel {
    /// `stem` is the bare name of its file, which the scene calls `file`.
    pub fn new(stem: &str, file: &str, mesh: &TriMesh) -> Self {
        let ending = file.rsplit('.').next().unwrap_or("").to_lowercase();
        let (up, front, reason) = match ending.as_str() {
            "obj" => (
                "y",
                "z",
                "OBJ files mostly have y up and their front along z",
            ),
            "stl" | "3mf" => (
                "z",
                "-y",
                "files for printing mostly have z up and their front along -y",
            ),
            _ => (
                "z",
                "-y",
                "the file does not say: z up and the front along -y is as likely as any",
            ),
        };
        let (lo, hi) = mesh.bounds().unwrap_or_default();
        Self {
            name: plain(stem),
            file: file.to_string(),
            up,
            front,
            reason,
            extent: hi - lo,
            vertices: mesh.vertices.len(),
        }
    }

    /// Where its underside goes if its largest side is `size`, millimetres.
    fn underside(&self, size: f64) -> f64 {
        let tall = match self.up {
            "y" => self.extent.y,
            _ => self.extent.z,
        };
        let height = size * tall / self.extent.max_element().max(1e-12);
        (MIDDLE - height / 2.0).max(LOWEST).round()
    }
}

/// A name that may be one of a view, which is one of a file.
fn plain(stem: &str) -> String {
    let allowed = |c: char| match c {
        'a'..='z' | 'A'..='Z' | '0'..='9' | '-' | '_' => c,
        _ => '-',
    };
    let name: String = stem
        .chars()
        .map(allowed)
        .take(defaults::LONGEST_NAME / 2)
        .collect();
    match name.trim_matches('-') {
        "" => "model".into(),
        name => name.into(),
    }
}

/// Gives every model a name of its own, as file systems without capitals see it.
fn names(models: &[StarterModel]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for model in models {
        let taken = |name: &str| names.iter().any(|n| n.eq_ignore_ascii_case(name));
        let numbered = (2..).map(|k| format!("{}-{k}", model.name));
        let mut candidates = [model.name.clone()].into_iter().chain(numbered);
        let name = candidates.find(|n| !taken(n)).unwrap_or_default();
        names.push(name);
    }
    names
}

/// The scene, with models of `share` (0 to 1) of the size that mostly works. `command` is what was typed.
pub fn starter(models: &[StarterModel], share: f64, command: &str) -> String {
    let count = models.len() as f64;
    let more = count - ROOMY.min(models.len()) as f64;
    let ground = (GROUND + MORE_GROUND * more).min(MOST_GROUND);
    let crowd = (ROOMY as f64 / count).min(1.0);
    let size = (share * SIZE * crowd * ground / GROUND).round();
    let eye = (EYE * ground / GROUND).round();
    let names = names(models);
    let (mut list, mut views) = (String::new(), String::new());
    for (k, (model, name)) in models.iter().zip(&names).enumerate() {
        let StarterModel {
            up, front, reason, ..
        } = model;
        let file = &model.file;
        let under = model.underside(size);
        let _ = write!(
            list,
            "        // {reason}; does it lie or look away? See `pillarforest inspect --views`.\n        (\n            name: \"{name}\",\n            file: {file:?},\n            place: Fit(largest: {size}, up: \"{up}\", front: \"{front}\", at: (0, 0, {under})),\n        ),\n"
        );
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / count).sin_cos();
        let [x, y] = [eye * sin, -eye * cos].map(|v| (10.0 * v).round() / 10.0 + 0.0);
        let _ = writeln!(
            views,
            "        (name: \"{name}\", eye: ({x}, {y}, {EYE_HEIGHT}), look_at: (0, 0, {MIDDLE}), models: [\"{name}\"]),"
        );
    }
    let detail = match models.iter().any(|m| m.vertices > DETAIL) {
        true => format!(
            "    // Finer models are simplified to so many vertices; without this line nothing is.\n    detail: {DETAIL},\n\n"
        ),
        false => String::new(),
    };
    let title = names.join(", ");
    let title: String = title.chars().take(defaults::LONGEST_TITLE).collect();
    let base = ground + 1.0;
    format!(
        "\
// Written by: {command}
//
//   pillarforest check     says what is wrong with it, with places and advice
//   pillarforest plan      finds the pillars and draws who sees which of them
//   pillarforest build     makes the forest: 3MF and STL to print, plan, pictures, report
//   pillarforest schema    prints the whole language with every default
//
// z points up and the top of the base is z = 0. Lengths are in `units`, angles in degrees.
(
    title: \"{title}\",
    units: mm,

    // What is to be seen. `largest` is its longest side; `up` and `front` are axes of the file: the front is turned to the eye.
    // `at` is where the middle of its underside goes.
    models: [
{list}    ],

{detail}    // From where: eyes around the forest, a hand's width above the table. Each sees its models.
    views: [
{views}    ],

    // What carries it: found by `plan` and `build`. Is none found, make the models smaller or the ground larger.
    pillars: Auto(region: Disc(radius: {ground})),
    base: Disc(radius: {base}, thickness: 5, centre: (0, 0)),

    // Reliefs may stand 5 mm in front of the pillars' axes and sink 2 mm behind them; 1 mm of pillar stays behind that.
    depth: (from: Axis, front: 5, back: 2, core: 1),

    // Your printer, for the warnings.
    printer: (nozzle: 0.4, bed: (256, 256, 256)),
)
"
    )
}
