//! One eye with all that is known of it before its depths are found: the one value that later stages take.
//!
//! Takes a view and the supports. Gives its image and its groups. Stages that change what an eye may show (contests, tears) give a
//! sight again.

use crate::groups::{Groups, ThinSupport, groups, with_bounds, without};
use crate::index::{CellId, FaceId, SupportId, ViewId};
use crate::view::View;
use crate::viewmap::{Image, SupportField, Target, ViewMap, ViewMapError};
use std::ops::Range;

/// A cell that its view loses to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loss {
    pub cell: CellId,
    /// The view that owns the place.
    pub owner: ViewId,
    /// The owner's support there.
    pub support: SupportId,
}

/// See the module.
pub struct Sight<'a> {
    pub image: Image<'a>,
    pub groups: Groups,
    /// Cells left to other views, rising.
    pub lost: Vec<Loss>,
}

/// Why nothing can appear to an eye.
#[derive(Clone, Debug, PartialEq)]
pub enum Unseen {
    Image(ViewMapError),
    /// Its layers would leave too little of these supports.
    Thin(Vec<ThinSupport>),
    /// No support stands behind or in its models.
    NotCarried,
}

impl<'a> Sight<'a> {
    /// Projects, maps and groups one view.
    ///
    /// # Errors
    /// If the models do not lie before the eye, nothing of them is seen, or no support carries them.
    pub fn new(view: &'a View, field: &'a SupportField<'a>) -> Result<Self, Unseen> {
        let image = Image::new(view, field).map_err(Unseen::Image)?;
        let groups = groups(&image).map_err(Unseen::Thin)?;
        if groups.groups.is_empty() {
            return Err(Unseen::NotCarried);
        }
        Ok(Self {
            image,
            groups,
            lost: Vec::new(),
        })
    }

    pub fn name(&self) -> &'a str {
        &self.image.view.name
    }

    /// The view's models by name, with their faces in its target.
    pub fn models(&self) -> impl Iterator<Item = (&'a str, Range<FaceId>)> {
        self.image
            .view
            .models
            .iter()
            .scan(FaceId(0), |first, model| {
                let faces = *first..first.plus(model.mesh.faces.len());
                *first = faces.end;
                Some((model.name.as_str(), faces))
            })
    }

    /// The same without the cells it loses (rising), which may leave it nothing.
    pub fn without(mut self, lost: Vec<Loss>) -> Self {
        if !lost.is_empty() {
            let cells: Vec<CellId> = lost.iter().map(|l| l.cell).collect();
            self.groups = without(&self.groups, &cells, &self.image);
            self.lost = lost;
        }
        self
    }

    /// The same surface cut along lines that the eye cannot see, with bounds for its new mesh.
    pub fn cut(&self, target: Target, map: ViewMap) -> Self {
        let image = self.image.cut(target, map);
        Self {
            groups: with_bounds(self.groups.clone(), &image),
            image,
            lost: self.lost.clone(),
        }
    }
}
