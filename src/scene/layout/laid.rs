//! From a plan to what scenes hold: a layout file's text, and the scene with its pillars.
//!
//! Both come from the same rounded numbers, so that the file reads back as the very pillars of the scene.

use super::written::{layer_as_written, rounded};
use crate::diag::escaped;
use crate::planner::{Adjustment, Pillar, Planned, Shape};
use crate::scene::defaults;
use crate::scene::models::placing;
use crate::scene::resolved::Scene;
use crate::scene::supports::cross_section::point;
use crate::scene::supports::pillars::{Batch, Colonnade, UNNAMED};
use crate::scene::supports::{BasePlate, Spot};
use crate::support::{Datum, Support, SupportKind};
use glam::DVec2;
use std::fmt::Write;

/// An entry of a layout file: pillars of one name, shape and height.
struct LayoutEntry<'a> {
    name: &'a str,
    shape: &'a Shape,
    height: f64,
    fixed: bool,
    spots: Vec<Spot>,
}

/// The scene with the pillars of a plan of its brief, and its models changed as the plan wants: complete, as if it included the
/// layout file. Fixed pillars keep their names; those found are called after their views.
pub fn laid_out(scene: &Scene, planned: &Planned) -> Scene {
    let entries = entries(scene, planned);
    let mut supports = Colonnade::of(entries.iter().map(|entry| Batch {
        name: entry.name,
        outline: &entry.shape.profile,
        round: entry.shape.round,
        height: entry.height,
        layer: layer_as_written(entry.shape.layer),
        spots: &entry.spots,
    }));
    supports.base = scene.supports.iter().find_map(base);
    let mut laid = scene.clone();
    for (view, adjustment) in laid.views.iter_mut().zip(&planned.adjustments) {
        placing::adjust(&mut view.models, &rounded_to(adjustment, PLANNED_DECIMALS));
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
    let entries = entries(scene, planned);
    let mut out = head(scene, planned);
    out.push_str("(\n    units: mm,\n    pillars: [\n");
    for entry in &entries {
        out.push_str(&entry_text(entry));
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

fn entry_text(entry: &LayoutEntry) -> String {
    let layer = layer_as_written(entry.shape.layer);
    let from = match layer.datum() {
        Datum::Plane => "Axis",
        Datum::Surface => "Surface",
    };
    let place = |s: &Spot| point(&s.at);
    let lines: Vec<String> = entry
        .spots
        .chunks(5)
        .map(|row| row.iter().map(place).collect::<Vec<_>>().join(", "))
        .collect();
    let name = match entry.name {
        UNNAMED => String::new(),
        name => format!("            name: {name:?},\n"),
    };
    let remark = if entry.fixed { "  // fixed" } else { "" };
    format!(
        "        ({remark}\n{name}            shape: {},\n            height: {},\n            depth: (from: {from}, front: {}, back: {}, core: {}),\n            places: At([\n                {},\n            ]),\n        ),\n",
        entry.shape.written,
        entry.height,
        layer.front,
        layer.back(),
        layer.core,
        lines.join(",\n                ")
    )
}

/// A plan's pillars in the order in which files and scenes number them: fixed ones in their order, then those of every view, then
/// those that nobody sees.
fn entries<'a>(scene: &'a Scene, planned: &Planned) -> Vec<LayoutEntry<'a>> {
    let Some(brief) = &scene.brief else {
        return Vec::new();
    };
    let given = scene.supports.iter().zip(&brief.given);
    let mut fixed_names = given.filter(|(_, g)| g.fixed).map(|(s, _)| stem(&s.name));
    let mut fixed: Vec<LayoutEntry> = Vec::new();
    let mut found: Vec<(usize, LayoutEntry)> = Vec::new();
    for (pillar, height) in planned.pillars.iter().zip(&planned.heights) {
        let Some(shape) = brief.shapes.get(pillar.shape) else {
            continue;
        };
        let view = pillar.owner.and_then(|v| Some((v, scene.views.get(v)?)));
        if pillar.fixed {
            let fresh = LayoutEntry::new(
                fixed_names.next().unwrap_or(UNNAMED),
                shape,
                pillar,
                *height,
            );
            // They only join the last entry: their order gives their numbers.
            match fixed.last_mut().filter(|g| g.is_like(&fresh)) {
                Some(last) => last.spots.extend(fresh.spots),
                None => fixed.push(fresh),
            }
        } else {
            let (order, name) = view.map_or((usize::MAX, UNNAMED), |(v, view)| (v, &view.name));
            let fresh = LayoutEntry::new(name, shape, pillar, *height);
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
    fixed.extend(found.into_iter().map(|(_, entry)| entry));
    fixed
}

impl<'a> LayoutEntry<'a> {
    /// An entry of one pillar, its numbers rounded.
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

fn base(support: &Support) -> Option<BasePlate> {
    match &support.kind {
        SupportKind::Base {
            outline, bottom, ..
        } => Some(BasePlate {
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

fn rounded_to(a: &Adjustment, [turn, scale, shift]: [i32; 3]) -> Adjustment {
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
            rounded_to(kept, KEPT_DECIMALS)
        } else {
            rounded_to(planned, PLANNED_DECIMALS)
        }
    };
    both.map(one).collect()
}
