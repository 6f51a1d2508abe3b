//! Bust of a woman in the manner of early Greek marbles: almond eyes with drilled pupils, parted wavy hair with a band.

use crate::field::*;
use crate::meshing::Creature;
use glam::{DVec2, DVec3};

/// Centre and radius of the left eye (at +x), mm; the right one is its mirror image.
const EYE: DVec3 = v(9.3, -20.4, 32.2);
const EYE_RADIUS: f64 = 5.0;
/// Half width of the opening between the lids, mm.
const LIDS: f64 = 5.3;
/// Where the neck is cut; the chin is at 0.
const CUT: f64 = -19.0;
/// The combed strands run like meridians from one of these poles to the other.
const COMB_FROM: DVec3 = v(0.0, -34.0, 46.0);
const COMB_TO: DVec3 = v(0.0, 34.0, 26.0);

/// The head, about 87 mm tall, facing -y.
pub(crate) fn head() -> Creature {
    let field = |p: DVec3| {
        let m = mirror_x(p);
        let mut d = join(flesh(p, m), lids(m), 0.7);
        d = join(d, eyeball(m), 0.12);
        d = join(d, lips(p, m), 1.1);
        d = join(d, ear(m), 1.0);
        d = join(d, hair(p, m), 0.5);
        meet(d, CUT - p.z, 0.6)
    };
    let edge = |p: DVec3| {
        let m = mirror_x(p);
        let eye = 1.0 - 0.25 * step(11.0, 6.0, m.distance(EYE));
        let mouth = 1.0 - 0.2 * step(12.0, 7.0, p.distance(v(0.0, -29.0, 13.0)));
        0.42 * eye * mouth * (1.0 + 1.3 * step(6.0, 20.0, p.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-34.0, -42.0, CUT - 2.0),
        high: v(34.0, 42.0, 74.0),
        edge: Box::new(edge),
    }
}

/// Skull, face and neck without eyes, lips, ears and hair.
fn flesh(p: DVec3, m: DVec3) -> f64 {
    let face = ellipsoid(p, v(0.0, -10.0, 20.0), v(16.6, 15.6, 20.5));
    let mut d = join(scalp(p), face, 9.0);
    let jaw = tube(
        m,
        &[
            (v(15.2, 1.0, 20.0), 3.6),
            (v(11.6, -4.5, 10.5), 3.2),
            (v(4.2, -20.5, 4.0), 4.2),
        ],
        4.0,
    );
    d = join(d, jaw, 7.0);
    d = join(d, ellipsoid(p, v(0.0, -22.6, 4.4), v(5.0, 5.6, 4.7)), 4.5);
    d = join(d, ellipsoid(p, v(0.0, -19.2, 14.5), v(10.0, 8.4, 9.0)), 6.0);
    d = join(d, ellipsoid(m, v(11.8, -15.6, 23.0), v(6.8, 7.2, 6.4)), 7.0);
    d = join(d, ellipsoid(m, v(9.6, -11.5, 14.0), v(6.0, 8.0, 8.5)), 7.0);
    d = carve(d, ellipsoid(m, v(9.8, -29.0, 32.2), v(7.6, 5.6, 5.0)), 4.0);
    d = join(d, nose(p, m), 2.4);
    d = join(d, brow(m), 3.0);
    let philtrum = 0.4 * bell(p.x, 0.0, 0.8) - 0.15 * bell(m.x, 1.7, 0.7);
    d += philtrum * step(15.2, 16.4, p.z) * step(20.0, 18.6, p.z) * step(-24.0, -26.0, p.y);
    join(d, neck(p, m), 6.0)
}

fn scalp(p: DVec3) -> f64 {
    let cranium = ellipsoid(p, v(0.0, 2.0, 39.0), v(21.4, 26.5, 25.0));
    let forehead = ellipsoid(p, v(0.0, -7.0, 42.5), v(18.2, 19.8, 17.5));
    join(cranium, forehead, 6.0)
}

fn neck(p: DVec3, m: DVec3) -> f64 {
    let column = tube(
        p,
        &[
            (v(0.0, 5.0, 20.0), 12.0),
            (v(0.0, 5.0, -4.0), 11.2),
            (v(0.0, 7.0, -24.0), 13.4),
        ],
        8.0,
    );
    // The muscle from behind the ear to the pit of the throat.
    let strap = tube(
        m,
        &[
            (v(15.5, 7.0, 16.0), 2.6),
            (v(9.6, -0.5, -4.0), 2.4),
            (v(4.2, -6.2, -20.0), 2.2),
        ],
        5.0,
    );
    let throat = ellipsoid(p, v(0.0, -4.6, -6.0), v(3.0, 3.6, 4.5));
    join(join(column, strap, 4.0), throat, 4.0)
}

fn nose(p: DVec3, m: DVec3) -> f64 {
    let bridge = tube(
        p,
        &[
            (v(0.0, -24.6, 37.0), 2.2),
            (v(0.0, -26.6, 32.0), 2.1),
            (v(0.0, -30.0, 25.5), 2.3),
            (v(0.0, -31.6, 22.4), 2.6),
        ],
        2.0,
    );
    let wing = ellipsoid(m, v(2.6, -27.8, 21.3), v(1.9, 3.6, 2.1));
    let nostril = turned_ellipsoid(
        m,
        v(1.7, -30.2, 20.0),
        axes(v(0.35, 1.0, 0.0), DVec3::Z),
        v(1.4, 0.75, 1.0),
    );
    let seam = 0.12 * bell(m.distance(v(3.2, -30.0, 22.8)), 0.0, 1.1);
    carve(join(bridge, wing, 2.4) + seam, nostril, 0.5)
}

/// Ridge of the brow with its hairs.
fn brow(m: DVec3) -> f64 {
    let arch = tube(
        m,
        &[
            (v(2.4, -25.0, 38.2), 1.4),
            (v(8.0, -24.2, 39.8), 1.6),
            (v(15.0, -19.0, 38.4), 0.9),
        ],
        2.0,
    );
    let hairs = ((m.x * 0.75 - m.z * 0.8) * 4.2).sin();
    let middle = curve(m.x, &[(2.0, 38.6), (8.0, 40.6), (13.5, 40.0), (17.5, 37.2)]);
    let strip = step(
        1.7,
        0.6,
        (m.z - middle).abs() * curve(m.x, &[(2.0, 0.9), (17.5, 1.8)]),
    );
    let ends = step(1.6, 3.2, m.x) * step(18.0, 15.5, m.x);
    arch - (0.35 + 0.2 * hairs) * strip * ends
}

/// Signed distance from the almond-shaped opening of the lids in the plane of the face, mm.
fn almond(m: DVec3) -> f64 {
    // Seen along the eye's axis, which points a little outwards; the outer corner is the higher one.
    let x = (m.x - EYE.x) * 0.97 + (m.y - EYE.y) * 0.24 + 0.9;
    let z = m.z - EYE.z - 0.07 * x;
    let arc = |high: f64| {
        let r = (LIDS * LIDS + high * high) / (2.0 * high);
        (DVec2::new(x, r - high), r)
    };
    let (up, up_r) = arc(2.3);
    let (low, low_r) = arc(1.9);
    let above = DVec2::new(x, z + up.y).length() - up_r;
    let below = DVec2::new(x, z - low.y).length() - low_r;
    above.max(below)
}

/// Two lids around the eye with a crease above.
fn lids(m: DVec3) -> f64 {
    let opening = almond(m);
    let rim = 0.45 * bell(opening, 0.75, 0.55);
    let crease = 0.7 * bell(opening, 2.6, 0.5) * step(0.5, 2.0, m.z - EYE.z);
    let shell = ball(m, EYE, EYE_RADIUS + 0.75) - rim + crease;
    carve(shell, opening - 0.1, 0.35)
}

/// Eyeball with engraved iris and drilled pupil.
fn eyeball(m: DVec3) -> f64 {
    let out = v(0.05, -1.0, -0.02).normalize();
    let q = m - EYE;
    let r = (q - out * q.dot(out)).length();
    let front = step(0.0, 1.5, q.dot(out));
    let ring = 0.4 * bell(r, 2.5, 0.4);
    let pupil = 1.1 * step(1.5, 0.8, r);
    ball(m, EYE, EYE_RADIUS) + (ring + pupil) * front
}

fn lips(p: DVec3, m: DVec3) -> f64 {
    // A mirrored point that stays clear of the middle: no crease there.
    let m = m.with_x(p.x.hypot(1.0));
    let upper = tube(
        m,
        &[
            (v(0.0, -27.5, 14.5), 1.1),
            (v(1.9, -27.4, 14.8), 1.3),
            (v(4.5, -25.8, 14.2), 1.0),
            (v(7.6, -22.7, 13.2), 0.4),
        ],
        1.2,
    );
    let lower = tube(
        m,
        &[
            (v(0.6, -26.7, 11.2), 1.8),
            (v(3.2, -25.8, 11.8), 1.2),
            (v(7.0, -23.0, 12.9), 0.4),
        ],
        2.0,
    );
    let line = 0.9 * bell(p.z - 13.1 - 0.25 * (m.x * 0.9).cos(), 0.0, 0.45) * step(9.0, 7.5, m.x);
    join(upper, lower, 0.4) + line
}

/// Ear as a tilted plate with helix, inner fold, bowl, tragus and lobe.
fn ear(m: DVec3) -> f64 {
    // In the ear's frame x runs backwards along the plate, y out of the head, z up.
    let frame = axes(v(0.42, 0.9, 0.12), v(0.0, -0.2, 1.0));
    let q = frame.transpose() * (m - v(20.6, 3.0, 28.0));
    let q = v(q.x, -q.y, q.z);
    let plate = ellipsoid(q, v(0.6, 0.0, 0.5), v(5.0, 1.5, 8.6));
    let helix = tube(
        q,
        &[
            (v(-2.6, 0.7, 0.2), 0.8),
            (v(-3.8, 0.9, 3.4), 1.0),
            (v(-2.6, 1.1, 7.2), 1.1),
            (v(1.2, 1.4, 8.8), 1.1),
            (v(4.6, 1.6, 6.4), 1.1),
            (v(5.4, 1.5, 1.6), 1.0),
            (v(3.6, 1.1, -4.4), 0.9),
            (v(1.2, 0.9, -7.2), 1.2),
        ],
        0.6,
    );
    let fold = tube(
        q,
        &[
            (v(0.6, 0.9, 5.8), 0.8),
            (v(2.2, 1.2, 2.0), 0.9),
            (v(1.6, 1.2, -2.4), 0.9),
            (v(-0.6, 1.0, -4.0), 0.9),
        ],
        0.6,
    );
    let bowl = ellipsoid(q, v(-1.0, 1.6, -0.6), v(2.3, 2.2, 3.2));
    let tragus = ellipsoid(q, v(-3.4, 1.0, -1.6), v(1.1, 1.0, 1.9));
    let lobe = ellipsoid(q, v(-0.4, 0.6, -7.2), v(2.5, 1.4, 2.3));
    let root = ellipsoid(q, v(-1.0, -2.0, 0.0), v(3.6, 3.0, 6.5));
    let mut d = carve(join(join(plate, root, 1.5), lobe, 1.2), bowl, 0.7);
    d = join(d, join(helix, fold, 0.3), 0.5);
    join(d, tragus, 0.6)
}

/// Angle about the line between the poles of the combing, 0 on top, and the share of the way from pole to pole.
fn combed(p: DVec3) -> (f64, f64) {
    let line = (COMB_TO - COMB_FROM).normalize();
    let q = p - (COMB_FROM + COMB_TO) * 0.5;
    let along = q.dot(line);
    let up = (DVec3::Z - line * line.z).normalize();
    let off = q - line * along;
    (off.x.atan2(off.dot(up)), along)
}

/// Relief of the strands: broad waved locks with fine hairs on them.
fn strands(p: DVec3) -> f64 {
    let (angle, along) = combed(p);
    let side = angle.abs();
    let wave =
        0.085 * (along * 0.42 + 2.2 * side).sin() + 0.05 * noise(v(along * 0.12, side * 3.0, 3.0));
    let a = side + wave * step(0.05, 0.3, side);
    // Rounded crests with narrow grooves; the fine hairs end where the mesh gets coarse.
    let crest = |x: f64| (x.sin().powi(2) + 0.02).powf(0.3);
    let fine = (a * 27.0 + 1.3 * (along * 0.2).sin()).sin();
    let fine = (fine * fine + 0.04).sqrt() * step(16.0, 6.0, p.y);
    1.7 * (crest(a * 9.0) - 0.75) + 0.45 * (fine - 0.5) - 0.9 * bell(side, 0.0, 0.07)
}

/// Hair: a cap behind the hairline with a knot at the nape and a band around it.
fn hair(p: DVec3, m: DVec3) -> f64 {
    // No hair in front of the hairline (face) and below the ears' tops (ears and neck).
    let line = curve(
        m.x,
        &[
            (0.0, 51.5),
            (6.0, 49.6),
            (12.0, 45.0),
            (16.0, 39.5),
            (20.0, 34.0),
        ],
    );
    let temple = curve(
        p.z,
        &[(26.0, 0.0), (34.0, -4.5), (40.0, -8.5), (48.0, -10.0)],
    );
    let face = meet(p.z - line, p.y - temple, 3.0) * 0.8;
    let below = (p.z - 35.5 + 0.75 * (p.y - 3.0).max(0.0)) * 0.8;
    let bald = join(face, below, 2.5);
    // The hair rises from the skin within 9 mm.
    let cap = scalp(p) - 0.5 - 3.4 * step(-1.0, 9.0, bald);
    let fade = 0.35 + 0.65 * step(0.0, 5.0, bald);
    let d = join(carve(cap - strands(p) * fade, bald, 0.8), band(p), 0.5);
    let knot = ball(p, v(0.0, 31.0, 25.0), 10.0);
    let turns = (p.distance(v(0.0, 34.0, 20.0)) * 2.0).sin();
    join(d, knot - 0.5 * turns, 2.5)
}

/// Band around the hair, in a plane that rises towards the front.
fn band(p: DVec3) -> f64 {
    let cap = scalp(p) - 4.8;
    let off = (p - v(0.0, -5.0, 64.0)).dot(v(0.0, 0.88, 0.47)).abs();
    let rim = 0.35 * step(0.9, 1.3, off);
    // It ends behind the ears.
    meet(meet(cap - rim, off - 2.0, 0.6), 37.0 - p.z, 1.0)
}
