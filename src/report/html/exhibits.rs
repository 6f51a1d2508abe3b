//! What the page shows besides figures.

use crate::render::ViewPictures;

/// What is shown besides figures. SVG as whole documents without a prolog, trusted as they are.
#[derive(Clone, Debug, Default)]
pub struct Exhibits<'a> {
    pub plan: Option<&'a str>,
    pub camouflage: Option<&'a str>,
    /// In the order of the report's views; may be shorter.
    pub views: Vec<ViewExhibit<'a>>,
    /// Paths of the files made, and their sizes in bytes.
    pub files: Vec<(&'a str, usize)>,
}

/// One view's pictures.
#[derive(Clone, Copy, Debug)]
pub struct ViewExhibit<'a> {
    /// In which the plan and the curves draw it.
    pub colour: [u8; 3],
    pub pictures: Option<&'a ViewPictures>,
    /// PNG: the sheet in real light.
    pub lights: Option<&'a [u8]>,
}
