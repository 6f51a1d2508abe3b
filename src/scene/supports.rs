//! Pillars and base: from their entries in the scene to solids with layers.

use super::checks::{Slab, Standing};
use super::layout::{self, Spot, positive, positive_at};
use super::raw::{
    List, RawBase, RawDatum, RawDepth, RawDisc, RawPillars, RawScene, RawShape, RawSlab,
};
use super::reader::{Reader, Span, error_at, short};
use super::spanned::Field;
use super::{defaults, shapes};
use crate::support::{Datum, Layer, Support, SupportKind};
use glam::DVec2;

/// One entry of the scene's pillars, ready to be put up.
struct Entry {
    name: String,
    /// Around the origin, counter-clockwise.
    profile: Vec<DVec2>,
    round: bool,
    height: f64,
    spots: Vec<Spot>,
    layer: Layer,
}

/// What the supports section gives: pillars and base for the checks and, with them, the solids.
pub struct Supports {
    pub pillars: Vec<Standing>,
    pub base: Option<Slab>,
    layers: Vec<Layer>,
}

/// Reads pillars, base and depth layers.
pub fn supports(reader: &mut Reader, raw: &RawScene, whole: &Span) -> Supports {
    let depth = match reader.given(&raw.depth) {
        Some((depth, span)) => layer(reader, depth, &span, &Wish::default()),
        None => Wish::default(),
    };
    let mut found = Supports {
        pillars: Vec::new(),
        base: None,
        layers: Vec::new(),
    };
    if let Some((list, span)) = reader.required(&raw.pillars, "pillars", "the scene", whole) {
        let entries = entries(reader, list, &span, depth);
        put_up(&entries, &mut found);
    }
    found.base = base(reader, &raw.base, &found.pillars);
    found
}

impl Supports {
    /// The solids: pillars in order, the base last.
    pub fn solids(self) -> Vec<Support> {
        let thickness = self.base.as_ref().map_or(0.0, |b| b.thickness);
        // A pillar that only stood on the base would touch it in a face: sunk in, the two truly overlap.
        let bottom = -defaults::SINK.min(thickness / 2.0);
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
        let base = self.base.into_iter().map(|slab| Support {
            name: "base".to_string(),
            mesh: shapes::prism(&slab.outline, -slab.thickness, 0.0),
            kind: SupportKind::Base {
                outline: slab.outline,
                bottom: -slab.thickness,
                top: 0.0,
            },
            layer: None,
        });
        pillars.chain(base).collect()
    }
}

fn entries(reader: &mut Reader, list: &List<RawPillars>, span: &Span, depth: Wish) -> Vec<Entry> {
    if list.is_empty() {
        reader.error(span, "a forest needs at least one pillar");
    }
    let mut entries = Vec::new();
    let (mut total, mut corners, mut pairs) = (0u64, 0u64, 0u64);
    for item in list {
        let item_span = reader.span(item);
        let Some(raw) = reader.value(item) else {
            continue;
        };
        let Some(entry) = entry(reader, raw, &item_span, &depth) else {
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
        let (pillars, sides) = (entry.spots.len() as u64, entry.profile.len() as u64);
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

fn entry(reader: &mut Reader, raw: &RawPillars, span: &Span, depth: &Wish) -> Option<Entry> {
    let owner = "this entry of `pillars`";
    let name = match reader.given(&raw.name) {
        Some((name, name_span)) => super::names::checked(reader, name, &name_span, "pillars"),
        None => Some("p".to_string()),
    };
    let shape = reader
        .required(&raw.shape, "shape", owner, span)
        .and_then(|(s, at)| outline(reader, s, &at));
    let height = match &raw.height {
        Field::Missing => Some(defaults::PILLAR_HEIGHT),
        field => positive(reader, field, "height"),
    };
    let spots = reader
        .required(&raw.places, "places", owner, span)
        .and_then(|(p, at)| layout::spots(reader, p, &at));
    let wish = match reader.given(&raw.depth) {
        Some((own, at)) => layer(reader, own, &at, depth),
        None => depth.clone(),
    };
    let (name, (profile, round), height, spots) = (name?, shape?, height?, spots?);
    let layer = settled(reader, &profile, round, &wish, span);
    Some(Entry {
        name,
        profile,
        round,
        height,
        spots,
        layer,
    })
}

/// A shape's profile around the origin and whether it stands for a circle.
fn outline(reader: &mut Reader, shape: &RawShape, span: &Span) -> Option<(Vec<DVec2>, bool)> {
    match shape {
        RawShape::Round(raw) => {
            reader.need(&raw.radius, "radius", "this Round", span);
            let radius = positive(reader, &raw.radius, "radius");
            let facets = match &raw.facets {
                Field::Missing => Some(defaults::ROUND_FACETS),
                field => reader
                    .count(field, "facets", defaults::FACETS)
                    .map(|(f, _)| f),
            };
            Some((shapes::regular(facets?, radius?, 0.0), true))
        }
        RawShape::Polygon(raw) => {
            reader.need(&raw.sides, "sides", "this Polygon", span);
            reader.need(&raw.radius, "radius", "this Polygon", span);
            let sides = reader.count(&raw.sides, "sides", 3..=512).map(|(s, _)| s);
            let radius = positive(reader, &raw.radius, "radius");
            let turn = layout::turn(reader, &raw.turn);
            Some((shapes::regular(sides?, radius?, turn), false))
        }
        RawShape::Rectangle(raw) => {
            reader.need(&raw.width, "width", "this Rectangle", span);
            reader.need(&raw.depth, "depth", "this Rectangle", span);
            let width = positive(reader, &raw.width, "width");
            let depth = positive(reader, &raw.depth, "depth");
            let turn = layout::turn(reader, &raw.turn);
            Some((shapes::rectangle(width?, depth?, turn), false))
        }
        RawShape::Profile(raw) => {
            let turn = layout::turn(reader, &raw.turn);
            let (list, list_span) = reader.required(&raw.points, "points", "this Profile", span)?;
            profile(reader, list, &list_span, turn).map(|profile| (profile, false))
        }
    }
}

fn profile(
    reader: &mut Reader,
    list: &List<[f64; 2]>,
    span: &Span,
    turn: f64,
) -> Option<Vec<DVec2>> {
    if list.len() > defaults::MOST_POINTS {
        reader.error(
            span,
            format!(
                "{} points in one outline; the limit is {}",
                list.len(),
                defaults::MOST_POINTS
            ),
        );
        return None;
    }
    let mut points = Vec::new();
    for item in list {
        let at = reader.span(item);
        let point = reader
            .value(item)
            .and_then(|p| reader.point(p, "points", &at));
        points.extend(point.map(|p| DVec2::from_angle(turn).rotate(p.into())));
    }
    if points.len() < list.len() {
        return None;
    }
    shapes::simple(points)
        .map_err(|why| reader.error(span, why))
        .ok()
}

/// A depth layer as far as the scene gives it, millimetres.
#[derive(Clone, Default)]
struct Wish {
    /// Where the scene asks for it.
    span: Option<Span>,
    datum: Option<Datum>,
    front: Option<f64>,
    back: Option<f64>,
    core: Option<f64>,
}

/// What `raw` asks for; fields left out are taken from `under`.
fn layer(reader: &mut Reader, raw: &RawDepth, span: &Span, under: &Wish) -> Wish {
    let datum = reader.given(&raw.from).map(|(from, _)| match from {
        RawDatum::Axis => Datum::AxisPlane,
        RawDatum::Surface => Datum::Surface,
    });
    let mut length = |field, name, under| {
        reader
            .length_from(field, name, 0.0)
            .map(|(value, _)| value)
            .or(under)
    };
    let front = length(&raw.front, "front", under.front);
    let back = length(&raw.back, "back", under.back);
    let core = length(&raw.core, "core", under.core);
    if let (Some(front), Some(back)) = (front, back)
        && front + back < 0.05
    {
        reader.problems.push(
            error_at(
                span,
                format!(
                    "the depth layer is {} mm thick (front + back): no relief fits in",
                    short(front + back)
                ),
            )
            .help("a few millimetres are usual: (front: 5, back: 2)"),
        );
    }
    Wish {
        span: Some(span.clone()),
        datum: datum.or(under.datum),
        front,
        back,
        core,
    }
}

/// The layer of a pillar: defaults filled in; an error if it does not leave the pillar standing. `entry` is the pillars' place.
fn settled(
    reader: &mut Reader,
    profile: &[DVec2],
    round: bool,
    wish: &Wish,
    entry: &Span,
) -> Layer {
    let span = wish.span.as_ref().unwrap_or(entry);
    let reach = profile.iter().map(|p| p.length()).fold(0.0, f64::max);
    let width = shapes::narrowest(profile);
    let datum = wish.datum.unwrap_or(defaults::LAYER.datum);
    let (room, of) = match (datum, round) {
        (Datum::AxisPlane, true) => (reach, "the radius"),
        (Datum::AxisPlane, false) => (width / 2.0, "half the width"),
        (Datum::Surface, _) => (width, "the width"),
    };
    let front = wish.front.unwrap_or(defaults::LAYER.front);
    let core = wish
        .core
        .unwrap_or(defaults::LAYER.core.min(defaults::CORE_SHARE * room));
    let back = wish
        .back
        .unwrap_or(defaults::LAYER.back.min(defaults::BACK_SHARE * room));
    if back + core > room + 1e-6 {
        let (back, core) = (short(back), short(core));
        reader.problems.push(
            error_at(span, format!("reliefs would cut the pillar through: back {back} mm + core {core} mm is more than {of}, {} mm", short(room)))
                .help(format!("thicker pillars, or a smaller `back` or `core` in `depth`: back + core <= {}", short(room))),
        );
    }
    Layer {
        datum,
        front,
        back,
        core,
    }
}

/// Puts the entries' pillars up and numbers them: `p1`, `p2`, ... or the entry's own name with a number.
fn put_up(entries: &[Entry], found: &mut Supports) {
    let mut counters = std::collections::BTreeMap::<&str, usize>::new();
    for entry in entries {
        let reach = entry.profile.iter().map(|p| p.length()).fold(0.0, f64::max);
        for spot in &entry.spots {
            let number = counters.entry(&entry.name).or_default();
            *number += 1;
            let dash = if entry.name == "p" { "" } else { "-" };
            found.layers.push(entry.layer);
            found.pillars.push(Standing {
                name: format!("{}{dash}{number}", entry.name),
                axis: spot.at,
                profile: entry.profile.iter().map(|p| spot.at + *p).collect(),
                height: entry.height,
                reach,
                round: entry.round,
                span: spot.span.clone(),
            });
        }
    }
}

/// The base, by default a disc that reaches beyond every pillar.
fn base(reader: &mut Reader, field: &Field<RawBase>, pillars: &[Standing]) -> Option<Slab> {
    match reader.given(field) {
        None => disc(reader, &RawDisc::default(), None, pillars),
        Some((RawBase::Disc(raw), span)) => disc(reader, raw, Some(span), pillars),
        Some((RawBase::Rectangle(raw), span)) => rectangle(reader, raw, span, pillars),
        Some((RawBase::None, span)) => {
            if pillars.len() > 1 {
                reader.problems.push(super::reader::warning_at(
                    &span,
                    format!(
                        "without a base the {} pillars are loose parts",
                        pillars.len()
                    ),
                ));
            }
            None
        }
    }
}

fn disc(
    reader: &mut Reader,
    raw: &RawDisc,
    span: Option<Span>,
    pillars: &[Standing],
) -> Option<Slab> {
    let thickness = thickness(reader, &raw.thickness);
    let margin = margin(reader, &raw.margin);
    let centre = reader
        .point_field(&raw.centre, "centre")
        .map(|(p, _)| DVec2::from(p));
    let centre = centre
        .or_else(|| bounds(pillars).map(|(lo, hi)| (lo + hi) / 2.0))
        .unwrap_or(DVec2::ZERO);
    let facets = match &raw.facets {
        Field::Missing => defaults::BASE_FACETS,
        field => reader.count(field, "facets", defaults::FACETS)?.0,
    };
    let radius = match &raw.radius {
        Field::Missing => {
            let corners = pillars.iter().flat_map(|p| &p.profile);
            let reach = corners.map(|p| p.distance(centre)).fold(0.0, f64::max);
            // The polygon's sides run inside its circle.
            (reach + margin?) / (std::f64::consts::PI / f64::from(facets)).cos()
        }
        field => positive(reader, field, "radius")?,
    };
    let outline = shapes::regular(facets, radius, 0.0)
        .into_iter()
        .map(|p| p + centre)
        .collect();
    Some(Slab {
        outline,
        thickness: thickness?,
        span,
    })
}

fn rectangle(reader: &mut Reader, raw: &RawSlab, span: Span, pillars: &[Standing]) -> Option<Slab> {
    let thickness = thickness(reader, &raw.thickness);
    let margin = margin(reader, &raw.margin);
    let (lo, hi) = bounds(pillars).unwrap_or((DVec2::ZERO, DVec2::ZERO));
    let centre = reader
        .point_field(&raw.centre, "centre")
        .map_or((lo + hi) / 2.0, |(p, _)| p.into());
    let reach = (hi - centre).max(centre - lo);
    let mut side = |field: &Field<f64>, name: &str, half: f64| match field {
        Field::Missing => margin.map(|m| 2.0 * (half + m)),
        field => positive_at(reader, field, name).map(|(v, _)| v),
    };
    let (width, depth) = (
        side(&raw.width, "width", reach.x),
        side(&raw.depth, "depth", reach.y),
    );
    let outline = shapes::rectangle(width?, depth?, 0.0)
        .into_iter()
        .map(|p| p + centre)
        .collect();
    Some(Slab {
        outline,
        thickness: thickness?,
        span: Some(span),
    })
}

fn thickness(reader: &mut Reader, field: &Field<f64>) -> Option<f64> {
    match field {
        Field::Missing => Some(defaults::BASE_THICKNESS),
        field => reader.length_from(field, "thickness", 0.2).map(|(v, _)| v),
    }
}

fn margin(reader: &mut Reader, field: &Field<f64>) -> Option<f64> {
    match field {
        Field::Missing => Some(defaults::BASE_MARGIN),
        field => reader.length_from(field, "margin", 0.0).map(|(v, _)| v),
    }
}

fn bounds(pillars: &[Standing]) -> Option<(DVec2, DVec2)> {
    let points = pillars.iter().flat_map(|p| &p.profile);
    points.fold(None, |b: Option<(DVec2, DVec2)>, p| {
        Some(b.map_or((*p, *p), |(l, h)| (l.min(*p), h.max(*p))))
    })
}
