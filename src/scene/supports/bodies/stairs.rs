//! Stairs.

use super::entry::{BodyEntry, frame, name};
use super::framed::{FramedMesh, moved};
use crate::geom::polygon_area;
use crate::mesh::TriMesh;
use crate::scene::defaults;
use crate::scene::language::raw::RawStairs;
use crate::scene::supports::shapes;
use crate::scene::text::{Field, Reader};
use glam::{DVec2, DVec3};

/// Facets of one plane, but for rounding, radians.
const FLAT: f64 = 1e-6;

/// A flight of stairs; every riser and tread is a part of its own.
pub(crate) fn stairs<'r>(
    reader: &mut Reader,
    raw: &'r RawStairs,
    entry: &BodyEntry,
) -> Option<FramedMesh<'r>> {
    let name = name(reader, &raw.name, "stairs");
    reader.need(&raw.steps, "steps", "this staircase", entry.span);
    let steps = reader.count(&raw.steps, "steps", 1..=200);
    let [width] = entry.sizes(reader, [(&raw.width, "width")])?;
    let [rise, going] = defaults::STEP;
    let rise = reader.positive_or(&raw.rise, "rise", rise)?;
    let going = reader.positive_or(&raw.going, "going", going)?;
    Some(FramedMesh {
        crease: Some(FLAT),
        ..FramedMesh::plain(
            name?,
            flight(steps?.0, width, rise, going),
            frame(reader, &raw.at, &raw.facing, &Field::Missing)?,
            &raw.depth,
        )
    })
}

/// Steps that go up away from the viewer, solid down to the ground; the lowest riser is the face.
fn flight(steps: u32, width: f64, rise: f64, going: f64) -> TriMesh {
    // (z, y): the outline seen from the side.
    let mut outline = vec![DVec2::ZERO];
    for k in 0..steps {
        let (back, low) = (-going * f64::from(k), rise * f64::from(k));
        outline.push(DVec2::new(back, low + rise));
        outline.push(DVec2::new(back - going, low + rise));
    }
    outline.push(DVec2::new(-going * f64::from(steps), 0.0));
    if polygon_area(&outline) < 0.0 {
        outline.reverse();
    }
    let half = width / 2.0;
    let turned = shapes::prism(&outline, -half, half);
    moved(&turned, |p| DVec3::new(-p.z, p.y, p.x))
}
