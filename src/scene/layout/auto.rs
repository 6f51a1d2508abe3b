//! What is wanted of pillars that are to be found: `Auto(...)`, and lists that are to be mended.

use super::aims::{count, freedom, matters, narrow, range, tolerance};
use super::around::Around;
use super::region::Room;
use super::written::{as_written, rounded};
use crate::certify::printability::MISSED_MM2;
use crate::planner::{Brief, Care, Freedom, Pillar, Plates, Region, Shape};
use crate::scene::defaults;
use crate::scene::language::raw::{RawAuto, RawRange, RawShape};
use crate::scene::resolved::Making;
use crate::scene::supports::Standing;
use crate::scene::supports::cross_section::{CrossSection, cross_section};
use crate::scene::supports::depths::{Wish, settled};
use crate::scene::supports::pillars::{PillarEntry, entries, reach};
use crate::scene::text::{Field, List, Reader, Span};
use crate::support::Layer;
use glam::DVec2;
use std::collections::BTreeMap;

/// Pillars that stay, as they will be written.
pub(crate) fn fixed(reader: &mut Reader, raw: &RawAuto, depth: &Wish) -> Vec<PillarEntry> {
    match reader.given(&raw.fixed) {
        Some((list, _)) => {
            let entries = entries(reader, list, depth);
            entries.into_iter().map(as_written).collect()
        }
        None => Vec::new(),
    }
}

/// The brief of an `Auto` at `span`, and the places of its allowed shapes. Its pillars may stand in `region` besides the `fixed`
/// ones.
pub(crate) fn brief(
    reader: &mut Reader,
    (raw, span): (&RawAuto, &Span),
    region: Vec<DVec2>,
    fixed: &[PillarEntry],
    depth: &Wish,
    around: &Around,
) -> (Brief, Vec<Span>) {
    let (shapes, spans) = allowed(reader, raw, span, depth);
    let gap = reader.length_from(&raw.gap, "gap", 0.0);
    if let Some((gap, span)) = &gap {
        narrow(reader, *gap, span, around.making);
    }
    let tries = reader.count(&raw.tries, "tries", defaults::TRIES_ALLOWED);
    let seconds = reader.within(&raw.seconds, "seconds", defaults::SECONDS_ALLOWED);
    let hidden = reader.within(&raw.hidden_from, "hidden_from", defaults::HIDDEN_ALLOWED);
    let standing = fixed.iter().map(|e| e.spots.len()).sum();
    let mut brief = Brief {
        region: Region::new(region),
        care: Care::found(around.making.line, plates(around.making)),
        allowed: shapes.len(),
        shapes,
        gap: gap.map_or(defaults::GAP, |(v, _)| v),
        count: count(reader, &raw.count, standing),
        given: Vec::new(),
        seed: (reader.count(&raw.seed, "seed", 0..=u32::MAX))
            .map_or(defaults::SEED, |(v, _)| v)
            .into(),
        tries: tries.map_or_else(|| defaults::tries(around.view_count), |(v, _)| v.into()),
        seconds: seconds.map_or(defaults::SECONDS, |(v, _)| v),
        hidden_from_deg: hidden.map_or(defaults::HIDDEN_FROM, |(v, _)| v),
        matters: matters(reader, &raw.matters),
        tolerance_mm: tolerance(reader, &raw.eye_tolerance, around.view_count),
        freedom: freedom(reader, &raw.models),
    };
    give(&mut brief, fixed, true);
    (brief, spans)
}

/// Plates that the check of walls lets pass, with a tenth in hand for what perspective and carving take.
fn plates(making: &Making) -> Plates {
    match making.limits.wall {
        Some(wall) => Plates {
            thinnest: 1.1 * wall.limit,
            missed: MISSED_MM2,
        },
        None => Plates::ANY,
    }
}

/// The brief of a list of pillars that are to be moved as little as can be, in `region`.
pub(crate) fn mending(entries: &[PillarEntry], region: Vec<DVec2>, around: &Around) -> Brief {
    let standing: usize = entries.iter().map(|e| e.spots.len()).sum();
    let mut brief = Brief {
        region: Region::new(region),
        care: Care::given(plates(around.making)),
        shapes: Vec::new(),
        allowed: 0,
        // What is printable as it stands need not move.
        gap: around.making.narrowest_gap(),
        count: [1, (2 * standing).max(defaults::COUNT[1] as usize)],
        given: Vec::new(),
        seed: defaults::SEED.into(),
        tries: defaults::tries(around.view_count),
        seconds: defaults::SECONDS,
        hidden_from_deg: defaults::HIDDEN_FROM,
        matters: defaults::MATTERS,
        tolerance_mm: vec![0.0; around.view_count],
        freedom: Freedom::NONE,
    };
    give(&mut brief, entries, false);
    brief.allowed = brief.shapes.len();
    brief
}

/// Adds the pillars of the entries to the given ones, and their shapes.
fn give(brief: &mut Brief, entries: &[PillarEntry], fixed: bool) {
    let mut known = BTreeMap::<String, usize>::new();
    for entry in entries {
        let (height, layer) = (entry.height, entry.layer);
        let shape = shape(&entry.section, entry.outline.clone(), [height; 2], layer);
        let next = brief.shapes.len();
        let index = *known
            .entry(format!("{} {height} {layer:?}", shape.written))
            .or_insert(next);
        if index == next {
            brief.shapes.push(shape);
        }
        brief.given.extend(entry.spots.iter().map(|spot| Pillar {
            at: spot.at,
            shape: index,
            owner: None,
            fixed,
            given: None,
        }));
    }
}

fn shape(section: &CrossSection, outline: Vec<DVec2>, heights: [f64; 2], layer: Layer) -> Shape {
    Shape {
        reach: reach(&outline),
        profile: outline,
        round: section.is_round(),
        heights,
        layer,
        written: section.written(),
    }
}

/// What the checks want to know of a brief whose region stands at `span`, and its shapes at `spans`.
pub(crate) fn room(brief: &Brief, span: &Span, spans: &[Span]) -> Room {
    let allowed = &brief.shapes[..brief.allowed];
    let sample = |(shape, span): (&Shape, &Span)| Standing {
        name: format!("a pillar with `{}`", shape.written),
        axis: DVec2::ZERO,
        profile: shape.profile.clone(),
        height: shape.heights[1],
        reach: shape.reach,
        round: shape.round,
        span: span.clone(),
    };
    Room {
        region: brief.region.outline().to_vec(),
        tops: allowed.iter().map(|s| s.heights[1]).fold(0.0, f64::max),
        span: span.clone(),
        samples: allowed.iter().zip(spans).map(sample).collect(),
    }
}

/// The shapes that new pillars may have, and their places: every shape at every size.
fn allowed(
    reader: &mut Reader,
    raw: &RawAuto,
    span: &Span,
    depth: &Wish,
) -> (Vec<Shape>, Vec<Span>) {
    let heights = heights(reader, &raw.height);
    let factors = factors(reader, &raw.sizes);
    let (mut allowed, mut spans) = (Vec::<Shape>::new(), Vec::new());
    for (section, span) in sections(reader, &raw.shapes, span) {
        for factor in &factors {
            let section = sized(&section, *factor);
            let outline = match section.outline() {
                Ok(outline) => outline,
                Err(why) => {
                    reader.error(&span, format!("at {factor} times its size {why}"));
                    break;
                }
            };
            let before = reader.problems.len();
            let layer = settled(reader, &outline, section.is_round(), depth, &span);
            let shape = shape(&section, outline, heights, layer);
            if allowed.iter().all(|s| s.written != shape.written) {
                allowed.push(shape);
                spans.push(span.clone());
            }
            // What is too deep for one size is so for the next.
            if reader.problems.len() > before {
                break;
            }
        }
    }
    (allowed, spans)
}

fn sections(
    reader: &mut Reader,
    field: &Field<List<RawShape>>,
    auto: &Span,
) -> Vec<(CrossSection, Span)> {
    let Some((list, span)) = reader.given(field) else {
        let round = CrossSection::Round {
            radius: defaults::PLANNED_RADIUS,
            facets: defaults::ROUND_FACETS,
        };
        return vec![(round, auto.clone())];
    };
    if list.is_empty() || list.len() > defaults::MOST_SHAPES {
        let text = format!(
            "{} shapes; planned pillars have from 1 to {}",
            list.len(),
            defaults::MOST_SHAPES
        );
        reader.error(&span, text);
        return Vec::new();
    }
    let mut sections = Vec::new();
    for item in list {
        let at = reader.span(item);
        let Some(raw) = reader.value(item) else {
            continue;
        };
        sections.extend(cross_section(reader, raw, &at).map(|s| (s, at)));
    }
    sections
}

/// A shape at `factor` of its size.
fn sized(section: &CrossSection, factor: f64) -> CrossSection {
    section.with_lengths(|v| match factor {
        1.0 => rounded(v, defaults::LENGTH_DECIMALS),
        factor => rounded(factor * v, defaults::SIZE_DECIMALS),
    })
}

/// At most [`defaults::SIZES`] factors from the smallest to the largest.
fn factors(reader: &mut Reader, field: &Field<RawRange<f64>>) -> Vec<f64> {
    let Some(([least, most], span)) = range(reader, field, "sizes") else {
        return vec![1.0];
    };
    let allowed = defaults::SIZE_FACTORS;
    if !allowed.contains(&least) || !allowed.contains(&most) {
        let (from, to) = (allowed.start(), allowed.end());
        let text = format!("`sizes` are factors on the shapes' lengths, from {from} to {to}");
        reader.error(&span, text);
        return vec![1.0];
    }
    if least == most {
        return vec![least];
    }
    let last = (defaults::SIZES - 1) as f64;
    let factor = |k: usize| least + (most - least) * k as f64 / last;
    (0..defaults::SIZES).map(factor).collect()
}

fn heights(reader: &mut Reader, field: &Field<RawRange<f64>>) -> [f64; 2] {
    let Some((heights, span)) = range(reader, field, "height") else {
        return [defaults::PILLAR_HEIGHT; 2];
    };
    // As written: a layout file holds thousandths.
    let least = 10f64.powi(-defaults::PLACE_DECIMALS);
    let mut height = |v| reader.measured(v, "height", least, &span);
    match (height(heights[0]), height(heights[1])) {
        (Some(low), Some(high)) => [low, high].map(|v| rounded(v, defaults::PLACE_DECIMALS)),
        _ => [defaults::PILLAR_HEIGHT; 2],
    }
}
