//! The forest with everything that led to it.

use super::sight::{Shape, Sight};
use crate::bvh::Bvh;
use crate::carve::Forest;
use crate::scene::Scene;
use crate::viewmap::SupportField;

/// All results of the stages that make a forest.
pub struct Built<'a> {
    pub scene: &'a Scene,
    pub field: &'a SupportField<'a>,
    pub sights: Vec<Sight<'a>>,
    pub shapes: Vec<Shape>,
    pub forest: Forest,
    /// That of the whole forest.
    pub bvh: Bvh,
}
