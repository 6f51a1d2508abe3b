//! What each command does, in order.

use super::args::{Cli, Command, Global, SceneArgs, Style};
use super::ending::{
    FAILED, NOT_PRINTABLE, NOTHING, WELL, WRONG_INPUT, WRONG_USAGE, count, fail, say,
};
use super::load::{Loaded, load};
use super::messages::Messages;
use super::plan::{self, Search};
use super::progress::Reporter;
use super::write::Destination;
use super::{bench, figures, init, inspect};
use clap::CommandFactory;
use pillarforest::compile::{self, Build, Drawn, Progress, Stop};
use pillarforest::diag::Diagnostic;
use pillarforest::scene::{self, Purpose, Scene};
use pillarforest::support::Support;
use std::path::Path;

const NOTHING_YET: &str = "Nothing was written; `--force` writes it all the same.";

/// Runs the command; gives the exit code.
pub(super) fn run(cli: &Cli, messages: &Messages) -> u8 {
    match &cli.command {
        Command::Init { paths, force } => init::run(messages, paths, *force),
        Command::Check { scene } => check(messages, &cli.global, scene),
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
            let errand = Errand {
                goal: Goal::Forest,
                output: output.as_deref(),
                force: *force,
            };
            make(messages, &cli.global, &scene, &errand)
        }
        Command::Plan { scene, search } => {
            plan::run(messages, &cli.global, scene, search, Search::Plan)
        }
        Command::Repair { scene, search } => {
            plan::run(messages, &cli.global, scene, search, Search::Repair)
        }
        Command::View { scene, output } => {
            let errand = Errand::of(Goal::Plan, output.as_deref());
            make(messages, &cli.global, scene, &errand)
        }
        Command::Render { scene, output } => {
            let errand = Errand::of(Goal::Pictures, output.as_deref());
            make(messages, &cli.global, scene, &errand)
        }
        Command::Inspect { files, json, views } => {
            let json = *json || cli.global.diagnostics == Style::Json;
            match views {
                true => inspect::draw(messages, files),
                false => inspect::run(messages, files, json),
            }
        }
        Command::Figures(args) => figures::run(messages, &cli.global, args),
        Command::Bench(args) => bench::run(messages, &cli.global, args),
        Command::Schema => say(&scene::schema()),
        Command::Completions { shell } => completions(*shell),
    }
}

fn completions(shell: clap_complete::Shell) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "pillarforest", &mut script);
    say(&String::from_utf8_lossy(&script))
}

/// Runs one of the pipeline's goals with progress, and prints the `warnings` that it gives. The error code has been explained to the
/// user.
fn compile<T>(
    messages: &Messages,
    reporter: &Reporter,
    args: &SceneArgs,
    loaded: &Loaded,
    goal: impl FnOnce(&Scene, Progress, Stop) -> Result<T, Vec<Diagnostic>>,
    warnings: impl FnOnce(&T) -> &[Diagnostic],
) -> Result<T, u8> {
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
    Ok(done)
}

fn check(messages: &Messages, global: &Global, args: &SceneArgs) -> u8 {
    let reporter = Reporter::new(global.quiet, global.verbose);
    let Some(loaded) = load(messages, args, Purpose::Build, &reporter) else {
        return WRONG_INPUT;
    };
    match compile(messages, &reporter, args, &loaded, compile::check, |w| w) {
        Err(code) => code,
        Ok(told) => {
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
    /// The files that it may write.
    fn names(self, scene: &Scene) -> Vec<String> {
        match self {
            Self::Forest => compile::build_names(scene),
            Self::Plan => compile::plan_names(scene),
            Self::Pictures => compile::picture_names(scene),
        }
    }

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
struct Errand<'a> {
    goal: Goal,
    output: Option<&'a Path>,
    /// Write even what does not hold.
    force: bool,
}

impl<'a> Errand<'a> {
    fn of(goal: Goal, output: Option<&'a Path>) -> Self {
        Self {
            goal,
            output,
            force: false,
        }
    }
}

fn make(messages: &Messages, global: &Global, args: &SceneArgs, errand: &Errand) -> u8 {
    let allowed: &[&str] = match errand.goal {
        Goal::Plan => &["svg", "png"],
        Goal::Pictures => &[],
        Goal::Forest => &["3mf", "stl", "glb", "svg", "png", "json"],
    };
    let destination = match Destination::new(errand.output, &args.scene, allowed) {
        Ok(destination) => destination,
        Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
    };
    let reporter = Reporter::new(global.quiet, global.verbose);
    let Some(loaded) = load(messages, args, Purpose::Build, &reporter) else {
        return WRONG_INPUT;
    };
    if errand.goal == Goal::Forest
        && loaded.scene.output.split
        && matches!(destination, Destination::File(_))
    {
        let problem = Diagnostic::error("`--split` writes many files, and `-o` names only one")
            .help("give a directory: `-o out/pieces`");
        return fail(messages, &[problem], None, WRONG_USAGE);
    }
    if errand.goal != Goal::Plan {
        let slow = compile::slow(&loaded.scene, rayon::current_num_threads());
        messages.print(slow.as_slice(), None);
    }
    let names = errand.goal.names(&loaded.scene);
    let names = names.iter().map(String::as_str);
    if let Err(problems) = destination.clear(names, &args.scene, &loaded.read) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    let goal =
        |scene: &Scene, progress: Progress, stop: Stop| errand.goal.run(scene, progress, stop);
    let build = match compile(messages, &reporter, args, &loaded, goal, |b| &b.warnings) {
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
        if !errand.force {
            messages.closing(&build.failures, NOTHING_YET);
            return code;
        }
        messages.closing(&build.failures, "Written all the same.");
    }
    // Once more: minutes have passed.
    let names = build.files.iter().map(|f| f.path.as_str());
    if let Err(problems) = destination.clear(names, &args.scene, &loaded.read) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    match destination.write(&build.files) {
        Err(problem) => fail(messages, &[problem], None, FAILED),
        Ok(path) => {
            let seconds = reporter.finish().as_secs_f64();
            let done = format!("wrote {}  {}", path.display(), build.summary);
            match say(&format!("{done}  ({seconds:.1} s)\n")) {
                WELL => code,
                failed => failed,
            }
        }
    }
}
