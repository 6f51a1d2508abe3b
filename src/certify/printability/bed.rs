//! Whether it fits the printer's bed.

use super::check::{PrintCheck, PrintFinding, Printed};
use crate::certify::point::without_minus_zero;
use glam::DVec3;

/// The body that fits the bed worst: its size along the tightest direction.
pub(crate) fn bed(printed: &Printed, room: [f64; 3]) -> PrintCheck {
    let (lo, hi) = printed.whole.bounds();
    let forest = [(String::new(), hi - lo)];
    let bodies = if printed.bodies.is_empty() {
        &forest[..]
    } else {
        printed.bodies
    };
    let sides = |(name, size): &(String, DVec3)| {
        // Turned as it fits better: longer side to longer side.
        let (long, short) = (size.x.max(size.y), size.x.min(size.y));
        let [x, y, z] = room;
        [(long, x.max(y)), (short, x.min(y)), (size.z, z)]
            .into_iter()
            .map(|(value, room)| (name.clone(), value, room))
            .collect::<Vec<_>>()
    };
    let worst = bodies
        .iter()
        .flat_map(sides)
        .max_by(|a, b| (a.1 - a.2).total_cmp(&(b.1 - b.2)));
    let (name, value, room) = worst.unwrap_or_default();
    PrintCheck {
        finding: PrintFinding::Bed {
            body: (!printed.bodies.is_empty()).then_some(name),
        },
        place: without_minus_zero((lo + hi) / 2.0),
        value_mm: value,
        wanted_mm: room,
        limit_mm: room,
        ok: value <= room,
    }
}
