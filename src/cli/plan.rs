//! `plan` and `repair`: pillars found or mended, and written down.

use super::args::{Global, SceneArgs, SearchArgs};
use super::ending::{FAILED, NOT_PRINTABLE, NOTHING, WRONG_INPUT, WRONG_USAGE, count, fail, say};
use super::load::{Loaded, load};
use super::messages::Messages;
use super::progress::Reporter;
use super::write::Destination;
use pillarforest::compile::{self, LAYOUT};
use pillarforest::diag::Diagnostic;
use pillarforest::planner::{Change, Planned, Watch};
use pillarforest::scene::{Purpose, Scene};
use pillarforest::support::SupportKind;
use std::path::Path;

/// What is searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Search {
    Plan,
    Repair,
}

/// Runs the command; gives the exit code.
pub(super) fn run(
    messages: &Messages,
    global: &Global,
    args: &SceneArgs,
    search: &SearchArgs,
    kind: Search,
) -> u8 {
    let purpose = match kind {
        Search::Plan => Purpose::Build,
        Search::Repair => Purpose::Mend,
    };
    let destination = Destination::new(search.output.as_deref(), &args.scene, &["ron"]);
    let destination =
        match destination.and_then(|t| t.spares([LAYOUT], &args.scene, &[]).map(|()| t)) {
            Ok(destination) => destination,
            Err(problem) => return fail(messages, &[problem], None, WRONG_USAGE),
        };
    let reporter = Reporter::new(global.quiet, global.verbose);
    let Some(mut loaded) = load(messages, args, purpose, &reporter) else {
        return WRONG_INPUT;
    };
    if let Err(problems) = destination.clear(compile::SEARCH_FILES, &args.scene, &loaded.read) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    wish(&mut loaded.scene, search);
    let (laid, plan) = match searched(&loaded, kind, &reporter) {
        Ok(done) => done,
        Err(problems) => return loaded.failed(messages, &problems),
    };
    if args.timings {
        reporter.tell(messages.is_json());
    }
    let shortfalls = compile::shortfalls(&loaded.scene, &plan);
    if !shortfalls.is_empty() {
        return fail(messages, &shortfalls, Some(&loaded.source), NOT_PRINTABLE);
    }
    if kind == Search::Repair && plan.changes.is_empty() {
        let text = format!("{}: nothing to mend. {NOTHING}\n", args.scene.display());
        return say(&text);
    }
    let files = compile::plan_outputs(&loaded.scene, &plan);
    let names = files.iter().map(|f| f.path.as_str());
    if let Err(problems) = destination.clear(names, &args.scene, &loaded.read) {
        return fail(messages, &problems, None, WRONG_USAGE);
    }
    match destination.write(&files) {
        Err(problem) => fail(messages, &[problem], None, FAILED),
        Ok(path) => {
            let seconds = reporter.finish().as_secs_f64();
            let pillars = count(plan.pillars.len(), "pillar");
            let views = count(laid.views.len(), "view");
            let written = path.display();
            let done = format!("wrote {written}  {pillars}, {views}  ({seconds:.1} s)\n");
            if global.quiet {
                return say(&done);
            }
            let before = changes(&loaded.scene, &laid, &plan) + &table(&loaded.scene, &plan);
            let after = usage(&args.scene, &path) + &note(&loaded.scene, &plan);
            say(&(before + &done + &after))
        }
    }
}

/// What the command line wants otherwise than the scene.
fn wish(scene: &mut Scene, search: &SearchArgs) {
    if let Some(brief) = &mut scene.brief {
        brief.seed = search.seed.map_or(brief.seed, u64::from);
        brief.tries = search.tries.map_or(brief.tries, u64::from);
        brief.seconds = search.seconds.unwrap_or(brief.seconds);
    }
}

fn searched(
    loaded: &Loaded,
    kind: Search,
    reporter: &Reporter,
) -> Result<(Scene, Planned), Vec<Diagnostic>> {
    let watch = Watch {
        progress: &|stage, share| reporter.report(stage, share),
        stop: &loaded.time_is_up(),
    };
    let done = match kind {
        Search::Plan => compile::planned(&loaded.scene, watch),
        Search::Repair => compile::repaired(&loaded.scene, watch),
    };
    reporter.finish();
    done
}

/// What the plan is worth to every view.
fn table(scene: &Scene, plan: &Planned) -> String {
    let angle = scene.brief.as_ref().map_or(0.0, |b| b.hidden_from_deg);
    let head = [
        "view".to_string(),
        "coverage".into(),
        "conflicts".into(),
        "pillars".into(),
        format!("at {angle} deg off"),
        "half likeness".into(),
        "eye tolerance".into(),
    ];
    let views = scene.views.iter().zip(&plan.worth);
    let rows = views.map(|(view, worth)| {
        let [usual, least] = worth.tolerance_mm;
        [
            view.name.clone(),
            format!("{:.2} %", 100.0 * worth.coverage),
            worth.conflicts.to_string(),
            worth.pillars.to_string(),
            format!("{:.1} deg", worth.hidden_deg),
            worth
                .half_likeness_deg
                .map_or("never".into(), |deg| format!("{deg:.1} deg")),
            format!("{usual:.2} mm, at least {least:.2} mm"),
        ]
    });
    let rows: Vec<[String; 7]> = [head].into_iter().chain(rows).collect();
    let width = |column: usize| rows.iter().map(|r| r[column].chars().count()).max();
    let widths: Vec<usize> = (0..7).map(|c| width(c).unwrap_or(0)).collect();
    let line = |row: &[String; 7]| {
        let cells = row.iter().zip(&widths).enumerate();
        let cells: Vec<String> = cells
            .map(|(column, (cell, width))| match column {
                0 | 6 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            })
            .collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

/// Every pillar that was moved, added or removed.
fn changes(scene: &Scene, laid: &Scene, plan: &Planned) -> String {
    let line = |change: &Change| {
        let given = change.given.and_then(|i| place(scene, i));
        Some(match (given, change.to) {
            (Some((name, from)), Some(to)) => format!(
                "moved {name} by {:.1} mm to ({:.3}, {:.3})\n",
                from.distance(to),
                to.x,
                to.y
            ),
            (Some((name, from)), None) => {
                format!("removed {name} at ({:.3}, {:.3})\n", from.x, from.y)
            }
            (None, Some(to)) => {
                let names = (0..laid.supports.len()).filter_map(|i| place(laid, i));
                let name = names
                    .min_by(|a, b| a.1.distance(to).total_cmp(&b.1.distance(to)))?
                    .0;
                format!("added {name} at ({:.3}, {:.3})\n", to.x, to.y)
            }
            (None, None) => return None,
        })
    };
    plan.changes.iter().filter_map(line).collect()
}

/// Name and axis of a pillar.
fn place(scene: &Scene, pillar: usize) -> Option<(&str, glam::DVec2)> {
    let support = scene.supports.get(pillar)?;
    match &support.kind {
        SupportKind::Pillar { axis, .. } => Some((support.name.as_str(), *axis)),
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    }
}

/// How a scene takes the layout up.
fn usage(scene: &Path, layout: &Path) -> String {
    let folder = scene.parent().filter(|p| !p.as_os_str().is_empty());
    let folder = std::fs::canonicalize(folder.unwrap_or(Path::new("."))).ok();
    let written = std::fs::canonicalize(layout).ok();
    let inside = folder.zip(written).and_then(|(folder, written)| {
        let parts = written.strip_prefix(folder).ok()?.components();
        let parts: Vec<String> = parts
            .map(|c| c.as_os_str().to_string_lossy().to_string())
            .collect();
        Some(parts.join("/"))
    });
    let scene = scene.display();
    match inside {
        Some(path) => format!("to use it, write in {scene}:  pillars: File({path:?})\n"),
        None => {
            let name = layout.file_name().unwrap_or_default().to_string_lossy();
            format!("to use it, copy it beside {scene} and write there:  pillars: File({name:?})\n")
        }
    }
}

/// What to know if time ended the search.
fn note(scene: &Scene, plan: &Planned) -> String {
    let cut = scene.brief.as_ref();
    let cut = cut.and_then(|brief| compile::cut_short(brief, plan));
    cut.map_or(String::new(), |d| {
        format!("note: {}; {}\n", d.message, d.help.join("; "))
    })
}
