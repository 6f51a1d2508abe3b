//! Scenes: the user's RON text and what it means. [`resolve`] turns the one into a [`Scene`] in which nothing is left to decide.
//!
//! The way of a scene: `text` cuts it into words and parses every value by itself, at its place. `language` holds what may be written
//! (`raw`, a mirror without meaning) and what that means for people (`schema`). Then each folder makes of its own fields what later
//! stages take: `models` (files, where they stand, their regions), `options` (energy, steps, relief, printer, output), `supports`
//! (pillars, base and bodies, with depth layers), `layout` (pillars that are to be found, and layout files), `views` (eyes and what
//! they see). `carriers` brings supports and layouts together, `checks` are the rules that join several values, `resolve` is all of it
//! on one screen, and `resolved` is what comes out.
//!
//! What to open to add
//! - a field: its struct in `language/raw.rs`, its line in `language/schema.rs` (a test holds the two against each other), what holds
//!   without it in `defaults`, and the file that reads that struct;
//! - a form of support: a struct and a variant in `language/raw.rs`, a chapter in the schema, a file of its own in `supports/bodies/`
//!   that makes the mesh, and a line in `supports/bodies/list.rs`;
//! - an energy: a variant and a struct in `language/raw.rs`, a chapter in the schema, its options in `options/energy.rs` and
//!   `defaults`; `options/whole.rs` says whether whole meshes can have it. What it does is `mimic`'s.

// In reading order: none names a later one. Blank lines keep the formatter from sorting them.

mod resolved;

mod request;

pub mod defaults;

mod text;

mod language;

mod models;

mod options;

mod supports;

mod layout;

mod views;

mod checks;

mod carriers;

mod resolve;

pub use language::quality::{Quality, at_quality};
pub use language::schema::schema;
pub use language::starter::{StarterModel, starter};
pub use language::template::{TEMPLATE, TEMPLATE_MODEL, TEMPLATE_MODEL_FILE};
pub use layout::laid::{laid_out, layout_text};
pub use request::{Begun, Purpose, ReadFile};
pub use resolve::{resolve, resolve_for, resolve_to_mend};
pub use resolved::{Making, MakingWay, Output, Printer, Scene};
pub use text::nearest;
pub use text::set::set;
