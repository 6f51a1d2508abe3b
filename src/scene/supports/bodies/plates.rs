//! Plates, alone and as strips side by side: boxes with one flat face.

use super::entry::{BodyEntry, frame, name};
use super::framed::{FramedMesh, upright};
use crate::diag::Diagnostic;
use crate::mesh::TriMesh;
use crate::scene::defaults;
use crate::scene::language::raw::{RawPlate, RawStrips};
use crate::scene::text::{Field, Reader, error_at, short};
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::TAU;

/// A plate as the scene says it.
pub(crate) fn plate<'r>(
    reader: &mut Reader,
    raw: &'r RawPlate,
    entry: &BodyEntry,
) -> Option<FramedMesh<'r>> {
    let name = name(reader, &raw.name, "plate");
    let [width, height] = entry.sizes(reader, [(&raw.width, "width"), (&raw.height, "height")])?;
    let thickness = reader.positive_or(&raw.thickness, "thickness", defaults::BODY_THICKNESS)?;
    Some(FramedMesh {
        flat: true,
        ..FramedMesh::plain(
            name?,
            board(width, height, thickness),
            frame(reader, &raw.at, &raw.facing, &raw.lean)?,
            &raw.depth,
        )
    })
}

/// Plates side by side, from left to right as they are looked at, each turned against its neighbour about their common edge.
pub(crate) fn strips<'r>(
    reader: &mut Reader,
    raw: &'r RawStrips,
    entry: &BodyEntry,
) -> Option<Vec<FramedMesh<'r>>> {
    let name = name(reader, &raw.name, "strip")?;
    reader.need(&raw.count, "count", "this row of strips", entry.span);
    let (count, _) = reader.count(&raw.count, "count", 1..=100)?;
    let [width, height] = entry.sizes(reader, [(&raw.width, "width"), (&raw.height, "height")])?;
    let thickness = reader.positive_or(&raw.thickness, "thickness", defaults::BODY_THICKNESS)?;
    let gap = match &raw.gap {
        Field::Missing => defaults::STRIP_GAP,
        field => reader.length_from(field, "gap", 0.0)?.0,
    };
    let turn = reader.turn(&raw.turn);
    if let Some(problem) = coils(reader, raw, count, turn) {
        reader.problems.push(problem);
        return None;
    }
    let row = frame(reader, &raw.at, &raw.facing, &Field::Missing)?;
    // The middle of the row stays at `at`, and the middle strip looks along `facing`.
    let angle = |k: u32| turn * (f64::from(k) - f64::from(count - 1) / 2.0);
    let way = |k: u32| DVec2::from_angle(-angle(k));
    let step = |k: u32| (width + gap) * (way(k) + way(k + 1)) / 2.0;
    let mut middles = vec![DVec2::ZERO];
    (1..count).for_each(|k| middles.push(middles[k as usize - 1] + step(k - 1)));
    let n = count as usize;
    let middle = (middles[(n - 1) / 2] + middles[n / 2]) / 2.0;
    let strip = |(k, at): (u32, &DVec2)| {
        let at = *at - middle;
        // In the frame x is to the right and z towards the viewer.
        let turned = DMat4::from_rotation_y(angle(k));
        let moved = DMat4::from_translation(DVec3::new(at.x, 0.0, at.y));
        FramedMesh {
            flat: true,
            ..FramedMesh::plain(
                name.clone(),
                board(width, height, thickness),
                row * moved * turned,
                &raw.depth,
            )
        }
    };
    Some((0..count).zip(&middles).map(strip).collect())
}

/// Strips of one width that turn by one angle lie on a circle: a row that goes round more than once lies on itself, and which of two
/// faces in one place carries a relief is left to rounding.
fn coils(reader: &mut Reader, raw: &RawStrips, count: u32, turn: f64) -> Option<Diagnostic> {
    let (_, span) = reader.given(&raw.turn)?;
    let turn = turn.rem_euclid(TAU);
    let turn = turn.min(TAU - turn);
    if f64::from(count) * turn <= TAU * (1.0 + 1e-9) {
        return None;
    }
    let round = (TAU / turn * (1.0 + 1e-9)).floor() as u32;
    let text = format!(
        "{count} strips, each turned by {} degrees against the one before, go round more than once: strip {} lies on strip 1",
        short(turn.to_degrees()),
        round + 1
    );
    let closed = short((360.0 / f64::from(count) * 1e3).floor() / 1e3);
    Some(error_at(&span, text).help(format!(
        "`count: {round}` is once around, or `turn: {closed}` for {count} of them"
    )))
}

/// A box behind its face.
fn board(width: f64, height: f64, thickness: f64) -> TriMesh {
    let half = width / 2.0;
    let outline = [
        (-half, -thickness),
        (half, -thickness),
        (half, 0.0),
        (-half, 0.0),
    ];
    upright(&outline.map(DVec2::from), height)
}
