//! Outlines in the ground plane and the upright prisms over them.

pub(crate) use crate::geom::{contains, gap, narrowest, to_segment};
use crate::geom::{polygon_area, segment_crossing};
use crate::index::VertexId;
use crate::mesh::TriMesh;
use crate::mesh::polygon::triangulate_outline;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A regular polygon of `sides` corners at `radius` around the origin, the first at angle `turn` (radians), counter-clockwise.
pub(crate) fn regular(sides: u32, radius: f64, turn: f64) -> Vec<DVec2> {
    (0..sides)
        .map(|i| radius * DVec2::from_angle(turn + TAU * f64::from(i) / f64::from(sides)))
        .collect()
}

/// A rectangle around the origin, turned by `turn` radians, counter-clockwise.
pub(crate) fn rectangle(width: f64, depth: f64, turn: f64) -> Vec<DVec2> {
    let half = DVec2::new(width, depth) / 2.0;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    corners
        .iter()
        .map(|&(x, y)| DVec2::from_angle(turn).rotate(DVec2::new(x, y) * half))
        .collect()
}

/// A polygon made fit: a repeated last point dropped, counter-clockwise.
///
/// # Errors
/// Why it is not a simple polygon of some area.
pub(crate) fn simple(mut points: Vec<DVec2>) -> Result<Vec<DVec2>, String> {
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let n = points.len();
    if n < 3 {
        return Err(format!(
            "an outline needs at least 3 different points, found {n}"
        ));
    }
    if let Some(i) = (0..n).find(|&i| points[i].distance(points[(i + 1) % n]) < 1e-3) {
        return Err(format!(
            "points {} and {} of the outline are less than 0.001 mm apart",
            i + 1,
            (i + 1) % n + 1
        ));
    }
    for i in 0..n {
        for j in i + 2..n {
            let next_door = i == 0 && j == n - 1;
            if !next_door
                && segment_crossing(points[i], points[i + 1], points[j], points[(j + 1) % n])
                    .is_some()
            {
                return Err(format!(
                    "the outline crosses itself: its sides {} and {} meet",
                    i + 1,
                    j + 1
                ));
            }
        }
    }
    let area = polygon_area(&points);
    if area.abs() < 1e-3 {
        return Err("the outline has no area".to_string());
    }
    if area < 0.0 {
        points.reverse();
    }
    Ok(points)
}

/// The closed prism over a simple counter-clockwise polygon, outward oriented. Vertices: the ring at the bottom, then the ring at
/// the top.
pub(crate) fn prism(profile: &[DVec2], bottom: f64, top: f64) -> TriMesh {
    let n = profile.len();
    let ring = |z: f64| profile.iter().map(move |p| DVec3::new(p.x, p.y, z));
    let vertices = ring(bottom).chain(ring(top)).collect();
    let mut faces = Vec::new();
    for [a, b, c] in triangulate_outline(profile) {
        faces.push([c, b, a]);
        faces.push([a + n, b + n, c + n]);
    }
    for i in 0..n {
        let j = (i + 1) % n;
        faces.push([i, j, j + n]);
        faces.push([i, j + n, i + n]);
    }
    let faces = faces.into_iter().map(|f| f.map(VertexId::new));
    TriMesh {
        vertices,
        faces: faces.collect(),
    }
}

/// Distance of a point from a polygon, 0 inside.
pub(crate) fn gap_to_point(polygon: &[DVec2], p: DVec2) -> f64 {
    if contains(polygon, p) {
        return 0.0;
    }
    let n = polygon.len();
    (0..n)
        .map(|i| to_segment(p, polygon[i], polygon[(i + 1) % n]))
        .fold(f64::INFINITY, f64::min)
}

/// Lowest and highest corner of a box around the points.
pub(crate) fn bounds(points: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let first = *points.first()?;
    Some(
        points
            .iter()
            .fold((first, first), |(l, h), p| (l.min(*p), h.max(*p))),
    )
}
