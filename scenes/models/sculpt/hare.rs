//! Sitting hare in three-quarter view: fur locks, long open ears, eyes, whisker pads and paws.

use crate::coat::{Coat, Shape, Tile, scatter};
use crate::field::*;
use crate::meshing::Creature;
use glam::DVec3;

/// Turn of the hare (+x in its own frame) towards the viewer, degrees.
const TURN: f64 = -42.0;
const EYE: DVec3 = v(19.8, 6.3, 47.4);
const LOCK: Shape = Shape {
    shoulder: 0.15,
    point: 1.5,
    edge: 1.15,
    crown: 0.35,
    quill: 0.3,
};

/// The hare, about 78 mm tall.
pub(crate) fn hare() -> Creature {
    let fur = fur();
    let field = move |p: DVec3| {
        let t = turn(-TURN) * p;
        let m = mirror_y(t);
        let mut d = trunk(t, m) - fur.height(t) - folds(m);
        d = join(d, paws(m), 0.8);
        d = join(d, ears(m), 1.5);
        join(d, face_parts(m, t), 0.5)
    };
    let edge = |p: DVec3| {
        let t = mirror_y(turn(-TURN) * p);
        let face = 1.0 - 0.28 * step(14.0, 7.0, t.distance(v(23.0, 3.0, 45.0)));
        0.645 * face * (1.0 + 1.0 * step(2.0, 14.0, p.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-42.0, -42.0, -3.0),
        high: v(42.0, 42.0, 86.0),
        edge: Box::new(edge),
    }
}

/// Everything that carries fur, in the hare's frame and mirrored.
fn trunk(p: DVec3, m: DVec3) -> f64 {
    let rump = ellipsoid(p, v(-13.0, 0.0, 17.0), v(16.0, 13.5, 15.0));
    let torso = turned_ellipsoid(
        p,
        v(-1.0, 0.0, 23.0),
        axes(v(1.0, 0.0, 0.45), v(0., 0., 1.)),
        v(18.0, 11.0, 12.5),
    );
    let chest = ellipsoid(p, v(9.0, 0.0, 26.0), v(9.0, 9.0, 12.5));
    let neck = cone(p, v(9.0, 0.0, 32.0), v(14.0, 0.0, 42.0), 8.6, 7.2);
    let thigh = turned_ellipsoid(
        m,
        v(-9.0, 10.2, 14.0),
        axes(v(1.0, 0.05, -0.35), v(0., 0., 1.)),
        v(13.0, 6.2, 11.0),
    );
    let shoulder = ellipsoid(m, v(7.5, 6.8, 22.0), v(6.2, 4.6, 9.5));
    let fore = tube(
        m,
        &[
            (v(9.5, 6.2, 20.0), 5.0),
            (v(12.0, 5.4, 10.0), 3.6),
            (v(13.0, 5.2, 3.6), 3.0),
        ],
        2.0,
    );
    let tail = ball(p, v(-29.0, 0.0, 13.5), 5.6);
    let mut d = join(join(rump, torso, 8.0), join(chest, neck, 6.0), 6.0);
    d = join(d, thigh, 2.2);
    d = join(d, join(shoulder, fore, 2.5), 2.0);
    d = join(d, tail, 1.5);
    join(d, head(p, m), 3.5)
}

fn head(p: DVec3, m: DVec3) -> f64 {
    let skull = ellipsoid(p, v(16.5, 0.0, 46.5), v(10.0, 7.8, 8.4));
    let muzzle = ellipsoid(p, v(25.0, 0.0, 43.0), v(6.4, 4.9, 5.0));
    let cheek = ellipsoid(m, v(19.0, 4.6, 42.0), v(5.6, 3.8, 4.6));
    join(join(skull, muzzle, 5.0), cheek, 2.5)
}

/// Feet with toes.
fn paws(m: DVec3) -> f64 {
    let hind = tube(
        m,
        &[
            (v(-15.0, 11.0, 4.0), 3.9),
            (v(-4.0, 12.6, 3.6), 3.5),
            (v(5.5, 13.4, 3.0), 3.2),
        ],
        2.0,
    );
    let fore = ellipsoid(m, v(15.4, 5.2, 2.7), v(4.4, 3.4, 2.8));
    let mut d = join(hind, fore, 0.5);
    for k in [-1.0, 0.0, 1.0] {
        let long = 1.2 * (1.0 - f64::abs(k));
        let toe = cone(
            m,
            v(5.0, 13.4 + 2.1 * k, 2.6),
            v(8.4 + long, 13.6 + 2.5 * k, 2.0),
            1.9,
            1.7,
        );
        let finger = cone(
            m,
            v(16.5, 5.2 + 2.0 * k, 2.4),
            v(18.9 + long, 5.2 + 2.3 * k, 1.9),
            1.7,
            1.5,
        );
        d = join(d, toe.min(finger), 0.6);
    }
    d
}

/// Long ears: leaf-shaped, hollow towards the viewer, with a thick rim and veins inside.
fn ears(m: DVec3) -> f64 {
    let (base, tip) = (v(13.0, 3.4, 51.0), v(4.0, 9.8, 79.0));
    let up = (tip - base).normalize();
    let open = v(0.85, 0.3, 0.25);
    let open = (open - up * open.dot(up)).normalize();
    let side = up.cross(open);
    let d = m - base;
    let q = v(d.dot(side), d.dot(open), d.dot(up));
    let middle = 15.5;
    let outer = ellipsoid(q, v(0.0, 0.0, middle), v(5.6, 3.4, 15.8));
    let root = cone(q, v(0.0, 0.0, -3.0), v(0.0, 0.0, 8.0), 3.6, 3.4);
    let hollow = ellipsoid(q, v(0.0, 3.4, middle + 0.5), v(3.9, 3.6, 13.2));
    let vein = 0.22 * (q.x * 2.0 + 0.15 * q.z).cos() * step(4.0, 9.0, q.z);
    carve(join(outer, root, 3.0), hollow + vein, 1.6)
}

fn face_parts(m: DVec3, p: DVec3) -> f64 {
    let out = v(0.45, 0.86, 0.15).normalize();
    // The lids are a ring flattened from above and below, which gives the eye its almond shape.
    let gaze = (m - EYE) * v(1.0, 1.0, 1.22);
    let r = (gaze - out * gaze.dot(out)).length();
    let dimple = 0.5 * step(1.8, 0.9, r) * step(0.0, 1.0, gaze.dot(out));
    let eye = ball(m, EYE + out * 0.25, 3.1) + dimple;
    let lid = ring(gaze, out * 1.4, out, 3.6, 0.85) / 1.1;
    let pad = ellipsoid(m, v(27.4, 2.3, 41.6), v(4.0, 2.9, 3.0));
    let q = m - v(27.4, 2.3, 41.6);
    let dots =
        0.28 * (q.x * 2.6).sin() * (q.z * 2.6).sin() * step(3.0, 1.5, q.x) * step(-3.2, -1.8, q.x);
    let bridge = cone(p, v(21.0, 0.0, 47.4), v(29.6, 0.0, 44.6), 3.6, 2.3);
    let nose = ellipsoid(m, v(30.6, 0.7, 44.4), v(1.7, 1.7, 1.3));
    let nostril = ball(m, v(32.0, 1.1, 44.1), 0.55);
    let chin = ellipsoid(p, v(26.0, 0.0, 38.4), v(3.4, 2.6, 2.0));
    let mut d = join(pad - dots, chin, 0.6);
    d = join(d, bridge, 1.6);
    d = join(d, carve(nose, nostril, 0.4), 0.35);
    join(d, join(eye, lid, 0.25), 1.0)
}

/// Soft folds of skin on the haunch and between the legs.
fn folds(m: DVec3) -> f64 {
    0.5 * noise(v(m.x * 0.16, m.y * 0.16, m.z * 0.2))
}

/// Locks of fur that follow the body from the nose back and down.
fn fur() -> Coat {
    let whole = |p: DVec3| trunk(p, mirror_y(p));
    let gap = |p: DVec3| {
        let m = mirror_y(p);
        let bare = m.distance(EYE) < 4.8 || p.x > 27.0 || p.z < 1.5 || (p.z < 5.0 && p.x > 8.0);
        let face = step(22.0, 12.0, p.distance(v(24.0, 0.0, 45.0)));
        (!bare).then_some(3.4 - 1.6 * face)
    };
    let roots = scatter(&whole, v(-38., -20., 0.), v(36., 20., 58.), &gap);
    let tiles = roots.into_iter().map(|p| {
        let m = mirror_y(p);
        let face = step(22.0, 12.0, p.distance(v(24.0, 0.0, 45.0)));
        let trunk_flow = v(-1.0, 0.15 * p.y.signum(), -0.35);
        let limb = v(-0.25, 0.0, -1.0);
        let chest = step(4.0, 10.0, p.x) * step(42.0, 38.0, p.z);
        let low = (step(24.0, 12.0, p.z) * step(12.0, 18.0, m.y + 8.0)).max(chest);
        let sway = 0.5 * noise(p * 0.15 + v(7.0, 0.0, 0.0));
        let flow = trunk_flow.lerp(limb, low) + v(0.0, 0.0, sway);
        let wild = 1.0 + 0.35 * noise(p * 0.9);
        let size = (1.0 - 0.38 * face) * wild;
        Tile::on(
            &whole,
            p,
            flow,
            [7.6 * size, 2.2 * size.max(0.7), (0.95 - 0.1 * face) * size],
        )
    });
    Coat::new(tiles.collect(), LOCK)
}
