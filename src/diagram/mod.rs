//! Diagrams. The plan: who sees which pillar, from above. Sections are in [`section`].
//!
//! Takes views and supports, gives a display list; [`Plan::svg`] and [`Plan::png`] show the same page.
//! The forest is drawn at true scale (one unit of the SVG is one millimetre); eyes far outside of it stand at the rim
//! with their distance written beside them, and a small overview shows them to scale.

pub mod chart;
pub mod curves;
pub mod drawing;
mod eyes;
mod facts;
mod finished;
mod footer;
mod layout;
pub mod lettering;
mod map;
mod mark;
mod page;
pub mod planning;
pub mod raster;
pub mod section;
mod svg;
pub mod vista;

pub use finished::Plan;
pub use layout::layout;

use crate::support::Support;
use crate::view::View;
use drawing::Drawing;
use facts::Facts;
use page::Page;

/// Draws the visibility map of a scene. `rooms` are how far every view's eye may move before its picture breaks,
/// millimetres; empty if nothing was built yet.
pub fn plan(title: &str, views: &[View], supports: &[Support], rooms: &[Option<f64>]) -> Plan {
    let facts = Facts::new(title, views, supports, rooms);
    let page = Page::new(&facts);
    let mut drawing = Drawing::new(page.size());
    map::draw(&mut drawing, &page, &facts);
    footer::draw(&mut drawing, &page, &facts);
    Plan {
        title: title.to_owned(),
        drawing,
    }
}
