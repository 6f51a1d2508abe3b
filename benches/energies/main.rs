//! Every energy and variant on one scene: seconds for groups, depths and relief, and the error of the relief's normals.
//!
//!     cargo bench --bench energies -- [--scene FILE] [--models DIR] [--energy TEXT]...
//!
//! Takes a scene file (`scenes/plate.ron`) and energies as the scene language writes them (all variants of the paper and what it
//! compares itself with). Prints a table, one line for each energy and view as it goes. The conic form is in it next to the
//! quadratic one, which it equals in everything but time.

use pillarforest::diag::Diagnostic;
use pillarforest::figures::measure::{changed, relief_errors, sights};
use pillarforest::report::NormalError;
use pillarforest::scene::Scene;
use pillarforest::viewmap::SupportField;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use std::{env, fs};

const ENERGIES: [&str; 9] = [
    "Normal(steps: Never)",
    "Curvature()",
    "Curvature(form: Conic)",
    "Curvature(hidden_weight: 1)",
    "Curvature(scale_invariant: false)",
    "Curvature(mean_curvature: true)",
    "Curvature(iterate: 20, hidden_weight: 1)",
    "Linear",
    "Gradient()",
];

/// What the command line asks for.
struct Asked {
    scene: PathBuf,
    models: Option<PathBuf>,
    energies: Vec<String>,
}

impl Asked {
    fn read(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut wishes = Self {
            scene: PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes/plate.ron"),
            models: None,
            energies: Vec::new(),
        };
        while let Some(word) = words.next() {
            // Cargo adds it to the arguments of every benchmark.
            if word == "--bench" {
                continue;
            }
            let value = words.next().ok_or(format!("{word} wants a value"))?;
            match word.as_str() {
                "--scene" => wishes.scene = value.into(),
                "--models" => wishes.models = Some(value.into()),
                "--energy" => wishes.energies.push(value),
                _ => return Err(format!("there is no {word}")),
            }
        }
        if wishes.energies.is_empty() {
            wishes.energies = ENERGIES.map(String::from).to_vec();
        }
        Ok(wishes)
    }
}

fn main() -> ExitCode {
    match Asked::read(env::args().skip(1)).and_then(|wishes| run(&wishes)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("error: {what}");
            ExitCode::FAILURE
        }
    }
}

fn run(wishes: &Asked) -> Result<(), String> {
    let text = fs::read_to_string(&wishes.scene)
        .map_err(|e| format!("{}: {e}", wishes.scene.display()))?;
    println!("| energy | view | seconds | mean | median | 90 % below |");
    println!("|---|---|---|---|---|---|");
    for energy in &wishes.energies {
        let scene = resolved(&text, wishes, energy)?;
        let field = SupportField::new(&scene.supports);
        for sight in sights(&scene, &field)? {
            let start = Instant::now();
            let errors = relief_errors(&scene, &sight);
            let seconds = start.elapsed().as_secs_f64();
            match errors {
                Ok(NormalError { mean, median, p90 }) => println!(
                    "| `{energy}` | {} | {seconds:.2} | {mean:.2} | {median:.2} | {p90:.2} |",
                    sight.name()
                ),
                Err(why) => println!(
                    "| `{energy}` | {} | {seconds:.2} | {why} | - | - |",
                    sight.name()
                ),
            }
        }
    }
    Ok(())
}

/// The scene with this energy.
fn resolved(text: &str, wishes: &Asked, energy: &str) -> Result<Scene, String> {
    let beside = wishes.scene.parent().unwrap_or(Path::new("."));
    let folder = wishes.models.as_deref().unwrap_or(beside);
    let read = |file: &str| {
        let path = folder.join(file);
        fs::read(&path).map_err(|e| Diagnostic::error(format!("{}: {e}", path.display())))
    };
    changed(text, &[format!("energy={energy}")], &read)
}
