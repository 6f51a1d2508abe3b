//! The outlines of the supports as the eye sees them.

use super::field::SupportField;
use crate::geom::{ImagePlane, segment_crossing};
use crate::index::{FaceId, FacetId, SupportId};
use crate::mesh::Edges;
use crate::mesh::topology::HalfEdge;
use crate::support::SupportKind;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Unit normals that differ by less belong to one plane: rounding of coordinates.
const PLANE: f64 = 1e-9;

/// A ray through a line grazes the line's own support there: hits nearer by less than this are its own, millimetres.
const GRAZED: f64 = 1e-3;

/// A piece of outline in the image.
pub(crate) type Segment = [DVec2; 2];

/// An outline edge in space with its image and inverse depths.
struct OutlineEdge {
    image: Segment,
    inverse_depth: [f64; 2],
}

/// The pieces of all supports' outlines inside the rectangle `window` that are not hidden by another support.
pub(crate) fn seen_outlines(
    plane: &ImagePlane,
    field: &SupportField,
    window: (DVec2, DVec2),
) -> Vec<Segment> {
    let mut lines: Vec<OutlineEdge> = silhouette(field, plane.eye)
        .iter()
        .filter_map(|e| line(plane, *e))
        .collect();
    lines.extend(feet(field).iter().filter_map(|e| line(plane, *e)));
    lines.retain_mut(|l| clip(l, window));
    let mut seen = Vec::new();
    for (i, l) in lines.iter().enumerate() {
        let cuts = cuts(&lines, i);
        for pair in cuts.windows(2).filter(|p| p[1] - p[0] > 1e-12) {
            if is_seen(plane, field, l, (pair[0] + pair[1]) / 2.0) {
                seen.push([
                    l.image[0].lerp(l.image[1], pair[0]),
                    l.image[0].lerp(l.image[1], pair[1]),
                ]);
            }
        }
    }
    seen.extend(far_outlines(plane, field, window));
    seen
}

/// Where rays pass from one plane to the next on leaving the wall that they first meet, where a layer goes through that.
fn far_outlines(plane: &ImagePlane, field: &SupportField, window: (DVec2, DVec2)) -> Vec<Segment> {
    let edges = far_edges(field, plane.eye);
    let clipped = edges.into_iter().filter_map(|(support, ends)| {
        let mut l = line(plane, ends)?;
        clip(&mut l, window).then_some((support, l))
    });
    let (supports, lines): (Vec<SupportId>, Vec<OutlineEdge>) = clipped.unzip();
    let pieces = |i: usize| {
        let l: &OutlineEdge = &lines[i];
        let cuts = cuts(&lines, i);
        let pairs = cuts.windows(2).filter(|p| p[1] - p[0] > 1e-12);
        let ends = pairs.filter(|p| is_in_wall(plane, field, supports[i], l, p[0].midpoint(p[1])));
        let image = |t: f64| l.image[0].lerp(l.image[1], t);
        ends.map(|p| [image(p[0]), image(p[1])]).collect()
    };
    let pieces: Vec<Vec<Segment>> = (0..lines.len()).into_par_iter().map(pieces).collect();
    pieces.concat()
}

/// Edges of faces turned away from the eye of supports whose layers go through walls, with their supports.
fn far_edges(field: &SupportField, eye: DVec3) -> Vec<(SupportId, [DVec3; 2])> {
    let mesh = &field.mesh;
    let owner = |sides: &[HalfEdge]| field.owner[sides[0].face];
    let away = |h: &HalfEdge| mesh.area_vector(h.face).dot(eye - mesh.corners(h.face)[0]) <= 0.0;
    let edges = Edges::new(mesh);
    let wanted = edges
        .iter()
        .filter(|sides| field.goes_through(owner(sides)) && sides.iter().any(away));
    let ends = |sides: &[HalfEdge]| [sides[0].low, sides[0].high].map(|v| mesh.vertices[v]);
    wanted.map(|sides| (owner(sides), ends(sides))).collect()
}

/// Whether the line at parameter `t` lies between where a ray meets the support and where it leaves it again.
fn is_in_wall(
    plane: &ImagePlane,
    field: &SupportField,
    support: SupportId,
    l: &OutlineEdge,
    t: f64,
) -> bool {
    let direction = plane.direction(l.image[0].lerp(l.image[1], t));
    let depth = 1.0 / (l.inverse_depth[0] + t * (l.inverse_depth[1] - l.inverse_depth[0]));
    let wall = field.wall(support, plane.eye, direction);
    wall.is_some_and(|(first, leaves)| (first.t - GRAZED..=leaves.t + GRAZED).contains(&depth))
}

/// Edges between a face turned to the eye and one turned away (or no face), and those between two planes of a surface that a
/// layer follows.
fn silhouette(field: &SupportField, eye: DVec3) -> Vec<[DVec3; 2]> {
    let mesh = &field.mesh;
    let faces_eye = |f: FaceId| mesh.area_vector(f).dot(eye - mesh.corners(f)[0]) > 0.0;
    let on_outline = |sides: &&[HalfEdge]| {
        let front = sides.iter().filter(|h| faces_eye(h.face)).count();
        front == 1 || (front > 0 && (sides.len() != 2 || is_bent(field, sides)))
    };
    let ends = |sides: &[HalfEdge]| [sides[0].low, sides[0].high].map(|v| mesh.vertices[v]);
    Edges::new(mesh)
        .iter()
        .filter(on_outline)
        .map(ends)
        .collect()
}

/// Whether a layer follows the surface round this edge, and its faces are not one plane; or whether parts meet there.
fn is_bent(field: &SupportField, sides: &[HalfEdge]) -> bool {
    let normal = |h: &HalfEdge| field.mesh.normal(h.face);
    let apart = |h: &HalfEdge| normal(h).distance(normal(&sides[0])) > PLANE;
    let parted =
        |h: &HalfEdge| field.part(FacetId::of(h.face)) != field.part(FacetId::of(sides[0].face));
    (field.is_shell(FacetId::of(sides[0].face)) && sides.iter().any(apart))
        || sides.iter().any(parted)
}

/// Where pillars stand on the base: no silhouette, but the support changes there.
fn feet(field: &SupportField) -> Vec<[DVec3; 2]> {
    let Some(z) = field.base_top() else {
        return Vec::new();
    };
    let mut rings = Vec::new();
    for support in field.supports {
        if let SupportKind::Pillar {
            profile,
            bottom,
            top,
            ..
        } = &support.kind
            && (*bottom..*top).contains(&z)
        {
            let n = profile.len();
            rings.extend((0..n).map(|i| [profile[i].extend(z), profile[(i + 1) % n].extend(z)]));
        }
    }
    rings
}

fn line(plane: &ImagePlane, ends: [DVec3; 2]) -> Option<OutlineEdge> {
    let image = [plane.project(ends[0])?, plane.project(ends[1])?];
    Some(OutlineEdge {
        image,
        inverse_depth: ends.map(|p| 1.0 / plane.depth(p)),
    })
}

/// Shortens the line to the window (Liang & Barsky 1984); false if nothing is left.
fn clip(l: &mut OutlineEdge, window: (DVec2, DVec2)) -> bool {
    let (a, d) = (l.image[0], l.image[1] - l.image[0]);
    let (mut t0, mut t1) = (0.0f64, 1.0f64);
    for k in 0..2 {
        for (p, q) in [(-d[k], a[k] - window.0[k]), (d[k], window.1[k] - a[k])] {
            if p == 0.0 && q < 0.0 {
                return false;
            } else if p < 0.0 {
                t0 = t0.max(q / p);
            } else if p > 0.0 {
                t1 = t1.min(q / p);
            }
        }
    }
    if t0 >= t1 {
        return false;
    }
    let inverse = |t: f64| l.inverse_depth[0] + t * (l.inverse_depth[1] - l.inverse_depth[0]);
    let clipped = OutlineEdge {
        image: [a + t0 * d, a + t1 * d],
        inverse_depth: [inverse(t0), inverse(t1)],
    };
    *l = clipped;
    true
}

/// Parameters along line `i` at which it crosses another, with both ends, in rising order.
fn cuts(lines: &[OutlineEdge], i: usize) -> Vec<f64> {
    let [a, b] = lines[i].image;
    let (lo, hi) = (a.min(b), a.max(b));
    let mut cuts = vec![0.0, 1.0];
    for (j, other) in lines.iter().enumerate() {
        let [c, d] = other.image;
        let apart = c.min(d).cmpgt(hi).any() || c.max(d).cmplt(lo).any();
        if j != i && !apart {
            cuts.extend(segment_crossing(a, b, c, d));
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts
}

/// Whether nothing stands in front of the line at parameter `t`.
fn is_seen(plane: &ImagePlane, field: &SupportField, l: &OutlineEdge, t: f64) -> bool {
    let q = l.image[0].lerp(l.image[1], t);
    let depth = 1.0 / (l.inverse_depth[0] + t * (l.inverse_depth[1] - l.inverse_depth[0]));
    field
        .first_hit(plane.eye, plane.direction(q))
        .is_none_or(|(_, z)| z > depth - GRAZED)
}
