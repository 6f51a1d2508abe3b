//! Cross-sections of pillars, in numbers.
//!
//! Takes what a scene says, gives millimetres and degrees from which the outline follows. [`CrossSection::written`] is RON text that
//! reads back as the same section, bit for bit.

use super::shapes;
use crate::scene::defaults;
use crate::scene::language::raw::RawShape;
use crate::scene::text::{Field, List, Reader, Span};
use glam::DVec2;

/// A cross-section around the axis of its pillar; lengths in millimetres, turns in degrees.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CrossSection {
    Round { radius: f64, facets: u32 },
    Polygon { sides: u32, radius: f64, turn: f64 },
    Rectangle { width: f64, depth: f64, turn: f64 },
    Profile { points: Vec<DVec2>, turn: f64 },
}

/// What the scene says of a section.
pub(crate) fn cross_section(
    reader: &mut Reader,
    shape: &RawShape,
    span: &Span,
) -> Option<CrossSection> {
    match shape {
        RawShape::Round(raw) => {
            reader.need(&raw.radius, "radius", "this Round", span);
            let radius = reader.positive(&raw.radius, "radius");
            let facets = match &raw.facets {
                Field::Missing => Some(defaults::ROUND_FACETS),
                field => reader
                    .count(field, "facets", defaults::FACETS)
                    .map(|(f, _)| f),
            };
            Some(CrossSection::Round {
                facets: facets?,
                radius: radius?,
            })
        }
        RawShape::Polygon(raw) => {
            reader.need(&raw.sides, "sides", "this Polygon", span);
            reader.need(&raw.radius, "radius", "this Polygon", span);
            let sides = reader.count(&raw.sides, "sides", 3..=512).map(|(s, _)| s);
            let radius = reader.positive(&raw.radius, "radius");
            let turn = turn(reader, &raw.turn);
            Some(CrossSection::Polygon {
                sides: sides?,
                radius: radius?,
                turn,
            })
        }
        RawShape::Rectangle(raw) => {
            reader.need(&raw.width, "width", "this Rectangle", span);
            reader.need(&raw.depth, "depth", "this Rectangle", span);
            let width = reader.positive(&raw.width, "width");
            let depth = reader.positive(&raw.depth, "depth");
            let turn = turn(reader, &raw.turn);
            Some(CrossSection::Rectangle {
                width: width?,
                depth: depth?,
                turn,
            })
        }
        RawShape::Profile(raw) => {
            let turn = turn(reader, &raw.turn);
            let (list, list_span) = reader.required(&raw.points, "points", "this Profile", span)?;
            let points = points(reader, list, &list_span)?;
            let section = CrossSection::Profile { points, turn };
            match section.outline() {
                Ok(_) => Some(section),
                Err(why) => {
                    reader.error(&list_span, why);
                    None
                }
            }
        }
    }
}

/// Degrees; 0 if not given.
fn turn(reader: &mut Reader, field: &Field<f64>) -> f64 {
    reader.number(field, "turn").map_or(0.0, |(turn, _)| turn)
}

/// Corners of a polygon, millimetres; not too many of them.
pub(crate) fn points(
    reader: &mut Reader,
    list: &List<[f64; 2]>,
    span: &Span,
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
        points.extend(point.map(DVec2::from));
    }
    (points.len() == list.len()).then_some(points)
}

impl CrossSection {
    /// The outline around the origin, counter-clockwise, millimetres.
    ///
    /// # Errors
    /// Why the points of a profile are no simple polygon.
    pub(crate) fn outline(&self) -> Result<Vec<DVec2>, String> {
        Ok(match self {
            Self::Round { radius, facets } => shapes::regular(*facets, *radius, 0.0),
            Self::Polygon {
                sides,
                radius,
                turn,
            } => shapes::regular(*sides, *radius, turn.to_radians()),
            Self::Rectangle { width, depth, turn } => {
                shapes::rectangle(*width, *depth, turn.to_radians())
            }
            Self::Profile { points, turn } => {
                let turn = DVec2::from_angle(turn.to_radians());
                return shapes::simple(points.iter().map(|p| turn.rotate(*p)).collect());
            }
        })
    }

    pub(crate) fn is_round(&self) -> bool {
        matches!(self, Self::Round { .. })
    }

    /// The section with `of` applied to its lengths; counts and turns stay.
    pub(crate) fn with_lengths(&self, of: impl Fn(f64) -> f64) -> Self {
        let mut section = self.clone();
        match &mut section {
            Self::Round { radius, .. } | Self::Polygon { radius, .. } => *radius = of(*radius),
            Self::Rectangle { width, depth, .. } => (*width, *depth) = (of(*width), of(*depth)),
            Self::Profile { points, .. } => points
                .iter_mut()
                .for_each(|p| *p = DVec2::new(of(p.x), of(p.y))),
        }
        section
    }

    /// As scenes in millimetres write it: `Round(radius: 4)`.
    pub(crate) fn written(&self) -> String {
        let turned = |turn: &f64| match turn {
            0.0 => String::new(),
            turn => format!(", turn: {turn}"),
        };
        match self {
            Self::Round { radius, facets } if *facets == defaults::ROUND_FACETS => {
                format!("Round(radius: {radius})")
            }
            Self::Round { radius, facets } => format!("Round(radius: {radius}, facets: {facets})"),
            Self::Polygon {
                sides,
                radius,
                turn,
            } => format!("Polygon(sides: {sides}, radius: {radius}{})", turned(turn)),
            Self::Rectangle { width, depth, turn } => {
                format!("Rectangle(width: {width}, depth: {depth}{})", turned(turn))
            }
            Self::Profile { points, turn } => {
                let corners: Vec<String> = points.iter().map(point).collect();
                format!("Profile(points: [{}]{})", corners.join(", "), turned(turn))
            }
        }
    }
}

/// `(1, -2.5)`.
pub(crate) fn point(p: &DVec2) -> String {
    format!("({}, {})", p.x, p.y)
}
