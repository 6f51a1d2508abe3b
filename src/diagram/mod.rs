//! Diagrams. The plan: who sees which pillar, from above. Sections are in [`section`].
//!
//! Takes views and supports, gives a display list; [`Plan::svg`] and [`Plan::png`] show the same page.
//! The forest is drawn at true scale (one unit of the SVG is one millimetre); eyes far outside of it stand at the rim
//! with their distance written beside them, and a small overview shows them to scale.

pub mod chart;
pub mod curves;
pub mod drawing;
mod eyes;
mod footer;
mod layout;
pub mod lettering;
mod map;
mod page;
pub mod planning;
pub mod raster;
pub mod section;
mod sight;
mod svg;

pub use layout::layout;
pub use sight::{Run, Sight};

use crate::diagram::drawing::Drawing;
use crate::diagram::page::Page;
use crate::support::{Support, SupportKind};
use crate::view::View;

/// A finished page.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    title: String,
    drawing: Drawing,
}

impl Plan {
    /// An SVG document, one unit a millimetre.
    pub fn svg(&self) -> String {
        self.drawing.svg(&self.title)
    }

    /// A PNG of this width in pixels.
    pub fn png(&self, width_px: u32) -> Vec<u8> {
        self.drawing.png(width_px)
    }
}

/// What the page tells, worked out before anything is drawn.
struct Facts<'a> {
    title: &'a str,
    views: &'a [View],
    supports: &'a [Support],
    /// One per view.
    sights: Vec<Sight>,
    /// For every support the view that sees most of it, if any does.
    owners: Vec<Option<usize>>,
    /// How far every eye may move, millimetres; empty if that is not known.
    rooms: &'a [Option<f64>],
}

impl Facts<'_> {
    fn pillars(&self) -> usize {
        self.supports
            .iter()
            .filter(|s| matches!(s.kind, SupportKind::Pillar { .. }))
            .count()
    }
}

/// Draws the visibility map of a scene. `rooms` are how far every view's eye may move before its picture breaks,
/// millimetres; empty if nothing was built yet.
pub fn plan(title: &str, views: &[View], supports: &[Support], rooms: &[Option<f64>]) -> Plan {
    let sights: Vec<Sight> = views.iter().map(|v| Sight::new(v, supports)).collect();
    let owners = (0..supports.len()).map(|k| owner(&sights, k)).collect();
    let facts = Facts {
        title,
        views,
        supports,
        sights,
        owners,
        rooms,
    };
    let page = Page::new(&facts);
    let mut drawing = Drawing::new(page.size());
    map::draw(&mut drawing, &page, &facts);
    footer::draw(&mut drawing, &page, &facts);
    Plan {
        title: title.to_owned(),
        drawing,
    }
}

/// The view that sees the support `k` over the widest angle; the earlier one of equals.
fn owner(sights: &[Sight], k: usize) -> Option<usize> {
    let mut best = (None, 0.0);
    for (view, sight) in sights.iter().enumerate() {
        let angle = sight.angle_of(k);
        if angle > best.1 {
            best = (Some(view), angle);
        }
    }
    best.0
}
