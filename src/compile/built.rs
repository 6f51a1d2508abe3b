//! The forest with everything that led to it.

use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::kinds::Optimised;
use crate::scene::Scene;
use crate::sight::Sight;
use crate::viewmap::SupportField;

/// All results of the stages that make a forest.
pub(crate) struct Built<'a> {
    pub scene: &'a Scene,
    pub field: &'a SupportField<'a>,
    pub sights: &'a [Sight<'a>],
    pub shapes: Vec<Box<dyn Optimised + 'a>>,
    pub forest: Forest,
    /// That of the whole forest.
    pub bvh: Bvh,
}
