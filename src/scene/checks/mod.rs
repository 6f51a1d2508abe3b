//! Rules that join several values: pillars that overlap, eyes in the wrong place, forests that cannot be made.
//!
//! Takes what stands and is seen, as [`Checked`] and eyes; gives problems to the reader of the scene's text. What one value alone can
//! have wrong is told where it is read.

mod base;
mod checked;
mod eyes;
mod pillars;

pub(crate) use checked::Checked;

use crate::scene::resolved::Making;
use crate::scene::text::Reader;
use crate::scene::views::Eye;

/// All of them.
pub(crate) fn all(reader: &mut Reader, checked: &Checked, eyes: &[Eye], making: &Making) {
    pillars::slimness(reader, checked.pillars, making);
    if !checked.mend {
        pillars::gaps(reader, checked.pillars, making);
        if let Some(base) = checked.base {
            base::standing(reader, checked.pillars, base);
        }
    }
    if let Some(room) = checked.room {
        pillars::slimness(reader, &room.samples, making);
        let problem = checked.base.and_then(|base| base::region(room, base));
        reader.problems.extend(problem);
    }
    base::size(reader, checked, making);
    eyes::pairs(reader, eyes);
    eyes::places(reader, checked, eyes);
}
