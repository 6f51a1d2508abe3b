//! What a run says while it works: a bar on a terminal, plain lines elsewhere, nothing in the first half second.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Shorter runs say nothing.
const PATIENCE: Duration = Duration::from_millis(500);
const STEPS: u64 = 1000;

/// Takes stage reports from any thread.
pub(super) struct Reporter {
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
    pub(super) fn new(silent: bool, verbose: bool) -> Self {
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
    pub(super) fn report(&self, stage: &str, share: f64) {
        let elapsed = self.start.elapsed();
        // A thread that panicked while reporting must not take the others with it.
        let mut state = self
            .state
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
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
    pub(super) fn finish(&self) -> Duration {
        let state = self
            .state
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(bar) = &state.bar {
            bar.finish_and_clear();
        }
        self.start.elapsed()
    }

    /// Prints how long every stage took and the largest memory so far: a line each, or one JSON object.
    pub(super) fn tell(&self, json: bool) {
        let (stages, all) = self.stages();
        let peak = peak_mb();
        if json {
            let stages: Vec<_> = stages
                .iter()
                .map(|(name, seconds)| serde_json::json!({ "stage": name, "seconds": seconds }))
                .collect();
            let told =
                serde_json::json!({ "timings": stages, "seconds": all, "peak_memory_mb": peak });
            eprintln!("{told}");
            return;
        }
        for (name, seconds) in stages {
            eprintln!("{seconds:>8.2} s  {name}");
        }
        eprintln!("{all:>8.2} s  in all");
        if let Some(peak) = peak {
            eprintln!("{peak:>8.0} MB largest memory");
        }
    }

    /// Every stage with its seconds, from when it began until the next one did; and those since the start.
    fn stages(&self) -> (Vec<(String, f64)>, f64) {
        let state = self
            .state
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let end = self.start.elapsed();
        let next = state.stages.iter().skip(1).map(|(_, t)| *t).chain([end]);
        let stages = state
            .stages
            .iter()
            .zip(next)
            .map(|((name, from), to)| (name.clone(), to.saturating_sub(*from).as_secs_f64()));
        (stages.collect(), end.as_secs_f64())
    }
}

/// The largest memory of this process so far, megabytes, where the system tells (Linux).
fn peak_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes / 1024.0)
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  ({eta} left)");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
