//! Standing imp that waves: one arm reaches up and towards the viewer with spread fingers, one large ear stands off to the
//! side. Warty hide, horns, a grin with teeth, a round belly, clawed feet and a barbed tail.

use crate::coat::{Mosaic, scatter};
use crate::field::*;
use crate::meshing::Creature;
use glam::DVec3;

/// Centre and radius of the imp's left eye (at +x), mm.
const EYE: DVec3 = v(5.0, -12.4, 55.0);
const EYE_RADIUS: f64 = 3.7;
/// Root and tip of the large ear, on the imp's right (at -x).
const EAR_ROOT: DVec3 = v(-9.5, -1.0, 55.0);
const EAR_TIP: DVec3 = v(-37.0, 1.0, 66.0);
/// Shoulder, elbow and wrist of the raised arm (at +x), which reaches towards the viewer.
const SHOULDER: DVec3 = v(12.5, -1.0, 39.5);
const ELBOW: DVec3 = v(24.5, -8.0, 40.0);
const WRIST: DVec3 = v(29.5, -20.0, 55.0);

/// The imp, about 75 mm tall, facing -y.
pub(crate) fn imp() -> Creature {
    let warts = warts();
    let field = move |p: DVec3| {
        let m = mirror_x(p);
        let mut d = trunk(p, m) - warts.pebbles(p, wart_depth(p, m), 0.9) - belly_folds(p);
        d = join(d, legs(m), 1.2);
        d = join(d, raised_arm(p), 1.5);
        d = join(d, other_arm(p), 1.2);
        d = join(d, large_ear(p), 1.2);
        d = join(d, small_ear(p), 1.0);
        d = join(d, face(p, m), 0.6);
        d = join(d, tail(p), 1.0);
        meet(d, -p.z, 0.5)
    };
    let edge = |p: DVec3| {
        let m = mirror_x(p);
        let face = 1.0 - 0.25 * step(13.0, 7.0, m.distance(v(4.0, -13.0, 52.0)));
        let hand = 1.0 - 0.2 * step(14.0, 9.0, p.distance(WRIST + v(1.0, -2.0, 6.0)));
        0.635 * face * hand * (1.0 + 1.0 * step(2.0, 14.0, p.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-44.0, -36.0, -2.0),
        high: v(44.0, 34.0, 84.0),
        edge: Box::new(edge),
    }
}

/// Head, chest, belly and thighs: what carries warts.
fn trunk(p: DVec3, m: DVec3) -> f64 {
    let belly = ellipsoid(p, v(0.0, -2.5, 24.5), v(12.5, 12.0, 11.5));
    let chest = ellipsoid(p, v(0.0, 0.5, 36.0), v(12.0, 9.0, 9.5));
    let shoulder = ball(m, v(11.5, 0.0, 39.0), 4.8);
    let back = ellipsoid(p, v(0.0, 4.5, 32.0), v(10.5, 8.0, 14.0));
    let thigh = tube(
        m,
        &[(v(6.8, 0.0, 18.0), 6.6), (v(11.0, -4.5, 12.0), 5.0)],
        3.0,
    );
    let skull = ellipsoid(p, v(0.0, -2.0, 55.0), v(12.4, 11.0, 10.6));
    let jaw = ellipsoid(p, v(0.0, -5.5, 48.6), v(10.2, 8.6, 6.4));
    let neck = cone(p, v(0.0, 0.5, 40.0), v(0.0, -0.5, 48.0), 7.0, 6.5);
    let mut d = join(join(belly, chest, 5.0), back, 5.0);
    d = join(join(d, shoulder, 3.0), thigh, 2.0);
    let head = join(skull, jaw, 4.0);
    join(d, join(head, neck, 3.0), 2.0)
}

/// Folds of the belly, and its navel.
fn belly_folds(p: DVec3) -> f64 {
    let ribs =
        0.5 * (p.z * 1.5 + 0.05 * p.x * p.x).sin() * step(31.0, 34.0, p.z) * step(42.0, 39.0, p.z);
    let front = step(-3.0, -7.0, p.y) * step(10.0, 6.0, p.x.abs());
    let crease = -0.9 * bell(p.z - 0.02 * p.x * p.x, 28.6, 0.7)
        - 0.7 * bell(p.z - 0.02 * p.x * p.x, 17.0, 0.7);
    let navel = -1.6 * bell((p.x.hypot(p.z - 22.5)) / 1.3, 0.0, 1.0);
    front * (ribs + crease + navel)
}

/// Shanks and feet with three clawed toes.
fn legs(m: DVec3) -> f64 {
    let shank = tube(
        m,
        &[
            (v(11.0, -4.5, 12.0), 4.8),
            (v(11.5, -0.5, 6.5), 3.4),
            (v(11.5, 0.5, 3.2), 3.2),
        ],
        1.5,
    );
    let calf = ellipsoid(m, v(11.6, 0.4, 8.0), v(3.6, 3.8, 4.4));
    let foot = cone(m, v(11.5, 0.0, 2.6), v(12.6, -7.5, 2.2), 3.3, 3.0);
    let knee = ellipsoid(m, v(11.0, -8.6, 12.4), v(2.8, 1.6, 3.0));
    let mut d = join(join(shank, calf, 2.0), join(foot, knee, 0.6), 1.5);
    for (side, long) in [(-0.42, 3.6), (0.08, 4.4), (0.6, 3.6)] {
        let out = v(side, -1.0, 0.0).normalize();
        let root = v(12.4 + 3.2 * side, -8.6, 2.2);
        let tip = root + out * long;
        d = join(d, cone(m, root, tip, 2.0, 1.8), 0.5);
        d = join(
            d,
            cone(
                m,
                tip + v(0.0, 0.0, 0.6),
                tip + out * 3.2 - v(0.0, 0.0, 1.2),
                1.2,
                0.5,
            ),
            0.3,
        );
    }
    d
}

/// A hand with an open palm: `reach` along the middle finger, `palm` the direction it shows, `thumb` the side of the
/// thumb; `curl` bends the fingers towards the palm (share of their length).
fn hand(p: DVec3, wrist: DVec3, reach: DVec3, palm: DVec3, thumb: f64, curl: f64) -> f64 {
    let reach = reach.normalize();
    let palm = (palm - reach * palm.dot(reach)).normalize();
    let side = palm.cross(reach) * thumb;
    let q = v(
        (p - wrist).dot(side),
        (p - wrist).dot(palm),
        (p - wrist).dot(reach),
    );
    let base = ellipsoid(q, v(0.0, 0.0, 3.8), v(3.9, 2.2, 4.6));
    let hollow = ellipsoid(q, v(0.0, 2.8, 3.8), v(2.2, 1.3, 2.6));
    let mut d = carve(base, hollow, 1.0);
    for (fan, long) in [(-0.36, 8.2), (0.02, 9.6), (0.40, 8.4)] {
        let out = v(fan, 0.0, 1.0).normalize();
        let root = v(fan * 6.6, 0.0, 5.8);
        let joint = root + out * (0.5 * long) - v(0.0, 0.12 * long * (1.0 - 2.0 * curl), 0.0);
        let tip = root + out * long + v(0.0, curl * long, 0.0);
        let finger = tube(q, &[(root, 1.65), (joint, 1.5), (tip, 1.25)], 0.5);
        let knuckle = ball(q, joint - v(0.0, 0.5, 0.0), 1.35);
        let nail = cone(q, tip, tip + out * 2.2 + v(0.0, 0.9, 0.0), 1.05, 0.45);
        d = join(d, join(finger, knuckle, 0.5).min(nail), 0.6);
    }
    let thumb = tube(
        q,
        &[
            (v(2.6, 0.2, 2.6), 1.8),
            (v(5.8, 1.0, 4.4), 1.6),
            (v(7.6, 1.8, 7.0), 1.2),
        ],
        0.5,
    );
    let nail = cone(q, v(7.6, 1.8, 7.0), v(8.2, 2.4, 9.2), 1.0, 0.45);
    join(d, thumb.min(nail), 0.8)
}

fn raised_arm(p: DVec3) -> f64 {
    let upper = tube(
        p,
        &[
            (SHOULDER, 4.4),
            (SHOULDER.lerp(ELBOW, 0.45) + v(0.0, -0.6, 0.6), 3.8),
            (ELBOW, 2.9),
        ],
        2.0,
    );
    let lower = tube(
        p,
        &[
            (ELBOW, 2.9),
            (ELBOW.lerp(WRIST, 0.35) + v(0.4, 0.2, 0.0), 3.3),
            (WRIST, 2.1),
        ],
        1.5,
    );
    let spur = cone(p, ELBOW, ELBOW + v(3.4, 4.0, -2.6), 2.0, 0.6);
    let cuff = ring(
        p,
        WRIST - (WRIST - ELBOW).normalize() * 2.0,
        (WRIST - ELBOW).normalize(),
        2.7,
        0.9,
    );
    let arm = join(join(upper, lower, 0.8), spur, 1.0);
    let arm = join(arm, cuff, 0.3);
    join(
        arm,
        hand(
            p,
            WRIST,
            v(0.12, -0.35, 1.0),
            v(0.05, -1.0, -0.2),
            -1.0,
            0.16,
        ),
        0.8,
    )
}

/// The other arm, with the hand on the hip.
fn other_arm(p: DVec3) -> f64 {
    let (shoulder, elbow, wrist) = (
        v(-12.5, 0.0, 39.5),
        v(-22.5, 1.0, 29.5),
        v(-15.0, -6.0, 22.5),
    );
    let arm = tube(
        p,
        &[
            (shoulder, 4.4),
            (shoulder.lerp(elbow, 0.5) + v(-0.5, 0.0, 0.5), 3.7),
            (elbow, 2.9),
            (elbow.lerp(wrist, 0.4), 3.1),
            (wrist, 2.2),
        ],
        1.2,
    );
    let spur = cone(p, elbow, elbow + v(-4.0, 2.2, -0.6), 2.0, 0.6);
    let hand = hand(
        p,
        wrist,
        v(0.75, -0.5, -0.55),
        v(0.75, 0.62, -0.1),
        1.0,
        0.05,
    );
    join(join(arm, spur, 1.0), hand, 0.8)
}

/// A leaf-shaped ear from `root` to `tip`, hollow towards `open`, with a thick rim, veins and notches.
fn ear(p: DVec3, root: DVec3, tip: DVec3, open: DVec3, half: f64) -> f64 {
    let along = (tip - root).normalize();
    let open = (open - along * open.dot(along)).normalize();
    let side = along.cross(open);
    let length = root.distance(tip);
    let q = v(
        (p - root).dot(side),
        (p - root).dot(open),
        (p - root).dot(along),
    );
    let s = q.z / length;
    let width = half
        * curve(
            s,
            &[
                (-0.1, 0.45),
                (0.15, 0.8),
                (0.4, 1.0),
                (0.7, 0.66),
                (1.0, 0.02),
            ],
        );
    let notch = 0.8 * bell(q.z, 0.62 * length, 1.2) + 0.6 * bell(q.z, 0.8 * length, 0.9);
    let bow = 0.035 * (q.z - 0.4 * length).powi(2) * 0.35 - 0.05 * q.x * q.x;
    let h = q.y + bow;
    let edge = q.x.abs() - width + notch * step(0.0, -1.0, q.x);
    let rim = 0.9 * bell(edge, -1.2, 0.9);
    let veins = 0.3
        * (q.x / width.max(1.0) * 9.0 + 0.15 * q.z).cos()
        * step(0.1, 0.3, s)
        * step(0.95, 0.7, s);
    let plate = meet(
        h.abs() - 0.9 - rim - veins * step(0.0, 0.5, h),
        edge * 0.8,
        1.2,
    );
    let plate = meet(plate, (-q.z - 3.0).max(q.z - length), 0.8);
    let stem = cone(
        p,
        root - along * 3.0,
        root + along * 0.2 * length - open * 0.4,
        0.34 * half,
        1.4,
    );
    join(plate, stem, 1.5)
}

fn large_ear(p: DVec3) -> f64 {
    ear(p, EAR_ROOT, EAR_TIP, v(0.1, -1.0, 0.0), 8.2)
}

/// The other ear is folded back against the head.
fn small_ear(p: DVec3) -> f64 {
    ear(
        p,
        v(10.4, 0.0, 55.5),
        v(16.8, 9.0, 62.5),
        v(0.8, -0.6, 0.0),
        4.2,
    )
}

/// Eyes, brows, nose, grin with teeth, and horns.
fn face(p: DVec3, m: DVec3) -> f64 {
    let out = v(0.22, -0.96, 0.02).normalize();
    let q = m - EYE;
    let r = (q - out * q.dot(out)).length();
    let front = step(0.0, 1.0, q.dot(out));
    let eye =
        ball(m, EYE, EYE_RADIUS) + (0.9 * step(1.5, 0.8, r) + 0.3 * bell(r, 2.4, 0.35)) * front;
    let gaze = q * v(1.0, 1.0, 1.2);
    let lid = ring(gaze, out * 1.6, out, 3.8, 0.95) / 1.1;
    let brow = tube(
        m,
        &[
            (v(1.2, -14.8, 57.0), 1.5),
            (v(5.0, -14.2, 60.0), 1.9),
            (v(9.6, -10.0, 61.4), 1.5),
            (v(12.0, -6.0, 63.4), 0.6),
        ],
        1.0,
    );
    // Bone under the brow and behind the nose: without it they would form loops with the skull.
    let bone = ellipsoid(m, v(5.2, -9.6, 60.0), v(5.0, 4.2, 2.6));
    let septum = ellipsoid(p, v(0.0, -13.2, 51.6), v(2.2, 3.4, 3.6));
    let nose = tube(
        p,
        &[
            (v(0.0, -13.0, 56.5), 1.9),
            (v(0.0, -16.6, 52.6), 2.3),
            (v(0.0, -18.6, 49.6), 1.9),
        ],
        1.2,
    );
    let wing = ball(m, v(2.2, -15.4, 50.8), 1.6);
    let nostril = ball(m, v(1.5, -17.2, 49.2), 0.8);
    let nose = join(join(nose, septum, 1.0), wing, 0.8);
    let nose = carve(nose, nostril, 0.4);
    let cheek = ellipsoid(m, v(7.6, -9.6, 49.6), v(3.0, 3.4, 2.6));
    let chin = cone(p, v(0.0, -11.6, 44.0), v(0.0, -14.8, 41.6), 2.6, 1.3);
    let horn = tube(
        m,
        &[
            (v(4.8, -6.0, 62.5), 3.0),
            (v(7.0, -8.0, 67.5), 2.2),
            (v(7.2, -6.6, 71.5), 1.5),
            (v(5.8, -3.6, 74.5), 0.6),
        ],
        1.2,
    );
    let rings = 0.18 * ((m.z - 0.4 * m.y) * 2.6).sin() * step(72.0, 69.0, m.z);
    let mut d = join(join(eye, lid, 0.3), join(brow, bone, 1.2), 0.7);
    d = join(join(d, nose, 0.8), join(cheek, chin, 0.5), 1.2);
    d = join(d, horn - rings, 0.8);
    join(d, grin(p, m), 0.4)
}

/// Wide mouth: two lips with a row of pointed teeth between them.
fn grin(p: DVec3, m: DVec3) -> f64 {
    let height = |x: f64| 45.8 + 0.035 * x * x;
    let depth = |x: f64| -13.9 + 0.055 * x * x;
    let lip = |up: f64| {
        let (dy, dz) = (p.y - depth(m.x), p.z - height(m.x) - up);
        (dy.hypot(dz) - 1.0).max(m.x - 8.2) * 0.8
    };
    let corner = ball(m, v(8.4, -10.2, 48.4), 1.4);
    let mut d = join(lip(1.6).min(lip(-1.5)), corner, 0.8);
    for i in 0..4 {
        let x = 0.9 + 1.9 * f64::from(i);
        let root = v(x, depth(x) + 0.4, height(x) + 1.0);
        d = join(d, cone(m, root, root + v(0.0, -0.1, -2.2), 0.9, 0.45), 0.25);
    }
    d
}

/// Tail that curls out on the side of the large ear and ends in a barb.
fn tail(p: DVec3) -> f64 {
    let d = tube(
        p,
        &[
            (v(0.0, 9.0, 18.0), 4.0),
            (v(-6.0, 15.0, 9.0), 3.0),
            (v(-16.0, 15.0, 4.0), 2.4),
            (v(-25.0, 10.0, 6.0), 2.0),
            (v(-29.0, 6.0, 13.0), 1.7),
            (v(-27.0, 4.0, 19.0), 1.4),
        ],
        2.0,
    );
    // The barb: a flat arrowhead with a ridge along its middle.
    let q = p - v(-26.6, 3.8, 20.0);
    let half = curve(q.z, &[(-2.0, 4.6), (0.0, 3.4), (7.5, 0.0)]);
    let outline = (q.x.abs() - half).max(-q.z - 1.6 + 0.5 * q.x.abs()) * 0.85;
    let thick = q.y.abs() - 0.9 - 0.7 * bell(q.x, 0.0, 0.9);
    join(d, meet(outline, thick, 0.7), 0.8)
}

fn wart_depth(p: DVec3, m: DVec3) -> f64 {
    let face = step(3.0, 7.0, m.distance(v(5.0, -13.0, 53.5)));
    let belly = step(13.0, 16.0, p.distance(v(0.0, -12.0, 23.0)));
    0.5 * face.min(belly)
}

/// Seeds of the pebbled hide: smaller on the head.
fn warts() -> Mosaic {
    let whole = |p: DVec3| trunk(p, mirror_x(p));
    let gap = |p: DVec3| Some(if p.z > 45.0 { 2.4 } else { 3.0 });
    Mosaic::new(
        scatter(&whole, v(-20., -18., 6.), v(20., 18., 68.), &gap),
        3.8,
    )
}
