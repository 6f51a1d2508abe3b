//! Fish with its flank towards -y: overlapping scales, rayed fins, gill cover, eye and lips.

use crate::coat::{Coat, Shape, Tile};
use crate::field::*;
use crate::meshing::Creature;
use glam::{DVec2, DVec3};

/// Outline of the body from tail root to nose: (x, upper z), (x, lower z) and (x, half thickness), mm.
const BACK: [(f64, f64); 8] = [
    (-27., 4.2),
    (-20., 6.2),
    (-10., 12.5),
    (2., 17.5),
    (13., 17.2),
    (22., 12.5),
    (29., 6.5),
    (33.5, 1.0),
];
const BELLY: [(f64, f64); 8] = [
    (-27., -4.2),
    (-20., -5.6),
    (-10., -10.8),
    (2., -15.5),
    (13., -15.8),
    (22., -11.8),
    (29., -6.8),
    (33.5, -2.6),
];
const GIRTH: [(f64, f64); 8] = [
    (-27., 2.6),
    (-20., 4.0),
    (-10., 7.2),
    (2., 10.2),
    (13., 10.8),
    (22., 9.0),
    (29., 5.8),
    (33.5, 3.0),
];

/// Height of the fish relative to the tables above and the fins' outlines.
const TALL: f64 = 1.2;
const EYE: DVec3 = v(22.6, 8.3, 3.8);
const SCALE: Shape = Shape {
    shoulder: 0.4,
    point: 2.0,
    edge: 1.2,
    crown: 0.35,
    quill: 0.0,
};

/// The fish, about 80 mm long, nose towards +x.
pub(crate) fn fish() -> Creature {
    let scales = scales();
    let field = move |p: DVec3| {
        let q = straighten(p);
        let m = mirror_y(q);
        let skin = body(q) - head_relief(m) - scales.height(q);
        let mut d = join(skin, fins(q, m), 1.2);
        d = join(d, eye(m), 0.4);
        d = join(d, mouth(q), 0.5);
        carve(d, gape(q), 0.5)
    };
    let edge = |p: DVec3| {
        let near = mirror_y(straighten(p)).distance(EYE);
        0.6 * (1.0 - 0.25 * step(9.0, 4.0, near)) * (1.0 + 1.0 * step(0.5, 5.0, straighten(p).y))
    };
    Creature {
        field: Box::new(field),
        low: v(-50.0, -26.0, -38.0),
        high: v(42.0, 26.0, 42.0),
        edge: Box::new(edge),
    }
}

/// Undoes the swimming bend: tail and nose swing towards the viewer and away.
fn straighten(p: DVec3) -> DVec3 {
    let bend = 5.0 * ((p.x + 6.0) * 0.055).cos() - 4.0;
    let tail = -6.0 * step(-15.0, -50.0, p.x);
    v(p.x, p.y - bend - tail, p.z)
}

fn body(p: DVec3) -> f64 {
    let p = v(p.x, p.y, p.z / TALL);
    let x = p.x.clamp(-27.0, 33.5);
    let (up, low, wide) = (curve(x, &BACK), curve(x, &BELLY), curve(x, &GIRTH));
    let (mid, high) = ((up + low) * 0.5, (up - low) * 0.5);
    let end = (p.x - x) * 1.6;
    let r = v(wide, high, 0.5 * (wide + high));
    ellipsoid(v(p.y, p.z - mid, end), DVec3::ZERO, r)
}

/// Share of a point that lies behind the gill cover: 0 on the head, 1 on the trunk.
fn behind_gill(p: DVec3) -> f64 {
    step(10.4, 9.2, gill(p))
}

/// Distance-like coordinate that is constant along the rear edge of the gill cover.
fn gill(p: DVec3) -> f64 {
    34.0 - (24.5 - p.x).hypot(0.85 * (p.z - 0.5)) - 9.0
}

/// Gill cover with its rim, cheek plate, and nostril.
fn head_relief(m: DVec3) -> f64 {
    let g = gill(m) - 9.8;
    let cover = 1.1 * step(-0.6, 0.6, g) * step(12.0, 3.0, g);
    let rim = 0.55 * bell(g, 1.2, 0.7);
    let spokes =
        0.18 * ((m.z - 0.5).atan2(24.5 - m.x) * 26.0).cos() * step(1.6, 2.6, g) * step(6.5, 4.5, g);
    let plate = 0.6 * bell(g, 6.6, 0.8) * step(9.0, 4.0, m.z.abs()) + 0.5 * step(6.0, 7.6, g);
    let nostril = -0.7 * bell(v(m.x, 0.0, m.z).distance(v(29.2, 0.0, 3.0)), 0.0, 0.8);
    let flank = step(0.5, 2.5, m.y);
    flank * (cover + rim + spokes + plate + nostril)
}

fn eye(m: DVec3) -> f64 {
    let r = (m.x - EYE.x).hypot(m.z - EYE.z);
    let pupil = -0.8 * step(2.5, 1.6, r);
    let globe = ellipsoid(m, EYE - v(0.0, 1.0, 0.0), v(4.3, 3.1, 4.3)) - pupil;
    let lid = ring(
        m,
        EYE + v(0.0, -0.2, 0.0),
        v(0.14, 0.98, 0.1).normalize(),
        4.5,
        0.95,
    );
    join(globe, lid, 0.5)
}

fn mouth(p: DVec3) -> f64 {
    let m = mirror_y(p);
    let upper = tube(
        m,
        &[
            (v(33.8, 0.0, -0.2), 1.7),
            (v(32.4, 3.0, -1.4), 1.5),
            (v(29.6, 5.0, -3.4), 1.0),
        ],
        0.8,
    );
    let lower = tube(
        m,
        &[
            (v(33.0, 0.0, -4.2), 1.7),
            (v(31.8, 2.8, -4.6), 1.5),
            (v(29.4, 4.7, -5.0), 1.0),
        ],
        0.8,
    );
    join(upper, lower, 0.3)
}

fn gape(p: DVec3) -> f64 {
    ellipsoid(p, v(34.6, 0.0, -2.3), v(3.4, 3.0, 1.1))
}

/// A rayed plate: the outline (x, z) in its own plane, half thickness at the root and at the edge, rays from `hub`.
struct Fin<'a> {
    outline: &'a [DVec2],
    hub: DVec2,
    rays: f64,
    reach: f64,
}

impl Fin<'_> {
    /// Field at in-plane position `q` and height `h` above the plane.
    fn field(&self, q: DVec2, h: f64) -> f64 {
        let d = q - self.hub;
        let angle = d.y.atan2(d.x);
        let wave = (angle * self.rays).cos();
        let out = d.length() / self.reach;
        let scallop = 0.35 * wave * step(0.5, 1.0, out);
        let outline = polygon(q, self.outline) - 1.0 - scallop;
        let thick = 1.35 + 0.9 * (1.0 - out).max(0.0) + 0.4 * wave * step(0.25, 0.55, out);
        meet(outline, h.abs() - thick, 1.2)
    }
}

const fn c(x: f64, z: f64) -> DVec2 {
    DVec2::new(x, z)
}

fn fins(p: DVec3, m: DVec3) -> f64 {
    let flat = c(p.x, p.z / TALL);
    let tail = Fin {
        outline: &[
            c(-22., 2.),
            c(-28., 5.5),
            (c(-34., 12.)),
            c(-41., 18.5),
            c(-45., 20.),
            c(-44.5, 15.),
            c(-41.5, 8.),
            c(-39.8, 0.),
            c(-41.5, -8.),
            c(-44.5, -15.),
            c(-45., -20.),
            c(-41., -18.5),
            c(-34., -12.),
            c(-28., -5.5),
            c(-22., -2.),
        ],
        hub: c(-18.0, 0.0),
        rays: 48.0,
        reach: 27.0,
    };
    let dorsal = Fin {
        outline: &[
            c(18., 12.),
            c(14., 20.),
            c(9., 26.),
            c(3., 28.5),
            c(-3., 27.5),
            c(-9., 24.),
            c(-14., 20.5),
            c(-18.5, 18.),
            c(-17., 13.),
            c(-14., 8.),
            c(4., 13.),
        ],
        hub: c(10.0, -8.0),
        rays: 62.0,
        reach: 34.0,
    };
    let anal = Fin {
        outline: &[
            c(-3., -11.),
            c(-8., -19.),
            c(-13., -22.5),
            c(-18., -21.5),
            c(-18.5, -17.),
            c(-18., -12.),
            c(-17., -5.),
        ],
        hub: c(-4.0, -1.0),
        rays: 44.0,
        reach: 23.0,
    };
    let mut d = join(tail.field(flat, p.y), dorsal.field(flat, p.y), 0.5);
    d = join(d, anal.field(flat, p.y), 0.5);
    d = join(d, pectoral(m), 0.6);
    join(d, pelvic(m), 0.6)
}

/// Side fin behind the gill cover, standing off the flank.
fn pectoral(m: DVec3) -> f64 {
    let fin = Fin {
        outline: &[
            c(1., 1.6),
            c(-5., 4.0),
            c(-11., 4.6),
            c(-15.5, 2.5),
            c(-16., -1.5),
            c(-13., -5.5),
            c(-8., -7.0),
            c(-3., -5.),
            c(1., -1.6),
        ],
        hub: c(4.0, 0.0),
        rays: 36.0,
        reach: 19.0,
    };
    let frame = axes(v(0.93, -0.36, 0.22), v(0.0, 0.2, 1.0));
    let q = frame.transpose() * (m - v(11.5, 10.2, -5.0));
    fin.field(c(q.x, q.z), q.y + 0.012 * q.x * q.x)
}

/// Paired fin under the belly.
fn pelvic(m: DVec3) -> f64 {
    let fin = Fin {
        outline: &[
            c(2.5, 3.),
            c(2., -3.),
            c(-1., -8.),
            c(-6., -11.5),
            c(-9.5, -10.5),
            c(-9., -5.),
            c(-6., 0.),
            c(-3., 3.),
        ],
        hub: c(2.0, 6.0),
        rays: 36.0,
        reach: 18.0,
    };
    let frame = axes(v(1.0, 0.0, 0.0), v(0.0, -0.32, 1.0));
    let q = frame.transpose() * (m - v(4.0, 4.2, -13.5 * TALL));
    fin.field(c(q.x, q.z), q.y)
}

/// Rows of scales on both flanks, growing towards the tail; those in front cover the roots of those behind.
fn scales() -> Coat {
    let mut tiles = Vec::new();
    let mut x = 18.0;
    let mut column = 0;
    while x > -24.0 {
        let (up, low) = (curve(x, &BACK) * TALL, curve(x, &BELLY) * TALL);
        // Distance between neighbouring scales of a column at the middle of the flank.
        let gap = 0.5 * (up - low) * 0.235;
        for row in -7..=7 {
            // Equal steps of the angle around the body; fewer rows towards the tail would break the diagonals.
            let angle = (f64::from(row) + 0.5 * f64::from(column % 2)) * 0.235;
            let z = (up + low) * 0.5 + (up - low) * 0.5 * angle.min(1.5).sin();
            for side in [-1.0, 1.0] {
                let from = v(x, 40.0 * side, z);
                let Some(root) = march(&body, from, v(0.0, -side, 0.0)) else {
                    continue;
                };
                if behind_gill(root - v(1.0, 0.0, 0.0)) > 0.5 {
                    let size = [1.75 * gap + 0.9, 0.64 * gap, 0.3 * gap];
                    tiles.push(Tile::on(&body, root, v(-1.0, 0.0, 0.0), size));
                }
            }
        }
        x -= 0.72 * gap + 0.2;
        column += 1;
    }
    Coat::new(tiles, SCALE)
}
