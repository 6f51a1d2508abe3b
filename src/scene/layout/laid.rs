//! From a plan to what scenes hold: a layout file's text, and the scene with its pillars.
//!
//! Both come from the same rounded numbers, so that the file reads back as the very pillars of the scene.

use super::auto::layer_as_written;
use crate::diag::escaped;
use crate::planner::{Adjustment, Pillar, Planned, Shape};
use crate::scene::checks::Slab;
use crate::scene::defaults;
use crate::scene::models::placing;
use crate::scene::resolved::Scene;
use crate::scene::supports::cross_section::{point, rounded};
use crate::scene::supports::pillars::{Row, Supports, UNNAMED};
use crate::scene::supports::places::Spot;
use crate::support::{Datum, Support, SupportKind};
use glam::DVec2;
use std::fmt::Write;

/// Pillars of one name, shape and height.
struct Group<'a> {
    name: &'a str,
    shape: &'a Shape,
    height: f64,
    fixed: bool,
    spots: Vec<Spot>,
}

/// The scene with the pillars of a plan of its brief, and its models changed as the plan wants: complete, as if it included the
/// layout file. Fixed pillars keep their names; those found are called after their views.
pub fn laid_out(scene: &Scene, planned: &Planned) -> Scene {
    let groups = groups(scene, planned);
    let mut supports = Supports::of(groups.iter().map(|group| Row {
        name: group.name,
        outline: &group.shape.profile,
        round: group.shape.round,
        height: group.height,
        layer: layer_as_written(group.shape.layer),
        spots: &group.spots,
    }));
    supports.base = scene.supports.iter().find_map(slab);
    let mut laid = scene.clone();
    for (view, adjustment) in laid.views.iter_mut().zip(&planned.adjustments) {
        placing::adjust(&mut view.models, &tidy(adjustment, PLANNED_DECIMALS));
    }
    Scene {
        supports: supports.solids(),
        brief: None,
        adjusted: adjustments(scene, planned),
        ..laid
    }
}

/// The layout file of a plan of the scene's brief.
pub fn layout_text(scene: &Scene, planned: &Planned) -> String {
    let groups = groups(scene, planned);
    let mut out = head(scene, planned);
    out.push_str("(\n    units: mm,\n    pillars: [\n");
    for group in &groups {
        out.push_str(&entry(group));
    }
    out.push_str("    ],\n");
    let adjusted = adjustments(scene, planned);
    if adjusted.iter().any(|a| *a != Adjustment::NONE) {
        out.push_str("    adjust: [\n");
        let views = scene.views.iter().zip(&adjusted);
        for (view, a) in views.filter(|(_, a)| **a != Adjustment::NONE) {
            let (turn, shift) = (
                rounded(a.turn.to_degrees(), KEPT_DECIMALS[0]),
                point(&a.shift),
            );
            // Writing to a String cannot fail.
            let _ = writeln!(
                out,
                "        (view: {:?}, turn: {turn}, scale: {}, shift: {shift}),",
                view.name, a.scale
            );
        }
        out.push_str("    ],\n");
    }
    out.push_str(")\n");
    out
}

fn head(scene: &Scene, planned: &Planned) -> String {
    let title = escaped(&scene.title);
    let (pillars, views) = (planned.pillars.len(), scene.views.len());
    let made = match &scene.brief {
        Some(brief) if planned.changes.is_empty() => {
            format!("found with seed {} in {} tries", brief.seed, planned.tries)
        }
        _ => format!("mended by {} changes", planned.changes.len()),
    };
    format!(
        "\
// A layout of \"{title}\" (views: {views}, pillars: {pillars}), {made}.
// A scene takes it up with   pillars: File(\"layout.ron\")   by its path from the scene's folder.
// Entries are as in scenes and may be edited; `pillarforest check` tells what then is wrong, `pillarforest repair` mends it.
"
    )
}

fn entry(group: &Group) -> String {
    let layer = layer_as_written(group.shape.layer);
    let from = match layer.datum() {
        Datum::Plane => "Axis",
        Datum::Surface => "Surface",
    };
    let place = |s: &Spot| point(&s.at);
    let lines: Vec<String> = group
        .spots
        .chunks(5)
        .map(|row| row.iter().map(place).collect::<Vec<_>>().join(", "))
        .collect();
    let name = match group.name {
        UNNAMED => String::new(),
        name => format!("            name: {name:?},\n"),
    };
    let remark = if group.fixed { "  // fixed" } else { "" };
    format!(
        "        ({remark}\n{name}            shape: {},\n            height: {},\n            depth: (from: {from}, front: {}, back: {}, core: {}),\n            places: At([\n                {},\n            ]),\n        ),\n",
        group.shape.written,
        group.height,
        layer.front,
        layer.back(),
        layer.core,
        lines.join(",\n                ")
    )
}

/// A plan's pillars in the order in which files and scenes number them: fixed ones in their order, then those of every view, then
/// those that nobody sees.
fn groups<'a>(scene: &'a Scene, planned: &Planned) -> Vec<Group<'a>> {
    let Some(brief) = &scene.brief else {
        return Vec::new();
    };
    let given = scene.supports.iter().zip(&brief.given);
    let mut fixed_names = given.filter(|(_, g)| g.fixed).map(|(s, _)| stem(&s.name));
    let mut fixed: Vec<Group> = Vec::new();
    let mut found: Vec<(usize, Group)> = Vec::new();
    for (pillar, height) in planned.pillars.iter().zip(&planned.heights) {
        let Some(shape) = brief.shapes.get(pillar.shape) else {
            continue;
        };
        let view = pillar.owner.and_then(|v| Some((v, scene.views.get(v)?)));
        if pillar.fixed {
            let fresh = Group::new(
                fixed_names.next().unwrap_or(UNNAMED),
                shape,
                pillar,
                *height,
            );
            // They only join the last group: their order gives their numbers.
            match fixed.last_mut().filter(|g| g.is_like(&fresh)) {
                Some(last) => last.spots.extend(fresh.spots),
                None => fixed.push(fresh),
            }
        } else {
            let (order, name) = view.map_or((usize::MAX, UNNAMED), |(v, view)| (v, &view.name));
            let fresh = Group::new(name, shape, pillar, *height);
            match found
                .iter_mut()
                .find(|(o, g)| *o == order && g.is_like(&fresh))
            {
                Some((_, known)) => known.spots.extend(fresh.spots),
                None => found.push((order, fresh)),
            }
        }
    }
    found.sort_by_key(|(order, _)| *order);
    fixed.extend(found.into_iter().map(|(_, group)| group));
    fixed
}

impl<'a> Group<'a> {
    /// A group of one pillar, its numbers rounded.
    fn new(name: &'a str, shape: &'a Shape, pillar: &Pillar, height: f64) -> Self {
        let place = |v| rounded(v, defaults::PLACE_DECIMALS);
        let at = pillar.at.to_array().map(place).into();
        Self {
            name,
            shape,
            height: place(height),
            fixed: pillar.fixed,
            spots: vec![Spot { at, span: 0..0 }],
        }
    }

    fn is_like(&self, other: &Self) -> bool {
        self.name == other.name
            && std::ptr::eq(self.shape, other.shape)
            && self.height == other.height
    }
}

/// The name of the entry that a pillar came from: without its number.
fn stem(name: &str) -> &str {
    name.rsplit_once('-').map_or(UNNAMED, |(stem, _)| stem)
}

fn slab(support: &Support) -> Option<Slab> {
    match &support.kind {
        SupportKind::Base {
            outline, bottom, ..
        } => Some(Slab {
            outline: outline.clone(),
            thickness: -bottom,
            span: None,
        }),
        SupportKind::Pillar { .. } | SupportKind::Body { .. } => None,
    }
}

/// Decimals of degrees, factors and millimetres in adjustments that a plan makes: a model's far side moves by less than a
/// micrometre or two.
const PLANNED_DECIMALS: [i32; 3] = [3, 5, 3];
/// Those of one that a file gave: as many as survive the way to radians and back.
const KEPT_DECIMALS: [i32; 3] = [defaults::LENGTH_DECIMALS; 3];

fn tidy(a: &Adjustment, [turn, scale, shift]: [i32; 3]) -> Adjustment {
    Adjustment {
        turn: rounded(a.turn.to_degrees(), turn).to_radians(),
        scale: rounded(a.scale, scale),
        shift: DVec2::from(a.shift.to_array().map(|v| rounded(v, shift))),
    }
}

/// What a plan makes of the models of every view. A layout file is mended without turning models once more: one of the two
/// adjustments is none.
fn adjustments(scene: &Scene, planned: &Planned) -> Vec<Adjustment> {
    let both = scene.adjusted.iter().zip(&planned.adjustments);
    let one = |(kept, planned): (&Adjustment, &Adjustment)| {
        if *planned == Adjustment::NONE {
            tidy(kept, KEPT_DECIMALS)
        } else {
            tidy(planned, PLANNED_DECIMALS)
        }
    };
    both.map(one).collect()
}
