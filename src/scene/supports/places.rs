//! Where the pillars of one entry stand: lists, grids, rings and honeycombs.

use crate::scene::defaults;
use crate::scene::language::raw::{RawGrid, RawHex, RawPlaces, RawRing};
use crate::scene::text::{Field, List, Reader, Span};
use glam::DVec2;
use std::f64::consts::TAU;

/// A pillar's place and where the scene says so.
#[derive(Clone, Debug)]
pub(crate) struct Spot {
    pub at: DVec2,
    pub span: Span,
}

/// The places of one entry, or `None` after an error. Refuses more than [`defaults::MOST_PILLARS`] before making any.
pub(crate) fn spots(reader: &mut Reader, places: &RawPlaces, span: &Span) -> Option<Vec<Spot>> {
    let points = match places {
        RawPlaces::At(list) => return listed(reader, list, span),
        RawPlaces::Grid(grid) => lattice(reader, grid, span)?,
        RawPlaces::Ring(ring) => circle(reader, ring, span)?,
        RawPlaces::Hex(hex) => honeycomb(reader, hex, span)?,
    };
    Some(
        points
            .into_iter()
            .map(|at| Spot {
                at,
                span: span.clone(),
            })
            .collect(),
    )
}

fn listed(reader: &mut Reader, list: &List<[f64; 2]>, span: &Span) -> Option<Vec<Spot>> {
    affordable(reader, list.len() as u64, span)?;
    let mut spots = Vec::new();
    for item in list {
        let item_span = reader.span(item);
        let point = reader
            .value(item)
            .and_then(|p| reader.point(p, "at", &item_span));
        spots.extend(point.map(|p| Spot {
            at: p.into(),
            span: item_span,
        }));
    }
    (spots.len() == list.len()).then_some(spots)
}

/// Errors if an entry asks for more pillars than the program takes, or for none.
fn affordable(reader: &mut Reader, count: u64, span: &Span) -> Option<()> {
    if count == 0 {
        reader.error(span, "there are no places in this list");
        return None;
    }
    if count > defaults::MOST_PILLARS {
        reader.error(
            span,
            format!("{count} pillars; the limit is {}", defaults::MOST_PILLARS),
        );
        return None;
    }
    Some(())
}

fn lattice(reader: &mut Reader, grid: &RawGrid, span: &Span) -> Option<Vec<DVec2>> {
    let owner = "this Grid";
    reader.need(&grid.columns, "columns", owner, span);
    reader.need(&grid.rows, "rows", owner, span);
    reader.need(&grid.pitch, "pitch", owner, span);
    let columns = count(reader, &grid.columns, "columns");
    let rows = count(reader, &grid.rows, "rows");
    let pitch = reader.positive(&grid.pitch, "pitch");
    let pitch_y = if is_given(&grid.pitch_y) {
        reader.positive(&grid.pitch_y, "pitch_y")
    } else {
        pitch
    };
    let centre = centre(reader, &grid.centre);
    let turn = reader.turn(&grid.turn);
    let (columns, rows, pitch, pitch_y) = (columns?, rows?, pitch?, pitch_y?);
    affordable(
        reader,
        u64::from(columns).saturating_mul(u64::from(rows)),
        span,
    )?;
    let middle = DVec2::new(f64::from(columns - 1), f64::from(rows - 1)) / 2.0;
    let cell = |i: u32, j: u32| {
        (DVec2::new(f64::from(i), f64::from(j)) - middle) * DVec2::new(pitch, pitch_y)
    };
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    Some(
        cells
            .map(|(i, j)| centre + DVec2::from_angle(turn).rotate(cell(i, j)))
            .collect(),
    )
}

fn circle(reader: &mut Reader, ring: &RawRing, span: &Span) -> Option<Vec<DVec2>> {
    reader.need(&ring.count, "count", "this Ring", span);
    reader.need(&ring.radius, "radius", "this Ring", span);
    let count = count(reader, &ring.count, "count");
    let radius = reader.positive(&ring.radius, "radius");
    let centre = centre(reader, &ring.centre);
    let turn = reader.turn(&ring.turn);
    let (count, radius) = (count?, radius?);
    affordable(reader, u64::from(count), span)?;
    let angle = |i: u32| turn + TAU * f64::from(i) / f64::from(count);
    Some(
        (0..count)
            .map(|i| centre + radius * DVec2::from_angle(angle(i)))
            .collect(),
    )
}

/// A pillar in the middle and `rings` hexagons around it: 1 + 3 r (r + 1) places.
fn honeycomb(reader: &mut Reader, hex: &RawHex, span: &Span) -> Option<Vec<DVec2>> {
    reader.need(&hex.rings, "rings", "this Hex", span);
    reader.need(&hex.pitch, "pitch", "this Hex", span);
    let rings = reader.given(&hex.rings).map(|(r, _)| *r);
    let pitch = reader.positive(&hex.pitch, "pitch");
    let centre = centre(reader, &hex.centre);
    let turn = reader.turn(&hex.turn);
    let (rings, pitch) = (rings?, pitch?);
    let count = u64::from(rings)
        .saturating_mul(u64::from(rings) + 1)
        .saturating_mul(3)
        .saturating_add(1);
    affordable(reader, count, span)?;
    let r = i64::from(rings);
    let across = DVec2::from_angle(TAU / 6.0);
    let cells = (-r..=r)
        .flat_map(|j| (-r..=r).map(move |i| (i, j)))
        .filter(|(i, j)| (i + j).abs() <= r);
    let place = |(i, j): (i64, i64)| {
        DVec2::from_angle(turn).rotate(pitch * (i as f64 * DVec2::X + j as f64 * across))
    };
    Some(cells.map(|cell| centre + place(cell)).collect())
}

fn is_given<T>(field: &Field<T>) -> bool {
    matches!(field, Field::Given(_))
}

fn centre(reader: &mut Reader, field: &Field<[f64; 2]>) -> DVec2 {
    reader
        .point_field(field, "centre")
        .map_or(DVec2::ZERO, |(p, _)| p.into())
}

/// A count of at least one.
fn count(reader: &mut Reader, field: &Field<u32>, name: &str) -> Option<u32> {
    reader.count(field, name, 1..=u32::MAX).map(|(v, _)| v)
}
