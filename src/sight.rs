//! One eye with all that is known of it before its depths are found: the one value that later stages take.
//!
//! Takes a view and the supports. Gives its image and its groups. Stages that change what an eye may show (contests, tears) give a
//! sight again.

use crate::groups::{Groups, ThinSupport, groups, with_bounds, without};
use crate::index::{CellId, FaceId, SupportId, ViewId};
use crate::view::View;
use crate::viewmap::{Image, SupportField, Target, ViewMap, ViewMapError};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// Rays this far, radians, from the way to a support meet its layer thousands of times as far away as it is, or never: 89.99 degrees.
const FARTHEST_BESIDE: f64 = FRAC_PI_2 - 2e-4;

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
    /// No support stands behind or in its models: where those that could carry something are instead.
    NotCarried(Vec<(SupportId, Elsewhere)>),
    /// A face that the support carries has a corner at this angle, radians, from the way to the support, whose layer no ray meets
    /// so far beside it.
    Beside(SupportId, f64),
}

/// Why a support carries nothing for an eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elsewhere {
    /// It stands behind the eye.
    BehindEye,
    /// Its face looks away from the eye; unit, in plan: where it would look at it.
    FacesAway(DVec2),
    /// It stands beside the models, or before them.
    BesideModels,
}

impl<'a> Sight<'a> {
    /// Projects, maps and groups one view.
    ///
    /// # Errors
    /// If the models do not lie before the eye, nothing of them is seen, no support carries them, or faces reach too far beside one.
    pub fn new(view: &'a View, field: &'a SupportField<'a>) -> Result<Self, Unseen> {
        let image = Image::new(view, field).map_err(Unseen::Image)?;
        let groups = groups(&image).map_err(Unseen::Thin)?;
        if groups.groups.is_empty() {
            return Err(Unseen::NotCarried(aside(&image, &groups)));
        }
        if let Some((support, angle)) = beside(&image, &groups) {
            return Err(Unseen::Beside(support, angle));
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

    /// Sides at which one layer carries different faces, each told once: the cell with the lower number, its side and the cell beyond.
    /// Only there can sheets of the relief cross: a ray meets one cell, and a layer that jumps decides itself what is before what.
    pub fn seams(&self) -> impl Iterator<Item = (CellId, usize, CellId)> {
        let Self { image, groups, .. } = self;
        let map = &image.map;
        map.all().flat_map(move |(c, cell)| {
            let goes_on = move |k: usize| {
                let n = map.neighbours[c][k].filter(|n| *n > c)?;
                let other = &map.cells[n];
                groups.of_cell[c].and(groups.of_cell[n])?;
                let slab = groups.slabs[cell.support?].as_ref()?;
                let meet = cell.support == other.support && cell.face != other.face;
                (meet && image.layer_goes_on(slab, c, k, n)).then_some((c, k, n))
            };
            (0..3).filter_map(goes_on)
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

/// The corner of a carried face that is farthest beside its support, as long as that is too far.
fn beside(image: &Image, groups: &Groups) -> Option<(SupportId, f64)> {
    let mut worst: Option<(SupportId, f64)> = None;
    for carried in groups.carried(&image.map) {
        let support = groups.groups[carried.group].support;
        for q in image.target.image_of(carried.face) {
            let angle = carried.slab.angle_to(image.map.plane.direction(q));
            if angle >= FARTHEST_BESIDE && worst.is_none_or(|(_, w)| angle > w) {
                worst = Some((support, angle));
            }
        }
    }
    worst
}

/// Where supports are that carry nothing.
fn aside(image: &Image, groups: &Groups) -> Vec<(SupportId, Elsewhere)> {
    let plane = &image.map.plane;
    let why = |id: SupportId| {
        let support = &image.field.supports[id];
        support.layer?;
        let vertices = &support.mesh.vertices;
        let middle = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        let to_eye = (plane.eye - middle).truncate().normalize_or_zero();
        Some(match groups.slabs[id] {
            _ if vertices.iter().all(|v| plane.depth(*v) <= 0.0) => Elsewhere::BehindEye,
            None if support.is_body() => Elsewhere::FacesAway(to_eye),
            _ => Elsewhere::BesideModels,
        })
    };
    let all = SupportId::all(image.field.supports.len());
    all.filter_map(|id| Some((id, why(id)?))).collect()
}
