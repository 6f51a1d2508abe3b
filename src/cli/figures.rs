//! `figures`: builds the cases of the figures, writes the page, and says what holds.

use super::args::{FigureArgs, Global};
use super::case_builder::CaseBuilder;
use super::ending::{FAILED, NOT_PRINTABLE, WELL, WRONG_INPUT, WRONG_USAGE, fail, say};
use super::messages::{Messages, tell};
use super::write::Destination;
use pillarforest::diag::Diagnostic;
use pillarforest::figures::{self, Done, FIGURES, FILES, Figure, Job, Workshop};
use pillarforest::scene::nearest;
use std::path::Path;
use std::time::Instant;

/// Makes the figures; gives the exit code.
pub(super) fn run(messages: &Messages, global: &Global, args: &FigureArgs) -> u8 {
    if args.list {
        let line = |f: &Figure| format!("{:<10}{}: {}\n", f.name, f.paper, f.title);
        return say(&FIGURES.iter().map(line).collect::<String>());
    }
    let wanted = match wanted(&args.names) {
        Ok(wanted) => wanted,
        Err(problems) => return fail(messages, &problems, None, WRONG_USAGE),
    };
    if let Err(problem) = has_scenes(&args.scenes) {
        return fail(messages, &[problem], None, WRONG_INPUT);
    }
    let destination = match Destination::new(Some(&args.output), Path::new("figures"), &[]) {
        Ok(destination @ Destination::Directory(_)) => destination,
        Ok(Destination::File(_)) => {
            let problem =
                Diagnostic::error("figures are many files").help("give a directory: `-o DIR`");
            return fail(messages, &[problem], None, WRONG_USAGE);
        }
        Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
    };
    if let Err(problems) = destination.clear(FILES, Path::new("figures"), &[]) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    let start = Instant::now();
    let done = made(&wanted, args, global);
    match destination.write(&figures::files(&done)) {
        Err(problem) => fail(messages, &[problem], None, FAILED),
        Ok(page) => {
            let mut text: String = done.iter().map(told_of).collect();
            let well = done.iter().filter(|d| d.ok()).count();
            text.push_str(&format!(
                "wrote {}  {well} of {} figures hold  ({:.1} s)\n",
                page.display(),
                done.len(),
                start.elapsed().as_secs_f64()
            ));
            match say(&text) {
                WELL if well < done.len() => NOT_PRINTABLE,
                said => said,
            }
        }
    }
}

/// That the scenes of the figures lie there.
pub(super) fn has_scenes(folder: &Path) -> Result<(), Diagnostic> {
    match folder.is_dir() {
        true => Ok(()),
        false => Err(Diagnostic::error(format!(
            "there is no folder \"{}\" with the scenes of the figures",
            folder.display()
        ))
        .help("run it where the program's sources lie, or say where: `--scenes DIR`")),
    }
}

/// The figures of these names, in the paper's order; all if there are no names.
fn wanted(names: &[String]) -> Result<Vec<Figure>, Vec<Diagnostic>> {
    let known = || FIGURES.iter().map(|f| f.name);
    let unknown = names.iter().filter(|n| known().all(|k| k != n.as_str()));
    let problems: Vec<Diagnostic> = unknown
        .map(|name| {
            let problem = Diagnostic::error(format!("there is no figure \"{name}\""));
            match nearest(name, known()) {
                Some(guess) => problem.help(format!("did you mean `{guess}`?")),
                None => problem.help("`pillarforest figures --list` says which there are"),
            }
        })
        .collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let is_wanted = |f: &&Figure| names.is_empty() || names.iter().any(|n| n == f.name);
    Ok(FIGURES.iter().filter(is_wanted).copied().collect())
}

fn made(wanted: &[Figure], args: &FigureArgs, global: &Global) -> Vec<Done> {
    let builder = CaseBuilder {
        scenes: &args.scenes,
        models: &args.models,
        output: &args.output,
        jobs: args.jobs,
        quiet: global.quiet,
    };
    let mut build = |job: &Job| builder.build(job);
    let mut workshop = Workshop::new(&mut build);
    let one = |figure: &Figure| {
        if !global.quiet {
            tell(&format!("{}: {}", figure.paper, figure.title));
        }
        figures::make(*figure, &mut workshop)
    };
    wanted.iter().map(one).collect()
}

/// What a figure claims, and what of it holds.
fn told_of(done: &Done) -> String {
    let Done {
        figure,
        findings,
        failure,
    } = done;
    let mut text = format!("{}: {}\n", figure.paper, figure.title);
    for claim in &findings.claims {
        let sign = if claim.holds {
            "holds"
        } else {
            "DOES NOT HOLD"
        };
        text.push_str(&format!("    {sign}: {}\n", claim.text));
    }
    for case in findings.cases.iter().filter(|c| !c.ok) {
        text.push_str(&format!(
            "    DOES NOT HOLD: what a build promises, in the case {}\n",
            case.name
        ));
    }
    if let Some(why) = failure {
        text.push_str(&format!("    NOT MADE: {why}\n"));
    }
    text
}
