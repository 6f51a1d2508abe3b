//! `report.html`: the report for people, as one page that needs nothing but itself.
//!
//! Takes a [`Report`] and what there is to show with it, gives the page's text. Pictures are part of it, style and script too;
//! the page forbids itself every other source, so that it looks the same from a disk, in a mail and in ten years. Without
//! scripts everything can still be seen, and it prints. The same report gives the same bytes. Figures carry their exact value
//! as `<data value>`; what people read is rounded.

mod certificate;
mod exhibits;
mod page;
mod text;
mod views;

pub use exhibits::{Exhibits, ViewExhibit};
pub use page::print_sheet;
