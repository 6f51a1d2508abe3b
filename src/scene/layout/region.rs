//! Where planned pillars may stand, and what can be said of it before any is found.

use crate::scene::defaults;
use crate::scene::language::raw::RawRegion;
use crate::scene::supports::{BasePlate, Standing, cross_section, shapes};
use crate::scene::text::{Reader, Span, short};
use glam::DVec2;

/// The room of planned pillars, for the checks.
pub(crate) struct Room {
    /// Counter-clockwise, millimetres.
    pub region: Vec<DVec2>,
    /// Highest top that a pillar may have.
    pub tops: f64,
    pub span: Span,
    /// One pillar of each allowed shape at its largest height, nowhere in particular.
    pub samples: Vec<Standing>,
}

/// What a scene says of the region.
pub(crate) fn region(reader: &mut Reader, raw: &RawRegion, span: &Span) -> Option<Vec<DVec2>> {
    let centre = |reader: &mut Reader, field| {
        let point = reader.point_field(field, "centre");
        point.map_or(DVec2::ZERO, |(p, _)| p.into())
    };
    let (outline, centre) = match raw {
        RawRegion::Disc(raw) => {
            reader.need(&raw.radius, "radius", "this Disc", span);
            let radius = reader.positive(&raw.radius, "radius");
            let centre = centre(reader, &raw.centre);
            (disc(radius?), centre)
        }
        RawRegion::Rectangle(raw) => {
            reader.need(&raw.width, "width", "this Rectangle", span);
            reader.need(&raw.depth, "depth", "this Rectangle", span);
            let width = reader.positive(&raw.width, "width");
            let depth = reader.positive(&raw.depth, "depth");
            let turn = reader.turn(&raw.turn);
            let centre = centre(reader, &raw.centre);
            (shapes::rectangle(width?, depth?, turn), centre)
        }
        RawRegion::Polygon(raw) => {
            let (list, at) = reader.required(&raw.points, "points", "this Polygon", span)?;
            let points = cross_section::points(reader, list, &at)?;
            let outline = shapes::simple(points).map_err(|why| reader.error(&at, why));
            (outline.ok()?, DVec2::ZERO)
        }
    };
    Some(outline.into_iter().map(|p| p + centre).collect())
}

/// A disc around the origin, as a polygon with its corners on the circle.
fn disc(radius: f64) -> Vec<DVec2> {
    shapes::regular(defaults::REGION_CORNERS, radius, 0.0)
}

/// The region if neither it nor a base's size is given.
pub(crate) fn usual() -> Vec<DVec2> {
    disc(defaults::REGION_RADIUS)
}

/// A disc around these points, with room for moves.
pub(crate) fn around(points: &[DVec2]) -> Vec<DVec2> {
    let Some((lo, hi)) = shapes::bounds(points) else {
        return usual();
    };
    let middle = (lo + hi) / 2.0;
    let reach = points
        .iter()
        .map(|p| p.distance(middle))
        .fold(0.0, f64::max);
    let disc = disc(reach + defaults::BASE_MARGIN);
    disc.into_iter().map(|p| p + middle).collect()
}

/// A base's outline without its rim.
pub(crate) fn on_base(reader: &mut Reader, base: &BasePlate, span: &Span) -> Vec<DVec2> {
    let rim = defaults::REGION_RIM;
    let width = shapes::narrowest(&base.outline);
    if width > 2.5 * rim {
        return inset(&base.outline, rim);
    }
    let text = format!(
        "the base is {} mm wide: no pillar has room on it",
        short(width)
    );
    reader.error(base.span.as_ref().unwrap_or(span), text);
    base.outline.clone()
}

/// A convex counter-clockwise polygon with its sides moved inwards by `by`.
fn inset(outline: &[DVec2], by: f64) -> Vec<DVec2> {
    let n = outline.len();
    let inward = |i: usize| {
        (outline[(i + 1) % n] - outline[i % n])
            .perp()
            .normalize_or_zero()
    };
    let corner = |i: usize| {
        let (a, b) = (inward(i + n - 1), inward(i));
        outline[i] + by * (a + b) / (1.0 + a.dot(b))
    };
    (0..n).map(corner).collect()
}
