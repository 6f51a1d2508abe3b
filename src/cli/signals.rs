//! Signals that end a run, put off while files are written.
//!
//! Only then do they matter: before and after, nothing half done lies on a disk, and their usual effect is the right one.

#[cfg(unix)]
mod system {
    use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::{flag, low_level};
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    use std::sync::{Arc, OnceLock};

    struct Waiting {
        /// Whether signals have their usual effect.
        usual: Arc<AtomicBool>,
        /// The last one that came, or 0.
        came: Arc<AtomicUsize>,
    }

    static WATCH: OnceLock<Waiting> = OnceLock::new();

    fn waiting() -> Waiting {
        let watch = Waiting {
            usual: Arc::new(AtomicBool::new(true)),
            came: Arc::default(),
        };
        for signal in [SIGINT, SIGTERM] {
            // Where one cannot be watched it keeps its usual effect.
            let _ = flag::register_conditional_default(signal, watch.usual.clone());
            let _ =
                flag::register_usize(signal, watch.came.clone(), signal.unsigned_abs() as usize);
        }
        // A file beyond the user's limit: writing it then fails with words instead.
        let _ = flag::register(SIGXFSZ, Arc::default());
        watch
    }

    pub(super) fn hold() {
        let watch = WATCH.get_or_init(waiting);
        watch.usual.store(false, Ordering::SeqCst);
    }

    pub(super) fn came() -> bool {
        let came = |w: &Waiting| w.came.load(Ordering::SeqCst) != 0;
        WATCH.get().is_some_and(came)
    }

    pub(super) fn release() {
        let Some(watch) = WATCH.get() else { return };
        watch.usual.store(true, Ordering::SeqCst);
        let signal = watch.came.load(Ordering::SeqCst);
        if let Some(signal) = i32::try_from(signal).ok().filter(|s| *s != 0) {
            let _ = low_level::emulate_default_handler(signal);
        }
    }
}

/// Other systems end a run as they do; what it leaves behind is for the next one to tidy.
#[cfg(not(unix))]
mod system {
    pub(super) fn hold() {}
    pub(super) fn came() -> bool {
        false
    }
    pub(super) fn release() {}
}

/// While it lives, signals wait; one that came has its effect when it goes.
pub(super) struct Held(());

impl Held {
    pub(super) fn new() -> Self {
        system::hold();
        Self(())
    }

    /// Whether a signal waits.
    pub(super) fn came(&self) -> bool {
        let Self(()) = self;
        system::came()
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        system::release();
    }
}
