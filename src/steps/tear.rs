//! Tears a view's surface and finds its depths: price by price, until there are few enough tears.
//!
//! Where a step has no room (an outline that lies on its support leaves a tenth of a millimetre) the surface must hang together. The bounds
//! of all the points around decide that, so the solver is asked: its proof that there are no depths names the steps in contradiction with
//! the bounds. Those are closed, and it is asked again. Every round closes at least one of finitely many steps.

use super::cut::{Cut, cut, lowest_mm};
use super::fusion::{Functional, PatchDepths, Prices, pressed};
use super::lines::{self, StepLine, StepSummary, lines};
use super::options::StepOptions;
use super::patches::{Patch, Patches};
use super::thin;
use crate::index::{FaceId, VertexId};
use crate::mimic::{Depths, NormalOptions, Opening, RowKind, SolveError, opened_depths};
use crate::sight::Sight;
use crate::viewmap::Image;
use rayon::prelude::*;

/// Rebate along the sharpest creases: they are lines of the model already.
const CREASE_REBATE: f64 = 0.5;
/// How the price grows while there are more tears than wanted, and how often at most: the last is beyond any surface's worth.
const PRICE_GROWTH: f64 = 4.0;
const PRICE_ROUNDS: usize = 12;

/// A torn surface: the view's sight on the cut mesh, with its depths.
pub struct Torn<'a> {
    pub sight: Sight<'a>,
    pub depths: Depths,
    /// The uncut target's vertex at every vertex, and its face at every face.
    pub vertices: Vec<VertexId>,
    pub faces: Vec<FaceId>,
    pub lines: Vec<StepLine>,
    pub summary: StepSummary,
}

/// Tears the surface and finds its depths.
///
/// # Errors
/// As [`depths`](crate::mimic::depths).
pub fn torn<'a>(
    steps: &StepOptions,
    options: NormalOptions,
    sight: &Sight<'a>,
) -> Result<Torn<'a>, SolveError> {
    let image = &sight.image;
    let patches = Patches::new(steps, sight);
    let mut price = steps.price;
    let (mut rounds, mut given_up) = (0, 0);
    loop {
        let (y, absorbed) = tear(steps, options, price, image, &patches);
        let last = rounds == PRICE_ROUNDS;
        rounds += 1;
        price *= PRICE_GROWTH;
        let too_many = |lines: usize| !last && steps.most.is_some_and(|most| lines > most as usize);
        if too_many(lines::count(&image.target, &patches, &y)) {
            continue;
        }
        let OpenedCut {
            cut,
            opening,
            torn,
            depths,
        } = match opened(steps, options, sight, &patches, &y, &absorbed) {
            Ok(opened) => opened,
            // Steps that contradict each other: with fewer tears there are fewer of them. Bounds alone would contradict each other all the
            // more where less is torn.
            Err(SolveError::Infeasible(rows))
                if !last && !rows.iter().all(|row| is_bound(*row)) =>
            {
                given_up += 1;
                continue;
            }
            Err(error) => return Err(error),
        };
        let given_away = patches.patches.iter().zip(&absorbed).filter(|(_, a)| **a);
        let absorbed_mm2 = given_away.map(|(p, _)| p.seen_mm2).sum();
        let (lines, summary) = lines(image, &patches, &cut.corners, &depths);
        // Solving may open a line that the field's corners did not show.
        if too_many(summary.lines) {
            continue;
        }
        let target = &torn.image.target;
        return Ok(Torn {
            lines,
            summary: StepSummary {
                lowest_mm: lowest_mm(&opening.steps, target, &depths),
                absorbed_mm2,
                given_up,
                ..summary
            },
            vertices: cut.vertices,
            faces: patches.patches.iter().map(|p| p.face).collect(),
            sight: torn,
            depths,
        });
    }
}

/// A surface cut along its tears, with its depths.
struct OpenedCut<'a> {
    cut: Cut,
    opening: Opening,
    torn: Sight<'a>,
    depths: Depths,
}

/// Cuts the surface along the tears of a field and finds its depths; steps that contradict the bounds are closed first.
///
/// # Errors
/// As [`depths`](crate::mimic::depths), if no step is among what contradicts.
fn opened<'a>(
    steps: &StepOptions,
    options: NormalOptions,
    sight: &Sight<'a>,
    patches: &Patches,
    field: &PatchDepths,
    absorbed: &[bool],
) -> Result<OpenedCut<'a>, SolveError> {
    let mut closed = Vec::new();
    loop {
        let (target, map, cut) = cut(&sight.image, patches, field, steps.limits.least_mm, &closed);
        let opening = cut.opening(patches, steps, absorbed);
        let orders = if options.ordering {
            &cut.orders[..]
        } else {
            &[]
        };
        let torn = sight.cut(target, map);
        match opened_depths(options, &torn, orders, &opening) {
            Ok(depths) => {
                return Ok(OpenedCut {
                    cut,
                    opening,
                    torn,
                    depths,
                });
            }
            Err(SolveError::Infeasible(rows)) => {
                let without_room = cut.parted_by(&steps_among(&rows));
                if without_room.is_empty() {
                    return Err(SolveError::Infeasible(rows));
                }
                closed.extend(without_room);
            }
            Err(other) => return Err(other),
        }
    }
}

fn is_bound(row: RowKind) -> bool {
    matches!(row, RowKind::Near(_) | RowKind::Far(_))
}

/// The numbers of the steps among rows.
fn steps_among(rows: &[RowKind]) -> Vec<usize> {
    let number = |row: &RowKind| match row {
        RowKind::Step(i) => Some(*i as usize),
        RowKind::Near(_) | RowKind::Far(_) | RowKind::Order(_) | RowKind::Scale(_) => None,
    };
    rows.iter().filter_map(number).collect()
}

/// The tears at a price, support by support, and which patches were given away because they were too narrow.
fn tear(
    steps: &StepOptions,
    options: NormalOptions,
    price: f64,
    image: &Image,
    patches: &Patches,
) -> (PatchDepths, Vec<bool>) {
    let target = &image.target;
    let prices = Prices {
        tilt: 1f64.to_radians().powi(-2),
        length: price,
        height: price / 2.0,
        crease: CREASE_REBATE,
        ordered: options.ordering,
    };
    let results: Vec<(PatchDepths, Vec<bool>)> = patches
        .by_support()
        .into_par_iter()
        .map(|(range, cells)| {
            let corners = |p: &Patch| target.mesh.faces[p.face];
            let depth = |p: &Patch| corners(p).map(|v| target.depth[v]);
            let mut y = pressed(&patches.patches[range.clone()], depth);
            let functional = Functional::new(patches, prices, range);
            functional.descend(&mut y);
            let narrowest = steps.narrowest_mm / image.map.plane.scale(patches.depth);
            let absorbed = thin::absorb_thin(image, &functional, &cells, &mut y, narrowest);
            (y, absorbed)
        })
        .collect();
    let (fields, absorbed): (Vec<PatchDepths>, Vec<Vec<bool>>) = results.into_iter().unzip();
    (fields.concat(), absorbed.concat())
}
