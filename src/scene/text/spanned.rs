//! Values that know where they were written, and that fail one by one.
//!
//! A [`Spanned`] value is parsed from its own slice of the text and keeps its error instead of failing its
//! surroundings: one wrong number does not hide the next. Positions are remembered as addresses, because serde offers no other channel;
//! the reader turns them back into byte offsets of the text it parsed.

use super::lexer;
use ron::error::SpannedError;
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer};

/// A value of the scene's text with its place.
#[derive(Debug)]
pub(crate) struct Spanned<T> {
    /// Address of the first byte of the value in the parsed text.
    pub address: usize,
    /// Bytes.
    pub length: usize,
    /// The value, or what is wrong with it; positions inside are relative to the value's own text.
    pub value: Result<T, SpannedError>,
}

/// A list whose items fail one by one.
pub(crate) type List<T> = Vec<Spanned<T>>;

/// A field that may be left out.
#[derive(Debug, Default)]
pub(crate) enum Field<T> {
    #[default]
    Missing,
    Given(Spanned<T>),
}

/// How scenes are read: newtypes need no brackets of their own.
pub(crate) fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// The text of a value without spaces and comments around it.
pub(crate) fn own_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<&'de str, D::Error> {
    let text = <&'de RawValue>::deserialize(deserializer)?.get_ron();
    Ok(&text[lexer::trimmed(text)])
}

impl<T: DeserializeOwned> Spanned<T> {
    /// The value that `text`, a part of the parsed text, stands for.
    pub(crate) fn of(text: &str) -> Self {
        Self {
            address: text.as_ptr() as usize,
            length: text.len(),
            value: options().from_str(text),
        }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for Spanned<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        own_text(deserializer).map(Self::of)
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for Field<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Spanned::deserialize(deserializer).map(Field::Given)
    }
}
