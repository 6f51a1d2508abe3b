//! Scene text as text: words, values with their places, and what is wrong with them.
//!
//! Takes text and the types it is to be read as; gives values, each with its place or with the problem that stands there instead.
//! Knows no scene: what fields there are and what they mean is told in `language` and above.
//!
//! `lexer` and `tree` find words and values, `spanned` parses each value by itself, `explain` says in words what RON found wrong,
//! `reader` asks for values one by one and notes what is missing or out of range, `document` reads a text again without the fields
//! that nobody knows, `set` changes one value of a text.

pub(crate) mod document;
mod explain;
pub(crate) mod lexer;
pub(crate) mod names;
mod place;
mod reader;
pub(crate) mod set;
pub(crate) mod spanned;
mod tree;
pub(crate) mod wanted;
mod wording;

pub(crate) use place::{Span, error_at, placed, warning_at};
pub(crate) use reader::Reader;
pub(crate) use spanned::{Field, List, Spanned};
pub use wording::nearest;
pub(crate) use wording::{printable, short};
