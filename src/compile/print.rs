//! The print checks of a scene.

use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::certify::printability::{PrintCheck, PrintLimits, Subject, printability};
use crate::scene::{Scene, defaults};
use glam::DVec3;

/// Measures the forest against the scene's printer; `bodies` go on the bed one by one.
pub fn print_checks(scene: &Scene, forest: &Forest, bodies: &[(String, DVec3)]) -> Vec<PrintCheck> {
    let limits = PrintLimits {
        nozzle: scene.printer.nozzle,
        bed: scene.printer.bed,
        wall_nozzles: defaults::THIN_WALL_NOZZLES,
        gap_nozzles: defaults::NARROW_GAP_NOZZLES,
        slimmest: defaults::SLIMMEST,
    };
    let subject = Subject {
        supports: &scene.supports,
        whole: &forest.whole,
        bvh: &Bvh::new(forest.whole.mesh()),
        standing: &forest.standing,
        bodies,
    };
    printability(&subject, &limits)
}
