//! The print checks of a scene.

use super::built::Built;
use crate::certify::printability::{PrintCheck, PrintLimits, Printed, printability};
use crate::scene::defaults;
use glam::DVec3;

/// Measures a forest against its scene's printer; `bodies` go on the bed one by one.
pub(crate) fn print_checks(built: &Built, bodies: &[(String, DVec3)]) -> Vec<PrintCheck> {
    let (scene, forest) = (built.scene, &built.forest);
    let limits = PrintLimits {
        nozzle: scene.printer.nozzle,
        bed: scene.printer.bed,
        wall_nozzles: defaults::THIN_WALL_NOZZLES,
        gap_nozzles: defaults::NARROW_GAP_NOZZLES,
        slimmest: defaults::SLIMMEST,
    };
    let printed = Printed {
        supports: &scene.supports,
        whole: &forest.whole,
        bvh: &built.bvh,
        standing: &forest.standing,
        bodies,
    };
    printability(&printed, &limits)
}
