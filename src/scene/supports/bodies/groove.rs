//! Blocks with a groove.

use super::entry::{BodyEntry, frame, name};
use super::framed::{FramedMesh, upright};
use crate::mesh::TriMesh;
use crate::scene::defaults;
use crate::scene::language::raw::RawGroove;
use crate::scene::text::{Reader, error_at, short};
use glam::DVec2;

/// A block with a groove as the scene says it.
pub(crate) fn groove<'r>(
    reader: &mut Reader,
    raw: &'r RawGroove,
    entry: &BodyEntry,
) -> Option<FramedMesh<'r>> {
    let name = name(reader, &raw.name, "groove");
    let sizes = [
        (&raw.width, "width"),
        (&raw.height, "height"),
        (&raw.opening, "opening"),
        (&raw.deep, "deep"),
    ];
    let [width, height, opening, deep] = entry.sizes(reader, sizes)?;
    let usual = deep + defaults::BODY_THICKNESS;
    let thickness = reader.positive_or(&raw.thickness, "thickness", usual)?;
    if opening > width || deep >= thickness {
        let text = format!(
            "the groove, {} mm wide and {} mm deep, is not inside its block of {} x {} mm",
            short(opening),
            short(deep),
            short(width),
            short(thickness)
        );
        reader.problems.push(
            error_at(entry.span, text).help("keep `opening` <= `width` and `deep` < `thickness`"),
        );
        return None;
    }
    Some(FramedMesh::plain(
        name?,
        block(width, height, thickness, opening, deep),
        frame(reader, &raw.at, &raw.facing, &raw.lean)?,
        &raw.depth,
    ))
}

/// A block with a groove of V section, `opening` wide at the face and `deep` in the middle, from bottom to top.
fn block(width: f64, height: f64, thickness: f64, opening: f64, deep: f64) -> TriMesh {
    let (half, edge) = (width / 2.0, opening / 2.0);
    let outline = [
        (-half, -thickness),
        (half, -thickness),
        (half, 0.0),
        (edge, 0.0),
        (0.0, -deep),
        (-edge, 0.0),
        (-half, 0.0),
    ];
    upright(&outline.map(DVec2::from), height)
}
