//! What cutting a forest into pieces takes and gives.

use super::cuts::{Cuts, Pin};
use crate::carve::CarveError;
use crate::carve::boolean::BooleanError;
use crate::ladder::Ladder;
use crate::mesh::Solid;
use glam::{DVec2, DVec3};

/// Thinnest base that can have sockets, millimetres.
pub(crate) const THINNEST_BASE_MM: f64 = 2.0;
/// Depth of engraved numbers, millimetres: three layers of most printers.
pub(crate) const ENGRAVED_MM: f64 = 0.6;
/// Width of an engraved stroke in nozzles: as wanted, and the least that is still a stroke.
pub(crate) const STROKE_NOZZLES: [f64; 3] = [2.0, 1.5, 1.1];
/// Pillars have met if they share more than this, cubic millimetres.
pub(crate) const MET_MM3: f64 = 1e-6;

/// What is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitOptions {
    /// Width of a printed line, millimetres.
    pub nozzle: f64,
    /// Width, depth and height of the build volume, millimetres.
    pub bed: [f64; 3],
    /// Room between peg and socket, pin and hole, plate and plate, millimetres.
    pub clearance: f64,
}

/// The forest in pieces.
#[derive(Clone, Debug)]
pub struct Split {
    /// Plates first.
    pub pieces: Vec<Piece>,
    pub cuts: Cuts,
    pub pins: Vec<Pin>,
    /// One per pillar, by number.
    pub sockets: Vec<Socket>,
}

/// One solid, standing on z = 0 about the origin.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Usable as a file name: `plate-1`, `pillar-07`, `pillar-03-04`.
    pub name: String,
    /// What the forest's names are.
    pub says: String,
    /// Numbers of the pillars it is or has sockets for.
    pub numbers: Vec<usize>,
    /// Whether those numbers can be read on it.
    pub engraved: bool,
    pub is_plate: bool,
    pub solid: Solid,
    /// What puts it back in its place.
    pub origin: DVec3,
}

/// Where a pillar goes.
#[derive(Clone, Debug)]
pub struct Socket {
    /// From 1.
    pub number: usize,
    /// Index of the support.
    pub support: usize,
    /// The number on the plate, if there is room for it.
    pub label: Option<PlateNumber>,
    /// The key at the peg's end, across the pillar; none without a base.
    pub key: Option<[DVec2; 2]>,
}

/// A number on a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateNumber {
    pub middle: DVec2,
    /// Width of its strokes, millimetres.
    pub stroke: f64,
    /// Which of [`STROKE_NOZZLES`] that is.
    pub rung: usize,
}

impl Split {
    /// What was tried in turn: strokes of the numbers beside sockets.
    pub fn ladders(&self) -> Vec<Ladder> {
        // Without a base there are no plates for numbers to stand on.
        let plates = self.pieces.iter().any(|p| p.is_plate);
        let sockets = self.sockets.iter().filter(|_| plates);
        let strokes = sockets.map(|s| {
            let rung = s.label.map_or(STROKE_NOZZLES.len(), |l| l.rung);
            let socket = format!("socket {}", s.number);
            let name = "stroke of a number on a plate, none at last";
            Ladder::new(name, Some(&socket), rung, STROKE_NOZZLES.len() + 1)
        });
        strokes.collect()
    }
}

/// Why there are no pieces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplitError {
    #[error("the base is {0} mm thick: sockets need at least {THINNEST_BASE_MM} mm")]
    ThinBase(f64),
    #[error("only forests of pillars are cut into pieces, and \"{0}\" is no pillar")]
    Body(String),
    #[error("the printer's bed is too small to cut the base into plates for it")]
    SmallBed,
    #[error(transparent)]
    Carve(#[from] CarveError),
}

impl From<BooleanError> for SplitError {
    fn from(source: BooleanError) -> Self {
        let place = "a piece of the forest".into();
        Self::Carve(CarveError::Boolean { place, source })
    }
}
