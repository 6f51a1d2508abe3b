//! What a run says while it works: a bar on a terminal, plain lines elsewhere, nothing in the first half second.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Shorter runs say nothing.
const PATIENCE: Duration = Duration::from_millis(500);
const STEPS: u64 = 1000;

/// Takes stage reports from any thread.
pub struct Reporter {
    start: Instant,
    silent: bool,
    verbose: bool,
    state: Mutex<State>,
}

struct State {
    bar: Option<ProgressBar>,
    /// Stages in order of their first report, with its time since the start.
    stages: Vec<(String, Duration)>,
    told: usize,
}

impl Reporter {
    pub fn new(silent: bool, verbose: bool) -> Self {
        let state = State {
            bar: None,
            stages: Vec::new(),
            told: 0,
        };
        Self {
            start: Instant::now(),
            silent,
            verbose,
            state: Mutex::new(state),
        }
    }

    /// A stage is at work, `share` of the whole run is done.
    pub fn report(&self, stage: &str, share: f64) {
        let elapsed = self.start.elapsed();
        // A thread that panicked while reporting must not take the others with it.
        let mut state = self
            .state
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        if state.stages.iter().all(|(name, _)| name != stage) {
            state.stages.push((stage.to_string(), elapsed));
        }
        if self.silent || (elapsed < PATIENCE && !self.verbose) {
            return;
        }
        if std::io::stderr().is_terminal() {
            let bar = state.bar.get_or_insert_with(bar);
            bar.set_position((share.clamp(0.0, 1.0) * STEPS as f64) as u64);
            bar.set_message(stage.to_string());
        } else {
            let fresh: Vec<String> = state.stages[state.told..]
                .iter()
                .map(|(name, _)| name.clone())
                .collect();
            state.told = state.stages.len();
            for name in fresh {
                eprintln!("[{:>3.0} %] {name}", share.clamp(0.0, 1.0) * 100.0);
            }
        }
    }

    /// Removes the bar; gives the time since the start.
    pub fn finish(&self) -> Duration {
        let state = self
            .state
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(bar) = &state.bar {
            bar.finish_and_clear();
        }
        self.start.elapsed()
    }

    /// One line per stage: when it began and how long until the next one did.
    pub fn timings(&self) -> String {
        let state = self
            .state
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        let end = self.start.elapsed();
        let next = state.stages.iter().skip(1).map(|(_, t)| *t).chain([end]);
        let lines = state.stages.iter().zip(next).map(|((name, from), to)| {
            format!(
                "{:>8.2} s  {name}\n",
                to.saturating_sub(*from).as_secs_f64()
            )
        });
        lines
            .chain([format!("{:>8.2} s  in all\n", end.as_secs_f64())])
            .collect()
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  ({eta} left)");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
