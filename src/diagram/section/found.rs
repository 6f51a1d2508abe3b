//! Cuts a view open.

use super::plane::SectionPlane;
use super::slice::slice;
use super::values::{CutGroup, Laid, Section, Stretch};
use crate::groups::anchor;
use crate::index::{CellId, GroupId, SupportId};
use crate::mesh::TriMesh;
use crate::mimic::Depths;
use crate::relief::Relief;
use crate::sight::Sight;
use crate::steps::Torn;
use crate::support::SupportKind;
use crate::viewmap::ViewMap;
use glam::DVec2;

/// Lines tried in each direction. With 16 a row of the creatures' small groups is missed now and then; the time grows with them.
const LINES: usize = 48;

/// A group counts as cut if its cut is at least this share of the width of all that is seen: narrower ones could not be drawn.
const LEAST_SHARE: f64 = 0.01;

/// Cuts a view open whose surface is in one piece.
pub fn section(sight: &Sight, depths: &Depths, relief: &Relief) -> Section {
    let model = &sight.image.target.mesh;
    cut_open(sight, depths, relief, model)
}

/// Cuts a view open whose surface was torn; `model` is the mesh that it was before.
pub fn torn_section(torn: &Torn, relief: &Relief, model: &TriMesh) -> Section {
    Section {
        torn: true,
        ..cut_open(&torn.sight, &torn.depths, relief, model)
    }
}

fn cut_open(sight: &Sight, depths: &Depths, relief: &Relief, model: &TriMesh) -> Section {
    let Sight { image, groups, .. } = sight;
    let (map, field) = (&image.map, image.field);
    let cut = chosen(sight);
    let crossed = CellId::all(map.cells.len()).filter_map(|c| Some((c, crossing(map, &cut, c)?)));
    let mut found: Vec<(Option<GroupId>, Stretch)> = crossed
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
            let support = groups.groups[id].support;
            cut_groups.push(CutGroup {
                group: id,
                mu: depths.mu[id],
                support: field.supports[support].name.clone(),
                width: 0.0,
            });
        }
        cut_groups[laid.group].width += stretch.x[1] - stretch.x[0];
    }
    let carries = |s: SupportId| (cut_groups.iter()).any(|g| groups.groups[g.group].support == s);
    let supports = SupportId::all(field.supports.len()).zip(field.supports);
    let supports = supports.filter(|(_, s)| !matches!(s.kind, SupportKind::Base { .. }));
    Section {
        supports: supports
            .flat_map(|(k, s)| slice(&s.mesh, &cut).into_iter().map(move |o| (o, k)))
            .map(|(outline, k)| (outline, carries(k)))
            .collect(),
        model: slice(model, &cut),
        cut,
        stretches: found.into_iter().map(|f| f.1).collect(),
        groups: cut_groups,
        of: groups.groups.len(),
        torn: false,
    }
}

/// The line that cuts most groups.
fn chosen(sight: &Sight) -> SectionPlane {
    let cut = |upright: bool, offset: f64| SectionPlane {
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
fn best_line(sight: &Sight, cut: impl Fn(f64) -> SectionPlane) -> (f64, usize) {
    let (map, groups) = (&sight.image.map, &sight.groups);
    let (along, across) = cut(0.0).axes();
    let shown: Vec<CellId> = CellId::all(map.cells.len())
        .filter(|c| groups.of_cell[*c].is_some())
        .collect();
    let span = |cells: &[CellId], axis: DVec2| {
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
        let group = groups.of_cell[c].map_or(0, GroupId::at);
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
fn crossing(map: &ViewMap, cut: &SectionPlane, cell: CellId) -> Option<[End; 2]> {
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
    fn new(sight: &Sight, depths: &Depths, relief: &Relief, c: CellId) -> Option<Self> {
        let Sight { image, groups, .. } = sight;
        let (map, target) = (&image.map, &image.target);
        let cell = &map.cells[c];
        let face = cell.face?;
        let at = map.triangle(c).map(|q| anchor(target, face, q));
        let layer = || {
            let support = groups.of_cell[c].and(cell.support)?;
            let slab = groups.slabs[support]?;
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
