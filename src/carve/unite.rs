//! Unites all carved supports.

use super::boolean::{Boolean, BooleanError};
use super::forest::{CarveError, Forest, Repairs};
use super::operand::Operand;
use super::sound::{SPARE_MM, sound_mesh};
use super::support::{Carved, carve_support};
use crate::index::{SupportId, ViewId};
use crate::mesh::boxes::{Box3, BoxTree};
use crate::mesh::{Resolving, Solid, TriMesh, without_spare_corners_where};
use crate::viewmap::SupportField;
use rayon::prelude::*;

/// Carves and unites everything; `line` is the width of a printed line, millimetres.
///
/// # Errors
/// If the boolean library refuses an operand or a result does not become a solid, with its name.
pub fn carve(field: &SupportField, views: &[Operand], line: f64) -> Result<Forest, CarveError> {
    let carved: Vec<Carved> = (0..field.supports.len() as u32)
        .into_par_iter()
        .map(|s| carve_support(field, SupportId(s), views, line))
        .collect::<Result<_, _>>()?;
    let names: Vec<&str> = views.iter().map(Operand::name).collect();
    unite(carved, &names)
}

/// The forest of carved supports; `views` are the views' names.
fn unite(carved: Vec<Carved>, views: &[&str]) -> Result<Forest, CarveError> {
    let mut repairs = Repairs::default();
    carved.iter().for_each(|c| repairs.add(&c.repairs));
    let of_view = |v: ViewId| {
        let blocks = carved.iter().flat_map(|c| &c.blocks);
        blocks.filter(|b| b.0 == v).map(|b| &b.1).collect()
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
    let mut told = |(solid, took): (Solid, Resolving)| {
        repairs.resolving.add(&took);
        solid
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
        standing: carved.into_iter().map(|c| c.whole).collect(),
        repairs,
    })
}

/// The union of some parts as a checked solid; `None` of nothing.
///
/// What is read by the library is read here, in order: it numbers meshes as they come, those of different supports in the order of
/// threads, and its results depend on that.
fn united(parts: Vec<&TriMesh>, place: &str) -> Result<Option<(Solid, Resolving)>, CarveError> {
    let mut gathered = gathered(&parts);
    if gathered.len() < 2 {
        let only = gathered.pop();
        return only.map(|mesh| sound_mesh(&mesh, place)).transpose();
    }
    let read: Result<Vec<Boolean>, BooleanError> = gathered.iter().map(Boolean::new).collect();
    let whole = read.and_then(Boolean::union);
    let whole = whole.map_err(|source| CarveError::Boolean {
        place: place.into(),
        source,
    })?;
    // The parts are without spare corners, and where they are apart they stay as they were.
    let overlaps = overlaps(&parts);
    let spared = without_spare_corners_where(whole.mesh(), SPARE_MM, |p| overlaps.covers(p));
    sound_mesh(&spared, place).map(Some)
}

/// Where the boxes of two parts overlap.
fn overlaps(parts: &[&TriMesh]) -> BoxTree {
    let boxes: Vec<Box3> = parts.iter().filter_map(|p| Box3::of(p)).collect();
    let mut common = Vec::new();
    for (i, a) in boxes.iter().enumerate() {
        common.extend(boxes[..i].iter().filter_map(|b| a.common(b)));
    }
    BoxTree::new(&common)
}

/// Some parts as fewer: those whose boxes are apart need no boolean.
fn gathered(parts: &[&TriMesh]) -> Vec<TriMesh> {
    let mut gathered: Vec<(TriMesh, Vec<Box3>)> = Vec::new();
    for part in parts {
        let Some(own) = Box3::of(part) else {
            continue;
        };
        let is_apart = |boxes: &[Box3]| boxes.iter().all(|b| !b.overlaps(&own));
        match gathered.iter_mut().find(|(_, boxes)| is_apart(boxes)) {
            Some((mesh, boxes)) => {
                mesh.append(part);
                boxes.push(own);
            }
            None => gathered.push(((*part).clone(), vec![own])),
        }
    }
    gathered.into_iter().map(|(mesh, _)| mesh).collect()
}
