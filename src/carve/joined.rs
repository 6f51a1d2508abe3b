//! Forests of meshes that stay whole: every mesh as it is, united with its support.

use super::boolean::{Boolean, BooleanError};
use super::{CRUMB_MM3, CarveError, Carved, Forest, Repairs, sound, unite};
use crate::mesh::TriMesh;
use crate::viewmap::SupportField;
use rayon::prelude::*;

/// A closed mesh and what it stands on.
pub struct Whole<'a> {
    /// Of its view.
    pub name: &'a str,
    pub support: u32,
    pub mesh: &'a TriMesh,
}

/// Unites every mesh with its support, and everything with everything. Meshes that cross themselves are resolved: what lies
/// inside of any part of them is solid.
///
/// # Errors
/// If the boolean library refuses an operand, or a solid is unsound.
pub fn joined(field: &SupportField, views: &[Whole]) -> Result<Forest, CarveError> {
    let carved: Vec<Carved> = (0..field.supports.len())
        .into_par_iter()
        .map(|s| on_support(field, s as u32, views))
        .collect::<Result<_, _>>()?;
    let names: Vec<&str> = views.iter().map(|v| v.name).collect();
    unite(&carved, &names)
}

fn on_support(field: &SupportField, s: u32, views: &[Whole]) -> Result<Carved, CarveError> {
    let support = &field.supports[s as usize];
    let place = |what: &str| format!("{} ({what})", support.name);
    let failed = |source: BooleanError| CarveError::Boolean {
        place: support.name.clone(),
        source,
    };
    let mut repairs = Repairs::default();
    let mut bare = Boolean::new(&support.mesh).map_err(failed)?;
    let mut whole = bare.clone();
    let mut blocks = Vec::new();
    for (v, view) in views.iter().enumerate().filter(|(_, w)| w.support == s) {
        let mesh = Boolean::new(view.mesh).map_err(failed)?;
        let (joined, crumbs) = (whole.plus_any(&mesh).map_err(failed)?).without_crumbs(CRUMB_MM3);
        repairs.crumbs_mm3 += crumbs;
        whole = joined;
        bare = bare.minus_any(&mesh).map_err(failed)?;
        blocks.push((v, mesh));
    }
    let bare = bare.without_crumbs(CRUMB_MM3).0;
    let block = |(v, mesh): (usize, Boolean)| {
        let what = place(views[v].name);
        let resolved = |_| sound(&whole.minus(&bare).map_err(failed)?, &what);
        Ok((v, sound(&mesh, &what).or_else(resolved)?))
    };
    Ok(Carved {
        blocks: blocks.into_iter().map(block).collect::<Result<_, _>>()?,
        whole: sound(&whole, &place("with its mesh"))?,
        bare: sound(&bare, &place("bare"))?,
        given_up: Vec::new(),
        repairs,
        widths: 0,
    })
}
