//! Pillars as pieces: which belong together, their pegs, and their numbers.

use super::digits::Lettering;
use super::foot::Foot;
use super::pieces::{ENGRAVED_MM, MET_MM3, Piece, STROKE_NOZZLES, SplitError, SplitOptions};
use super::stand::{grained, moved, standing_on_zero};
use crate::carve::boolean::{Boolean, BooleanError};
use crate::mesh::boxes::Box3;
use crate::mesh::{DisjointSets, TriMesh};
use crate::support::{Support, SupportKind};
use rayon::prelude::*;

/// Pillars that belong together because their reliefs meet: positions in `numbered`.
pub(crate) fn meeting(
    standing: &[TriMesh],
    numbered: &[usize],
) -> Result<Vec<Vec<usize>>, BooleanError> {
    let boxes: Vec<Option<Box3>> = numbered.iter().map(|s| Box3::of(&standing[*s])).collect();
    let meet = |a: usize, b: usize| {
        let both = boxes[a].zip(boxes[b]);
        both.is_some_and(|(a, b)| a.overlaps(&b))
    };
    let pairs: Vec<(usize, usize)> = (0..numbered.len())
        .flat_map(|b| (0..b).map(move |a| (a, b)))
        .filter(|(a, b)| meet(*a, *b))
        .collect();
    let solid = |k: usize| Boolean::new(&standing[numbered[k]]);
    let met: Vec<bool> = pairs
        .par_iter()
        .map(|(a, b)| Ok(solid(*a)?.common(&solid(*b)?)?.volume() > MET_MM3))
        .collect::<Result<_, BooleanError>>()?;
    let mut sets = DisjointSets::new(numbered.len());
    for ((a, b), _) in pairs.iter().zip(met).filter(|(_, met)| *met) {
        sets.join(*a as u32, *b as u32);
    }
    Ok(sets.members())
}

/// One pillar, or several whose reliefs meet, with pegs.
pub(crate) fn pillar(
    supports: &[Support],
    standing: &[TriMesh],
    numbered: &[usize],
    group: &[usize],
    depth: f64,
    options: &SplitOptions,
) -> Result<Piece, SplitError> {
    let members = || group.iter().map(|k| numbered[*k]);
    let axis = members().find_map(|s| match supports[s].kind {
        SupportKind::Pillar { axis, .. } => Some(axis),
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    });
    let lowest = members()
        .filter_map(|s| standing[s].bounds())
        .map(|(lo, _)| lo.z)
        .fold(f64::INFINITY, f64::min);
    let bottom = if depth > 0.0 { -depth } else { grained(lowest) };
    let origin = axis.unwrap_or_default().map(grained).extend(bottom);
    let flat = origin.truncate();
    let mut parts = Vec::new();
    let mut feet = Vec::new();
    for s in members() {
        let carved = Boolean::new(&moved(&standing[s], -flat.extend(0.0)))?;
        let foot = Foot::new(&supports[s], flat, depth);
        parts.push(match &foot {
            Some(foot) if depth > 0.0 => foot.pegged(&carved)?,
            _ => carved,
        });
        feet.push(foot);
    }
    let mut united = Boolean::union(parts)?;
    let mut engraved = true;
    for (k, foot) in group.iter().zip(&feet) {
        let tool = foot.as_ref().and_then(|f| under(f, k + 1, bottom, options));
        engraved &= tool.is_some();
        if let Some(tool) = tool {
            united = united.minus(&tool?)?;
        }
    }
    let numbers: Vec<usize> = group.iter().map(|k| k + 1).collect();
    let digits = numbered.len().to_string().len();
    let tags: Vec<String> = numbers.iter().map(|n| format!("{n:0digits$}")).collect();
    let names: Vec<&str> = members().map(|s| supports[s].name.as_str()).collect();
    let name = format!("pillar-{}", tags.join("-"));
    let solid = standing_on_zero(&united, -bottom, &name)?;
    Ok(Piece {
        solid,
        name,
        says: format!("pillar {} ({})", tags.join(" and "), names.join(", ")),
        numbers,
        engraved,
        is_plate: false,
        origin,
    })
}

/// What engraves a number in the end of a peg, to be read from below; `None` if there is no room for it.
fn under(
    foot: &Foot,
    number: usize,
    bottom: f64,
    options: &SplitOptions,
) -> Option<Result<Boolean, BooleanError>> {
    let circle = foot.end()?;
    let letters = Lettering::new(number).mirrored();
    let room = (circle.radius - options.nozzle) / (letters.size().length() / 2.0);
    let [most, .., least] = STROKE_NOZZLES.map(|n| n * options.nozzle);
    (room >= least).then(|| {
        let rings = letters.rings(circle.centre, room.min(most));
        Boolean::upright(&rings, bottom - 1.0, bottom + ENGRAVED_MM)
    })
}
