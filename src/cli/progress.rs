//! What a run says while it works: a bar on a terminal, plain lines elsewhere, nothing in the first half second.

use super::messages::{is_dumb, tell};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Shorter runs say nothing.
const PATIENCE: Duration = Duration::from_millis(500);
/// How often what is told is brought up to date.
const TICK: Duration = Duration::from_millis(250);
const STEPS: u64 = 1000;

/// Stages in their order with what each takes of a build, per cent: those of scenes/minimal.ron on two cores. Contested surface takes so much
/// with four views of one model; simplifying and pieces are guesses. Others (searches for pillars) tell their share themselves.
const MEASURED: [(&str, f64); 11] = [
    ("models", 3.0),
    ("simplifying models", 2.0),
    ("scene", 0.1),
    ("view maps", 7.0),
    ("contested surface", 2.0),
    ("quadratic programs", 50.0),
    ("solids", 18.0),
    ("pictures", 9.0),
    ("pieces", 3.0),
    ("certificates", 5.0),
    ("files", 5.0),
];
/// Before so much of a run is done its time left is anybody's guess.
const TELLING: f64 = 0.08;

/// Takes stage reports from any thread, and tells them from one of its own: a stage that takes minutes must not look dead.
pub(super) struct Reporter {
    shared: Arc<Shared>,
}

struct Shared {
    start: Instant,
    silent: bool,
    verbose: bool,
    terminal: bool,
    state: Mutex<State>,
}

/// In order of their first report.
struct Reported {
    name: String,
    /// Of the first report since the start.
    at: Duration,
    /// What of the run was done then, 0 to 1.
    done: f64,
}

#[derive(Default)]
struct State {
    bar: Option<ProgressBar>,
    stages: Vec<Reported>,
    /// How many of them were told.
    told: usize,
    /// Of the whole run when the stage at work began, and by when it will be done if it takes as long as measured; 0 to 1.
    from: f64,
    to: f64,
    /// Since the start, when that was.
    since: Duration,
    /// Nothing is told while others print.
    paused: bool,
    finished: bool,
}

impl Reporter {
    pub(super) fn new(silent: bool, verbose: bool) -> Self {
        let shared = Arc::new(Shared {
            start: Instant::now(),
            silent,
            verbose,
            terminal: std::io::stderr().is_terminal() && !is_dumb(),
            state: Mutex::default(),
        });
        if !silent {
            let shared = shared.clone();
            let ticking = move || {
                while shared.tick() {
                    std::thread::sleep(TICK);
                }
            };
            // Where no thread can start, only reports are told.
            let _ = std::thread::Builder::new().spawn(ticking);
        }
        Self { shared }
    }

    /// A stage is at work, `share` of the whole run is done as far as the stage knows.
    pub(super) fn report(&self, stage: &str, share: f64) {
        let now = self.shared.start.elapsed();
        let mut state = self.shared.state();
        if state.stages.last().is_none_or(|s| s.name != stage) {
            let (from, to) = measured(stage).unwrap_or((share, share));
            (state.from, state.to, state.since) = (from, to, now);
            if state.stages.iter().all(|s| s.name != stage) {
                state.stages.push(Reported {
                    name: stage.to_string(),
                    at: now,
                    done: from,
                });
            }
        } else if measured(stage).is_none() {
            (state.from, state.to, state.since) = (share, share, now);
        }
        state.paused = false;
        self.shared.tell(&mut state);
    }

    /// Tells nothing until the next report, so that messages have the terminal.
    pub(super) fn pause(&self) {
        let mut state = self.shared.state();
        state.paused = true;
        if let Some(bar) = state.bar.take() {
            bar.finish_and_clear();
        }
    }

    /// Removes the bar; gives the time since the start.
    pub(super) fn finish(&self) -> Duration {
        self.pause();
        self.shared.state().finished = true;
        self.shared.start.elapsed()
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
            tell(&told.to_string());
            return;
        }
        let lines = stage_lines(&stages, all, peak);
        lines.iter().for_each(|line| tell(line));
    }

    /// Every stage with its seconds, from when it began until the next one did; and those since the start.
    fn stages(&self) -> (Vec<(String, f64)>, f64) {
        let state = self.shared.state();
        let end = self.shared.start.elapsed();
        let next = state.stages.iter().skip(1).map(|s| s.at).chain([end]);
        let stages = state
            .stages
            .iter()
            .zip(next)
            .map(|(s, to)| (s.name.clone(), to.saturating_sub(s.at).as_secs_f64()));
        (stages.collect(), end.as_secs_f64())
    }
}

impl Drop for Reporter {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // A thread that panicked while reporting must not take the others with it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells what is new; whether to go on.
    fn tick(&self) -> bool {
        let mut state = self.state();
        self.tell(&mut state);
        !state.finished
    }

    fn tell(&self, state: &mut State) {
        let elapsed = self.start.elapsed();
        let is_early = elapsed < PATIENCE && !self.verbose;
        if self.silent || is_early || state.paused || state.finished {
            return;
        }
        let done = done((state.from, state.to), elapsed - state.since, elapsed);
        if !self.terminal {
            for Reported { name, done, .. } in &state.stages[state.told..] {
                tell(&format!("[{:>3.0} %] {name}", 100.0 * done));
            }
            state.told = state.stages.len();
        } else if let Some(Reported { name, .. }) = state.stages.last() {
            let left = match left(elapsed, done) {
                Some(seconds) => format!("{name}  (about {seconds} s left)"),
                None => name.clone(),
            };
            let bar = state.bar.get_or_insert_with(bar);
            bar.set_position((done * STEPS as f64) as u64);
            bar.set_message(left);
        }
    }
}

/// Which part of a run a stage is, from where to where, 0 to 1; `None` if that was never measured.
fn measured(stage: &str) -> Option<(f64, f64)> {
    let all: f64 = MEASURED.iter().map(|(_, share)| share).sum();
    let k = MEASURED.iter().position(|(name, _)| *name == stage)?;
    let before = MEASURED[..k]
        .iter()
        .fold(0.0, |sum, (_, share)| sum + share);
    Some((before / all, (before + MEASURED[k].1) / all))
}

/// The share of a run that is done if the stage from `from` to `to` of it has been at work for some time. One that takes longer than
/// measured comes ever nearer to its end and never gets there.
fn done((from, to): (f64, f64), at_work: Duration, elapsed: Duration) -> f64 {
    let before = (elapsed - at_work).as_secs_f64();
    let expected = match from > 0.0 {
        true => before / from * (to - from),
        false => PATIENCE.as_secs_f64(),
    };
    let times = at_work.as_secs_f64() / expected.max(1e-3);
    (from + (to - from) * (1.0 - (-times).exp())).clamp(0.0, 0.99)
}

/// Whole seconds left, at least one: work goes on. `None` while too little is done to tell.
fn left(elapsed: Duration, done: f64) -> Option<u64> {
    let left = elapsed.as_secs_f64() * (1.0 - done) / done.max(1e-9);
    (done > TELLING).then(|| left.ceil().max(1.0) as u64)
}

/// A line for each stage, one for all, and one for the largest memory, if it is known.
pub(super) fn stage_lines(stages: &[(String, f64)], all: f64, peak_mb: Option<f64>) -> Vec<String> {
    let stages = stages.iter().map(|(name, s)| format!("{s:>8.2} s  {name}"));
    let all = format!("{all:>8.2} s  in all");
    let peak = peak_mb.map(|mb| format!("{mb:>8.0} MB largest memory"));
    stages.chain([all]).chain(peak).collect()
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
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever its shares, a run that goes on has time left, and a stage that takes longer never comes back.
    #[test]
    fn work_that_goes_on_has_time_left() {
        let seconds = Duration::from_secs_f64;
        for (stage, _) in MEASURED {
            let part = measured(stage).unwrap();
            let mut last = 0.0;
            for at_work in [0.0, 0.1, 1.0, 10.0, 1000.0] {
                let elapsed = seconds(3.0 + at_work);
                let done = done(part, seconds(at_work), elapsed);
                assert!(
                    done >= last && done >= part.0.min(0.99) && done <= part.1,
                    "{stage}"
                );
                assert!(left(elapsed, done).is_none_or(|s| s > 0), "{stage}");
                last = done;
            }
        }
        assert_eq!(left(seconds(10.0), 0.5), Some(10));
    }
}
