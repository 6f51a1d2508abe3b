//! The arguments, as clap reads them and `--help` shows them.

use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;

const AFTER: &str = "\
A new forest in three commands:
  pillarforest init fox.obj      writes scene.ron with your model; without one, with an owl
  pillarforest check             reads everything, says what is wrong, writes nothing
  pillarforest build             writes the forest, plan, pictures and report to out/scene/

Exit codes: 0 all well, 1 scene or input error, 2 wrong usage, or no place to write to, 3 built, but not all that is promised holds,
4 pillarforest itself failed, or the system under it (a full disk).";

/// Turns a scene of models, eyes and pillars into a printable pillar forest: each model appears from its own eye only.
#[derive(Debug, Parser)]
#[command(name = "pillarforest", version, after_help = AFTER, propagate_version = true, max_term_width = 100)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub global: Global,
}

#[derive(Args, Debug)]
pub(super) struct Global {
    /// Say less: errors and the last line only
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more: every stage as it starts
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// When to colour messages
    #[arg(long, global = true, value_enum, default_value_t = When::Auto, value_name = "WHEN")]
    pub color: When,
    /// How to print errors and warnings
    #[arg(long, global = true, value_enum, default_value_t = Style::Human, value_name = "STYLE")]
    pub diagnostics: Style,
    /// Treat warnings as errors
    #[arg(long, global = true, value_enum, value_name = "WHAT")]
    pub deny: Option<Deny>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum When {
    Auto,
    Always,
    Never,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Style {
    /// With the line of the scene and what to do
    Human,
    /// One line each: file:line:column: error: ...
    Short,
    /// One JSON object a line
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Deny {
    Warnings,
}

/// How much work a run does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Effort {
    /// Models of at most 10000 vertices, pictures of 320 pixels, no lights and no camouflage
    Draft,
    /// As the scene is written
    Normal,
    /// As it is written, with pictures of 1024 pixels
    Final,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Write a commented scene to start from, with your models or with an owl
    Init {
        /// Models that the scene is to show (STL, 3MF, OBJ, PLY), each from an eye of its own; and where to write the scene, if that is
        /// not scene.ron. Models that lie elsewhere are copied to models/ beside the scene
        #[arg(value_name = "MODELS|SCENE.ron", value_hint = ValueHint::FilePath)]
        paths: Vec<PathBuf>,
        /// Overwrite files that exist
        #[arg(long)]
        force: bool,
    },
    /// Read everything, report every error and warning, write nothing
    Check {
        #[command(flatten)]
        scene: SceneArgs,
    },
    /// Build the forest: 3MF, STL, GLB, plan, pictures and report
    Build {
        #[command(flatten)]
        scene: SceneArgs,
        /// Directory for all files, or one file whose ending picks the format (.3mf .stl .glb .svg .png .json) [default: out/<scene>]
        #[arg(short, long, value_hint = ValueHint::AnyPath)]
        output: Option<PathBuf>,
        /// Write everything even if something of it does not hold (exit code 3 all the same)
        #[arg(long)]
        force: bool,
        /// Also write the forest in pieces: plates that fit the bed, with pins and numbered sockets, each pillar with a peg, and
        /// layout.svg at 1:1
        #[arg(long)]
        split: bool,
    },
    /// Find pillars for a scene with `pillars: Auto(...)`: layout.ron, to be included with `pillars: File("layout.ron")`, and the plan
    Plan {
        #[command(flatten)]
        scene: SceneArgs,
        #[command(flatten)]
        search: SearchArgs,
    },
    /// Mend the pillars that a scene lists with the fewest moves, say which, and write them to layout.ron
    Repair {
        #[command(flatten)]
        scene: SceneArgs,
        #[command(flatten)]
        search: SearchArgs,
    },
    /// Draw only the plan: the forest from above with what every eye sees
    View {
        #[command(flatten)]
        scene: SceneArgs,
        /// Directory for plan.svg and plan.png, or one .svg or .png file [default: out/<scene>]
        #[arg(short, long, value_hint = ValueHint::AnyPath)]
        output: Option<PathBuf>,
    },
    /// Render only the pictures: for every eye the model, the forest and the difference
    Render {
        #[command(flatten)]
        scene: SceneArgs,
        /// Directory; pictures go to its views/ [default: out/<scene>]
        #[arg(short, long, value_hint = ValueHint::AnyPath)]
        output: Option<PathBuf>,
    },
    /// Check any mesh file for printing: closed, oriented, no self-intersection, one part
    Inspect {
        /// STL, 3MF, OBJ, PLY or OFF files
        #[arg(required = true, value_hint = ValueHint::FilePath)]
        files: Vec<PathBuf>,
        /// Print the findings as JSON
        #[arg(long)]
        json: bool,
        /// Check nothing, but draw every file from its six sides to out/<file>-sides.png, with the words that turn each to the eye
        /// (`up: "y", front: "z"`)
        #[arg(long, conflicts_with = "json")]
        views: bool,
    },
    /// Make the figures of the paper again: scenes, pictures, numbers, and a page with what the paper says beside them
    Figures(FigureArgs),
    /// Measure this machine: the examples of the paper's Table 1 beside its times, the stages of a forest, and how time grows with the
    /// model
    Bench(BenchArgs),
    /// Print the whole scene language with its defaults
    Schema,
    /// Print a completion script for a shell
    Completions {
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
}

#[derive(Args, Clone, Debug)]
pub(super) struct SceneArgs {
    /// The scene
    #[arg(default_value = "scene.ron", value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// Where to look first for models and layouts, by file name; several are tried in turn [env: PILLARFOREST_MODELS]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub models: Vec<PathBuf>,
    /// Let the scene name files outside of its folder: absolute, by `..` or through links
    #[arg(long)]
    pub allow_outside: bool,
    /// Change a value of the scene for this run: pillars[0].height=80, views[front].eye=(0,-300,60), energy=Curvature()
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub sets: Vec<String>,
    /// How much work to do: a draft for trying things out, what the scene says, or large pictures
    #[arg(long, value_enum, default_value_t = Effort::Normal, value_name = "QUALITY")]
    pub quality: Effort,
    /// Threads to use [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Print how long every stage took, and the largest memory; with `--diagnostics json` as one object
    #[arg(long)]
    pub timings: bool,
}

#[derive(Args, Clone, Debug)]
pub(super) struct FigureArgs {
    /// Which of them, as `--list` names them [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Say which there are, and make none
    #[arg(long)]
    pub list: bool,
    /// Where the scenes lie
    #[arg(long, default_value = "scenes/paper", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub scenes: PathBuf,
    /// Where to look first for models, by file name, before those beside the scenes (../models)
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub models: Vec<PathBuf>,
    /// Directory for the page and all files
    #[arg(short, long, default_value = "out/figures", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
    /// Threads to use [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum BenchPart {
    /// The stages of a forest of four creatures
    Stages,
    /// A ball on a plate with 10,000 vertices and more, by three energies
    Growth,
    /// The examples of the paper's Table 1, about five minutes
    Table1,
}

#[derive(Args, Clone, Debug)]
pub(super) struct BenchArgs {
    /// What to measure [default: all]
    #[arg(value_enum, value_name = "PART")]
    pub parts: Vec<BenchPart>,
    /// Where the scenes of the figures lie
    #[arg(long, default_value = "scenes/paper", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub scenes: PathBuf,
    /// Vertices of the largest model to see how time grows, at least 10000
    #[arg(long, default_value_t = 1_000_000, value_name = "N", value_parser = clap::value_parser!(u32).range(10_000..))]
    pub most: u32,
    /// Print one JSON object instead of tables
    #[arg(long)]
    pub json: bool,
    /// Directory for what is built
    #[arg(short, long, default_value = "out/bench", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
    /// Threads to use [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct SearchArgs {
    /// Directory for all files, or one .ron file for the layout alone [default: out/<scene>]
    #[arg(short, long, value_hint = ValueHint::AnyPath)]
    pub output: Option<PathBuf>,
    /// Seed of the search, instead of the scene's
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// Candidate layouts to try, instead of the scene's number; 0 gives the layout that the search would start from
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=10_000_000))]
    pub tries: Option<u32>,
    /// Seconds after which the search ends with what it has, instead of the scene's
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub seconds: Option<f64>,
}

/// A time that a clock can measure.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds > 0.0 => Ok(seconds),
        _ => Err("seconds are a number above 0".into()),
    }
}
