//! What of every model reaches its viewer, and why the rest does not.
