//! Owl on a stump: overlapping feather rows, facial discs with radial barbs, ear tufts, wings, talons.

use crate::coat::{Coat, Shape, Tile};
use crate::field::*;
use crate::meshing::Creature;
use glam::DVec3;

/// Centre of the right eye in the head's frame, mm.
const EYE: DVec3 = v(6.9, -13.2, 58.5);
/// Radius of the rim of a facial disc, mm.
const DISC: f64 = 9.6;
/// Turn of the body against the viewer and of the head against the body, degrees.
const BODY_TURN: f64 = 22.0;
const HEAD_TURN: f64 = -14.0;
/// Height of the stump, mm.
const STUMP: f64 = 7.0;

const FEATHER: Shape = Shape {
    shoulder: 0.35,
    point: 1.9,
    edge: 1.25,
    crown: 0.4,
    quill: 0.22,
};
const VANE: Shape = Shape {
    shoulder: 0.6,
    point: 1.8,
    edge: 1.35,
    crown: 0.3,
    quill: 0.35,
};

/// The owl, about 76 mm tall, facing -y.
pub(crate) fn owl() -> Creature {
    let body_coat = body_feathers();
    let head_coat = head_feathers();
    let wing_coat = wing_feathers();
    let field = move |p: DVec3| {
        let b = turn(-BODY_TURN) * p;
        let h = turn(-BODY_TURN - HEAD_TURN) * p;
        let w = mirror_x(b);
        let trunk = trunk(b) - body_coat.height(b);
        let wing = wing(w) - wing_coat.height(w);
        let skull = skull(h) - face_relief(h) - head_coat.height(h);
        let mut d = join(join(trunk, stump(b), 2.5), wing, 1.2);
        d = join(d, skull, 2.5);
        d = join(d, face_parts(mirror_x(h), h), 1.2);
        join(d, feet(w), 1.3)
    };
    let edge = |p: DVec3| {
        let h = turn(-BODY_TURN - HEAD_TURN) * p;
        let eye = mirror_x(h).distance(EYE);
        let face = 1.0 - 0.3 * step(11.0, 5.0, eye);
        0.68 * face * (1.0 + 1.2 * step(0.0, 10.0, p.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-30.0, -30.0, -2.0),
        high: v(30.0, 30.0, 84.0),
        edge: Box::new(edge),
    }
}

fn trunk(p: DVec3) -> f64 {
    let belly = ellipsoid(p, v(0.0, 0.0, 27.0), v(16.5, 15.0, 23.0));
    let chest = ellipsoid(p, v(0.0, -1.5, 39.0), v(15.5, 13.5, 15.0));
    let tail = turned_ellipsoid(
        p,
        v(0.0, 13.5, 15.5),
        axes(v(1., 0., 0.), v(0.0, -0.35, 1.0)),
        v(7.5, 4.0, 11.5),
    );
    join(join(belly, chest, 6.0), tail, 5.0)
}

fn skull(p: DVec3) -> f64 {
    let head = ellipsoid(p, v(0.0, -1.0, 58.0), v(17.0, 14.5, 12.8));
    let m = mirror_x(p);
    let tuft = tube(
        m,
        &[
            (v(10.0, -6.0, 65.0), 4.2),
            (v(13.8, -5.0, 72.0), 3.0),
            (v(16.6, -4.0, 79.5), 0.9),
        ],
        2.0,
    );
    join(head, tuft, 4.0)
}

fn wing(p: DVec3) -> f64 {
    let frame = axes(v(1.0, 0.12, 0.05), v(0.14, -0.38, 1.0));
    turned_ellipsoid(p, v(15.6, 3.5, 32.0), frame, v(5.2, 11.5, 22.5))
}

/// Distance from the axis of an eye in the plane of the face, and angle about it.
fn about_eye(p: DVec3) -> (f64, f64) {
    let (x, z) = (p.x.abs() - EYE.x, p.z - EYE.z);
    (x.hypot(z), z.atan2(x))
}

/// Dished facial discs with a raised rim and radial barbs.
fn face_relief(p: DVec3) -> f64 {
    let (r, angle) = about_eye(p);
    let front = step(-3.0, -8.0, p.y);
    let rim = 1.4 * bell(r, DISC, 1.1);
    let dish = -1.1 * step(DISC, DISC - 4.0, r);
    let barbs = 0.26
        * (angle * 17.0 + 0.5 * (r * 0.9).sin()).cos()
        * step(5.2, 6.4, r)
        * step(DISC, DISC - 1.2, r);
    front * (rim + dish + barbs)
}

/// Eyes, brows and beak; `m` is the mirrored point.
fn face_parts(m: DVec3, p: DVec3) -> f64 {
    let (r, _) = about_eye(p);
    let pupil = -0.8 * step(2.5, 1.6, r);
    let eye = ball(m, EYE, 4.6) - pupil * step(-13.0, -15.0, p.y);
    let lid = ring(
        m,
        EYE + v(0.3, -2.6, 0.0),
        v(0.17, -0.98, 0.1).normalize(),
        4.25,
        0.85,
    );
    let brow = tube(
        m,
        &[
            (v(1.0, -15.8, 59.0), 1.5),
            (v(6.0, -14.6, 64.6), 2.6),
            (v(10.5, -10.5, 67.6), 3.0),
            (v(13.6, -6.0, 72.0), 2.4),
        ],
        3.0,
    );
    let streaks = 0.3 * ((m.z - m.x) * 2.3).cos() * step(3.0, 5.0, m.x);
    let beak = tube(
        v(p.x * 1.25, p.y, p.z),
        &[
            (v(0.0, -14.0, 57.5), 2.6),
            (v(0.0, -17.2, 55.8), 2.7),
            (v(0.0, -18.9, 53.0), 2.0),
            (v(0.0, -18.7, 50.2), 1.0),
        ],
        0.8,
    );
    let cere = ellipsoid(p, v(0.0, -16.8, 57.6), v(2.3, 2.2, 1.6));
    join(
        join(join(eye, lid, 0.9), brow - streaks, 1.2),
        join(beak, cere, 0.4),
        1.0,
    )
}

/// Feathered legs, three toes each and claws over the edge of the stump.
fn feet(m: DVec3) -> f64 {
    let leg = cone(m, v(6.5, -4.0, 16.0), v(7.0, -9.5, 10.0), 5.5, 3.6);
    let mut d = leg;
    for (tip, spread) in [
        (v(3.3, -15.2, STUMP + 1.2), 0.6),
        (v(7.2, -16.0, STUMP + 1.2), 0.0),
        (v(10.8, -14.2, STUMP + 1.2), -0.5),
    ] {
        let knuckle = (v(7.0, -10.0, 9.6) + tip) * 0.5 + v(0.0, 0.0, 1.0);
        let toe = tube(
            m,
            &[
                (v(7.0 - spread, -9.5, 9.8), 2.2),
                (knuckle, 1.75),
                (tip, 1.7),
            ],
            0.4,
        );
        let out = (tip - v(7.0, -10.0, tip.z)).normalize();
        let claw = tube(
            m,
            &[
                (tip + v(0.0, 0.0, 0.3), 1.3),
                (tip + out * 2.2 - v(0.0, 0.0, 0.4), 1.1),
                (tip + out * 3.1 - v(0.0, 0.0, 2.6), 0.75),
            ],
            0.4,
        );
        // Pads under knuckle and claw: without them the arch of the toe and the stump would form loops.
        let pads = tube(
            m,
            &[
                (knuckle - v(0.0, 0.0, 1.9), 1.7),
                (tip - v(0.0, 0.0, 1.2), 1.6),
                (tip + out * 1.5 - v(0.0, 0.0, 2.2), 1.2),
            ],
            0.5,
        );
        d = join(d, join(join(toe, claw, 0.25), pads, 0.5), 0.5);
    }
    d
}

/// Stump with bark ridges and year rings.
fn stump(p: DVec3) -> f64 {
    let p = p + v(0.0, 2.5, 0.0);
    let radial = p.x.hypot(p.y);
    let angle = p.y.atan2(p.x);
    let wave = (angle * 11.0 + 1.6 * noise(v(angle * 2.0, 0.0, p.z * 0.25))).sin();
    let bark = 0.9 * (wave * wave + 0.1).sqrt() + 0.5 * noise(v(p.x * 0.5, p.y * 0.5, p.z * 0.8));
    let side = radial - 16.3 - 0.04 * (STUMP - p.z).max(0.0).powi(2) - bark;
    let rings = 0.16 * (radial * 3.4 + noise(p * 0.2)).sin();
    let top = p.z - STUMP - rings;
    meet(meet(side, top, 1.4), -p.z, 0.6)
}

/// Rows of feathers around the trunk, growing downwards; the upper row covers the roots of the lower one.
fn body_feathers() -> Coat {
    let mut tiles = Vec::new();
    let mut z = 11.0;
    let mut row = 0;
    while z < 54.0 {
        let count = 17;
        for i in 0..count {
            let angle = (f64::from(i) + 0.5 * f64::from(row % 2)) / f64::from(count)
                * std::f64::consts::TAU;
            let dir = v(angle.cos(), angle.sin(), 0.0);
            let jitter = scramble(i64::from(i), row.into(), 5) - 0.5;
            let from = v(0.0, 0.0, z + 3.0 + 0.7 * jitter) + dir * 60.0;
            if let Some(root) = march(&trunk, from, -dir) {
                let grow = 1.0 + 0.12 * jitter;
                tiles.push(Tile::on(
                    &trunk,
                    root,
                    v(0.12 * jitter, 0.0, -1.0),
                    [9.2 * grow, 3.6, 1.1],
                ));
            }
        }
        z += 4.7;
        row += 1;
    }
    Coat::new(tiles, FEATHER)
}

/// Small feathers on the crown, cheeks and ear tufts, growing away from the face.
fn head_feathers() -> Coat {
    let wanted = |p: DVec3| {
        let (r, _) = about_eye(p);
        let on_face = p.y < -4.0 && r < DISC + 0.7;
        (!on_face && p.z > 47.0).then_some(3.6)
    };
    let roots = crate::coat::scatter(&skull, v(-20., -18., 44.), v(20., 16., 82.), &wanted);
    let flow = |p: DVec3| {
        let back = v(0.0, 1.0, -0.35);
        let up = v(p.x.signum() * 0.3, 0.1, 1.0);
        let m = mirror_x(p);
        let tuft = step(66.0, 70.0, p.z) * step(6.0, 10.0, m.x);
        let away = v(p.x - EYE.x * p.x.signum(), 0.0, p.z - EYE.z).normalize_or_zero();
        let front = step(2.0, -8.0, p.y);
        back.lerp(away, 0.7 * front).lerp(up, tuft)
    };
    let tiles = roots
        .into_iter()
        .map(|p| {
            let tuft = step(66.0, 70.0, p.z) * step(6.0, 10.0, p.x.abs());
            Tile::on(
                &skull,
                p,
                flow(p),
                [6.4 + 1.6 * tuft, 2.5 - 0.5 * tuft, 0.8 + 0.3 * tuft],
            )
        })
        .collect();
    Coat::new(tiles, FEATHER)
}

/// Coverts at the shoulder, then ever longer rows down to the flight feathers.
fn wing_feathers() -> Coat {
    // (height of the roots, count across, length, half width, lift)
    let rows = [
        (52.5, 5, 6.0, 2.6, 0.8),
        (48.6, 7, 7.0, 2.8, 0.9),
        (44.3, 8, 7.5, 2.8, 1.0),
        (39.6, 8, 8.5, 2.9, 1.0),
        (34.5, 8, 11.0, 2.8, 1.1),
        (27.5, 8, 15.0, 2.6, 1.2),
        (18.0, 7, 17.0, 2.5, 1.2),
    ];
    let mut tiles = Vec::new();
    for (j, (z, count, length, half, lift)) in rows.into_iter().enumerate() {
        let centre = v(15.6, 3.5 + 0.38 * (32.0 - z), z);
        for i in 0..count {
            let across = (f64::from(i) + 0.5 * (j % 2) as f64) / f64::from(count - 1) - 0.5;
            let (sin, cos) = (across * 2.7).sin_cos();
            let from = centre + v(11.0 * cos, 22.0 * sin, -4.0 * sin);
            let Some(root) = march(&wing, from, (centre - from).normalize()) else {
                continue;
            };
            tiles.push(Tile::on(
                &wing,
                root,
                v(-0.1, 0.4, -1.0),
                [length, half, lift],
            ));
        }
    }
    Coat::new(tiles, VANE)
}
