//! The base as plates, with sockets and numbers.

use super::cuts::{Baseplate, grid};
use super::digits::Lettering;
use super::foot::Foot;
use super::label::label;
use super::pieces::{ENGRAVED_MM, MET_MM3, Piece, Split, SplitError, SplitOptions};
use super::stand::{grained, standing_on_zero};
use crate::carve::boolean::{Boolean, BooleanError};
use crate::support::Support;
use glam::DVec2;
use rayon::prelude::*;

/// More plates than this are refused: the bed is meant for something else.
const MOST_PLATES: usize = 256;

/// The base of a forest; lengths in millimetres.
pub(crate) struct Base<'a> {
    pub outline: &'a [DVec2],
    pub thickness: f64,
    /// Depth of its sockets.
    pub depth: f64,
}

/// A plate with the numbers of its sockets.
type Numbered = (Boolean, Vec<usize>);

/// Cuts the base, and adds its plates, cuts, pins and labels to `split`, whose sockets are known.
///
/// # Errors
/// A bed too small for any plate, or a plate that does not come out sound.
pub(crate) fn plates(
    supports: &[Support],
    base: &Base,
    options: &SplitOptions,
    split: &mut Split,
) -> Result<(), SplitError> {
    let foot = |s: usize| Foot::new(&supports[s], DVec2::ZERO, base.depth);
    let feet: Vec<Foot> = (split.sockets.iter())
        .filter_map(|s| foot(s.support))
        .collect();
    let holes: Vec<Vec<DVec2>> = feet.iter().map(|f| hole(f, options.clearance)).collect();
    let baseplate = Baseplate {
        outline: base.outline,
        thickness: base.thickness,
        sockets: &holes,
        clearance: options.clearance,
    };
    split.cuts = baseplate.cuts(options.bed).ok_or(SplitError::SmallBed)?;
    let cells = grid(&split.cuts);
    if cells.len() > MOST_PLATES {
        return Err(SplitError::SmallBed);
    }
    split.pins = baseplate.pins(&split.cuts);
    label(base.outline, &holes, options, split);
    let made: Vec<Option<Numbered>> = cells
        .par_iter()
        .map(|cell| plate(&baseplate, &feet, split, *cell))
        .collect::<Result<_, BooleanError>>()?;
    let made: Vec<Numbered> = made.into_iter().flatten().collect();
    let pieces: Vec<Piece> = (0..made.len())
        .into_par_iter()
        .map(|k| piece(&made, k, base.thickness, split))
        .collect::<Result<_, SplitError>>()?;
    split.pieces.extend(pieces);
    Ok(())
}

/// The outline of a foot's socket.
fn hole(foot: &Foot, clearance: f64) -> Vec<DVec2> {
    let rings = foot.outline(clearance);
    let first = rings.first().map(|r| r.iter().map(|p| DVec2::from(*p)));
    first.map_or_else(|| foot.profile.clone(), Iterator::collect)
}

/// The plate in one cell of the grid, if the base reaches there, with sockets and engraved numbers.
fn plate(
    baseplate: &Baseplate,
    feet: &[Foot],
    split: &Split,
    cell: (usize, usize),
) -> Result<Option<Numbered>, BooleanError> {
    let Some(mut plate) = baseplate.plate(&split.cuts, &split.pins, cell)? else {
        return Ok(None);
    };
    let (mut numbers, full) = (Vec::new(), plate.volume());
    for (foot, socket) in feet.iter().zip(&split.sockets) {
        let cut = plate.minus(&foot.socket(baseplate.clearance)?)?;
        if cut.volume() < full - MET_MM3 && cut.volume() < plate.volume() - MET_MM3 {
            plate = cut;
            numbers.push(socket.number);
        }
    }
    for socket in &split.sockets {
        let Some(label) = socket.label else {
            continue;
        };
        let rings = Lettering::new(socket.number).rings(label.middle, label.stroke);
        let deep = ENGRAVED_MM.min(baseplate.thickness / 4.0);
        plate = plate.minus(&Boolean::upright(&rings, -deep, 1.0)?)?;
    }
    Ok(Some((plate, numbers)))
}

/// Plate `k` of all as a piece, standing about the origin.
fn piece(made: &[Numbered], k: usize, thickness: f64, split: &Split) -> Result<Piece, SplitError> {
    let (plate, numbers) = &made[k];
    let digits = made.len().to_string().len();
    let name = format!("plate-{:0digits$}", k + 1);
    let (lo, hi) = plate.mesh().bounds().unwrap_or_default();
    let middle = ((lo + hi) / 2.0).truncate().map(grained);
    let labelled = |n: &usize| split.sockets[n - 1].label.is_some();
    let at = plate.moved(-middle.extend(0.0))?;
    let solid = standing_on_zero(&at, thickness, &name)?;
    Ok(Piece {
        solid,
        says: format!("plate {} of {}", k + 1, made.len()),
        name,
        engraved: numbers.iter().all(labelled),
        numbers: numbers.clone(),
        is_plate: true,
        origin: middle.extend(-thickness),
    })
}
