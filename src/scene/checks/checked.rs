//! What of a forest is checked.

use crate::scene::layout::Room;
use crate::scene::supports::{BasePlate, Standing};

/// What of a forest is checked.
pub(crate) struct Checked<'a> {
    pub pillars: &'a [Standing],
    pub base: Option<&'a BasePlate>,
    /// Where more pillars are to be found.
    pub room: Option<&'a Room>,
    /// Pillars that are to be mended may still overlap and stand anywhere.
    pub mend: bool,
}
