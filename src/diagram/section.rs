//! Sections: how groups are scaled, cut open along one plane through the eye (paper Fig 8).
//!
//! Takes what the stages of a view give (of a torn surface: its own target, map, groups and depths), gives the numbers of a section
//! and, by [`sheet`](mod@sheet), a page with three panels. Nothing is drawn but these numbers.
//!
//! # The plane
//!
//! A plane through the eye is a line of its image: its rays lie in it, and over one cell of the view map every depth is a straight
//! line in it, so that both ends of a cell's stretch say all. The line is level or upright and lies where most groups are cut: of
//! [`LINES`] level ones the one that cuts most, of equals the one that cuts most of them; an upright one if it cuts
//! more groups (on stairs, whose treads are level). Groups count from [`LEAST_SHARE`] of the width on.
//!
//! Places in the plane are `(x, y)` in millimetres with the eye in the origin: `x` to the right (of an upright section: up), `y` away
//! from the eye.

mod chains;
mod labels;
mod sheet;
mod slice;
mod window;

pub use sheet::groups_sheet;
pub use slice::Outline;

use crate::geom::ImagePlane;
use crate::groups::anchor;
use crate::mesh::TriMesh;
use crate::mimic::Depths;
use crate::relief::Relief;
use crate::sight::Sight;
use crate::support::SupportKind;
use crate::viewmap::ViewMap;
use glam::{DVec2, DVec3};

/// Lines tried in each direction. With 16 a row of the creatures' small groups is missed now and then; the time grows with them.
const LINES: usize = 48;

/// A group counts as cut if its cut is at least this share of the width of all that is seen: narrower ones could not be drawn.
const LEAST_SHARE: f64 = 0.01;

/// A plane through the eye.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    pub plane: ImagePlane,
    pub upright: bool,
    /// Where its line crosses the image's other axis.
    pub offset: f64,
}

impl Cut {
    /// Along the line, and across it.
    fn axes(&self) -> (DVec2, DVec2) {
        if self.upright {
            (DVec2::Y, DVec2::X)
        } else {
            (DVec2::X, DVec2::Y)
        }
    }

    /// The image point of the line at `x`.
    pub fn ray(&self, x: f64) -> DVec2 {
        let (along, across) = self.axes();
        x * along + self.offset * across
    }

    /// The place in the section of the point at depth `z` on the ray at `x`.
    pub fn place(&self, x: f64, z: f64) -> DVec2 {
        z * DVec2::new(x, (1.0 + self.offset * self.offset).sqrt())
    }

    /// Unit vectors of the section's axes in space.
    pub fn frame(&self) -> (DVec3, DVec3) {
        let (along, _) = self.axes();
        let sideways = along.x * self.plane.right + along.y * self.plane.up;
        (sideways, self.plane.direction(self.ray(0.0)).normalize())
    }
}

/// What the section cuts of one cell that shows the model: values at both its ends, depths along the image's forward axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Rising.
    pub x: [f64; 2],
    /// Of the model, and of the optimised surface before it is cut (it need not lie near any support where none carries it).
    pub model: [f64; 2],
    pub surface: [f64; 2],
    pub laid: Option<Laid>,
}

/// Where a group carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laid {
    /// Into [`Section::groups`].
    pub group: usize,
    /// Bounds of the layer: `mu near <= surface <= mu far`, to within what the relief was clamped by.
    pub near: [f64; 2],
    pub far: [f64; 2],
    /// Of the finished relief: `surface / mu`, clamped.
    pub relief: [f64; 2],
}

/// A group that is cut.
#[derive(Clone, Debug, PartialEq)]
pub struct CutGroup {
    /// Of the view's groups.
    pub group: u32,
    pub mu: f64,
    /// Name of its support.
    pub support: String,
    /// Length of its cut in the image.
    pub width: f64,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Section {
    pub cut: Cut,
    /// By rising `x`.
    pub stretches: Vec<Stretch>,
    /// In order of appearance.
    pub groups: Vec<CutGroup>,
    /// How many groups the view has.
    pub of: usize,
    /// Whether the surface was torn: then every `mu` is 1.
    pub torn: bool,
    /// Outlines of supports (bases are left out), and whether one carries a group that is cut.
    pub supports: Vec<(Outline, bool)>,
    pub model: Vec<Outline>,
}

/// Cuts a view open. `torn` says whether its surface may be; `model` is the mesh that it was before.
pub fn section(
    sight: &Sight,
    depths: &Depths,
    relief: &Relief,
    (model, torn): (&TriMesh, bool),
) -> Section {
    let Sight { image, groups, .. } = sight;
    let (map, field) = (&image.map, image.field);
    let cut = chosen(sight);
    let crossed = (0..map.cells.len()).filter_map(|c| Some((c, crossing(map, &cut, c)?)));
    let mut found: Vec<(Option<u32>, Stretch)> = crossed
        .filter_map(|(c, ends)| {
            let values = Corners::new(sight, depths, relief, c)?;
            Some((groups.of_cell[c], values.stretch(ends)))
        })
        .collect();
    found.sort_by(|(_, a), (_, b)| a.x[0].total_cmp(&b.x[0]));
    let mut cut_groups: Vec<CutGroup> = Vec::new();
    for (group, stretch) in &mut found {
        let (Some(laid), Some(id)) = (&mut stretch.laid, *group) else {
            continue;
        };
        let known = cut_groups.iter().position(|g| g.group == id);
        laid.group = known.unwrap_or(cut_groups.len());
        if known.is_none() {
            let support = groups.groups[id as usize].support as usize;
            cut_groups.push(CutGroup {
                group: id,
                mu: depths.mu[id as usize],
                support: field.supports[support].name.clone(),
                width: 0.0,
            });
        }
        cut_groups[laid.group].width += stretch.x[1] - stretch.x[0];
    }
    let carries = |s: usize| {
        (cut_groups.iter()).any(|g| groups.groups[g.group as usize].support as usize == s)
    };
    let supports = field.supports.iter().enumerate();
    let supports = supports.filter(|(_, s)| !matches!(s.kind, SupportKind::Base { .. }));
    Section {
        supports: supports
            .flat_map(|(k, s)| slice::slice(&s.mesh, &cut).into_iter().map(move |o| (o, k)))
            .map(|(outline, k)| (outline, carries(k)))
            .collect(),
        model: slice::slice(model, &cut),
        cut,
        stretches: found.into_iter().map(|f| f.1).collect(),
        groups: cut_groups,
        of: groups.groups.len(),
        torn,
    }
}

/// The line that cuts most groups.
fn chosen(sight: &Sight) -> Cut {
    let cut = |upright: bool, offset: f64| Cut {
        plane: sight.image.map.plane,
        upright,
        offset,
    };
    let [level, upright] = [false, true].map(|upright| {
        let (best, count) = best_line(sight, |offset| cut(upright, offset));
        (cut(upright, best), count)
    });
    if upright.1 > level.1 {
        upright.0
    } else {
        level.0
    }
}

/// The best line of one direction and how many groups it cuts.
fn best_line(sight: &Sight, cut: impl Fn(f64) -> Cut) -> (f64, usize) {
    let (map, groups) = (&sight.image.map, &sight.groups);
    let (along, across) = cut(0.0).axes();
    let shown: Vec<usize> = (0..map.cells.len())
        .filter(|c| groups.of_cell[*c].is_some())
        .collect();
    let span = |cells: &[usize], axis: DVec2| {
        let points = cells.iter().flat_map(|c| map.triangle(*c));
        points.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), q| {
            (lo.min(q.dot(axis)), hi.max(q.dot(axis)))
        })
    };
    let (lo, hi) = span(&shown, across);
    let wide = span(&shown, along);
    let step = (hi - lo) / LINES as f64;
    if step.is_nan() || step <= 0.0 {
        return (0.0, 0);
    }
    let line = |k: usize| lo + (k as f64 + 0.5) * step;
    let mut widths = vec![vec![0.0; groups.groups.len()]; LINES];
    for c in shown {
        let (low, high) = span(&[c], across);
        let first = ((low - lo) / step - 0.5).floor().max(0.0) as usize;
        let group = groups.of_cell[c].unwrap_or_default() as usize;
        for k in (first..LINES).take_while(|k| line(*k) <= high) {
            if let Some([a, b]) = crossing(map, &cut(line(k)), c) {
                widths[k][group] += b.x - a.x;
            }
        }
    }
    let least = LEAST_SHARE * (wide.1 - wide.0);
    let count = |k: usize| widths[k].iter().filter(|w| **w >= least).count();
    let total = |k: usize| widths[k].iter().sum::<f64>();
    let best = (0..LINES).max_by(|a, b| {
        let by_width = || total(*a).total_cmp(&total(*b));
        count(*a).cmp(&count(*b)).then_with(by_width)
    });
    best.map_or((0.0, 0), |k| (line(k), count(k)))
}

/// An end of a cell's stretch: on the side from corner `side` to the next one, at the share `t`.
#[derive(Clone, Copy)]
struct End {
    x: f64,
    side: usize,
    t: f64,
}

/// Both ends of what a line cuts of a cell, by rising `x`; none if it misses the cell or just touches it.
fn crossing(map: &ViewMap, cut: &Cut, cell: usize) -> Option<[End; 2]> {
    let (along, across) = cut.axes();
    let corners = map.triangle(cell);
    let height = corners.map(|q| q.dot(across) - cut.offset);
    let mut ends = (0..3).filter_map(|side| {
        let next = (side + 1) % 3;
        let (a, b) = (height[side], height[next]);
        ((a >= 0.0) != (b >= 0.0)).then(|| {
            let t = a / (a - b);
            let x = corners[side].lerp(corners[next], t).dot(along);
            End { x, side, t }
        })
    });
    let (a, b) = (ends.next()?, ends.next()?);
    let [first, last] = if a.x <= b.x { [a, b] } else { [b, a] };
    (last.x > first.x).then_some([first, last])
}

/// Depths at a cell's corners.
struct Corners {
    model: [f64; 3],
    surface: [f64; 3],
    /// Near, far, relief.
    laid: Option<[[f64; 3]; 3]>,
}

impl Corners {
    /// `None` if the cell does not show the model.
    fn new(sight: &Sight, depths: &Depths, relief: &Relief, c: usize) -> Option<Self> {
        let Sight { image, groups, .. } = sight;
        let (map, target) = (&image.map, &image.target);
        let cell = &map.cells[c];
        let face = cell.face? as usize;
        let at = map.triangle(c).map(|q| anchor(target, face, q));
        let layer = || {
            let support = groups.of_cell[c].and(cell.support)?;
            let slab = groups.slabs[support as usize]?;
            let bounds = [0, 1, 2].map(|k| image.layer_in(&slab, c, k));
            Some([bounds.map(|b| b.0), bounds.map(|b| b.1), relief.depth[c]?])
        };
        Some(Self {
            model: at.map(|(_, depth)| depth),
            surface: at.map(|(anchor, depth)| depth * anchor.relative_depth(&depths.s)),
            laid: layer(),
        })
    }

    /// The inverse of a depth is affine over a cell, so between two corners too.
    fn stretch(&self, ends: [End; 2]) -> Stretch {
        let of = |depth: &[f64; 3]| {
            ends.map(|e| {
                let (a, b) = (depth[e.side], depth[(e.side + 1) % 3]);
                1.0 / ((1.0 - e.t) / a + e.t / b)
            })
        };
        Stretch {
            x: ends.map(|e| e.x),
            model: of(&self.model),
            surface: of(&self.surface),
            laid: self.laid.as_ref().map(|[near, far, relief]| Laid {
                group: 0,
                near: of(near),
                far: of(far),
                relief: of(relief),
            }),
        }
    }
}
