//! The base: given, or fitted around what it is to hold.

use super::shapes;
use super::standing::BasePlate;
use crate::scene::defaults;
use crate::scene::language::raw::{RawBase, RawDisc, RawSlab};
use crate::scene::text::{Field, Reader, Span};
use glam::DVec2;

/// The base, by default a disc that reaches beyond everything it is to hold: corners of outlines.
pub(crate) fn base(
    reader: &mut Reader,
    field: &Field<RawBase>,
    held: &[DVec2],
) -> Option<BasePlate> {
    match reader.given(field) {
        None => disc(reader, &RawDisc::default(), None, held),
        Some((RawBase::Disc(raw), span)) => disc(reader, raw, Some(span), held),
        Some((RawBase::Rectangle(raw), span)) => rectangle(reader, raw, span, held),
        Some((RawBase::None, _)) => None,
    }
}

/// Whether the scene gives the base's size, so that it does not depend on what it holds.
pub(crate) fn has_size(field: &Field<RawBase>) -> bool {
    let given = |field: &Field<f64>| matches!(field, Field::Given(_));
    match field {
        Field::Given(base) => match &base.value {
            Ok(RawBase::Disc(raw)) => given(&raw.radius),
            Ok(RawBase::Rectangle(raw)) => given(&raw.width) && given(&raw.depth),
            _ => false,
        },
        Field::Missing => false,
    }
}

fn disc(
    reader: &mut Reader,
    raw: &RawDisc,
    span: Option<Span>,
    held: &[DVec2],
) -> Option<BasePlate> {
    let thickness = thickness(reader, &raw.thickness);
    let margin = margin(reader, &raw.margin);
    let centre = reader
        .point_field(&raw.centre, "centre")
        .map(|(p, _)| DVec2::from(p));
    let centre = centre
        .or_else(|| shapes::bounds(held).map(|(lo, hi)| (lo + hi) / 2.0))
        .unwrap_or(DVec2::ZERO);
    let facets = match &raw.facets {
        Field::Missing => defaults::BASE_FACETS,
        field => reader.count(field, "facets", defaults::FACETS)?.0,
    };
    let radius = match &raw.radius {
        Field::Missing => {
            let reach = held.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
            // The polygon's sides run inside its circle.
            (reach + margin?) / (std::f64::consts::PI / f64::from(facets)).cos()
        }
        field => reader.positive(field, "radius")?,
    };
    let outline = shapes::regular(facets, radius, 0.0)
        .into_iter()
        .map(|p| p + centre)
        .collect();
    Some(BasePlate {
        outline,
        thickness: thickness?,
        span,
    })
}

fn rectangle(reader: &mut Reader, raw: &RawSlab, span: Span, held: &[DVec2]) -> Option<BasePlate> {
    let thickness = thickness(reader, &raw.thickness);
    let margin = margin(reader, &raw.margin);
    let (lo, hi) = shapes::bounds(held).unwrap_or((DVec2::ZERO, DVec2::ZERO));
    let centre = reader
        .point_field(&raw.centre, "centre")
        .map_or((lo + hi) / 2.0, |(p, _)| p.into());
    let reach = (hi - centre).max(centre - lo);
    let mut side = |field: &Field<f64>, name: &str, half: f64| match field {
        Field::Missing => margin.map(|m| 2.0 * (half + m)),
        field => reader.positive_at(field, name).map(|(v, _)| v),
    };
    let (width, depth) = (
        side(&raw.width, "width", reach.x),
        side(&raw.depth, "depth", reach.y),
    );
    let outline = shapes::rectangle(width?, depth?, 0.0)
        .into_iter()
        .map(|p| p + centre)
        .collect();
    Some(BasePlate {
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
