//! Head of a dragon on its neck, in three-quarter view: open jaws with teeth and tongue, ringed horns, a frill of webbed
//! spines, brow ridges, overlapping scales and the plates of the throat.

use crate::coat::{Coat, Shape, Tile, scatter};
use crate::field::*;
use crate::meshing::Creature;
use glam::DVec3;

/// Turn of the dragon (+x in its own frame) towards the viewer, degrees.
const TURN: f64 = -38.0;
const EYE: DVec3 = v(11.5, 7.9, 49.0);
const EYE_RADIUS: f64 = 3.5;
/// Middle of the fan of the frill.
const HUB: DVec3 = v(-1.0, 8.0, 43.0);
/// Angles of the frill's spines above the horizontal, degrees, and their lengths, mm.
const SPINES: [(f64, f64); 5] = [
    (58.0, 19.0),
    (30.0, 23.0),
    (2.0, 24.0),
    (-28.0, 22.0),
    (-60.0, 17.0),
];
const SCALE: Shape = Shape {
    shoulder: 0.3,
    point: 1.7,
    edge: 1.0,
    crown: 0.4,
    quill: 0.3,
};

/// The dragon's head, about 85 mm tall.
pub(crate) fn dragon() -> Creature {
    let scales = scales();
    let field = move |p: DVec3| {
        let t = turn(-TURN) * p;
        let m = mirror_y(t);
        let mut d = hide(t, m) - scales.height(t) - throat(t) - snout_folds(t, m);
        d = join(d, ridge(t), 0.8);
        d = join(d, frill(m), 1.2);
        d = join(d, horns(m), 1.0);
        d = join(d, face(t, m), 0.6);
        d = join(d, mouth(t, m), 0.5);
        meet(d, -t.z, 0.6)
    };
    let edge = |p: DVec3| {
        let t = mirror_y(turn(-TURN) * p);
        let eye = 1.0 - 0.25 * step(12.0, 6.0, t.distance(EYE));
        let teeth = 1.0 - 0.15 * step(8.0, 14.0, t.x);
        0.79 * eye * teeth * (1.0 + 1.2 * step(2.0, 16.0, p.y))
    };
    Creature {
        field: Box::new(field),
        low: v(-52.0, -46.0, -2.0),
        high: v(52.0, 46.0, 92.0),
        edge: Box::new(edge),
    }
}

/// Everything that carries scales: neck, skull and both jaws.
fn hide(p: DVec3, m: DVec3) -> f64 {
    let neck = tube(
        p,
        &[
            (v(-6.0, 0.0, 42.0), 10.5),
            (v(-16.0, 0.0, 29.0), 11.0),
            (v(-17.0, 0.0, 14.0), 12.5),
            (v(-12.0, 0.0, -4.0), 15.5),
        ],
        8.0,
    );
    let skull = ellipsoid(p, v(2.0, 0.0, 46.0), v(13.5, 11.0, 9.5));
    let temple = ellipsoid(m, v(1.0, 7.5, 42.5), v(8.0, 4.6, 7.5));
    let mut d = join(join(skull, temple, 3.0), neck, 6.0);
    d = join(d, upper_jaw(p, m), 4.0);
    join(d, lower_jaw(p, m), 2.5)
}

/// Height of the palate over x, mm.
fn palate(x: f64) -> f64 {
    curve(
        x,
        &[
            (4.0, 36.0),
            (14.0, 38.2),
            (26.0, 38.8),
            (36.0, 37.4),
            (42.0, 36.0),
        ],
    )
}

/// Height of the floor of the mouth over x, mm.
fn floor(x: f64) -> f64 {
    curve(x, &[(4.0, 35.0), (12.0, 31.5), (24.0, 27.0), (36.0, 25.6)])
}

fn upper_jaw(p: DVec3, m: DVec3) -> f64 {
    let q = v(p.x, p.y * 0.92, p.z);
    let muzzle = tube(
        q,
        &[
            (v(4.0, 0.0, 44.0), 9.0),
            (v(18.0, 0.0, 42.6), 7.0),
            (v(30.0, 0.0, 41.2), 5.4),
            (v(36.5, 0.0, 40.2), 4.6),
        ],
        5.0,
    );
    let nose = ellipsoid(m, v(36.0, 3.3, 44.6), v(4.4, 2.8, 2.8));
    let bridge = cone(p, v(14.0, 0.0, 49.0), v(34.0, 0.0, 45.2), 2.6, 1.8);
    let d = join(join(muzzle, nose, 2.5), bridge, 3.0);
    let d = meet(d, palate(p.x) - p.z, 1.0);
    let roof = tube(
        p,
        &[(v(12.0, 0.0, 36.0), 4.6), (v(32.0, 0.0, 36.6), 3.4)],
        1.0,
    );
    carve(d, roof, 1.0)
}

fn lower_jaw(p: DVec3, m: DVec3) -> f64 {
    let bone = tube(
        v(p.x, p.y * 0.9, p.z),
        &[
            (v(-2.0, 0.0, 37.0), 7.6),
            (v(10.0, 0.0, 30.5), 6.6),
            (v(22.0, 0.0, 25.2), 4.9),
            (v(32.5, 0.0, 23.2), 4.1),
        ],
        5.0,
    );
    let hinge = ellipsoid(m, v(4.0, 7.0, 36.5), v(6.0, 3.2, 6.0));
    let d = meet(join(bone, hinge, 3.0), p.z - floor(p.x), 1.0);
    let trough = tube(
        p,
        &[
            (v(12.0, 0.0, 34.0), 4.6),
            (v(22.0, 0.0, 28.6), 3.5),
            (v(31.0, 0.0, 26.4), 2.6),
        ],
        1.0,
    );
    carve(d, trough, 0.8)
}

/// Tongue, teeth and lips.
fn mouth(p: DVec3, m: DVec3) -> f64 {
    let tongue = tube(
        v(p.x, p.y * 0.7, p.z),
        &[
            (v(4.0, 0.0, 34.5), 2.4),
            (v(14.0, 0.0, 31.2), 1.9),
            (v(24.0, 0.0, 29.2), 1.6),
            (v(28.5, 0.0, 30.8), 1.1),
            (v(31.0, 0.0, 33.4), 0.7),
        ],
        2.0,
    );
    let groove = 0.5 * bell(p.y, 0.0, 0.6);
    let mut d = tongue + groove;
    // Half widths of the jaws along x, where the teeth stand.
    let upper = [
        (8.0, 7.8),
        (18.0, 6.2),
        (28.0, 5.0),
        (36.0, 4.4),
        (40.5, 1.6),
    ];
    let lower = [
        (8.0, 6.6),
        (18.0, 5.2),
        (28.0, 4.0),
        (34.0, 2.8),
        (36.4, 1.0),
    ];
    let lip = |x: f64, y: f64, z: f64| ((m.y - y).hypot(p.z - z) - 1.0).max(8.0 - x);
    let top = lip(p.x, curve(p.x, &upper), palate(p.x) + 0.9).max(p.x - 38.5);
    let bottom = lip(p.x, curve(p.x, &lower), floor(p.x) - 0.7).max(p.x - 34.5);
    d = d.min(join(top, bottom, 0.3));
    for (i, x) in [13.0, 16.6, 20.2, 23.8, 27.4, 31.0, 34.6, 38.2]
        .into_iter()
        .enumerate()
    {
        let long = [2.6, 3.2, 3.0, 3.8, 3.2, 4.2, 5.6, 4.6][i];
        let root = v(x, curve(x, &upper) - 0.2, palate(x) + 0.6);
        d = join(
            d,
            cone(m, root, root + v(-0.7, 0.1, -long - 0.6), 1.25, 0.42),
            0.4,
        );
    }
    for (i, x) in [14.8, 18.4, 22.0, 25.6, 29.2, 32.6].into_iter().enumerate() {
        let long = [2.2, 2.8, 2.8, 3.4, 3.4, 5.2][i];
        let root = v(x, curve(x, &lower) - 0.2, floor(x) - 0.6);
        d = join(
            d,
            cone(m, root, root + v(-0.3, 0.3, long + 0.6), 1.2, 0.42),
            0.4,
        );
    }
    d
}

/// Eyes with slit pupils, brow ridges, nostrils, cheek bones and chin spikes.
fn face(p: DVec3, m: DVec3) -> f64 {
    let out = v(0.42, 0.88, 0.12).normalize();
    let q = m - EYE;
    let side = DVec3::Z.cross(out).normalize();
    let slit =
        0.8 * step(0.95, 0.35, q.dot(side).abs() + 0.1 * q.z.abs()) * step(2.9, 2.2, q.z.abs());
    let eye = ball(m, EYE, EYE_RADIUS) + slit * step(0.0, 1.0, q.dot(out));
    let gaze = q * v(1.0, 1.0, 1.35);
    let lid = ring(gaze, out * 1.5, out, 3.8, 0.9) / 1.15;
    let brow = tube(
        m,
        &[
            (v(20.5, 4.6, 49.6), 1.2),
            (v(14.0, 7.4, 53.0), 2.2),
            (v(6.0, 9.4, 55.2), 2.7),
            (v(0.0, 11.0, 57.6), 1.9),
            (v(-5.0, 12.4, 61.5), 0.7),
        ],
        1.5,
    );
    // Bone under the brow: without it the ridge would form a loop with the skull.
    let bone = tube(
        m,
        &[
            (v(19.0, 4.0, 47.6), 2.0),
            (v(12.0, 5.6, 50.4), 2.6),
            (v(4.0, 7.6, 52.0), 3.0),
            (v(-1.0, 8.6, 54.0), 2.2),
        ],
        1.5,
    );
    let notches = 0.2 * ((m.x - 0.4 * m.z) * 2.3).sin();
    let cheek = tube(
        m,
        &[
            (v(20.0, 6.2, 42.6), 1.0),
            (v(10.0, 9.0, 43.4), 2.0),
            (v(1.0, 11.6, 43.0), 2.4),
            (v(-5.0, 14.0, 40.5), 0.8),
        ],
        1.5,
    );
    let nostril = ring(
        m,
        v(37.6, 4.6, 45.2),
        v(0.55, 0.75, 0.35).normalize(),
        1.7,
        0.8,
    );
    let hook = cone(p, v(39.6, 0.0, 40.0), v(41.4, 0.0, 34.6), 2.0, 0.6);
    let mut d = join(join(eye, lid, 0.3), join(brow - notches, bone, 1.6), 0.8);
    d = join(join(d, cheek, 0.8), join(nostril, hook, 0.5), 0.5);
    for (root, tip) in [
        (v(33.0, 1.6, 21.0), v(33.5, 2.2, 14.6)),
        (v(25.0, 2.6, 21.5), v(23.0, 3.6, 15.8)),
        (v(15.0, 4.0, 24.4), v(11.5, 5.6, 18.6)),
        (v(36.6, 1.9, 46.4), v(33.4, 2.6, 51.6)),
    ] {
        d = join(d, cone(m, root, tip, 1.7, 0.5), 1.0);
    }
    d
}

/// Folds of skin behind the nostrils, and the nostrils' depth.
fn snout_folds(p: DVec3, m: DVec3) -> f64 {
    let along = p.x + 0.5 * (p.z - 43.0);
    let folds = 0.5 * (along * 1.9).sin() * step(27.0, 31.0, p.x) * step(37.0, 34.0, p.x);
    let bare = step(39.5, 41.0, p.z);
    let deep = -1.8 * step(1.9, 0.6, m.distance(v(38.4, 5.2, 45.6)));
    folds * bare + deep
}

/// Two pairs of horns with rings of growth.
fn horns(m: DVec3) -> f64 {
    let long = tube(
        m,
        &[
            (v(-3.0, 6.0, 52.0), 4.3),
            (v(-11.0, 8.6, 60.5), 3.7),
            (v(-19.0, 11.4, 66.0), 3.0),
            (v(-25.5, 13.0, 71.5), 2.3),
            (v(-29.6, 13.2, 77.5), 1.5),
            (v(-31.5, 12.6, 84.0), 0.7),
        ],
        3.0,
    );
    let along = (m - v(-4.0, 6.0, 54.0)).dot(v(-0.72, 0.2, 0.66));
    let saw = (along / 2.3).rem_euclid(1.0);
    let rings = 0.55
        * step(0.0, 0.75, saw)
        * step(1.0, 0.75, saw)
        * step(0.5, 4.0, along)
        * step(35.0, 22.0, along);
    let short = tube(
        m,
        &[
            (v(-3.0, 9.5, 48.0), 2.8),
            (v(-11.0, 14.0, 53.0), 2.1),
            (v(-18.0, 16.6, 60.0), 0.7),
        ],
        2.0,
    );
    join(long - rings, short, 1.5)
}

/// Webbed fan of spines behind the cheek.
fn frill(m: DVec3) -> f64 {
    let back = v(-0.74, 0.67, 0.0).normalize();
    let out = back.cross(DVec3::Z);
    let q = m - HUB;
    let (x, z) = (q.dot(back), q.z);
    let r = x.hypot(z);
    let angle = z.atan2(x).to_degrees();
    let mut d = f64::INFINITY;
    let mut reach: f64 = 0.0;
    for (i, (at, length)) in SPINES.into_iter().enumerate() {
        let (sin, cos) = at.to_radians().sin_cos();
        let tip = HUB + back * (cos * length) + v(0.0, 0.0, sin * length) + out * 1.5;
        d = join(d, cone(m, HUB, tip, 1.9, 0.6), 0.4);
        if let Some(&(next, other)) = SPINES.get(i + 1)
            && angle <= at
            && angle >= next
        {
            let s = (at - angle) / (at - next);
            let full = length + (other - length) * s;
            reach = full * (0.9 - 0.62 * s * (1.0 - s));
        }
    }
    let height = (q.dot(out) - 0.06 * r).abs();
    let ripple = 0.15 * (r * 1.5).sin();
    join(d, (height - 0.75 - ripple).max((r - reach) * 0.8), 0.8)
}

/// Row of spines from the forehead down the neck.
fn ridge(p: DVec3) -> f64 {
    let mut d = f64::INFINITY;
    for (root, lean, long) in [
        (v(11.0, 0.0, 52.0), v(-0.5, 0.0, 1.0), 4.5),
        (v(5.0, 0.0, 53.5), v(-0.7, 0.0, 1.0), 6.0),
        (v(-2.0, 0.0, 53.5), v(-0.9, 0.0, 1.0), 7.5),
        (v(-9.5, 0.0, 50.5), v(-1.0, 0.0, 0.75), 8.5),
        (v(-17.0, 0.0, 45.0), v(-1.0, 0.0, 0.55), 8.5),
        (v(-22.5, 0.0, 37.5), v(-1.0, 0.0, 0.35), 8.5),
        (v(-26.0, 0.0, 28.5), v(-1.0, 0.0, 0.25), 8.0),
        (v(-28.0, 0.0, 19.0), v(-1.0, 0.0, 0.3), 7.5),
        (v(-28.0, 0.0, 9.5), v(-1.0, 0.0, 0.4), 6.5),
    ] {
        let lean = lean.normalize();
        let q = v(p.x, p.y * 1.3, p.z);
        d = d.min(cone(q, root - lean * 3.0, root + lean * long, 3.0, 0.6));
    }
    d
}

/// Share of the throat (the front of the neck) at a point, and the way along the neck in mm.
fn on_throat(p: DVec3) -> (f64, f64) {
    let axis = curve(
        p.z,
        &[(0.0, -13.0), (14.0, -17.0), (29.0, -15.0), (38.0, -8.0)],
    );
    let angle = p.y.atan2(p.x - axis).abs();
    let share = step(0.95, 0.8, angle) * step(7.0, 5.0, p.x) * step(29.0, 26.0, p.z);
    (share, p.z - 0.25 * p.x)
}

/// Height of the plates across the throat; each overlaps the one below.
fn throat(p: DVec3) -> f64 {
    let (share, along) = on_throat(p);
    let saw = (along / 5.2).rem_euclid(1.0);
    share
        * (0.2
            + 1.4 * step(0.0, 0.22, saw) * (1.0 - 0.8 * step(0.2, 1.0, saw)) * step(1.0, 0.8, saw))
}

/// Scales that grow backwards from the snout and down the neck, ever larger.
fn scales() -> Coat {
    let whole = |p: DVec3| hide(p, mirror_y(p));
    let size = |p: DVec3| 2.0 + 2.0 * step(6.0, -12.0, p.x + 0.4 * (p.z - 40.0));
    let gap = |p: DVec3| {
        let m = mirror_y(p);
        let inside = p.x > 8.0 && p.z < palate(p.x) + 0.8 && p.z > floor(p.x) - 0.8;
        let bare = m.distance(EYE) < 4.6 || p.x > 33.5 || inside || p.z < -3.0;
        (!bare && on_throat(p).0 < 0.4).then_some(size(p))
    };
    let roots = scatter(&whole, v(-36., -20., -4.), v(42., 20., 60.), &gap);
    let tiles = roots.into_iter().map(|p| {
        let down = step(2.0, -10.0, p.x) * step(48.0, 38.0, p.z);
        let flow = v(-1.0, 0.0, 0.15).lerp(v(-0.15, 0.0, -1.0), down);
        let s = size(p);
        Tile::on(&whole, p, flow, [1.75 * s, 0.72 * s, 0.27 * s])
    });
    Coat::new(tiles.collect(), SCALE)
}
