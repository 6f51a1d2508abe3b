//! Programs of reliefs in one piece, solved by this crate and written for other solvers.
//!
//!     cargo bench --bench solvers -- [--vertices N]... [--energy curvature|normal]... [--write DIR]
//!
//! Takes a bumpy ball of about `N` vertices (10,000, 40,000, 160,000 and 320,000) on a plate with a layer of 8 mm, whose bounds bind at
//! hundreds to thousands of vertices. Prints for each the unknowns, the rows, the seconds from the model's view map to depths, those of the
//! last program alone from nothing, its method, objective and residuals.
//!
//! With `--write` every program goes to a folder of DIR: `P.mtx` (upper triangle) and `A.mtx` in MatrixMarket's coordinates, `q.txt`,
//! `l.txt` and `u.txt` with a number a line, for `min u'Pu / 2 + q'u` subject to `l <= A u <= u`; and `ours.json` with the seconds and
//! the objective of this crate.

mod matrices;

use pillarforest::diag::Diagnostic;
use pillarforest::figures::measure::{changed, sights};
use pillarforest::figures::{PLATE, bumpy_ball};
use pillarforest::kinds::{height_field_depths, height_field_program};
use pillarforest::mimic::{
    CurvatureOptions, Energy, FaceWeight, Method, NormalOptions, Program, Solution, solve_by,
};
use pillarforest::viewmap::SupportField;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

const VERTICES: [usize; 4] = [10_000, 40_000, 160_000, 320_000];

/// Energies by the names of the command line, and how each is solved.
const ENERGIES: [(&str, Energy, Method); 2] = [
    (
        "curvature",
        Energy::Curvature(CurvatureOptions::PAPER),
        Method::DualWorkingSet,
    ),
    (
        "normal",
        Energy::Normal(NormalOptions {
            weight: FaceWeight::SolidAngle,
            ordering: true,
            reweight: 0,
        }),
        Method::WarmInterior,
    ),
];

/// What the command line asks for.
struct Asked {
    vertices: Vec<usize>,
    energies: Vec<(&'static str, Energy, Method)>,
    write: Option<PathBuf>,
}

impl Asked {
    fn read(words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut asked = Self {
            vertices: Vec::new(),
            energies: Vec::new(),
            write: None,
        };
        let mut words = words.filter(|w| w != "--bench");
        while let Some(word) = words.next() {
            let value = words.next().ok_or(format!("{word} needs a value"))?;
            match word.as_str() {
                "--vertices" => {
                    let count = value.parse().map_err(|e| format!("--vertices: {e}"))?;
                    asked.vertices.push(count);
                }
                "--energy" => {
                    let known = ENERGIES.into_iter().find(|e| e.0 == value);
                    asked.energies.push(
                        known.ok_or(format!("--energy is curvature or normal, not {value}"))?,
                    );
                }
                "--write" => asked.write = Some(value.into()),
                _ => return Err(format!("there is no {word}")),
            }
        }
        if asked.vertices.is_empty() {
            asked.vertices = VERTICES.to_vec();
        }
        if asked.energies.is_empty() {
            asked.energies = ENERGIES.to_vec();
        }
        Ok(asked)
    }
}

fn main() -> ExitCode {
    match Asked::read(std::env::args().skip(1)).and_then(|asked| run(&asked)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("error: {what}");
            ExitCode::FAILURE
        }
    }
}

fn run(asked: &Asked) -> Result<(), String> {
    println!(
        "| energy | vertices | unknowns | rows | seconds to depths | of the last program | method | steps | objective | rows broken by | gap |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for count in &asked.vertices {
        let file = bumpy_ball(*count);
        let read = |_: &str| Ok::<_, Diagnostic>(file.clone());
        let scene = changed(PLATE, &[] as &[&str], &read)?;
        let field = SupportField::new(&scene.supports);
        let sight = &sights(&scene, &field)?[0];
        let vertices = sight.image.target.mesh.vertices.len();
        for (name, energy, method) in &asked.energies {
            let start = Instant::now();
            height_field_depths(*energy, sight).map_err(|e| e.to_string())?;
            let whole = start.elapsed().as_secs_f64();
            let program = height_field_program(*energy, sight).map_err(|e| e.to_string())?;
            let program = program.ok_or("no program")?;
            let start = Instant::now();
            let solution = solve_by(&program, *method).map_err(|e| e.to_string())?;
            let alone = start.elapsed().as_secs_f64();
            println!(
                "{}",
                line(name, vertices, &program, &solution, whole, alone)
            );
            if let Some(dir) = &asked.write {
                let folder = dir.join(format!("{name}-{vertices}"));
                let objective = solution.solved.optimality.objective;
                matrices::write(&folder, &program, alone, objective)
                    .map_err(|e| format!("{}: {e}", folder.display()))?;
            }
        }
    }
    Ok(())
}

fn line(
    name: &str,
    vertices: usize,
    program: &Program,
    solution: &Solution,
    whole: f64,
    alone: f64,
) -> String {
    let solved = &solution.solved;
    let optimality = &solved.optimality;
    format!(
        "| {name} | {vertices} | {} | {} | {whole:.2} | {alone:.2} | {:?} | {} | {:.9e} | {:.1e} | {:.1e} |",
        program.variables,
        program.rows.len(),
        solved.method,
        solved.iterations,
        optimality.objective,
        optimality.primal_residual,
        optimality.gap,
    )
}
