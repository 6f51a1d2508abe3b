//! Standing cow from the side, her head turned to the viewer: raised patches of coat, horns, ears, bell, udder and tail.
//! Light (about 12,000 vertices), so that a herd can be put together from copies.

use crate::field::*;
use crate::meshing::Creature;
use glam::DVec3;

/// Turn of the body (+x in its own frame) and of the head against the body towards the viewer, degrees.
const TURN: f64 = -14.0;
const HEAD_TURN: f64 = -42.0;
/// The joint of head and neck, about which the head turns.
const POLL: DVec3 = v(31.5, 0.0, 43.0);
/// Centre of the left eye in the head's frame, mm.
const EYE: DVec3 = v(3.4, 4.3, 0.6);
/// Patches of the coat on the right flank: middle (x, z) and half sizes, mm. The other flank has them in another order.
const PATCHES: [(f64, f64, f64, f64); 4] = [
    (-20.5, 36.0, 8.0, 7.5),
    (-2.5, 37.0, 7.0, 8.0),
    (5.5, 26.0, 4.2, 3.6),
    (17.5, 37.0, 6.0, 10.5),
];

/// The cow, about 55 mm tall.
pub(crate) fn cow() -> Creature {
    let field = |p: DVec3| {
        let t = turn(-TURN) * p;
        let m = mirror_y(t);
        let h = turn(-HEAD_TURN) * (t - POLL);
        let mut d = body(t, m) - coat(t);
        d = join(d, udder(m), 1.2);
        d = join(d, tail(t), 1.6);
        d = join(d, legs(t), 2.0);
        d = join(d, head(h, mirror_y(h)), 3.0);
        d = join(d, bell_and_collar(t), 0.4);
        meet(d, -t.z, 0.4)
    };
    let edge = |p: DVec3| {
        let t = turn(-TURN) * p;
        let h = turn(-HEAD_TURN) * (t - POLL);
        let head = 1.0 - 0.3 * step(16.0, 10.0, h.distance(v(5.0, 0.0, -1.0)));
        0.74 * head * (1.0 + 1.0 * step(0.0, 9.0, t.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-44.0, -34.0, -2.0),
        high: v(48.0, 28.0, 64.0),
        edge: Box::new(edge),
    }
}

fn body(p: DVec3, m: DVec3) -> f64 {
    let barrel = ellipsoid(p, v(-1.0, 0.0, 30.0), v(23.0, 10.4, 11.0));
    let chest = ellipsoid(p, v(15.0, 0.0, 29.5), v(10.5, 8.8, 11.5));
    let rump = ellipsoid(p, v(-18.0, 0.0, 31.5), v(10.0, 9.2, 10.0));
    let spine = tube(
        p,
        &[
            (v(-26.0, 0.0, 38.4), 2.0),
            (v(-16.0, 0.0, 40.2), 2.4),
            (v(2.0, 0.0, 38.8), 2.4),
            (v(16.0, 0.0, 40.6), 3.0),
        ],
        3.0,
    );
    let hip = ball(m, v(-14.5, 6.0, 38.2), 1.5);
    let pin = ball(m, v(-26.0, 3.6, 36.6), 1.7);
    let shoulder = turned_ellipsoid(
        m,
        v(14.5, 6.0, 29.0),
        axes(v(1.0, 0.0, 0.3), DVec3::Z),
        v(5.6, 4.4, 9.4),
    );
    let thigh = turned_ellipsoid(
        m,
        v(-19.5, 5.6, 27.0),
        axes(v(1.0, 0.0, -0.25), DVec3::Z),
        v(7.0, 5.0, 9.6),
    );
    let neck = cone(p, v(18.0, 0.0, 34.5), POLL - v(1.5, 0.0, 1.0), 8.6, 5.4);
    let dewlap = ellipsoid(p, v(23.5, 0.0, 27.5), v(5.0, 2.2, 6.0));
    let mut d = join(join(barrel, chest, 7.0), join(rump, spine, 5.0), 6.0);
    d = join(join(d, shoulder, 2.4), thigh, 2.4);
    d = join(d, join(hip, pin, 1.0), 3.0);
    join(d, join(neck, dewlap, 3.0), 4.0) + ribs(p) + folds(p)
}

fn ribs(p: DVec3) -> f64 {
    let along = p.x + 0.25 * (p.z - 30.0);
    0.22 * (along * 1.75).sin()
        * step(-11.0, -7.0, p.x)
        * step(9.5, 5.0, p.x)
        * step(21.0, 25.0, p.z)
        * step(38.0, 35.0, p.z)
}

/// Folds across the neck, and the hollow in front of the hip.
fn folds(p: DVec3) -> f64 {
    let along = p.x - 0.35 * (p.z - 34.0);
    let neck = 0.16 * (along * 1.9).sin() * step(19.0, 22.0, along) * step(29.0, 27.0, along);
    let flank = 1.0 * bell(p.distance(v(-10.0, 10.0 * p.y.signum(), 35.0)), 0.0, 4.5);
    neck + flank
}

/// Height of the dark patches of the coat, mm.
fn coat(p: DVec3) -> f64 {
    let wobble = 0.3 * noise(p * 0.22) + 0.06 * noise(p * 0.6);
    let inside = PATCHES.iter().map(|&(x, z, wide, tall)| {
        let mirrored = if p.y < 0.0 { x } else { -0.8 * x - 2.0 };
        1.0 - ((p.x - mirrored) / wide).hypot((p.z - z) / tall)
    });
    let nearest = inside.fold(f64::NEG_INFINITY, f64::max) + wobble;
    0.7 * step(0.0, 0.18, nearest) * step(18.0, 21.0, p.z)
}

fn udder(m: DVec3) -> f64 {
    let mut d = ellipsoid(m, v(-11.5, 1.6, 20.0), v(6.2, 4.2, 5.0));
    for x in [-14.2, -9.2] {
        d = join(
            d,
            cone(m, v(x, 2.8, 17.0), v(x + 0.3, 3.0, 13.2), 1.3, 0.75),
            0.8,
        );
    }
    d
}

fn tail(p: DVec3) -> f64 {
    let rope = tube(
        p,
        &[
            (v(-25.0, 0.0, 38.6), 2.0),
            (v(-29.8, 0.0, 36.2), 1.5),
            (v(-32.2, -1.0, 28.0), 1.1),
            (v(-31.2, -2.4, 19.0), 1.0),
        ],
        1.5,
    );
    let q = p - v(-31.2, -2.6, 14.5);
    let strands = 0.3 * (q.y.atan2(q.x) * 5.0 + q.z * 0.5).sin();
    join(
        rope,
        ellipsoid(q, DVec3::ZERO, v(1.9, 1.9, 5.6)) - strands,
        1.0,
    )
}

/// Legs in mid-step: those on one side stand before those on the other.
fn legs(p: DVec3) -> f64 {
    let stride = p.y.signum() * 2.2 * step(24.0, 3.0, p.z);
    let fore = v(p.x - stride, p.y.abs(), p.z);
    let hind = v(p.x - stride, p.y.abs(), p.z);
    let front = tube(
        fore,
        &[
            (v(14.5, 5.6, 24.0), 4.6),
            (v(15.2, 5.4, 14.6), 2.6),
            (v(15.6, 5.4, 12.2), 2.7),
            (v(15.2, 5.4, 5.0), 1.75),
            (v(15.4, 5.4, 3.4), 2.1),
        ],
        1.2,
    );
    let back = tube(
        hind,
        &[
            (v(-18.5, 5.6, 23.0), 5.4),
            (v(-17.6, 5.8, 17.5), 3.3),
            (v(-21.4, 5.8, 12.4), 2.5),
            (v(-20.4, 5.8, 5.0), 1.8),
            (v(-20.0, 5.8, 3.4), 2.15),
        ],
        1.2,
    );
    let hoof = |q: DVec3, x: f64, y: f64| {
        let split = 0.8 * bell(q.y, y, 0.45) * step(x - 0.5, x + 1.0, q.x);
        cone(q, v(x, y, 2.4), v(x + 0.9, y, 1.0), 2.25, 2.6) + split
    };
    let front = join(front, hoof(fore, 15.6, 5.4), 0.4);
    join(front, join(back, hoof(hind, -19.8, 5.8), 0.4), 0.5)
}

/// The head in its own frame: x forwards, origin at the poll.
fn head(p: DVec3, m: DVec3) -> f64 {
    let skull = ellipsoid(p, v(1.0, 0.0, 0.0), v(6.0, 4.7, 5.4));
    let face = tube(
        p,
        &[(v(2.0, 0.0, -0.6), 4.5), (v(11.0, 0.0, -6.4), 3.3)],
        2.0,
    );
    let muzzle = ellipsoid(p, v(12.0, 0.0, -7.2), v(3.2, 3.9, 3.2));
    let jaw = cone(p, v(1.5, 0.0, -4.0), v(9.0, 0.0, -8.4), 3.0, 2.2);
    let tuft = ellipsoid(p, v(0.5, 0.0, 5.0), v(2.8, 3.2, 1.9)) - 0.3 * (m.y * 3.2 + p.x).sin();
    let mut d = join(join(skull, face, 3.0), jaw, 2.0);
    d = join(join(d, muzzle, 1.2), tuft, 0.8);
    let line = (p.z + 8.7 - 0.28 * (p.x - 12.0)) * 1.1;
    d += 0.45 * bell(line, 0.0, 0.5) * step(8.0, 10.0, p.x);
    let nostril = turned_ellipsoid(
        m,
        v(14.4, 1.9, -5.8),
        axes(v(1.0, 0.8, 0.0), DVec3::Z),
        v(1.2, 1.0, 0.8),
    );
    d = carve(d, nostril, 0.5);
    let out = v(0.5, 0.86, 0.1).normalize();
    let gaze = (m - EYE) * v(0.92, 1.0, 1.4);
    let lid = ring(gaze, out * 0.6, out, 1.85, 0.5) / 1.2;
    let off = (m - EYE - out * (m - EYE).dot(out)).length();
    let eye = ball(m, EYE + out * 0.3, 1.8) + 0.5 * step(0.95, 0.5, off);
    let brow = cone(m, v(0.6, 4.0, 3.0), v(5.6, 3.6, 2.5), 0.8, 0.6);
    d = join(d, join(join(eye, lid, 0.15), brow, 0.3), 0.4);
    d = join(d, horn(m), 0.7);
    join(d, ear(m), 0.8)
}

fn horn(m: DVec3) -> f64 {
    tube(
        m,
        &[
            (v(-0.4, 3.0, 4.0), 1.8),
            (v(-0.6, 6.8, 6.2), 1.45),
            (v(0.8, 8.8, 9.4), 1.05),
            (v(2.2, 8.6, 12.0), 0.6),
        ],
        0.5,
    )
}

/// Leaf-shaped ear, hollow towards the front.
fn ear(m: DVec3) -> f64 {
    let along = v(-0.25, 1.0, -0.12).normalize();
    let open = v(1.0, 0.25, -0.1);
    let open = (open - along * open.dot(along)).normalize();
    let d = m - v(-1.4, 4.2, 1.6);
    let q = v(d.dot(along), d.dot(open), d.dot(along.cross(open)));
    let leaf = ellipsoid(q, v(4.4, 0.0, 0.0), v(5.2, 1.5, 2.7));
    let hollow = ellipsoid(q, v(4.6, 1.6, 0.0), v(3.6, 1.3, 1.7));
    join(
        carve(leaf, hollow, 0.8),
        ball(q, v(-0.4, 0.0, 0.0), 1.5),
        1.0,
    )
}

/// Collar around the neck with a bell under it.
fn bell_and_collar(p: DVec3) -> f64 {
    let axis = (POLL - v(1.5, 0.0, 1.0) - v(18.0, 0.0, 34.5)).normalize();
    let middle = v(24.4, 0.0, 37.6);
    let collar = ring(p, middle - v(0.0, 0.0, 0.5), axis, 7.3, 0.9);
    let q = p - v(26.5, 0.0, 28.2);
    let radial = q.x.hypot(q.y);
    let shell = (radial - curve(q.z, &[(-2.6, 3.0), (-1.0, 2.3), (1.4, 1.9), (2.4, 1.2)]))
        .max(q.z.abs() - 2.4)
        * 0.8;
    let clapper = ball(q, v(0.0, 0.0, -2.6), 1.2);
    join(collar, join(shell, clapper, 0.4), 0.6)
}
