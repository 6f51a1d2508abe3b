//! Convex regions in plan: hulls, the line that parts two of them best, half planes.

use glam::DVec2;

/// The line `normal . p = offset` in the middle of the widest strip between two convex polygons: the first lies on its lesser side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parting {
    /// Unit.
    pub normal: DVec2,
    pub offset: f64,
    /// Width of the strip, millimetres; negative if the polygons overlap by that much.
    pub room: f64,
}

/// Parts two counter-clockwise convex polygons as well as they can be parted.
pub fn part(a: &[DVec2], b: &[DVec2]) -> Parting {
    let along = |polygon: &[DVec2], normal: DVec2| {
        let ends = polygon.iter().map(|p| p.dot(normal));
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        })
    };
    let parting = |normal: DVec2| {
        let (hi, lo) = (along(a, normal).1, along(b, normal).0);
        Parting {
            normal,
            offset: (hi + lo) / 2.0,
            room: lo - hi,
        }
    };
    let outward = |polygon: &[DVec2]| -> Vec<DVec2> {
        let n = polygon.len();
        (0..n)
            .map(|i| {
                -(polygon[(i + 1) % n] - polygon[i])
                    .perp()
                    .normalize_or_zero()
            })
            .collect()
    };
    // The widest strip is square to a side of one, or to the line between two corners.
    let sides = outward(a)
        .into_iter()
        .chain(outward(b).into_iter().map(|n| -n));
    let corners = a
        .iter()
        .flat_map(|p| b.iter().map(move |q| (*q - *p).normalize_or_zero()));
    let best = |list: &mut dyn Iterator<Item = DVec2>| {
        list.filter(|n| *n != DVec2::ZERO)
            .map(parting)
            .reduce(|best, p| if p.room > best.room { p } else { best })
    };
    let by_sides = best(&mut sides.into_iter());
    let by_corners = best(&mut corners.into_iter()).filter(|p| p.room > 0.0);
    [by_sides, by_corners]
        .into_iter()
        .flatten()
        .reduce(|x, y| if y.room > x.room { y } else { x })
        .unwrap_or(Parting {
            normal: DVec2::X,
            offset: 0.0,
            room: 0.0,
        })
}

/// The part of a convex polygon with `normal . p <= offset` (Sutherland & Hodgman).
pub fn clipped(polygon: &[DVec2], normal: DVec2, offset: f64) -> Vec<DVec2> {
    let n = polygon.len();
    let mut kept = Vec::new();
    for i in 0..n {
        let (p, q) = (polygon[i], polygon[(i + 1) % n]);
        let (dp, dq) = (normal.dot(p) - offset, normal.dot(q) - offset);
        if dp <= 0.0 {
            kept.push(p);
        }
        if (dp < 0.0) != (dq < 0.0) && dp != dq {
            kept.push(p.lerp(q, dp / (dp - dq)));
        }
    }
    kept
}
