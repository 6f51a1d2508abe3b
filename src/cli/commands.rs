//! What each command does, in order.

use super::figures;
use super::files::{self, SceneFiles};
use super::messages::{Messages, Source};
use super::plan::{self, Search};
use super::progress::Reporter;
use super::write::{self, Target};
use super::{Cli, Command, Global, Quality, SceneArgs, Style};
use clap::CommandFactory;
use pillarforest::compile::{self, Build, Drawn, Progress, Stop};
use pillarforest::diag::{Diagnostic, Warned};
use pillarforest::scene::{self, Scene};
use pillarforest::support::Support;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub const WELL: u8 = 0;
pub const WRONG_INPUT: u8 = 1;
pub const WRONG_USAGE: u8 = 2;
pub const NOT_PRINTABLE: u8 = 3;

pub const NOTHING: &str = "Nothing was written.";
const NOTHING_YET: &str = "Nothing was written; `--force` writes it all the same.";

/// Runs the command; gives the exit code.
pub fn run(cli: &Cli) -> u8 {
    let messages = Messages::new(&cli.global);
    match &cli.command {
        Command::Init { scene, force } => init(&messages, scene, *force),
        Command::Check { scene } => check(&messages, &cli.global, scene),
        Command::Build {
            scene,
            output,
            force,
            split,
        } => {
            let mut scene = scene.clone();
            if *split {
                scene.sets.push("output.split=true".into());
            }
            let order = Order {
                goal: Goal::Forest,
                output: output.as_deref(),
                force: *force,
            };
            make(&messages, &cli.global, &scene, &order)
        }
        Command::Plan { scene, search } => {
            plan::run(&messages, &cli.global, scene, search, Search::Plan)
        }
        Command::Repair { scene, search } => {
            plan::run(&messages, &cli.global, scene, search, Search::Repair)
        }
        Command::View { scene, output } => {
            let order = Order::of(Goal::Plan, output.as_deref());
            make(&messages, &cli.global, scene, &order)
        }
        Command::Render { scene, output } => {
            let order = Order::of(Goal::Pictures, output.as_deref());
            make(&messages, &cli.global, scene, &order)
        }
        Command::Inspect { files, json } => inspect(
            &messages,
            files,
            *json || cli.global.diagnostics == Style::Json,
        ),
        Command::Figures(args) => figures::run(&messages, &cli.global, args),
        Command::Schema => say(&scene::schema()),
        Command::Completions { shell } => completions(*shell),
    }
}

/// Prints to standard output; a closed pipe is no error.
pub fn say(text: &str) -> u8 {
    let _ = std::io::stdout().write_all(text.as_bytes());
    WELL
}

fn completions(shell: clap_complete::Shell) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "pillarforest", &mut script);
    say(&String::from_utf8_lossy(&script))
}

/// Prints the problems of a failed command.
pub fn fail(messages: &Messages, list: &[Diagnostic], source: Option<&Source>, code: u8) -> u8 {
    messages.print(list, source);
    messages.closing(list, NOTHING);
    code
}

fn init(messages: &Messages, path: &Path, force: bool) -> u8 {
    let folder = path.parent().unwrap_or(Path::new(""));
    let files = [
        (path.to_path_buf(), scene::TEMPLATE.as_bytes()),
        (
            folder.join(scene::TEMPLATE_MODEL_FILE),
            scene::TEMPLATE_MODEL,
        ),
    ];
    let in_way: Vec<Diagnostic> = files
        .iter()
        .filter(|(path, bytes)| {
            path.exists() && !force && std::fs::read(path).ok().as_deref() != Some(*bytes)
        })
        .map(|(path, _)| {
            Diagnostic::error(format!("\"{}\" exists already", path.display()))
                .help("`--force` overwrites it; or give another name: `pillarforest init my.ron`")
        })
        .collect();
    if !in_way.is_empty() {
        return fail(messages, &in_way, None, WRONG_INPUT);
    }
    for (path, bytes) in &files {
        if let Err(error) = write::into_file(path, bytes) {
            let problem =
                Diagnostic::error(format!("cannot write \"{}\": {error}", path.display()));
            return fail(messages, &[problem], None, WRONG_INPUT);
        }
    }
    let scene_argument = if path == Path::new("scene.ron") {
        String::new()
    } else {
        format!(" {}", path.display())
    };
    say(&format!(
        "wrote {} and {}\nnext: pillarforest build{scene_argument}\n",
        files[0].0.display(),
        files[1].0.display()
    ))
}

/// A scene read for a command, with its text for messages.
pub struct Loaded {
    pub scene: Scene,
    warnings: Vec<Diagnostic>,
    pub source: Source,
    /// The files it names that were read.
    pub read: Vec<PathBuf>,
}

/// How a scene is read: [`scene::resolve`] or [`scene::resolve_to_mend`].
pub type Resolve = fn(&str, scene::ReadFile) -> Result<Warned<Scene>, Vec<Diagnostic>>;

/// Reads a scene with its models and prints what is wrong with it; `None` if that ends the run.
pub fn load(messages: &Messages, args: &SceneArgs, resolve: Resolve) -> Option<Loaded> {
    if let Some(jobs) = args.jobs {
        // Before anything runs in parallel: a pool that exists already would keep its size.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(jobs.into())
            .build_global();
    }
    let stop = |list: &[Diagnostic], source: Option<&Source>| {
        fail(messages, list, source, WRONG_INPUT);
        None
    };
    let mut text = match files::scene_text(&args.scene) {
        Ok(text) => text,
        Err(problem) => return stop(&[problem], None),
    };
    text = scene::at_quality(&text, quality(args.quality));
    for assignment in &args.sets {
        text = match scene::set(&text, assignment) {
            Ok(text) => text,
            Err(problem) => return stop(&[problem], None),
        };
    }
    let changed = match (args.sets.is_empty(), args.quality) {
        (false, _) => " (with --set)",
        (true, Quality::Normal) => "",
        (true, _) => " (with --quality)",
    };
    let source = Source {
        path: format!("{}{changed}", args.scene.display()),
        text,
    };
    let files = SceneFiles::of(&args.scene, libraries(&args.models), args.allow_outside);
    match resolve(&source.text, &|name| files.read(name)) {
        Err(problems) => stop(&problems, Some(&source)),
        Ok(Warned { value, warnings }) => {
            if messages.print(&warnings, Some(&source)) {
                messages.closing(&warnings, NOTHING);
                return None;
            }
            Some(Loaded {
                scene: value,
                warnings,
                source,
                read: files.into_read(),
            })
        }
    }
}

/// The folders that the user named, or else the one that the surroundings name.
pub fn libraries(named: &[PathBuf]) -> Vec<PathBuf> {
    if !named.is_empty() {
        return named.to_vec();
    }
    let variable = std::env::var_os("PILLARFOREST_MODELS").filter(|v| !v.is_empty());
    variable.map(PathBuf::from).into_iter().collect()
}

fn quality(quality: Quality) -> scene::Quality {
    match quality {
        Quality::Draft => scene::Quality::Draft,
        Quality::Normal => scene::Quality::Normal,
        Quality::Final => scene::Quality::Final,
    }
}

impl Loaded {
    /// Tells, from now on, whether a search for pillars has had its time. The library has no clock.
    pub fn time_is_up(&self) -> impl Fn() -> bool + Sync + use<> {
        let brief = self.scene.brief.as_ref();
        let seconds = brief.map_or(f64::INFINITY, |b| b.seconds);
        let start = Instant::now();
        move || start.elapsed().as_secs_f64() > seconds
    }

    /// Prints what ended the run; gives the exit code.
    pub fn failed(&self, messages: &Messages, problems: &[Diagnostic]) -> u8 {
        let all: Vec<Diagnostic> = problems.iter().chain(&self.warnings).cloned().collect();
        messages.print(problems, Some(&self.source));
        messages.closing(&all, NOTHING);
        WRONG_INPUT
    }
}

/// Runs one of the pipeline's goals with progress, and prints the `warnings` that it gives. The error code has been explained to the
/// user.
fn compile<T>(
    messages: &Messages,
    global: &Global,
    args: &SceneArgs,
    loaded: &Loaded,
    goal: impl FnOnce(&Scene, Progress, Stop) -> Result<T, Vec<Diagnostic>>,
    warnings: impl FnOnce(&T) -> &[Diagnostic],
) -> Result<(T, Reporter), u8> {
    let reporter = Reporter::new(global.quiet, global.verbose);
    let stop = loaded.time_is_up();
    let progress = |stage: &str, share| reporter.report(stage, share);
    let result = goal(&loaded.scene, &progress, &stop);
    reporter.finish();
    let done = result.map_err(|problems| loaded.failed(messages, &problems))?;
    let warnings = warnings(&done);
    if messages.print(warnings, Some(&loaded.source)) {
        messages.closing(warnings, NOTHING);
        return Err(WRONG_INPUT);
    }
    if args.timings {
        reporter.tell(messages.is_json());
    }
    Ok((done, reporter))
}

/// `1 view`, `2 views`.
pub fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn check(messages: &Messages, global: &Global, args: &SceneArgs) -> u8 {
    let Some(loaded) = load(messages, args, scene::resolve) else {
        return WRONG_INPUT;
    };
    match compile(messages, global, args, &loaded, compile::check, |w| w) {
        Err(code) => code,
        Ok((told, _)) => {
            let views = count(loaded.scene.views.len(), "view");
            let pillars = match &loaded.scene.brief {
                Some(_) => "pillars to be found".to_string(),
                None => {
                    let supports = &loaded.scene.supports;
                    let what = match supports.iter().any(Support::is_body) {
                        true => "support",
                        false => "pillar",
                    };
                    count(supports.iter().filter(|s| s.layer.is_some()).count(), what)
                }
            };
            let warnings = loaded.warnings.len() + told.len();
            let found = if warnings == 0 {
                "no problems".to_string()
            } else {
                count(warnings, "warning")
            };
            say(&format!(
                "{}: {views}, {pillars}: {found}\n",
                args.scene.display()
            ))
        }
    }
}

/// What is to be made of a scene.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Goal {
    Forest,
    Plan,
    Pictures,
}

impl Goal {
    fn run(self, scene: &Scene, progress: Progress, stop: Stop) -> Result<Build, Vec<Diagnostic>> {
        // Plans and pictures promise nothing.
        let unjudged = |drawn: Drawn| Build {
            files: drawn.files,
            summary: drawn.summary,
            failures: Vec::new(),
            warnings: drawn.warnings,
        };
        match self {
            Self::Forest => compile::build(scene, progress, stop),
            Self::Plan => compile::plan(scene, progress, stop).map(unjudged),
            Self::Pictures => compile::pictures(scene, progress, stop).map(unjudged),
        }
    }
}

/// What is to be made, and where it goes.
struct Order<'a> {
    goal: Goal,
    output: Option<&'a Path>,
    /// Write even what does not hold.
    force: bool,
}

impl<'a> Order<'a> {
    fn of(goal: Goal, output: Option<&'a Path>) -> Self {
        Self {
            goal,
            output,
            force: false,
        }
    }
}

fn make(messages: &Messages, global: &Global, args: &SceneArgs, order: &Order) -> u8 {
    let allowed: &[&str] = match order.goal {
        Goal::Plan => &["svg", "png"],
        Goal::Pictures => &[],
        Goal::Forest => &["3mf", "stl", "glb", "svg", "png", "json"],
    };
    let target = match Target::new(order.output, &args.scene, allowed) {
        Ok(target) => target,
        Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
    };
    let Some(loaded) = load(messages, args, scene::resolve) else {
        return WRONG_INPUT;
    };
    if order.goal == Goal::Forest && loaded.scene.output.split && matches!(target, Target::File(_))
    {
        let problem = Diagnostic::error("`--split` writes many files, and `-o` names only one")
            .help("give a directory: `-o out/pieces`");
        return fail(messages, &[problem], None, WRONG_USAGE);
    }
    let goal =
        |scene: &Scene, progress: Progress, stop: Stop| order.goal.run(scene, progress, stop);
    let (build, reporter) = match compile(messages, global, args, &loaded, goal, |b| &b.warnings) {
        Ok(done) => done,
        Err(code) => return code,
    };
    let code = if build.failures.is_empty() {
        WELL
    } else {
        NOT_PRINTABLE
    };
    if code != WELL {
        messages.print(&build.failures, Some(&loaded.source));
        if !order.force {
            messages.closing(&build.failures, NOTHING_YET);
            return code;
        }
        messages.closing(&build.failures, "Written all the same.");
    }
    let names = build.files.iter().map(|f| f.path.as_str());
    if let Err(problem) = target.spares(names, &args.scene, &loaded.read) {
        return fail(messages, &[problem], None, WRONG_USAGE);
    }
    match target.write(&build.files) {
        Err(problem) => fail(messages, &[problem], None, WRONG_INPUT),
        Ok(path) => {
            let seconds = reporter.finish().as_secs_f64();
            let done = format!("wrote {}  {}", path.display(), build.summary);
            say(&format!("{done}  ({seconds:.1} s)\n"));
            code
        }
    }
}

fn inspect(messages: &Messages, paths: &[PathBuf], json: bool) -> u8 {
    let mut code = WELL;
    for path in paths {
        let name = path.display().to_string();
        let found =
            files::regular(path).and_then(|bytes| pillarforest::formats::inspect(&name, &bytes));
        match found {
            Err(problem) => {
                messages.print(&[problem], None);
                code = WRONG_INPUT;
            }
            Ok(Warned { value, warnings }) => {
                let denied = messages.print(&warnings, None);
                say(&if json {
                    format!("{}\n", serde_json::json!(value))
                } else {
                    format!("{value}")
                });
                if code != WRONG_INPUT && !value.printable() {
                    code = NOT_PRINTABLE;
                }
                if denied {
                    code = WRONG_INPUT;
                }
            }
        }
    }
    code
}
