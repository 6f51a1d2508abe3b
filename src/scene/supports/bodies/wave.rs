//! Blocks whose face is a height field.

use super::entry::{BodyEntry, frame, name};
use super::framed::FramedMesh;
use super::heights;
use super::image;
use crate::index::VertexId;
use crate::mesh::TriMesh;
use crate::scene::defaults;
use crate::scene::language::raw::{RawHeights, RawWave};
use crate::scene::text::{Reader, Span, error_at, short};
use glam::DVec3;

/// A wave as the scene says it.
pub(crate) fn wave<'r>(
    reader: &mut Reader,
    raw: &'r RawWave,
    entry: &BodyEntry,
) -> Option<FramedMesh<'r>> {
    let name = name(reader, &raw.name, "wave");
    let [width, height] = entry.sizes(reader, [(&raw.width, "width"), (&raw.height, "height")])?;
    let usual = 2.0 * defaults::BODY_THICKNESS;
    let thickness = reader.positive_or(&raw.thickness, "thickness", usual)?;
    let pitch = reader.positive_or(&raw.pitch, "pitch", defaults::WAVE_PITCH)?;
    affordable(reader, [width, height].map(|side| side / pitch), entry)?;
    let (raw_heights, at) = reader.required(&raw.heights, "heights", "this Wave", entry.span)?;
    let heights = match raw_heights {
        RawHeights::Formula(text) => heights::formula(reader, text, &at),
        RawHeights::Image(image) => image::image(reader, image, &at, [width, height], entry.read),
    }?;
    let mesh = block(width, height, thickness, pitch, heights);
    above_back(reader, &mesh, thickness, &at)?;
    Some(FramedMesh::plain(
        name?,
        mesh,
        frame(reader, &raw.at, &raw.facing, &raw.lean)?,
        &raw.depth,
    ))
}

/// An error if a grid of so many cells has too many points.
fn affordable(reader: &mut Reader, [columns, rows]: [f64; 2], entry: &BodyEntry) -> Option<()> {
    if (columns + 1.0) * (rows + 1.0) <= defaults::MOST_WAVE_POINTS {
        return Some(());
    }
    let text = format!(
        "a grid of {} x {} points is too fine",
        columns.ceil(),
        rows.ceil()
    );
    let problem = error_at(entry.span, text).help("a larger `pitch`");
    reader.problems.push(problem);
    None
}

/// An error, where the heights stand, if the face goes through the back or is not finite.
fn above_back(reader: &mut Reader, mesh: &TriMesh, thickness: f64, heights: &Span) -> Option<()> {
    let face = mesh.vertices[..mesh.vertices.len() / 2].iter();
    let lowest = face.fold(f64::INFINITY, |low, v| match v.z.is_finite() {
        true => low.min(v.z),
        false => f64::NEG_INFINITY,
    });
    if lowest > -thickness {
        return Some(());
    }
    let text = match lowest.is_finite() {
        true => format!(
            "heights go down to {} mm, but the body behind is {} mm thick",
            short(lowest),
            short(thickness)
        ),
        false => "heights are not finite numbers everywhere".to_string(),
    };
    let problem = error_at(heights, text).help("a larger `thickness`, or other heights");
    reader.problems.push(problem);
    None
}

/// A block whose face is the height field `heights(x, y)`, sampled at most `pitch` apart, and whose back is flat, `thickness` behind
/// z = 0. Heights below the back are the caller's to refuse.
fn block(
    width: f64,
    height: f64,
    thickness: f64,
    pitch: f64,
    heights: impl Fn(f64, f64) -> f64,
) -> TriMesh {
    let columns = (width / pitch).ceil().max(1.0) as u32;
    let rows = (height / pitch).ceil().max(1.0) as u32;
    let mut mesh = TriMesh::default();
    for back in [false, true] {
        for j in 0..=rows {
            for i in 0..=columns {
                let x = width * (f64::from(i) / f64::from(columns) - 0.5);
                let y = height * f64::from(j) / f64::from(rows);
                let z = if back { -thickness } else { heights(x, y) };
                mesh.vertices.push(DVec3::new(x, y, z));
            }
        }
    }
    let front = mesh.vertices.len() / 2;
    let behind = |v: VertexId| v.plus(front);
    let at = |i: u32, j: u32| VertexId(j * (columns + 1) + i);
    let mut quad = |[a, b, c, d]: [VertexId; 4]| mesh.faces.extend([[a, b, c], [a, c, d]]);
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            quad([a, b, c, d]);
            quad([d, c, b, a].map(behind));
        }
    }
    let mut border: Vec<VertexId> = (0..columns).map(|i| at(i, 0)).collect();
    border.extend((0..rows).map(|j| at(columns, j)));
    border.extend((0..columns).map(|i| at(columns - i, rows)));
    border.extend((0..rows).map(|j| at(0, rows - j)));
    for (k, a) in border.iter().copied().enumerate() {
        let b = border[(k + 1) % border.len()];
        quad([b, a, behind(a), behind(b)]);
    }
    mesh
}
