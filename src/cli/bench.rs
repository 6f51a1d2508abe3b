//! `bench`: what builds take on this machine.

use super::args::{BenchArgs, BenchPart, Global};
use super::case_builder::CaseBuilder;
use super::ending::{FAILED, WRONG_INPUT, WRONG_USAGE, fail, say};
use super::figures::has_scenes;
use super::messages::Messages;
use super::progress::stage_lines;
use super::write::Destination;
use pillarforest::compile::OutputFile;
use pillarforest::diag::Diagnostic;
use pillarforest::figures::{
    self, Case, Job, Made, PLATE, SIZES, TIMES, WAYS, Workshop, bumpy_ball, exponent,
};
use serde_json::{Value, json};
use std::path::Path;

/// The forest whose stages are told.
const FOREST: &str = "../four-creatures";

/// Measures and prints; gives the exit code.
pub(super) fn run(messages: &Messages, global: &Global, args: &BenchArgs) -> u8 {
    if let Err(problem) = has_scenes(&args.scenes) {
        return fail(messages, &[problem], None, WRONG_INPUT);
    }
    let output = match Destination::new(Some(&args.output), Path::new("bench"), &[]) {
        Ok(Destination::Directory(folder)) => folder,
        Ok(Destination::File(_)) => {
            let problem = Diagnostic::error("what is built are many files")
                .help("give a directory: `-o DIR`");
            return fail(messages, &[problem], None, WRONG_USAGE);
        }
        Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
    };
    let builder = CaseBuilder {
        scenes: &args.scenes,
        models: &[],
        output: &output,
        jobs: args.jobs,
        quiet: global.quiet,
    };
    match (Bench { args, builder }).measured() {
        Ok(measured) if args.json => say(&format!("{}\n", measured.json())),
        Ok(measured) => say(&measured.tables()),
        Err(why) => fail(messages, &[Diagnostic::error(why)], None, FAILED),
    }
}

struct Bench<'a> {
    args: &'a BenchArgs,
    builder: CaseBuilder<'a>,
}

/// Everything that was measured; empty what was not asked for.
struct Measured {
    machine: String,
    forest: Option<Made>,
    examples: Vec<Case>,
    scaling: Vec<Scaling>,
}

/// Builds of growing models, by one energy.
struct Scaling {
    way: &'static str,
    builds: Vec<Made>,
}

impl Bench<'_> {
    fn measured(&self) -> Result<Measured, String> {
        Ok(Measured {
            machine: machine(self.args.jobs),
            forest: match self.asks_for(BenchPart::Stages) {
                true => Some(self.builder.build(&job(FOREST, &[], "forest".into()))?),
                false => None,
            },
            scaling: match self.asks_for(BenchPart::Growth) {
                true => self.scaling()?,
                false => Vec::new(),
            },
            examples: match self.asks_for(BenchPart::Table1) {
                true => self.examples()?,
                false => Vec::new(),
            },
        })
    }

    fn asks_for(&self, part: BenchPart) -> bool {
        self.args.parts.is_empty() || self.args.parts.contains(&part)
    }

    fn examples(&self) -> Result<Vec<Case>, String> {
        let mut build = |job: &Job| self.builder.build(job);
        let table = figures::make(TIMES, &mut Workshop::new(&mut build));
        match table.failure {
            Some(why) => Err(why),
            None => Ok(table.findings.cases),
        }
    }

    fn scaling(&self) -> Result<Vec<Scaling>, String> {
        let sizes = SIZES.into_iter().filter(|s| *s <= self.args.most as usize);
        let mut all: Vec<Scaling> = WAYS
            .iter()
            .map(|(way, _)| Scaling {
                way,
                builds: Vec::new(),
            })
            .collect();
        for size in sizes {
            let folder = self.builder.output.join(format!("ball-{size}"));
            let files = [
                OutputFile::new("ball.obj", bumpy_ball(size)),
                OutputFile::new("plate.ron", PLATE.as_bytes().to_vec()),
            ];
            let scenes = Destination::Directory(folder.clone());
            scenes.write(&files).map_err(|problem| problem.message)?;
            let builder = CaseBuilder {
                scenes: &folder,
                ..self.builder
            };
            for (k, (_, set)) in WAYS.iter().enumerate() {
                let made = builder.build(&job("plate", &[set], format!("ball-{size}/{k}")))?;
                all[k].builds.push(made);
            }
        }
        Ok(all)
    }
}

fn job(scene: &str, sets: &[&str], folder: String) -> Job {
    Job {
        scene: scene.to_owned(),
        sets: sets.iter().map(|s| (*s).to_owned()).collect(),
        folder,
    }
}

impl Scaling {
    /// Of the whole build, and of the optimisation alone.
    fn exponents(&self) -> [Option<f64>; 2] {
        let points = |seconds: &dyn Fn(&Made) -> f64| -> Vec<(f64, f64)> {
            let builds = self.builds.iter();
            builds.map(|m| (m.sizes().0, seconds(m))).collect()
        };
        [
            exponent(&points(&|m| m.seconds)),
            exponent(&points(&program_seconds)),
        ]
    }

    fn growth(&self) -> String {
        let mut text = format!(
            "\nA ball on a plate, {}\n\n{:>9} {:>9} {:>9} {:>8}\n",
            self.way, "vertices", "programs", "all", "MB"
        );
        for made in &self.builds {
            text.push_str(&format!(
                "{:>9.0} {:>7.2} s {:>7.2} s {:>8.0}\n",
                made.sizes().0,
                program_seconds(made),
                made.seconds,
                made.peak_mb.unwrap_or(f64::NAN),
            ));
        }
        if let [Some(whole), Some(program)] = self.exponents() {
            text.push_str(&format!(
                "time grows with vertices to the power of {whole:.2}, that of the optimisation to {program:.2}\n"
            ));
        }
        text
    }
}

fn program_seconds(made: &Made) -> f64 {
    made.stage_seconds("quadratic programs")
}

impl Measured {
    fn json(&self) -> Value {
        let build = |m: &Made| {
            json!({
                "vertices": m.sizes().0,
                "seconds": m.seconds,
                "program_seconds": program_seconds(m),
                "peak_memory_mb": m.peak_mb,
            })
        };
        let forest = self.forest.as_ref().map(|made| {
            let stages = made.stages.iter();
            let stages: Vec<Value> = stages
                .map(|(stage, seconds)| json!({ "stage": stage, "seconds": seconds }))
                .collect();
            json!({
                "scene": made.scene,
                "seconds": made.seconds,
                "peak_memory_mb": made.peak_mb,
                "stages": stages,
            })
        });
        let examples = self.examples.iter();
        let examples: Vec<Value> = examples
            .map(|case| {
                let mut row: serde_json::Map<String, Value> = case
                    .measured
                    .iter()
                    .map(|(name, value)| ((*name).to_owned(), json!(value)))
                    .collect();
                row.insert("example".into(), json!(case.name));
                Value::Object(row)
            })
            .collect();
        let scaling = self.scaling.iter().map(|s| {
            let [whole, program] = s.exponents();
            json!({
                "energy": s.way,
                "exponent": whole,
                "program_exponent": program,
                "builds": s.builds.iter().map(build).collect::<Vec<_>>(),
            })
        });
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "machine": self.machine,
            "forest": forest,
            "table_1": examples,
            "scaling": scaling.collect::<Vec<_>>(),
        })
    }

    fn tables(&self) -> String {
        let mut text = format!(
            "pillarforest {} on {}\n",
            env!("CARGO_PKG_VERSION"),
            self.machine
        );
        text.extend(self.forest.as_ref().map(stages));
        self.scaling.iter().for_each(|s| text.push_str(&s.growth()));
        if !self.examples.is_empty() {
            text.push_str(&beside_the_paper(&self.examples));
        }
        text
    }
}

fn stages(forest: &Made) -> String {
    let lines = stage_lines(&forest.stages, forest.seconds, forest.peak_mb);
    format!("\nStages of {}\n\n{}\n", forest.scene, lines.join("\n"))
}

fn beside_the_paper(examples: &[Case]) -> String {
    let mut text = format!(
        "\nTable 1 of the paper (a quad-core at 3.4 GHz) and here: vertices, and seconds of the optimisation\n\n{:<28} {:>8} {:>8} {:>9} {:>8} {:>8} {:>8} {:>8}\n",
        "", "paper", "s", "here", "s", "all, s", "MB", "degrees"
    );
    for case in examples {
        let of = |name: &str| {
            let number = case.measured.iter().find(|n| n.0 == name);
            number.map_or(f64::NAN, |n| n.1)
        };
        text.push_str(&format!(
            "{:<28} {:>8.0} {:>8.0} {:>9.0} {:>8.2} {:>8.2} {:>8.0} {:>8.1}\n",
            case.name,
            of("paper_vertices"),
            of("paper_seconds"),
            of("vertices"),
            of("program_seconds"),
            of("seconds"),
            of("peak_memory_mb"),
            of("error_mean_deg"),
        ));
    }
    text
}

/// Processor and threads, as far as the system tells.
fn machine(jobs: Option<u16>) -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = jobs.map_or(threads, usize::from);
    let cpus = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = cpus.lines().find(|l| l.starts_with("model name"));
    let name = name.and_then(|l| l.split(':').nth(1)).map(str::trim);
    let name = name.unwrap_or(std::env::consts::ARCH);
    format!("{name}, {threads} threads, {}", std::env::consts::OS)
}
