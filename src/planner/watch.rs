//! How a caller follows a search and ends it.

/// How a caller follows a search and ends it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Stage and share of the planning done, 0 to 1. From any thread.
    pub progress: &'a (dyn Fn(&str, f64) + Sync),
    /// Whether to end with what there is.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Reports progress of several chains as one, and passes on when to stop.
pub(crate) fn follow<'a>(
    watch: Watch<'a>,
    stage: &'a str,
    [from, to]: [f64; 2],
    tries: u64,
) -> impl Fn(u64) -> bool + 'a {
    move |k| {
        (watch.progress)(stage, from + (to - from) * k as f64 / tries.max(1) as f64);
        (watch.stop)()
    }
}
