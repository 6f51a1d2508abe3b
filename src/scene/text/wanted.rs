//! What values should have been, for messages about those that are not.

use super::spanned::List;

/// What a value should have been.
pub(crate) trait Wanted {
    const WANTED: &'static str;
}

/// `f64 => "a number";`
macro_rules! wanted {
    ($($kind:ty => $text:expr;)*) => { $(impl Wanted for $kind { const WANTED: &'static str = $text; })* };
}
pub(in crate::scene) use wanted;

wanted! {
    String => "text in straight double quotes";
    f64 => "a number";
    u32 => "a whole number";
    bool => "true or false";
    [f64; 2] => "a point `(x, y)`";
    [f64; 3] => "a point `(x, y, z)`";
    [f64; 4] => "a row of four numbers `(a, b, c, d)`";
}

impl<T> Wanted for List<T> {
    const WANTED: &'static str = "a list `[...]`";
}
