//! The files of a forest in pieces.

use super::OutputFile;
use super::files::{BARE_COLOUR, file};
use crate::carve::Forest;
use crate::diag::Diagnostic;
use crate::diagram::layout;
use crate::formats::{Metadata, Part, write_3mf, write_stl};
use crate::mesh::{Solid, mend};
use crate::scene::Scene;
use crate::split::{Piece, Split, SplitError, SplitOptions, split};
use glam::{DMat4, DVec3};
use rayon::prelude::*;

/// Room between pieces in the 3MF, millimetres.
const SPACING_MM: f64 = 6.0;
/// Their places are multiples of this, millimetres: up to 256 mm from the origin that moves them exactly.
const GRAIN_MM: f64 = 1.0 / 64.0;

/// Divides the forest for the scene's printer.
///
/// # Errors
/// If it cannot be divided, with what to change.
pub fn pieces(scene: &Scene, forest: &Forest) -> Result<Split, Diagnostic> {
    let options = SplitOptions {
        nozzle: scene.printer.nozzle,
        bed: scene.printer.bed,
        clearance: scene.printer.clearance,
    };
    split(&scene.supports, &forest.standing, &options).map_err(|e| {
        let help = match e {
            SplitError::ThinBase(_) => "a thicker base: `base: Disc(thickness: 5)`",
            SplitError::SmallBed => "the size of your printer: `printer: (bed: (256, 256, 256))`",
            SplitError::Body(_) => "without `--split`: slicers cut other bodies",
            SplitError::Carve(_) => "without `--split` the forest comes in one piece",
        };
        Diagnostic::error(format!("the forest cannot be split: {e}")).help(help)
    })
}

/// Names and sizes of the pieces.
pub fn bodies(split: &Split) -> Vec<(String, DVec3)> {
    let size = |s: &Solid| s.bounds().1 - s.bounds().0;
    let pieces = split.pieces.iter();
    pieces.map(|p| (p.name.clone(), size(&p.solid))).collect()
}

/// What is worth telling of the pieces.
pub fn remarks(split: &Split) -> Vec<Diagnostic> {
    let mut remarks = Vec::new();
    let pieces = || split.pieces.iter();
    if pieces().all(|p| !p.is_plate) {
        let text = "the forest has no base: `--split` makes pillars without pegs, and no plates";
        remarks.push(Diagnostic::warning(text).help("layout.svg shows where they belong"));
    }
    let loose: Vec<&str> = pieces()
        .filter(|p| p.solid.parts() > 1)
        .map(|p| p.name.as_str())
        .collect();
    if !loose.is_empty() {
        remarks.push(Diagnostic::warning(format!(
            "of several loose parts: {}",
            loose.join(", ")
        )));
    }
    let mute: Vec<&str> = pieces()
        .filter(|p| !p.engraved)
        .map(|p| p.name.as_str())
        .collect();
    if !mute.is_empty() {
        remarks.push(
            Diagnostic::warning(format!(
                "no room to engrave the number of: {}",
                mute.join(", ")
            ))
            .help("their files are numbered all the same, and layout.svg shows every number"),
        );
    }
    remarks
}

/// `layout.svg`, an STL for each piece in `split/`, and `split.3mf` with every piece as an object; the last is left out, with a
/// warning, if rounding upsets a piece where it would stand.
pub fn split_files(scene: &Scene, split: &Split) -> (Vec<OutputFile>, Option<Diagnostic>) {
    let page = layout(&scene.title, &scene.views, &scene.supports, split);
    let mut files = vec![file("layout.svg", page.svg().into_bytes())];
    files.extend(split.pieces.iter().map(|piece| {
        let title = format!("{}, {}", scene.title, piece.says);
        file(
            format!("split/{}.stl", piece.name),
            write_stl(&piece.solid, &title),
        )
    }));
    match spread(split) {
        Ok(placed) => {
            files.push(file("split.3mf", three_mf(scene, split, &placed)));
            (files, None)
        }
        Err(name) => {
            let text = format!("split.3mf is left out: {name} is not sound beside the others");
            (
                files,
                Some(Diagnostic::warning(text).help("the files in split/ are complete")),
            )
        }
    }
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

/// The pieces side by side in rows, about the origin; or the name of one that is not sound there. A piece with a film so thin that
/// it is sound near the origin only, where f32 is finest, is put there.
fn spread(split: &Split) -> Result<Vec<Solid>, String> {
    let places = places(split);
    let name = |k: usize| split.pieces[k].name.clone();
    let put = |shift: DVec3| -> Result<Vec<Solid>, usize> {
        let pieces = split.pieces.par_iter().zip(&places).enumerate();
        let placed = pieces.map(|(k, (piece, at))| placed(piece, *at - shift).ok_or(k));
        // The first failure by number, whatever thread finds it.
        placed.collect::<Vec<_>>().into_iter().collect()
    };
    put(DVec3::ZERO).or_else(|k| put(places[k]).map_err(name))
}

fn placed(piece: &Piece, at: DVec3) -> Option<Solid> {
    let mesh = piece.solid.mesh();
    let mesh = mesh.transformed(DMat4::from_translation(at));
    let mended = || Solid::new(mend(&mesh).mesh);
    Solid::new(mesh.clone()).or_else(|_| mended()).ok()
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
