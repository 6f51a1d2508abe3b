//! A model from its six sides, each with the words that turn it to the eye: for files of which nobody knows where up and front are.
//!
//! Seen from far away, without perspective, all at one scale. Found by rays, as the view pictures; the result does not depend on the
//! thread count.

use crate::bvh::Bvh;
use crate::diagram::drawing::{Align, Drawing, TextStyle};
use crate::diagram::lettering::Typeface;
use crate::diagram::raster;
use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::render::inks::{QUIET, TEXT};
use crate::render::shading::{self, Lights, Rgb, smoothed};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Aspect of a picture, pixels, and what is around it.
const SIDE: usize = 320;
const GAP: usize = 12;
const HEAD: usize = 34;
const FOOT: usize = 30;
const COLUMNS: usize = 3;

/// Air around the model, as a share of its largest side.
const AIR: f64 = 0.04;

/// The axes of a file by the names that scenes have for them.
const AXES: [(&str, DVec3); 6] = [
    ("x", DVec3::X),
    ("-x", DVec3::NEG_X),
    ("y", DVec3::Y),
    ("-y", DVec3::NEG_Y),
    ("z", DVec3::Z),
    ("-z", DVec3::NEG_Z),
];

/// A side of a model: the axis that looks at us, and the one that points up in the picture.
struct Aspect {
    front: (&'static str, DVec3),
    up: (&'static str, DVec3),
}

/// The six sides. What looks along y is drawn with z up and the other way round, as files have it; what looks along x with `up`.
fn sides(up: &str) -> Vec<Aspect> {
    let named = |name: &str| AXES.into_iter().find(|(n, _)| *n == name);
    let [y, z] = ["y", "z"].map(|n| named(n).unwrap_or(AXES[4]));
    let upright = named(up).filter(|(_, axis)| axis.x == 0.0).unwrap_or(z);
    let with_up = |front: (&'static str, DVec3)| Aspect {
        front,
        up: match front.1.abs() {
            DVec3::X => upright,
            DVec3::Y => z,
            _ => y,
        },
    };
    ["-y", "z", "x", "y", "-z", "-x"]
        .into_iter()
        .filter_map(named)
        .map(with_up)
        .collect()
}

/// A PNG; `up` is the axis that most likely points up.
pub fn six_sides(name: &str, mesh: &TriMesh, up: &str) -> Vec<u8> {
    let (lo, hi) = mesh.bounds().unwrap_or((DVec3::ZERO, DVec3::ONE));
    let bvh = Bvh::new(mesh);
    let sides = sides(up);
    let rows = sides.len().div_ceil(COLUMNS);
    let across = COLUMNS * (SIDE + GAP) + GAP;
    let down = HEAD + rows * (SIDE + FOOT) + FOOT;
    let mut pixmap = raster::blank(across as u32, down as u32);
    let mut drawing = Drawing::new(DVec2::new(across as f64, down as f64));
    let style = |size, face, ink| TextStyle::new(size, face, ink, Align::Middle);
    let width = (across - 2 * GAP) as f64;
    let mut line = |y: usize, text: &str, style: TextStyle| {
        let at = DVec2::new(across as f64 / 2.0, y as f64);
        drawing.text(at, text, style.fitting(text, width));
    };
    line(
        HEAD - 12,
        &format!("{name}: write the words below the side that is to be seen"),
        style(15.0, Typeface::Regular, TEXT),
    );
    line(
        down - 11,
        "in the scene: place: Fit(up: ..., front: ..., ...); where it lies on its side, write the axis that points up in its place",
        style(12.0, Typeface::Light, QUIET),
    );
    for (k, side) in sides.iter().enumerate() {
        let corner = (
            GAP + k % COLUMNS * (SIDE + GAP),
            HEAD + k / COLUMNS * (SIDE + FOOT),
        );
        let pixels = picture(mesh, &bvh, (lo, hi), side);
        raster::put_square(&mut pixmap, corner, SIDE, pixels.into_iter());
        let words = format!("up: \"{}\", front: \"{}\"", side.up.0, side.front.0);
        let at = DVec2::new((corner.0 + SIDE / 2) as f64, (corner.1 + SIDE + 18) as f64);
        drawing.text(at, &words, style(14.0, Typeface::Regular, TEXT));
    }
    drawing.paint(&mut pixmap, 1.0);
    raster::encode(&pixmap)
}

/// One side by rows of [`SIDE`] pixels.
fn picture(mesh: &TriMesh, bvh: &Bvh, (lo, hi): (DVec3, DVec3), side: &Aspect) -> Vec<Rgb> {
    let (forward, up) = (-side.front.1, side.up.1);
    let largest = (hi - lo).max_element();
    let middle = (lo + hi) / 2.0;
    let plane = ImagePlane {
        eye: middle - 2.0 * largest * forward,
        forward,
        right: forward.cross(up),
        up,
        focal: 1.0,
    };
    let lights = Lights::of(&plane);
    let pixel = largest * (1.0 + 2.0 * AIR) / SIDE as f64;
    let cast = |x: f64, y: f64| {
        let [right, down] = [x, y].map(|p| (p - SIDE as f64 / 2.0) * pixel);
        let from = plane.eye + right * plane.right - down * plane.up;
        // A face that is turned the wrong way round is still to be recognised.
        let shade = |face| lights.shade(mesh.normal_against(face, forward), shading::PLASTER);
        let hit = bvh.first_hit(from, forward);
        [hit.map_or(shading::BACKGROUND, |h| shade(h.face))]
    };
    let centres: Vec<[Rgb; 1]> = (0..SIDE * SIDE)
        .into_par_iter()
        .map(|i| cast((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5))
        .collect();
    let pixels = smoothed(&centres, SIDE, cast);
    pixels.iter().map(|p| p[0]).collect()
}
