//! One view as certificates take it.

use crate::contest::Loss;
use crate::groups::Groups;
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
