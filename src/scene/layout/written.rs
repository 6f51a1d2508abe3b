//! Numbers as layout files hold them. Scenes with planned pillars are made of the same numbers, so that a file reads back as its scene.

use crate::scene::defaults;
use crate::scene::supports::pillars::PillarEntry;
use crate::support::Layer;

/// The entry with its numbers rounded to what layout files hold.
pub(crate) fn as_written(mut entry: PillarEntry) -> PillarEntry {
    let length = |v| rounded(v, defaults::LENGTH_DECIMALS);
    let place = |v| rounded(v, defaults::PLACE_DECIMALS);
    let section = entry.section.with_lengths(length);
    if let Ok(outline) = section.outline() {
        (entry.section, entry.outline) = (section, outline);
    }
    entry.height = place(entry.height).max(10f64.powi(-defaults::PLACE_DECIMALS));
    for spot in &mut entry.spots {
        spot.at = spot.at.to_array().map(place).into();
    }
    entry.layer = layer_as_written(entry.layer);
    entry
}

/// A layer as layout files hold it.
pub(crate) fn layer_as_written(layer: Layer) -> Layer {
    let length = |v| rounded(v, defaults::LENGTH_DECIMALS);
    layer.resized(
        length(layer.front),
        length(layer.back()),
        length(layer.core),
    )
}

/// Rounded to `decimals` decimals; never -0.
pub(crate) fn rounded(value: f64, decimals: i32) -> f64 {
    let unit = 10f64.powi(decimals);
    (value * unit).round() / unit + 0.0
}
