//! What is wanted of a layout: region, pillars allowed, what matters.

use crate::geom::{Circle, contains, inscribed, to_segment};
use crate::horizon::{Footprint, Obstacle};
use crate::support::Layer;
use glam::{DMat4, DQuat, DVec2, DVec3};

/// A cross-section that pillars of the layout may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Around the origin, counter-clockwise, millimetres.
    pub profile: Vec<DVec2>,
    /// It stands for a circle.
    pub round: bool,
    /// Largest distance of the profile from the origin, millimetres.
    pub reach: f64,
    /// Lowest and highest top, millimetres above the base.
    pub heights: [f64; 2],
    pub layer: Layer,
    /// As scenes write it, at this size: `Round(radius: 4)`. For writing layouts down; the planner does not look at it.
    pub written: String,
}

impl Shape {
    /// A pillar of this shape at a place, for the horizon. Round ones are circles, whatever polygon they are printed as: a layout is
    /// worth the same from all sides, and nothing of it depends on where corners happen to lie.
    pub fn obstacle(&self, at: DVec2) -> Obstacle<'_> {
        let footprint = if self.round {
            Footprint::Disc { radius: self.reach }
        } else {
            Footprint::Polygon {
                corners: &self.profile,
                inside: DVec2::ZERO,
            }
        };
        Obstacle { at, footprint }
    }
}

/// A pillar of a layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pillar {
    pub at: DVec2,
    /// Index of its shape.
    pub shape: usize,
    /// Index of the view that it is for; none if no view sees it yet.
    pub owner: Option<usize>,
    /// Stays where it is.
    pub fixed: bool,
    /// Its index among the brief's given pillars, if it is one of them.
    pub given: Option<usize>,
}

/// A place rounded as it is written.
pub(crate) fn rounded(at: DVec2) -> DVec2 {
    (at * 1e3).round() / 1e3
}

/// What matters, as weights on a layout's score.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matters {
    pub camouflage: f64,
    pub tolerance: f64,
    pub pillars: f64,
    pub spread: f64,
}

/// How far the models of a view may be changed, to either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Turned about the vertical through their middle, radians.
    pub turn: f64,
    /// Largest factor on their size, at least 1; the smallest is its inverse.
    pub scale: f64,
    /// Shifted level, millimetres.
    pub shift: f64,
}

impl Freedom {
    /// Models stay as they are placed.
    pub const NONE: Self = Self {
        turn: 0.0,
        scale: 1.0,
        shift: 0.0,
    };
}

/// How the models of one view are changed: turned and scaled about the middle of their underside, then shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjustment {
    /// Radians, counter-clockwise from above.
    pub turn: f64,
    pub scale: f64,
    /// Millimetres.
    pub shift: DVec2,
}

impl Adjustment {
    pub const NONE: Self = Self {
        turn: 0.0,
        scale: 1.0,
        shift: DVec2::ZERO,
    };

    /// The change as a matrix, for models whose underside has its middle at `foot`.
    pub fn matrix(&self, foot: DVec3) -> DMat4 {
        DMat4::from_translation(foot + self.shift.extend(0.0))
            * DMat4::from_scale_rotation_translation(
                DVec3::splat(self.scale),
                DQuat::from_rotation_z(self.turn),
                DVec3::ZERO,
            )
            * DMat4::from_translation(-foot)
    }
}

/// How much is kept in hand beyond what a build cannot do without, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Care {
    /// By how much the farther pillar reaches behind the nearer one at a cut, and beyond a model's outline.
    pub overlap: f64,
    /// Narrowest strip of relief.
    pub narrowest: f64,
    /// What stays of a pillar behind a nearer one beside its carved part is a fin: none has a width between these, at which it would
    /// not print. Narrower ones are too small to matter.
    pub fins: [f64; 2],
    /// Room between a relief, wherever it lies in its layer, and solids other than its pillar.
    pub reliefs: f64,
    /// What cuts may leave beside contours.
    pub plates: Plates,
}

/// What of a relief stands between a cut and an upright contour of the models: a plate along the sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plates {
    /// Thinner ones are not made, millimetres.
    pub thinnest: f64,
    /// But smaller ones are not missed, square millimetres.
    pub missed: f64,
}

impl Plates {
    /// All may be as thin as they are.
    pub const ANY: Self = Self {
        thinnest: 0.0,
        missed: 0.0,
    };
}

impl Care {
    /// For layouts found, made with lines of this width that leave these plates: polygons inside their circles and rounding to printable
    /// coordinates take a hundredth of the overlap, and strips are as wide as three lines.
    pub fn found(line: f64, plates: Plates) -> Self {
        Self {
            overlap: 0.25,
            narrowest: 3.0 * line,
            fins: [1.05 * line, 4.5 * line],
            reliefs: 0.5,
            plates,
        }
    }

    /// For layouts made by hand: what a build can just do with. Reliefs of neighbours may meet in a cut.
    pub fn given(plates: Plates) -> Self {
        Self {
            overlap: 0.02,
            narrowest: 0.4,
            fins: [0.0, 0.0],
            reliefs: 0.0,
            plates,
        }
    }
}

/// Ground on which pillars may stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    outline: Vec<DVec2>,
    /// A circle inside, as large as can be: most places are found to lie inside by it alone.
    inner: Circle,
}

/// To this many millimetres the inner circle is as large as can be.
const INNER_MM: f64 = 1.0;

impl Region {
    /// The region inside a simple polygon, counter-clockwise.
    pub fn new(outline: Vec<DVec2>) -> Self {
        let n = outline.len();
        let sides: Vec<[DVec2; 2]> = (0..n).map(|i| [outline[i], outline[(i + 1) % n]]).collect();
        let inner = inscribed(&sides, INNER_MM, f64::INFINITY).unwrap_or(Circle {
            centre: DVec2::ZERO,
            radius: 0.0,
        });
        Self { outline, inner }
    }

    pub fn outline(&self) -> &[DVec2] {
        &self.outline
    }

    pub fn middle(&self) -> DVec2 {
        self.inner.centre
    }

    /// Lower and upper corner of its box.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let far = DVec2::splat(f64::INFINITY);
        self.outline
            .iter()
            .fold((far, -far), |(l, h), p| (l.min(*p), h.max(*p)))
    }

    pub fn contains(&self, p: DVec2) -> bool {
        self.is_deep(p, 0.0) || contains(&self.outline, p)
    }

    fn is_deep(&self, at: DVec2, reach: f64) -> bool {
        let room = self.inner.radius - reach;
        room >= 0.0 && at.distance_squared(self.inner.centre) <= room * room
    }

    /// Distance of a point from the outline, millimetres.
    pub fn to_outline(&self, p: DVec2) -> f64 {
        let n = self.outline.len();
        let sides = (0..n).map(|i| to_segment(p, self.outline[i], self.outline[(i + 1) % n]));
        sides.fold(f64::INFINITY, f64::min)
    }

    /// How far the circle of radius `reach` around `at` sticks out, millimetres; 0 if it does not.
    pub fn outside(&self, at: DVec2, reach: f64) -> f64 {
        if self.is_deep(at, reach) {
            return 0.0;
        }
        let distance = self.to_outline(at);
        let inside = if contains(&self.outline, at) {
            distance
        } else {
            -distance
        };
        (reach - inside).max(0.0)
    }

    /// The region scaled about its middle.
    pub fn scaled(&self, factor: f64) -> Self {
        let middle = self.middle();
        Self::new(
            self.outline
                .iter()
                .map(|p| middle + factor * (*p - middle))
                .collect(),
        )
    }
}

/// What a layout is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Brief {
    /// Bodies of pillars stay inside.
    pub region: Region,
    /// Allowed shapes first, then those of fixed pillars only.
    pub shapes: Vec<Shape>,
    /// How many of `shapes` new pillars may have.
    pub allowed: usize,
    /// Room between any two pillars, millimetres.
    pub gap: f64,
    pub care: Care,
    /// Fewest and most pillars, fixed ones included.
    pub count: [usize; 2],
    /// Pillars to keep (`fixed`), or to begin with when a layout is mended.
    pub given: Vec<Pillar>,
    pub seed: u64,
    /// Candidate layouts to try, over all chains.
    pub tries: u64,
    /// Wall-clock seconds that the user grants; the planner itself has no clock and only looks at [`Watch::stop`](super::Watch).
    pub seconds: f64,
    /// How far off, in degrees, the models are to be hidden.
    pub hidden_from_deg: f64,
    pub matters: Matters,
    /// Least eye tolerance of every view, millimetres.
    pub tolerance_mm: Vec<f64>,
    pub freedom: Freedom,
}
