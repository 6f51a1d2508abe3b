//! The forest in pieces to be printed one by one and put together: plates with numbered sockets, and pillars with pegs.
//!
//! Takes the supports and every support as carved with its reliefs; gives checked solids and where they belong. Above the plates'
//! top nothing of a pillar changes. Reliefs that reach across to another pillar make one piece of both. A base that does not fit
//! the bed is cut into plates that do, aligned by pins. Numbers are engraved in the end of every peg and beside every socket,
//! as far as a nozzle can draw them there.
//!
//! Without a base there are no plates and no pegs, only pillars.

mod cuts;
mod digits;
mod foot;
mod label;
mod pieces;
mod pillars;
mod plates;
mod stand;

pub use cuts::{Cuts, Pin};
pub use digits::Lettering;
pub use foot::Foot;
pub use pieces::{Piece, PlateNumber, Socket, Split, SplitError, SplitOptions};

use crate::mesh::TriMesh;
use crate::support::{Support, SupportKind};
use glam::DVec2;
use pieces::THINNEST_BASE_MM;
use pillars::{meeting, pillar};
use plates::{Base, plates};
use rayon::prelude::*;

/// Material left under a socket: this share of the base's thickness, and at least so many millimetres.
const FLOOR_SHARE: f64 = 0.4;
const FLOOR_MM: f64 = 1.0;

/// Divides the forest. `standing` are the supports with their reliefs.
///
/// # Errors
/// A base too thin for sockets, a bed too small for any plate, or a piece that does not come out sound.
pub fn split(
    supports: &[Support],
    standing: &[TriMesh],
    options: &SplitOptions,
) -> Result<Split, SplitError> {
    let base = supports.iter().find_map(|s| match &s.kind {
        SupportKind::Base {
            outline,
            bottom,
            top,
        } => Some((outline, top - bottom)),
        SupportKind::Pillar { .. } | SupportKind::Body { .. } => None,
    });
    if let Some(body) = supports.iter().find(|s| s.is_body()) {
        return Err(SplitError::Body(body.name.clone()));
    }
    let depth = match base {
        Some((_, t)) if t < THINNEST_BASE_MM => return Err(SplitError::ThinBase(t)),
        // A multiple of a power of two: pegs keep their digits.
        Some((_, t)) => ((t - FLOOR_MM.max(FLOOR_SHARE * t)) * 16.0).floor() / 16.0,
        None => 0.0,
    };
    let numbered: Vec<usize> = (0..supports.len())
        .filter(|s| matches!(supports[*s].kind, SupportKind::Pillar { .. }))
        .collect();
    let mut split = Split {
        pieces: Vec::new(),
        cuts: Cuts::default(),
        pins: Vec::new(),
        sockets: numbered
            .iter()
            .enumerate()
            .map(|(k, s)| Socket {
                number: k + 1,
                support: *s,
                label: None,
                key: Foot::new(&supports[*s], DVec2::ZERO, depth)
                    .filter(|_| depth > 0.0)
                    .and_then(|f| f.key_line()),
            })
            .collect(),
    };
    if let Some((outline, thickness)) = base {
        let base = Base {
            outline,
            thickness,
            depth,
        };
        plates(supports, &base, options, &mut split)?;
    }
    let pillars: Vec<Piece> = meeting(standing, &numbered)?
        .par_iter()
        .map(|group| pillar(supports, standing, &numbered, group, depth, options))
        .collect::<Result<_, _>>()?;
    split.pieces.extend(pillars);
    Ok(split)
}
