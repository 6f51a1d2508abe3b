//! The checks of how a forest is made.

use super::built::Built;
use crate::certify::printability::{PrintCheck, Printed, printability};
use glam::DVec3;

/// Measures a forest against what its scene says of its making; `bodies` go on the bed one by one.
pub(crate) fn print_checks(built: &Built, bodies: &[(String, DVec3)]) -> Vec<PrintCheck> {
    let (scene, forest) = (built.scene, &built.forest);
    let printed = Printed {
        supports: &scene.supports,
        whole: &forest.whole,
        bvh: &built.bvh,
        standing: &forest.standing,
        bodies,
    };
    printability(&printed, &scene.making.limits)
}
