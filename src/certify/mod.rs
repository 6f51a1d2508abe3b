//! Certificates: what a viewer and a printer are promised, measured on what was built.
//!
//! Each submodule takes results of earlier stages and gives figures with places; none changes what is built.

pub mod camouflage;
pub mod conflicts;
pub mod coverage;
pub mod layer;
pub mod printability;
pub mod tolerance;

use crate::groups::Groups;
use crate::sight::{Loss, Sight};
use crate::view::View;
use crate::viewmap::{Target, ViewMap};
use std::ops::Range;

/// One view with what is known of it before its depths are found.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    pub view: &'a View,
    /// The mesh of [`View::target`], projected.
    pub target: &'a Target,
    pub map: &'a ViewMap,
    pub groups: &'a Groups,
    /// Cells lost to other views, rising.
    pub lost: &'a [Loss],
}

impl<'a> From<&'a Sight<'a>> for Seen<'a> {
    fn from(sight: &'a Sight<'a>) -> Self {
        Self {
            view: sight.image.view,
            target: &sight.image.target,
            map: &sight.image.map,
            groups: &sight.groups,
            lost: &sight.lost,
        }
    }
}

impl<'a> Seen<'a> {
    /// The view's models by name, with their faces in its target.
    pub fn models(&self) -> impl Iterator<Item = (&'a str, Range<usize>)> {
        self.view.models.iter().scan(0, |first, model| {
            let faces = *first..*first + model.mesh.faces.len();
            *first = faces.end;
            Some((model.name.as_str(), faces))
        })
    }
}
