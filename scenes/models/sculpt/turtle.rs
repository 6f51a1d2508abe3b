//! Turtle seen from the side in three-quarter view: scutes with growth rings, pebbled skin, beak and claws.

use crate::coat::{Mosaic, scatter};
use crate::field::*;
use crate::meshing::Creature;
use glam::DVec3;

/// Turn of the turtle's head (+x in its own frame) towards the viewer, degrees.
const TURN: f64 = -33.0;
const EYE: DVec3 = v(41.2, 5.0, 24.4);

/// The turtle, about 80 mm long.
pub(crate) fn turtle() -> Creature {
    let scutes = scutes();
    let skin = skin_cells();
    let field = move |p: DVec3| {
        let t = turn(-TURN) * p;
        let m = mirror_y(t);
        let shell = shell(t) - shell_relief(&scutes, t);
        let flesh = flesh(t) - skin.pebbles(t, skin_depth(m), 1.0) - wrinkles(t);
        let mut d = join(shell, flesh, 0.7);
        d = join(d, face_parts(m, t), 0.4);
        let line = t.z - 20.0 - 0.12 * (46.0 - t.x) - 0.02 * (t.x - 44.0).powi(2);
        d += 0.8 * bell(line, 0.0, 0.6) * step(36.5, 38.5, t.x);
        join(d, claws(m), 0.4)
    };
    let edge = |p: DVec3| {
        let t = mirror_y(turn(-TURN) * p);
        let face = 1.0 - 0.25 * step(12.0, 6.0, t.distance(EYE));
        0.7 * face
            * (1.0 + 1.2 * step(2.0, 14.0, p.y))
            * (1.0 + 0.5 * step(6.0, 3.0, p.z) * step(14.0, 9.0, t.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-46.0, -46.0, -3.0),
        high: v(50.0, 42.0, 46.0),
        edge: Box::new(edge),
    }
}

/// Dome with a flaring rim and a flat underside.
fn shell(p: DVec3) -> f64 {
    let dome = ellipsoid(p, v(-1.0, 0.0, 12.0), v(28.5, 23.0, 23.5));
    let rim = ellipsoid(p, v(-1.5, 0.0, 12.2), v(32.5, 26.5, 4.6));
    let top = meet(dome, 10.5 - p.z, 2.0);
    let plastron = ellipsoid(p, v(0.0, 0.0, 11.0), v(27.0, 20.0, 6.2));
    join(join(top, rim, 5.0), plastron, 2.0)
}

/// Skin parts: neck, head, legs and tail.
fn flesh(p: DVec3) -> f64 {
    let m = mirror_y(p);
    let neck = tube(
        p,
        &[
            (v(20.0, 0.0, 13.0), 8.0),
            (v(29.0, 0.0, 15.5), 6.6),
            (v(36.0, 0.0, 21.0), 6.0),
        ],
        4.0,
    );
    let head = ellipsoid(p, v(38.5, 0.0, 23.0), v(8.5, 6.6, 6.2));
    let snout = ellipsoid(p, v(44.0, 0.0, 21.8), v(5.0, 4.6, 4.4));
    let front = tube(
        m,
        &[
            (v(17.0, 12.0, 12.0), 7.0),
            (v(24.5, 20.0, 9.5), 6.0),
            (v(27.5, 22.5, 3.6), 5.0),
        ],
        3.0,
    );
    let foot = ellipsoid(m, v(29.0, 23.2, 2.6), v(5.6, 5.0, 2.8));
    let hind = tube(
        m,
        &[
            (v(-17.0, 12.0, 11.0), 7.0),
            (v(-22.5, 18.5, 8.0), 6.0),
            (v(-23.5, 20.5, 3.2), 4.6),
        ],
        3.0,
    );
    let sole = ellipsoid(m, v(-22.0, 21.3, 2.4), v(5.6, 4.6, 2.6));
    let tail = tube(
        p,
        &[
            (v(-27.0, 0.0, 9.0), 4.6),
            (v(-33.5, 1.0, 6.0), 3.2),
            (v(-38.0, 3.0, 4.2), 1.6),
        ],
        2.0,
    );
    let head = join(join(neck, head, 3.0), snout, 3.0);
    let legs = join(join(front, foot, 2.0), join(hind, sole, 2.0), 1.0);
    join(join(head, legs, 1.5), tail, 1.5)
}

/// Scutes: five along the spine, four on each side, and a rim of smaller ones.
fn scutes() -> Mosaic {
    let mut seeds = Vec::new();
    for x in [21.5, 11.5, -1.0, -13.5, -23.5] {
        seeds.push((x, 0.0));
    }
    for (x, y) in [(18.5, 14.0), (5.5, 17.5), (-8.5, 17.5), (-21.0, 13.5)] {
        seeds.push((x, y));
        seeds.push((x, -y));
    }
    let from_above = seeds.into_iter().filter_map(|(x, y)| {
        let from = v(x * 2.2, y * 2.6, 80.0);
        march(&shell, from, (v(x, y, 15.0) - from).normalize())
    });
    Mosaic::new(from_above.collect(), 24.0)
}

/// Height of the shell's relief: plates that rise to their middle with rings of growth, and the marginal plates.
fn shell_relief(scutes: &Mosaic, p: DVec3) -> f64 {
    let angle = (p.y / 26.5).atan2((p.x + 1.5) / 32.5);
    let upper = step(17.4, 18.8, p.z);
    let lower = step(18.0, 16.6, p.z) * step(7.6, 9.2, p.z);
    let plates = scutes.border(p, 1.2).map_or(0.0, |(inner, _)| {
        let d = join(inner, (p.z - 18.0) * 1.1, 2.5).max(0.0);
        let swell = 1.2 * step(0.0, 1.5, d) + 0.9 * step(0.5, 9.0, d);
        let rings = 0.36
            * (d * std::f64::consts::TAU / 2.6 + 2.6).sin()
            * step(0.9, 1.8, d)
            * step(10.5, 8.0, d);
        swell + rings
    });
    let part = (angle / std::f64::consts::TAU * 22.0).rem_euclid(1.0) - 0.5;
    let seam = join((0.5 - part.abs()) * 8.4, 17.6 - p.z, 1.0);
    let margin = 0.9 * step(0.0, 1.3, seam)
        + 0.3 * (seam * std::f64::consts::TAU / 2.6 + 2.6).sin() * step(0.9, 1.6, seam);
    upper * plates + lower * margin
}

fn skin_cells() -> Mosaic {
    let gap = |p: DVec3| {
        let m = mirror_y(p);
        let head = p.x > 34.0;
        let hidden = p.x.abs() < 18.0 && m.y < 14.0;
        (!hidden).then_some(if head { 2.6 } else { 3.6 })
    };
    Mosaic::new(
        scatter(&flesh, v(-42., -30., 0.), v(50., 30., 32.), &gap),
        4.2,
    )
}

/// Depth of the skin's pebbles: coarse on the legs, finer on the head, none on beak and eye.
fn skin_depth(m: DVec3) -> f64 {
    let beak = step(44.5, 42.5, m.x);
    let eye = step(3.6, 4.8, m.distance(EYE));
    let head = step(33.0, 36.0, m.x);
    (0.75 - 0.2 * head) * beak * eye
}

/// Folds across the neck.
fn wrinkles(p: DVec3) -> f64 {
    let along = (p - v(22.0, 0.0, 13.5)).dot(v(0.9, 0.0, 0.43));
    0.35 * (along * 2.2 + 0.8 * noise(p * 0.3)).sin()
        * step(0.0, 2.0, along)
        * step(11.0, 8.5, along)
        * step(12.0, 9.0, p.y.abs())
}

fn face_parts(m: DVec3, p: DVec3) -> f64 {
    let out = v(0.28, 0.93, 0.25).normalize();
    // The lids are a ring flattened from above and below, which gives the eye its almond shape.
    let gaze = (m - EYE) * v(1.0, 1.0, 1.3);
    let r = (gaze - out * gaze.dot(out)).length();
    let dimple = 0.6 * step(1.9, 1.0, r) * step(0.0, 1.0, gaze.dot(out));
    let eye = ball(m, EYE - out * 0.2, 2.8) + dimple;
    let lid = ring(gaze, out * 1.1, out, 3.0, 0.85) / 1.15;
    let brow = cone(m, v(37.0, 5.2, 27.4), v(43.5, 4.0, 26.8), 1.5, 1.0);
    // The beak: a plate above and one below the line of the mouth.
    let upper = meet(
        ellipsoid(p, v(43.6, 0.0, 22.2), v(6.2, 5.0, 4.6)),
        20.9 + 0.15 * (44.0 - p.x) - p.z,
        0.8,
    );
    let lower = meet(
        ellipsoid(p, v(42.5, 0.0, 19.8), v(5.8, 4.6, 3.4)),
        p.z - 20.0 - 0.15 * (44.0 - p.x),
        0.8,
    );
    let nostril = ball(m, v(49.0, 1.3, 23.6), 0.75);
    let beak = carve(join(upper, lower, 0.3), nostril, 0.4);
    join(join(join(eye, lid, 0.4), brow, 0.8), beak, 0.4)
}

fn claws(m: DVec3) -> f64 {
    let mut d = f64::INFINITY;
    for (base, heading) in [
        (v(32.6, 22.0, 2.4), v(1.0, -0.15, 0.0)),
        (v(32.4, 25.4, 2.4), v(0.85, 0.45, 0.0)),
        (v(29.6, 27.4, 2.4), v(0.4, 0.9, 0.0)),
        (v(-18.6, 24.0, 2.2), v(0.7, 0.7, 0.0)),
        (v(-21.8, 25.2, 2.2), v(0.15, 1.0, 0.0)),
        (v(-25.2, 24.2, 2.2), v(-0.4, 0.9, 0.0)),
    ] {
        let tip = base + heading.normalize() * 2.9 - v(0.0, 0.0, 0.9);
        d = d.min(cone(m, base, tip, 1.5, 0.8));
    }
    d
}
