//! Scene text as text: words, values with their places, and what is wrong with them. Knows no scene.

pub mod document;
pub mod explain;
pub mod lexer;
pub mod names;
pub mod reader;
pub mod set;
pub mod spanned;
pub mod tree;
