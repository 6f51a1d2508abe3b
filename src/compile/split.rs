//! The files of a forest in pieces.

use super::files::BARE_COLOUR;
use super::output::OutputFile;
use super::progress::Progress;
use crate::carve::Forest;
use crate::diag::Diagnostic;
use crate::diagram::layout;
use crate::formats::{Metadata, Part, write_3mf, write_stl};
use crate::ladder::Ladder;
use crate::mesh::{Solid, resolved};
use crate::scene::Scene;
use crate::split::{Piece, Split, SplitOptions, split};
use crate::words::split as words;
use glam::{DMat4, DVec3};
use rayon::prelude::*;

/// Room between pieces in the 3MF, millimetres.
const SPACING_MM: f64 = 6.0;
/// Their places are multiples of this, millimetres: up to 256 mm from the origin that moves them exactly.
const GRAIN_MM: f64 = 1.0 / 64.0;

/// A forest in pieces; empty if it is to stay in one.
#[derive(Default)]
pub(crate) struct Divided {
    /// Names and sizes of the pieces.
    pub bodies: Vec<(String, DVec3)>,
    pub files: Vec<OutputFile>,
    pub warnings: Vec<Diagnostic>,
    pub ladders: Vec<Ladder>,
}

/// Divides the forest for the scene's printer, if it is wanted.
///
/// # Errors
/// If it cannot be divided, with what to change.
pub(crate) fn divided(
    scene: &Scene,
    forest: &Forest,
    progress: Progress,
) -> Result<Divided, Vec<Diagnostic>> {
    if !scene.output.split {
        return Ok(Divided::default());
    }
    progress("pieces", 0.75);
    let options = SplitOptions {
        nozzle: scene.printer.nozzle,
        bed: scene.printer.bed,
        clearance: scene.printer.clearance,
    };
    let split = split(&scene.supports, &forest.standing, &options)
        .map_err(|error| vec![words::refusal(&error)])?;
    let mut divided = Divided {
        bodies: bodies(&split),
        files: piece_files(scene, &split),
        warnings: words::remarks(&split),
        ladders: split.ladders(),
    };
    match spread(&split) {
        Ok(placed) => {
            let bytes = three_mf(scene, &split, &placed);
            divided.files.push(OutputFile::new("split.3mf", bytes));
        }
        Err(name) => divided.warnings.push(words::left_out(&name)),
    }
    Ok(divided)
}

fn bodies(split: &Split) -> Vec<(String, DVec3)> {
    let size = |s: &Solid| s.bounds().1 - s.bounds().0;
    let pieces = split.pieces.iter();
    pieces.map(|p| (p.name.clone(), size(&p.solid))).collect()
}

/// `layout.svg`, and an STL for each piece in `split/`.
fn piece_files(scene: &Scene, split: &Split) -> Vec<OutputFile> {
    let page = layout(&scene.title, &scene.views, &scene.supports, split);
    let mut files = vec![OutputFile::new("layout.svg", page.svg().into_bytes())];
    files.extend(split.pieces.iter().map(|piece| {
        let title = format!("{}, {}", scene.title, piece.says);
        OutputFile::new(
            format!("split/{}.stl", piece.name),
            write_stl(&piece.solid, &title),
        )
    }));
    files
}

fn three_mf(scene: &Scene, split: &Split, placed: &[Solid]) -> Vec<u8> {
    let parts: Vec<Part> = split
        .pieces
        .iter()
        .zip(placed)
        .map(|(piece, solid)| Part {
            name: piece.says.clone(),
            colour: BARE_COLOUR,
            solid,
        })
        .collect();
    let meta = Metadata {
        title: scene.title.clone(),
        description: "A pillar forest in pieces: pillars go into the sockets of their number"
            .into(),
        application: format!("pillarforest {}", env!("CARGO_PKG_VERSION")),
        ..Metadata::default()
    };
    write_3mf(&parts, &meta, None)
}

/// The pieces side by side in rows, about the origin; or the name of one that does not become a solid there.
fn spread(split: &Split) -> Result<Vec<Solid>, String> {
    let places = places(split);
    let pieces = split.pieces.par_iter().zip(&places);
    let placed = pieces.map(|(piece, at)| placed(piece, *at).ok_or(&piece.name));
    // The first failure by number, whatever thread finds it.
    let placed: Vec<Result<Solid, &String>> = placed.collect();
    let placed: Result<Vec<Solid>, &String> = placed.into_iter().collect();
    placed.map_err(String::clone)
}

/// The piece moved there. Beyond 256 mm coordinates are coarser than it was made for.
fn placed(piece: &Piece, at: DVec3) -> Option<Solid> {
    let mesh = piece.solid.mesh();
    let mesh = mesh.transformed(DMat4::from_translation(at));
    let exact = Solid::new(mesh.clone()).ok();
    exact.or_else(|| Solid::of_resolved(resolved(&mesh).ok()?).ok())
}

fn places(split: &Split) -> Vec<DVec3> {
    let boxes: Vec<(DVec3, DVec3)> = split.pieces.iter().map(|p| p.solid.bounds()).collect();
    let size = |k: usize| (boxes[k].1 - boxes[k].0).truncate() + SPACING_MM;
    let area: f64 = (0..boxes.len()).map(|k| size(k).element_product()).sum();
    let widest = (0..boxes.len()).map(|k| size(k).x).fold(0.0, f64::max);
    // A little wider than square: rows leave gaps.
    let width = (1.2 * area.sqrt()).max(widest);
    let (mut x, mut y, mut row) = (0.0, 0.0, 0.0f64);
    let mut places = Vec::new();
    for (k, (lo, _)) in boxes.iter().enumerate() {
        let size = size(k);
        if x > 0.0 && x + size.x > width {
            (x, y, row) = (0.0, y + row, 0.0);
        }
        let at = DVec3::new(x - width / 2.0 - lo.x, y - width / 2.0 - lo.y, 0.0);
        places.push((at / GRAIN_MM).round() * GRAIN_MM);
        x += size.x;
        row = row.max(size.y);
    }
    places
}
