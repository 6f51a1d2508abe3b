//! Scenes: the user's RON text (`language::raw`) and what it means (`resolve`), in which nothing is left to decide.

mod carriers;
mod checks;
pub mod defaults;
mod language;
mod layout;
mod models;
mod options;
mod resolve;
mod resolved;
mod supports;
mod text;
mod views;

pub use language::quality::{Quality, at_quality};
pub use language::schema::schema;
pub use language::template::{TEMPLATE, TEMPLATE_MODEL, TEMPLATE_MODEL_FILE};
pub use layout::laid::{laid_out, layout_text};
pub use resolve::{ReadFile, resolve, resolve_to_mend};
pub use resolved::{Output, Printer, Scene};
pub use text::reader::nearest;
pub use text::set::set;
