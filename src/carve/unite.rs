//! Unites all carved supports.

use super::boolean::Boolean;
use super::forest::{CarveError, Forest, Repairs};
use super::operand::Operand;
use super::sound::{Sound, sound};
use super::support::{Carved, WIDTHS, carve_support};
use crate::index::{SupportId, ViewId};
use crate::ladder::Ladder;
use crate::mesh::Solid;
use crate::viewmap::SupportField;
use rayon::prelude::*;

/// Unions that came out unsound and were made again with other widths of one support: three are needed now and then.
const UNIONS: usize = 16;
/// Carves and unites everything.
///
/// # Errors
/// If the boolean library refuses an operand or a solid stays unsound at all widths tried, with the support.
pub fn carve(field: &SupportField, views: &[Operand]) -> Result<Forest, CarveError> {
    let mut carved: Vec<Carved> = (0..field.supports.len() as u32)
        .into_par_iter()
        .map(|s| carve_support(field, SupportId(s), views, 0))
        .collect::<Result<_, _>>()?;
    let names: Vec<&str> = views.iter().map(Operand::name).collect();
    // Meshes have no widths to try.
    let unions = if views.iter().any(Operand::has_widths) {
        UNIONS
    } else {
        1
    };
    for held in 0..unions {
        let error = match unite(&carved, &names) {
            Ok(mut forest) => {
                forest
                    .ladders
                    .push(Ladder::new("union of all supports", None, held, unions));
                return Ok(forest);
            }
            Err(error) if held + 1 == unions => return Err(error),
            Err(error) => error,
        };
        // Of the supports at the defect the one tried least often is carved anew.
        let near = |s: &usize| error.places().any(|p| carved[*s].is_near(p));
        let suspects = (0..carved.len()).filter(|s| carved[*s].widths + 1 < WIDTHS.len());
        let Some(s) = suspects.filter(near).min_by_key(|s| carved[*s].widths) else {
            return Err(error);
        };
        carved[s] = carve_support(field, SupportId::new(s), views, carved[s].widths + 1)?;
    }
    unreachable!("the last union ends it")
}

/// The forest of carved supports; `views` are the views' names.
fn unite(carved: &[Carved], views: &[&str]) -> Result<Forest, CarveError> {
    let mut repairs = Repairs::default();
    carved.iter().for_each(|c| repairs.add(&c.repairs));
    let of_view = |v: ViewId| {
        carved
            .iter()
            .flat_map(move |c| c.blocks.iter().filter(move |b| b.0 == v).map(|b| &b.1))
            .collect::<Vec<_>>()
    };
    let (whole, (bare, reliefs)) = rayon::join(
        || united(carved.iter().map(|c| &c.whole).collect(), "the forest"),
        || {
            rayon::join(
                || united(carved.iter().map(|c| &c.bare).collect(), "the bare pillars"),
                || {
                    (0..views.len())
                        .into_par_iter()
                        .map(|v| united(of_view(ViewId::new(v)), views[v]))
                        .collect::<Result<Vec<_>, _>>()
                },
            )
        },
    );
    let mut ladders: Vec<Ladder> = carved
        .iter()
        .flat_map(|c| c.ladders.iter().cloned())
        .collect();
    let mut told = |sound: Sound| {
        ladders.extend(sound.ladders);
        sound.solid
    };
    let whole = told(whole?.unwrap_or_else(|| unreachable!("a scene has supports")));
    let bare = told(bare?.unwrap_or_else(|| unreachable!("a scene has supports")));
    let reliefs = reliefs?.into_iter().map(|r| r.map(&mut told)).collect();
    let mut given_up = vec![Vec::new(); views.len()];
    for (v, cells) in carved.iter().flat_map(|c| &c.given_up) {
        given_up[*v].extend(cells);
    }
    given_up.iter_mut().for_each(|cells| cells.sort_unstable());
    Ok(Forest {
        whole,
        bare,
        reliefs,
        given_up,
        standing: carved.iter().map(|c| c.whole.clone()).collect(),
        repairs,
        ladders,
    })
}

/// The union of solids, sound again; `None` of nothing.
fn united(parts: Vec<&Solid>, place: &str) -> Result<Option<Sound>, CarveError> {
    if parts.is_empty() {
        return Ok(None);
    }
    let operands = parts
        .iter()
        .map(|s| Boolean::new(s.mesh()))
        .collect::<Result<Vec<_>, _>>();
    let whole = operands
        .and_then(Boolean::union)
        .map_err(|source| CarveError::Boolean {
            place: place.into(),
            source,
        })?;
    sound(&whole, place).map(Some)
}
