//! Scenes: the user's RON text and what it means.

mod carriers;
mod checks;
pub mod defaults;
mod language;
mod layout;
mod models;
mod options;
mod request;
mod resolve;
mod resolved;
mod supports;
mod text;
mod views;

pub use language::quality::{Quality, at_quality};
pub use language::schema::schema;
pub use language::template::{TEMPLATE, TEMPLATE_MODEL, TEMPLATE_MODEL_FILE};
pub use layout::laid::{laid_out, layout_text};
pub use request::ReadFile;
pub use resolve::{resolve, resolve_to_mend};
pub use resolved::{Output, Printer, Scene};
pub use text::nearest;
pub use text::set::set;
