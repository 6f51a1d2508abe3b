//! What pillars depend on besides their own part of the scene.

use crate::scene::request::{Purpose, ReadFile};
use crate::scene::resolved::Making;

/// What of the scene the pillars depend on.
pub(crate) struct Around<'a> {
    pub read: ReadFile<'a>,
    pub purpose: Purpose,
    pub making: &'a Making,
    /// Names of the views that could be read, and how many there should be.
    pub views: Vec<&'a str>,
    pub view_count: usize,
}
