//! Pictures of a plan: the layout before and after the search, the search itself, and what camouflage costs.
//!
//! Takes views, what was wanted of the layout, and what the planner found. Gives pages ([`Plan`]) and one animated SVG. Indices in
//! [`Planned`] must be those of the views and of the brief's shapes; what a fault is in words comes from outside, as [`Tell`].
//! Colours are never alone: pillars carry their view's letter where it can be read, faults are crossed out, regions are dashed.

mod film;
mod measures;
mod plot;
mod scenery;
mod sheet;
mod story;
mod strip;
mod table;
mod tracks;
mod words;

use crate::diagram::finished::Plan;
use crate::planner::{Brief, Planned};
use crate::view::View;
use story::Story;
pub use story::Tell;

/// Before and after the search, a table of the views, and the trade-off. An A4 page, larger for many views or faults.
pub fn sheet(title: &str, views: &[View], plan: (&Brief, &Planned), tell: Tell) -> Plan {
    Plan {
        title: format!("{title}: plan"),
        drawing: sheet::draw(&Story::new(title, views, plan, tell)),
    }
}

/// Camouflage against eye tolerance, with the layout that was chosen.
pub fn trade(title: &str, brief: &Brief, planned: &Planned) -> Plan {
    Plan {
        title: format!("{title}: camouflage against eye tolerance"),
        drawing: plot::page(title, brief, planned),
    }
}

/// The search as an animated SVG without scripts: six seconds, two at rest on the layout chosen, and again. Viewers that know no
/// animation show the layout chosen.
pub fn animation(title: &str, views: &[View], plan: (&Brief, &Planned), tell: Tell) -> String {
    film::svg(&Story::new(title, views, plan, tell))
}

/// The search as at most six small maps.
pub fn strip(title: &str, views: &[View], plan: (&Brief, &Planned), tell: Tell) -> Plan {
    Plan {
        title: format!("{title}: search"),
        drawing: strip::draw(&Story::new(title, views, plan, tell)),
    }
}
