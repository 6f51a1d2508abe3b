//! Finished pages: a drawing with its title.

use super::drawing::Drawing;

/// A finished page.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub(super) title: String,
    pub(super) drawing: Drawing,
}

impl Plan {
    /// An SVG document, one unit a millimetre.
    pub fn svg(&self) -> String {
        self.drawing.svg(&self.title)
    }

    /// A PNG of this width in pixels.
    pub fn png(&self, width_px: u32) -> Vec<u8> {
        self.drawing.png(width_px)
    }
}
