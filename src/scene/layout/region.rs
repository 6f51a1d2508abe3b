//! Where planned pillars may stand, and what can be said of it before any is found.

use crate::diag::Diagnostic;
use crate::geom::to_segment;
use crate::scene::checks::{Slab, Standing};
use crate::scene::defaults;
use crate::scene::language::raw::RawRegion;
use crate::scene::supports::bases::bounds;
use crate::scene::supports::cross_section as sections;
use crate::scene::supports::places::{positive, turn};
use crate::scene::supports::shapes;
use crate::scene::text::reader::{Reader, Span, error_at, short, warning_at};
use glam::DVec2;

/// The room of planned pillars, for the checks.
pub struct Room {
    /// Counter-clockwise, millimetres.
    pub region: Vec<DVec2>,
    /// Highest top that a pillar may have.
    pub tops: f64,
    pub span: Span,
    /// One pillar of each allowed shape at its largest height, nowhere in particular.
    pub samples: Vec<Standing>,
}

/// What a scene says of the region.
pub fn region(reader: &mut Reader, raw: &RawRegion, span: &Span) -> Option<Vec<DVec2>> {
    let centre = |reader: &mut Reader, field| {
        let point = reader.point_field(field, "centre");
        point.map_or(DVec2::ZERO, |(p, _)| p.into())
    };
    let (outline, centre) = match raw {
        RawRegion::Disc(raw) => {
            reader.need(&raw.radius, "radius", "this Disc", span);
            let radius = positive(reader, &raw.radius, "radius");
            let centre = centre(reader, &raw.centre);
            (disc(radius?), centre)
        }
        RawRegion::Rectangle(raw) => {
            reader.need(&raw.width, "width", "this Rectangle", span);
            reader.need(&raw.depth, "depth", "this Rectangle", span);
            let width = positive(reader, &raw.width, "width");
            let depth = positive(reader, &raw.depth, "depth");
            let turn = turn(reader, &raw.turn);
            let centre = centre(reader, &raw.centre);
            (shapes::rectangle(width?, depth?, turn), centre)
        }
        RawRegion::Polygon(raw) => {
            let (list, at) = reader.required(&raw.points, "points", "this Polygon", span)?;
            let points = sections::points(reader, list, &at)?;
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
pub fn usual() -> Vec<DVec2> {
    disc(defaults::REGION_RADIUS)
}

/// A disc around these points, with room for moves.
pub fn around(points: &[DVec2]) -> Vec<DVec2> {
    let Some((lo, hi)) = bounds(points) else {
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
pub fn on_base(reader: &mut Reader, slab: &Slab, span: &Span) -> Vec<DVec2> {
    let rim = defaults::REGION_RIM;
    let width = shapes::narrowest(&slab.outline);
    if width > 2.5 * rim {
        return inset(&slab.outline, rim);
    }
    let text = format!(
        "the base is {} mm wide: no pillar has room on it",
        short(width)
    );
    reader.error(slab.span.as_ref().unwrap_or(span), text);
    slab.outline.clone()
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

/// The region must lie on the base.
pub fn footing(room: &Room, slab: &Slab) -> Option<Diagnostic> {
    let n = slab.outline.len();
    let on_rim =
        |p: DVec2| (0..n).any(|i| to_segment(p, slab.outline[i], slab.outline[(i + 1) % n]) < 1e-6);
    let on = |p: &DVec2| shapes::contains(&slab.outline, *p) || on_rim(*p);
    let help = "enlarge the base, leave its size out (it then fits the region), or make the region smaller";
    if shapes::gap(&room.region, &slab.outline) > 0.0 {
        return Some(error_at(&room.span, "the region lies beside the base").help(help));
    }
    let hangs = room.region.iter().any(|p| !on(p));
    hangs.then(|| warning_at(&room.span, "the region hangs over the edge of the base").help(help))
}
