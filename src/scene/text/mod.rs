//! Scene text as text: words, values with their places, and what is wrong with them.
//!
//! Takes text and the types it is to be read as; gives values, each with its place or with the problem that stands there instead.
//! Knows no scene: what fields there are and what they mean is told in `language` and above.
//!
//! `lexer` and `tree` find words and values, `spanned` parses each value by itself, `explain` says in words what RON found wrong,
//! `reader` asks for values one by one and notes what is missing or out of range, `document` reads a text again without the fields
//! that nobody knows, `set` changes one value of a text.

pub mod document;
mod explain;
pub mod lexer;
pub mod names;
mod place;
mod reader;
pub mod set;
pub mod spanned;
mod tree;
pub mod wanted;
mod wording;

pub use place::{Span, error_at, placed, warning_at};
pub use reader::Reader;
pub use spanned::{Field, List, Spanned};
pub use wording::{nearest, printable, short};
