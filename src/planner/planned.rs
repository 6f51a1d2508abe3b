//! What a finished plan tells: the layout, what it is worth, and the way to it.

use super::brief::{Adjustment, Pillar};
use super::survey::Fault;
use crate::horizon::Run;
use glam::DVec2;

/// What a layout is worth to one view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worth {
    /// Share of the models' width that meets a pillar of the view's own.
    pub coverage: f64,
    /// Faults in which this view has a part: conflicts and contested surface.
    pub conflicts: usize,
    /// Pillars of its own that it sees.
    pub pillars: usize,
    /// Forecast mean error of the normals, degrees, from eyes turned by the brief's angle.
    pub hidden_deg: f64,
    /// Forecast angle at which half of the likeness is lost; none if it never is.
    pub half_likeness_deg: Option<f64>,
    /// How far the eye may move sideways before a cut opens by two arc-minutes, millimetres: with reliefs in the middle of their
    /// layers, and wherever they lie.
    pub tolerance_mm: [f64; 2],
}

/// A layout that the search held, for pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Candidates tried until then.
    pub tries: u64,
    pub pillars: Vec<Pillar>,
    /// Index: view; the first stretch is on pillar `Run::obstacle`.
    pub runs: Vec<Vec<Run>>,
    pub faults: Vec<Fault>,
    /// Least forecast error of any view, degrees, and least tolerance (guaranteed) of any, millimetres.
    pub hidden_deg: f64,
    pub tolerance_mm: f64,
}

/// A point of the trade-off: the best forecast found at this tolerance or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trade {
    pub tolerance_mm: f64,
    pub hidden_deg: f64,
    pub chosen: bool,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All tries were made.
    Tries,
    /// Nothing better was found for long.
    Converged,
    /// It was told to stop: another run may end elsewhere.
    Stopped,
}

/// A pillar that was moved, put up or taken away to mend a layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Index into the given pillars; none if it is new.
    pub given: Option<usize>,
    /// Where it stands now; none if it is taken away.
    pub to: Option<DVec2>,
}

/// A finished plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Given pillars that stay first, in their order, then those of each view from its left to its right.
    pub pillars: Vec<Pillar>,
    /// Height of each.
    pub heights: Vec<f64>,
    /// Index: view.
    pub adjustments: Vec<Adjustment>,
    pub worth: Vec<Worth>,
    /// Convex sight regions of the start, one polygon a view (millimetres); empty if the search had to begin without.
    pub regions: Vec<Vec<DVec2>>,
    /// From the start to the layout chosen, rising `tries`: the first and the last are what `before` and `after` show.
    pub frames: Vec<Frame>,
    /// Rising tolerance.
    pub trade: Vec<Trade>,
    pub tries: u64,
    pub ended: Ended,
    /// What was done to given pillars; only when a layout is mended.
    pub changes: Vec<Change>,
}
