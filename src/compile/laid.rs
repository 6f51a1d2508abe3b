//! The scene whose pillars stand: as it was given, or with those that a search found.

use super::output::OutputFile;
use super::planning::{cut_short, layout_file};
use super::progress::{Progress, Stop};
use crate::diag::Diagnostic;
use crate::planner::{self, Brief, Planned, Watch};
use crate::scene::{Scene, laid_out};
use crate::words;
use std::borrow::Cow;

/// Share of a run that finding its pillars takes.
const PLANNING: f64 = 0.3;

/// See the module.
pub(crate) struct LaidScene<'a> {
    given: &'a Scene,
    scene: Cow<'a, Scene>,
    /// What was asked of a search and what it found, if there was one.
    search: Option<(Brief, Planned)>,
}

/// Finds the pillars if the scene wants it.
///
/// # Errors
/// Which limits bind.
pub(crate) fn laid<'a>(
    given: &'a Scene,
    progress: Progress,
    stop: Stop,
) -> Result<LaidScene<'a>, Vec<Diagnostic>> {
    let tries = given.brief.as_ref().map_or(0, |b| b.tries);
    laid_after(given, tries, progress, stop)
}

/// The pillars that a search would start from.
///
/// # Errors
/// Which limits bind.
pub(crate) fn laid_at_first<'a>(
    given: &'a Scene,
    progress: Progress,
    stop: Stop,
) -> Result<LaidScene<'a>, Vec<Diagnostic>> {
    laid_after(given, 0, progress, stop)
}

fn laid_after<'a>(
    given: &'a Scene,
    tries: u64,
    progress: Progress,
    stop: Stop,
) -> Result<LaidScene<'a>, Vec<Diagnostic>> {
    let Some(brief) = &given.brief else {
        return Ok(LaidScene {
            given,
            scene: Cow::Borrowed(given),
            search: None,
        });
    };
    let brief = Brief {
        tries,
        ..brief.clone()
    };
    let watch = Watch {
        progress: &|stage, share| progress(stage, PLANNING * share),
        stop,
    };
    let plan = planner::plan(&given.views, &brief, watch)
        .map_err(|e| words::planner::no_layout(&given.views, &e))?;
    Ok(LaidScene {
        given,
        scene: Cow::Owned(laid_out(given, &plan)),
        search: Some((brief, plan)),
    })
}

impl LaidScene<'_> {
    pub(crate) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Progress of what is left of the run.
    pub(crate) fn rest<'p>(&self, progress: Progress<'p>) -> impl Fn(&str, f64) + Sync + use<'p> {
        let done = self.search.as_ref().map_or(0.0, |_| PLANNING);
        move |stage: &str, share| progress(stage, done + (1.0 - done) * share)
    }

    /// The layout found, to be kept.
    pub(crate) fn layout(&self) -> Option<OutputFile> {
        let (_, plan) = self.search.as_ref()?;
        Some(layout_file(self.given, plan))
    }

    /// Whether time ended the search.
    pub(crate) fn warning(&self) -> Option<Diagnostic> {
        let (brief, plan) = self.search.as_ref()?;
        cut_short(brief, plan)
    }
}
