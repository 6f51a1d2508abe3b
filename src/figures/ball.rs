//! A bumpy ball of any size, evenly meshed: what times are measured on.

use glam::DVec3;
use std::collections::HashMap;

/// A geodesic ball with waves on it, as an OBJ file; `10 f^2 + 2` vertices for the least `f` that gives as many as wanted.
pub fn bumpy_ball(vertices: usize) -> Vec<u8> {
    let frequency = ((vertices.saturating_sub(2)) as f64 / 10.0)
        .sqrt()
        .ceil()
        .max(1.0) as usize;
    let (points, faces) = geodesic(frequency);
    let mut text = String::new();
    for p in points {
        let p = bumpy(p);
        text.push_str(&format!("v {} {} {}\n", p.x, p.y, p.z));
    }
    for [a, b, c] in faces {
        text.push_str(&format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    }
    text.into_bytes()
}

/// Bumps of a tenth of the radius, and finer ones of a fiftieth.
fn bumpy(p: DVec3) -> DVec3 {
    let wave = |k: f64| (k * p.x).sin() * (k * p.y + 1.0).sin() * (k * p.z + 2.0).sin();
    p * (1.0 + 0.1 * wave(5.0) + 0.02 * wave(17.0))
}

/// Every face of an icosahedron cut into `f * f`, put on the unit ball; points on edges are shared.
fn geodesic(f: usize) -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        corners.extend([
            DVec3::new(0.0, a, b),
            DVec3::new(a, b, 0.0),
            DVec3::new(b, 0.0, a),
        ]);
    }
    let side = 2.0f64;
    let near = |a: usize, b: usize| (corners[a].distance(corners[b]) - side).abs() < 1e-9;
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    // Points by their weights of corners, which are exact; never iterated.
    let mut known: HashMap<[(usize, usize); 3], usize> = HashMap::new();
    let triples =
        (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| [a, b, c])));
    for [a, b, c] in triples.filter(|[a, b, c]| near(*a, *b) && near(*b, *c) && near(*c, *a)) {
        let outwards = (corners[b] - corners[a])
            .cross(corners[c] - corners[a])
            .dot(corners[a])
            > 0.0;
        let [b, c] = if outwards { [b, c] } else { [c, b] };
        let mut at = |i: usize, j: usize| {
            let mut key = [(a, f - i - j), (b, i), (c, j)];
            key.iter_mut().filter(|k| k.1 == 0).for_each(|k| k.0 = 12);
            key.sort_unstable();
            *known.entry(key).or_insert_with(|| {
                let sum =
                    (f - i - j) as f64 * corners[a] + i as f64 * corners[b] + j as f64 * corners[c];
                points.push(sum.normalize());
                points.len() - 1
            })
        };
        for i in 0..f {
            for j in 0..f - i {
                faces.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < f {
                    faces.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    (points, faces)
}
