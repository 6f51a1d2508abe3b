//! How many threads a run has.

use pillarforest::diag::Diagnostic;
use rayon::{ThreadBuilder, ThreadPoolBuilder};
use std::io::ErrorKind;
use std::sync::{Arc, Mutex, PoisonError, mpsc};

/// More threads than this for every core only wait for each other: on two cores a run with 1000 had not ended after 91 s of their time.
const PER_CORE: usize = 4;
/// As many are let through on any machine, so that what holds for many threads can be tried on few cores.
const ALWAYS: usize = 8;

/// Starts the threads that all work is done on, `wanted` of them or one for each core; what the user should know of it. Must be called
/// before anything runs in parallel.
pub(super) fn start(wanted: Option<u16>) -> Option<Diagnostic> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = (PER_CORE * cores).max(ALWAYS);
    let asked = wanted.map_or(cores, usize::from);
    let started = started(asked.min(most));
    if started < asked.min(most) {
        return Some(
            Diagnostic::warning(format!(
                "the system starts no more than {started} of {} threads; the run goes on with {started}",
                asked.min(most)
            ))
            .help(format!("`-j {started}` asks for no more; a limit on processes or memory (`ulimit -u`, `ulimit -v`) may be too low")),
        );
    }
    (asked > most).then(|| {
        Diagnostic::warning(format!(
            "`-j {asked}` are more threads than help on {cores} cores; the run goes on with {most}"
        ))
        .help(format!(
            "without `-j` there is one for each core, here {cores}"
        ))
    })
}

/// Starts so many threads, or as many as the system gives. They are started here and handed to the pool, because a pool that fails to
/// start them cannot be tried again.
fn started(wanted: usize) -> usize {
    let (give, take) = mpsc::channel::<ThreadBuilder>();
    let take = Arc::new(Mutex::new(take));
    let start = |_| {
        let take = take.clone();
        let work = move || {
            let next = take.lock().unwrap_or_else(PoisonError::into_inner).recv();
            if let Ok(thread) = next {
                thread.run();
            }
        };
        std::thread::Builder::new().spawn(work).ok()
    };
    let threads = (0..wanted).map_while(start).count();
    let pool = ThreadPoolBuilder::new().num_threads(threads.max(1));
    // A pool of this run exists only where a command asks twice; it stays.
    let _ = match threads {
        // The thread there is needs no start.
        0 => pool.use_current_thread().build_global(),
        _ => pool
            .spawn_handler(|thread| give.send(thread).map_err(|_| ErrorKind::Other.into()))
            .build_global(),
    };
    threads.max(1)
}
