//! Numbers made narrower, as files hold them. The only place of the formats that may: elsewhere a cast that loses something is an
//! error of lint, because files come from strangers and a length cut off at 32 bits is a wrong mesh without a word.

/// A count or a length in 32 bits.
///
/// # Panics
/// Above `u32::MAX`: a file of that format cannot say it. Meshes and files are refused long before.
pub(super) fn count(n: usize) -> u32 {
    u32::try_from(n).expect("fewer than 2^32")
}

/// The nearest f32.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
pub(super) fn single(x: f64) -> f32 {
    x as f32
}

/// A share of 0 to 1 as a byte.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast from a float ends at the ends of the range"
)]
pub(super) fn byte(share: f64) -> u8 {
    (share * 255.0).round() as u8
}

/// A number of a file as an index; `None` if it is none or has no room for its successor.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "in range and whole, as was just checked"
)]
pub(super) fn index(value: f64) -> Option<u32> {
    let is_one = value >= 0.0 && value < f64::from(u32::MAX) && value.fract() == 0.0;
    is_one.then_some(value as u32)
}
