//! Layouts: pillars found or mended for a scene, as a scene to build and as files to keep.

use super::output::OutputFile;
use crate::diag::Diagnostic;
use crate::diagram::Plan;
use crate::diagram::planning::{animation, sheet, strip, trade};
use crate::planner::{self, Brief, Ended, Frame, Planned, Watch, Worth};
use crate::scene::{Scene, laid_out, layout_text};
use crate::words;

/// Name of the layout file among the outputs.
pub const LAYOUT: &str = "layout.ron";
/// All files that a search may write.
pub const SEARCH_FILES: [&str; 7] = [
    LAYOUT,
    "plan.svg",
    "plan.png",
    "tradeoff.svg",
    "tradeoff.png",
    "search.svg",
    "search.png",
];
/// Widths of the planning pictures, pixels: text of 2.5 mm on A4 has 20 of them in the first.
const SHEET_PX: u32 = 2400;
const TRADE_PX: u32 = 1400;
const STRIP_PX: u32 = 2000;
/// A view whose models are covered by less than this misses something that can be seen.
const COVERED: f64 = 0.9995;

/// Finds the pillars of a scene that wants them found: the scene with them, and the plan.
///
/// # Errors
/// Which limit binds; or that the scene lists its pillars.
pub fn planned(scene: &Scene, watch: Watch) -> Result<(Scene, Planned), Vec<Diagnostic>> {
    let Some(brief) = &scene.brief else {
        return Err(vec![
            Diagnostic::error("the scene lists its pillars: there is nothing to plan")
                .help("to have them found, write `pillars: Auto()`; for this run only: --set \"pillars=Auto()\"")
                .help("`pillarforest repair` mends a list with the fewest moves"),
        ]);
    };
    let plan = planner::plan(&scene.views, brief, watch)
        .map_err(|e| words::planner::no_layout(&scene.views, &e))?;
    Ok((laid_out(scene, &plan), plan))
}

/// Mends the pillars of a scene that was [read for that](crate::scene::resolve_to_mend): the scene with them, and what was done.
///
/// # Errors
/// What cannot be mended; or that the scene has no pillars yet.
pub fn repaired(scene: &Scene, watch: Watch) -> Result<(Scene, Planned), Vec<Diagnostic>> {
    let listed = |b: &&Brief| !b.given.is_empty() && b.given.iter().all(|p| !p.fixed);
    let Some(brief) = scene.brief.as_ref().filter(listed) else {
        return Err(vec![
            Diagnostic::error("the scene has its pillars found: there is no list to mend")
                .help("`pillarforest plan` finds them and writes the list"),
        ]);
    };
    let plan = planner::repair(&scene.views, brief, watch)
        .map_err(|e| words::planner::no_layout(&scene.views, &e))?;
    Ok((laid_out(scene, &plan), plan))
}

/// The files of a plan of `scene` as it was read.
pub fn plan_outputs(scene: &Scene, plan: &Planned) -> Vec<OutputFile> {
    let mut files = vec![layout_file(scene, plan)];
    // A scene as read has the brief of its plan.
    if let Some(brief) = &scene.brief {
        let (title, views) = (&scene.title, &scene.views);
        let (found, tell) = ((brief, plan), |f: &Frame| words::planner::marks(views, f));
        files.extend(picture(
            "plan",
            &sheet(title, views, found, &tell),
            SHEET_PX,
        ));
        files.extend(picture("tradeoff", &trade(title, brief, plan), TRADE_PX));
        files.push(OutputFile::new(
            "search.svg",
            animation(title, views, found, &tell).into_bytes(),
        ));
        files.push(OutputFile::new(
            "search.png",
            strip(title, views, found, &tell).png(STRIP_PX),
        ));
    }
    files
}

fn picture(name: &str, page: &Plan, width_px: u32) -> [OutputFile; 2] {
    [
        OutputFile::new(format!("{name}.svg"), page.svg().into_bytes()),
        OutputFile::new(format!("{name}.png"), page.png(width_px)),
    ]
}

pub(crate) fn layout_file(scene: &Scene, plan: &Planned) -> OutputFile {
    OutputFile::new(LAYOUT, layout_text(scene, plan).into_bytes())
}

/// What of a plan does not hold.
pub fn shortfalls(scene: &Scene, plan: &Planned) -> Vec<Diagnostic> {
    let views = scene.views.iter().zip(&plan.worth);
    views.filter_map(|(v, w)| shortfall(&v.name, w)).collect()
}

fn shortfall(view: &str, worth: &Worth) -> Option<Diagnostic> {
    let missing = (worth.coverage < COVERED).then(|| {
        let part = 100.0 * (1.0 - worth.coverage);
        format!("{part:.2} % of its models meet no pillar of its own")
    });
    let conflicts = (worth.conflicts > 0).then(|| format!("{} conflicts", worth.conflicts));
    let found: Vec<String> = missing.into_iter().chain(conflicts).collect();
    let text = format!("view \"{view}\": {}", found.join(", "));
    let help = "more `tries`, a larger `region`, slimmer pillars or smaller models";
    (!found.is_empty()).then(|| Diagnostic::error(text).help(help))
}

/// Says so if time ended the search.
pub fn cut_short(brief: &Brief, plan: &Planned) -> Option<Diagnostic> {
    let text = format!(
        "the search for pillars ended after {} s and {} of {} tries: on another machine it may end elsewhere",
        brief.seconds, plan.tries, brief.tries
    );
    let help = format!("keep {LAYOUT} and include it, or ask for fewer `tries`");
    (plan.ended == Ended::Stopped).then(|| Diagnostic::warning(text).help(help))
}
