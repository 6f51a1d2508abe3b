//! Whether the forest can be printed: walls, gaps, overhangs, slenderness, bed, loose parts, core.
//!
//! Takes the finished solid, its supports and what can be made; gives one [`PrintCheck`] for each question that is asked, with the worst
//! place, what was measured there and what was wanted. Nothing is changed. The same solid gives the same figures on any number of
//! threads.
//!
//! # Wanted, and the limit
//!
//! `wanted_mm` is what prints without any loss, `limit_mm` where printing fails; `ok` tells on which side of the *limit* the value
//! lies, and the note what is lost in between. They differ where reliefs cannot help it: a surface that is cut along an eye's rays
//! and scaled back ends in lips as thin as one likes, and its pieces stand out from the pillar without anything below them. Slicers
//! blunt the first by a fraction of a millimetre and put supports under the second; neither makes a print fail.
//!
//! - `wall`: 2.25 nozzles wanted, the width of two printed lines that overlap; from 1.6 nozzles down slicers print nothing at all. A
//!   lip is no wall, and what is too small to be missed does not count (see `walls`); the note tells how much will be missing.
//! - `gap` between pillars: 0.5 nozzles wanted, below 0.25 nozzles two pillars fuse. Reliefs that meet on purpose, spots,
//!   and slots within one pillar do not count.
//! - `overhang`: how far reliefs stand out over nothing. 3 nozzles are printed freely, more needs a slicer's supports; the limit is
//!   given, and by default what a single tower of them holds.
//! - `slenderness`: the least width against a given share of the height.
//! - `bed`: the size against the printer's.
//! - `part`, `cavity`: extent of the largest piece that would come off, of the largest hollow without a way out; none wanted.
//! - `core`: the widest circle in the thinnest horizontal section of a pillar as carved by all views, against its layer's `core`.

mod bed;
mod check;
mod loose;
mod neck;
mod overhang;
mod slenderness;
mod walls;

pub use check::{
    Apart, GAP_NOZZLES, LostWalls, Margin, PrintCheck, PrintFinding, PrintLimits, Printed,
    WALL_NOZZLES,
};
pub use overhang::STEEP_DEG;
pub(crate) use walls::MISSED_MM2;

use rayon::join;

/// All checks that are asked, in the order of the module's list.
pub fn printability(printed: &Printed, limits: &PrintLimits) -> Vec<PrintCheck> {
    let mesh = printed.whole.mesh();
    let ((wall_and_gap, overhang), core) = join(
        || {
            join(
                || walls::walls(mesh, printed.bvh, printed.supports, limits),
                || limits.overhang.map(|most| overhang::overhang(mesh, most)),
            )
        },
        || neck::core(printed),
    );
    let mut checks = wall_and_gap;
    checks.extend(overhang);
    let slimmest = limits.slimmest;
    checks.extend(slimmest.and_then(|most| slenderness::slenderness(printed.supports, most)));
    checks.extend(limits.bed.map(|room| bed::bed(printed, room)));
    checks.extend(loose::loose(printed.whole, limits.apart));
    checks.extend(core);
    checks
}
