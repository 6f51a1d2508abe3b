//! Thickness of the layer against the error of the normals, for four kinds of surface: a table and a plot.
//!
//!     cargo bench --bench thickness -- [--models DIR] [--surface NAME]... [--thickness MM]... [--rows FILE] [--png FILE]
//!
//! Takes two scenes of the repository; the forest only where `--models` names the folder of its models. Figures already in
//! the file of rows are kept; only those missing are computed, and those of every `--surface` that is named. With `--surface`
//! or `--thickness` nothing else is computed. The file is saved after every view, so that a run can be ended and taken up
//! again: the paper's energy takes minutes a view. Gives the table on the terminal as it goes, the README's table at the end,
//! and the plot.
//!
//! The errors are those of the reliefs, before solids are made of them. Layers are parted 5 : 2 before and behind as the
//! default of 7 mm is, with 0.5 mm of pillar behind them: 12 mm then just fit the forest's pillars of 8 mm.

mod plot;
mod rows;

use pillarforest::diag::Diagnostic;
use pillarforest::figures::measure::{changed, relief_errors, sights};
use pillarforest::report::NormalError;
use pillarforest::scene::Scene;
use pillarforest::sight::Sight;
use pillarforest::viewmap::SupportField;
use rows::{Measured, Rows};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Thicknesses of layers, millimetres.
const THICKNESSES: [f64; 5] = [1.0, 2.0, 4.0, 7.0, 12.0];
/// Share of a layer before its datum: 5 mm of 7.
const FRONT_SHARE: f64 = 5.0 / 7.0;

/// A scene to measure.
struct Compared {
    /// File name in `scenes/` without ending.
    scene: &'static str,
    title: &'static str,
    /// Whether its models lie in the scenes' folder.
    bundled: bool,
}

const SUBJECTS: [Compared; 2] = [
    Compared {
        scene: "reference-forest",
        title: "Forest: four scans on 27 pillars of 8 mm",
        bundled: false,
    },
    Compared {
        scene: "plate",
        title: "Plate: one hare on 90 x 84 mm",
        bundled: true,
    },
];

/// A kind of surface.
struct SurfaceKind {
    name: &'static str,
    /// As the scene language writes it.
    energy: &'static str,
    /// sRGB of its line: Okabe & Ito's palette.
    colour: [u8; 3],
}

const SURFACES: [SurfaceKind; 4] = [
    SurfaceKind {
        name: "curvature",
        energy: "Curvature()",
        colour: [0x6F, 0x73, 0x78],
    },
    SurfaceKind {
        name: "normal",
        energy: "Normal(steps: Never)",
        colour: [0x00, 0x9E, 0x73],
    },
    SurfaceKind {
        name: "reweighted",
        energy: "Normal(steps: Never, reweight: 5)",
        colour: [0x00, 0x72, 0xB2],
    },
    SurfaceKind {
        name: "torn",
        energy: "Normal(steps: Allowed())",
        colour: [0xD5, 0x5E, 0x00],
    },
];

/// What the command line asks for.
#[derive(Default)]
struct Wishes {
    models: Option<PathBuf>,
    surfaces: Vec<String>,
    thicknesses: Vec<f64>,
    rows: Option<PathBuf>,
    png: Option<PathBuf>,
}

impl Wishes {
    fn read(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut wishes = Self::default();
        while let Some(word) = words.next() {
            // Cargo adds it to the arguments of every benchmark.
            if word == "--bench" {
                continue;
            }
            let value = words.next().ok_or(format!("{word} wants a value"))?;
            match word.as_str() {
                "--models" => wishes.models = Some(value.into()),
                "--rows" => wishes.rows = Some(value.into()),
                "--png" => wishes.png = Some(value.into()),
                "--surface" if SURFACES.iter().any(|s| s.name == value) => {
                    wishes.surfaces.push(value);
                }
                "--surface" => return Err(format!("{value} is none of the surfaces")),
                "--thickness" => match THICKNESSES.iter().find(|t| value == t.to_string()) {
                    Some(mm) => wishes.thicknesses.push(*mm),
                    None => return Err(format!("{value} is none of the thicknesses")),
                },
                _ => return Err(format!("there is no {word}")),
            }
        }
        Ok(wishes)
    }

    /// Whether it is to be computed: asked for by name, or not known yet and nothing else asked for.
    fn wants(&self, surface: &str, mm: f64, known: bool) -> bool {
        let named = self.surfaces.iter().any(|s| s == surface);
        (named || (self.surfaces.is_empty() && !known))
            && (self.thicknesses.is_empty() || self.thicknesses.contains(&mm))
    }
}

fn main() -> ExitCode {
    match Wishes::read(std::env::args().skip(1)).and_then(|wishes| run(&wishes)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("error: {what}");
            ExitCode::FAILURE
        }
    }
}

fn run(wishes: &Wishes) -> Result<(), String> {
    let mut rows = Rows::open(wishes.rows.as_deref())?;
    println!("| scene | surface | layer, mm | view | mean | median | 90 % below |");
    println!("|---|---|---|---|---|---|---|");
    for subject in &SUBJECTS {
        measure_subject(subject, wishes, &mut rows)?;
    }
    println!("\n{}", rows.summary());
    if let Some(path) = &wishes.png {
        let picture = plot::plot(&rows).png(plot::WIDTH);
        fs::write(path, picture).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

/// Computes what is wanted of one scene, thick layers first.
fn measure_subject(subject: &Compared, wishes: &Wishes, rows: &mut Rows) -> Result<(), String> {
    for surface in &SURFACES {
        for mm in THICKNESSES.into_iter().rev() {
            if !wishes.wants(surface.name, mm, rows.complete(subject.scene, surface, mm)) {
                continue;
            }
            if !subject.bundled && wishes.models.is_none() {
                eprintln!("{}: left out, no --models", subject.scene);
                return Ok(());
            }
            let scene = resolved(subject, surface, mm, wishes.models.as_deref())?;
            let field = SupportField::new(&scene.supports);
            measure_views(subject, surface, mm, &scene, &sights(&scene, &field)?, rows)?;
        }
    }
    Ok(())
}

/// One surface in one layer: a line for every view and one for all of them.
fn measure_views(
    subject: &Compared,
    surface: &SurfaceKind,
    mm: f64,
    scene: &Scene,
    sights: &[Sight],
    rows: &mut Rows,
) -> Result<(), String> {
    for sight in sights {
        let mut row = Measured {
            scene: subject.scene.into(),
            surface: surface.name.into(),
            mm,
            view: sight.name().to_owned(),
            errors: [f64::NAN; 3],
        };
        match relief_errors(scene, sight) {
            Ok(NormalError { mean, median, p90 }) => {
                row.errors = [mean, median, p90];
                println!("{row}");
                rows.put(row, scene.views.len())?;
            }
            // No such surface was found in this layer: the table has a dash.
            Err(why) => {
                println!(
                    "| {} | {} | {mm} | {} | {why} | - | - |",
                    row.scene, row.surface, row.view
                );
                rows.drop(&row)?;
            }
        }
    }
    if let Some([mean, median, p90]) = rows.average(subject.scene, surface.name, mm) {
        let (scene, surface) = (subject.scene, surface.name);
        println!("| {scene} | {surface} | {mm} | *all* | {mean:.2} | {median:.2} | {p90:.2} |");
    }
    Ok(())
}

/// The scene with this energy and this layer.
fn resolved(
    subject: &Compared,
    surface: &SurfaceKind,
    mm: f64,
    models: Option<&Path>,
) -> Result<Scene, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let path = folder.join(subject.scene).with_extension("ron");
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let front = FRONT_SHARE * mm;
    let settings = [
        format!("energy={}", surface.energy),
        format!("depth.front={front:.6}"),
        format!("depth.back={:.6}", mm - front),
        "depth.core=0.5".to_owned(),
    ];
    let models = models.filter(|_| !subject.bundled).unwrap_or(&folder);
    let read = |file: &str| {
        let path = models.join(file);
        fs::read(&path).map_err(|e| Diagnostic::error(format!("{}: {e}", path.display())))
    };
    changed(&text, &settings, &read)
}
