//! Pillars: from their entries to solids with layers.

use super::cross_section::{CrossSection, cross_section};
use super::depths::{Wish, layer, settled};
use super::places::{self, Spot};
use super::shapes;
use super::standing::{BasePlate, Standing};
use crate::scene::defaults;
use crate::scene::language::raw::RawPillars;
use crate::scene::text::{List, Reader, Span, error_at};
use crate::support::{Layer, Support, SupportKind};
use glam::DVec2;

/// One entry of the scene's pillars, ready to be put up.
pub(crate) struct PillarEntry {
    pub name: String,
    pub section: CrossSection,
    /// Around the origin, counter-clockwise.
    pub outline: Vec<DVec2>,
    pub height: f64,
    pub spots: Vec<Spot>,
    pub layer: Layer,
}

/// Pillars of one kind on their places.
pub(crate) struct Batch<'a> {
    pub name: &'a str,
    /// Around the origin, counter-clockwise.
    pub outline: &'a [DVec2],
    pub round: bool,
    pub height: f64,
    pub layer: Layer,
    pub spots: &'a [Spot],
}

impl PillarEntry {
    pub(crate) fn batch(&self) -> Batch<'_> {
        Batch {
            name: &self.name,
            outline: &self.outline,
            round: self.section.is_round(),
            height: self.height,
            layer: self.layer,
            spots: &self.spots,
        }
    }
}

/// Pillars in place and the base under them: for the checks and, with the layers, the solids.
#[derive(Default)]
pub(crate) struct Colonnade {
    pub pillars: Vec<Standing>,
    pub base: Option<BasePlate>,
    layers: Vec<Layer>,
}

impl Colonnade {
    /// Puts pillars up and numbers them: `p1`, `p2`, ... or the batch's own name with a number.
    pub(crate) fn of<'a>(batches: impl IntoIterator<Item = Batch<'a>>) -> Self {
        let mut found = Self::default();
        let mut counters = std::collections::BTreeMap::<&str, usize>::new();
        for batch in batches {
            let reach = reach(batch.outline);
            for spot in batch.spots {
                let number = counters.entry(batch.name).or_default();
                *number += 1;
                let dash = if batch.name == UNNAMED { "" } else { "-" };
                found.layers.push(batch.layer);
                found.pillars.push(Standing {
                    name: format!("{}{dash}{number}", batch.name),
                    axis: spot.at,
                    profile: batch.outline.iter().map(|p| spot.at + *p).collect(),
                    height: batch.height,
                    reach,
                    round: batch.round,
                    span: spot.span.clone(),
                });
            }
        }
        found
    }

    /// Corners of all pillars.
    pub(crate) fn corners(&self) -> Vec<DVec2> {
        let profiles = self.pillars.iter().map(|p| &p.profile);
        profiles.flatten().copied().collect()
    }

    /// The solids: pillars in order, the base last.
    pub(crate) fn solids(self) -> Vec<Support> {
        let thickness = self.base.as_ref().map_or(0.0, |b| b.thickness);
        let bottom = sunk(thickness);
        let pillars = self
            .pillars
            .into_iter()
            .zip(self.layers)
            .map(|(pillar, layer)| Support {
                mesh: shapes::prism(&pillar.profile, bottom, pillar.height),
                kind: SupportKind::Pillar {
                    axis: pillar.axis,
                    profile: pillar.profile,
                    bottom,
                    top: pillar.height,
                    round: pillar.round,
                },
                name: pillar.name,
                layer: Some(layer),
            });
        let base = self.base.into_iter().map(|base| Support {
            name: "base".to_string(),
            mesh: shapes::prism(&base.outline, -base.thickness, 0.0),
            kind: SupportKind::Base {
                outline: base.outline,
                bottom: -base.thickness,
                top: 0.0,
            },
            layer: None,
        });
        pillars.chain(base).collect()
    }
}

/// The name of entries without one: its pillars are p1, p2, ...
pub(crate) const UNNAMED: &str = "p";

/// Largest distance of an outline from the origin.
pub(crate) fn reach(outline: &[DVec2]) -> f64 {
    outline.iter().map(|p| p.length()).fold(0.0, f64::max)
}

/// Where pillars on a base of this thickness begin: one that only stood on it would touch it in a face; sunk in, the two truly overlap.
fn sunk(thickness: f64) -> f64 {
    -defaults::SINK.min(thickness / 2.0)
}

/// The entries that can be read; `depth` is what holds where they say nothing.
pub(crate) fn entries(
    reader: &mut Reader,
    list: &List<RawPillars>,
    depth: &Wish,
) -> Vec<PillarEntry> {
    let mut entries = Vec::new();
    let (mut total, mut corners, mut pairs) = (0u64, 0u64, 0u64);
    for item in list {
        let item_span = reader.span(item);
        let Some(raw) = reader.value(item) else {
            continue;
        };
        let Some(entry) = entry(reader, raw, &item_span, depth) else {
            continue;
        };
        total += entry.spots.len() as u64;
        if total > defaults::MOST_PILLARS {
            reader.error(
                &item_span,
                format!(
                    "{total} pillars up to here; the limit is {}",
                    defaults::MOST_PILLARS
                ),
            );
            return Vec::new();
        }
        let (pillars, sides) = (entry.spots.len() as u64, entry.outline.len() as u64);
        corners += pillars * sides;
        pairs += pillars * sides * sides;
        if corners > defaults::MOST_CORNERS || pairs > defaults::MOST_CORNER_PAIRS {
            let text =
                format!("outlines too detailed for so many pillars: {corners} corners up to here");
            reader.problems.push(
                error_at(&item_span, text)
                    .help("fewer `facets`, `sides` or `points`, or fewer pillars"),
            );
            return Vec::new();
        }
        entries.push(entry);
    }
    entries
}

/// As [`entries`], where there must be at least one.
pub(crate) fn some_entries(
    reader: &mut Reader,
    list: &List<RawPillars>,
    span: &Span,
    depth: &Wish,
) -> Vec<PillarEntry> {
    if list.is_empty() {
        reader.error(span, "a forest needs at least one pillar");
    }
    entries(reader, list, depth)
}

fn entry(reader: &mut Reader, raw: &RawPillars, span: &Span, depth: &Wish) -> Option<PillarEntry> {
    let owner = "this entry of `pillars`";
    let name = match reader.given(&raw.name) {
        Some((name, name_span)) => {
            crate::scene::text::names::checked(reader, name, &name_span, "pillars")
        }
        None => Some(UNNAMED.to_string()),
    };
    let section = reader
        .required(&raw.shape, "shape", owner, span)
        .and_then(|(s, at)| cross_section(reader, s, &at));
    let height = reader.positive_or(&raw.height, "height", defaults::PILLAR_HEIGHT);
    let spots = reader
        .required(&raw.places, "places", owner, span)
        .and_then(|(p, at)| places::spots(reader, p, &at));
    let wish = match reader.given(&raw.depth) {
        Some((own, at)) => layer(reader, own, &at, depth),
        None => depth.clone(),
    };
    let (name, section, height, spots) = (name?, section?, height?, spots?);
    let outline = section.outline().ok()?;
    let layer = settled(reader, &outline, section.is_round(), &wish, span);
    Some(PillarEntry {
        name,
        section,
        outline,
        height,
        spots,
        layer,
    })
}
