//! How a caller follows a run and ends a search.

/// Called as work goes on with the stage's name and the share of the whole run done, 0 to 1. May come from any thread.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

/// Asked now and then by a search for pillars whether it is to end with what it has. May come from any thread.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);
