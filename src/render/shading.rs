//! Light on facets, and smoothing of pictures made of single rays.

use crate::geom::ImagePlane;
use glam::DVec3;
use rayon::prelude::*;

/// sRGB components, 0 to 255.
pub(super) type Rgb = [f32; 3];

/// Colour of a surface without a colour of its own.
pub(super) const PLASTER: [u8; 3] = [0xEE, 0xEA, 0xE2];
pub(super) const BACKGROUND: Rgb = [255.0; 3];

/// Largest difference of a component between neighbouring pixels that is left as it is.
/// Below 10 nearly every facet edge of a fine mesh is cast again; above 40 outlines look jagged.
const JUMP: f32 = 20.0;

/// Three lights of an eye: a strong one from the upper left, weaker ones from the upper right and from the eye.
pub(super) struct Lights {
    lights: [(DVec3, f64); 3],
}

impl Lights {
    pub(super) fn of(plane: &ImagePlane) -> Self {
        let ImagePlane {
            forward: f,
            right: r,
            up: u,
            ..
        } = *plane;
        let key = (-0.6 * f - 0.5 * r + 0.7 * u).normalize();
        let fill = (-0.6 * f + 0.7 * r + 0.4 * u).normalize();
        Self {
            lights: [(key, 0.68), (fill, 0.16), (-f, 0.12)],
        }
    }

    /// Lambertian shade of a facet.
    pub(super) fn shade(&self, normal: DVec3, colour: [u8; 3]) -> Rgb {
        let lit: f64 = self
            .lights
            .iter()
            .map(|(l, strength)| strength * normal.dot(*l).max(0.0))
            .sum();
        scaled(colour, 0.14 + lit)
    }
}

/// A colour under a light of a strength of 0 to 1.
pub(super) fn scaled(colour: [u8; 3], light: f64) -> Rgb {
    colour.map(|c| light.min(1.0) as f32 * f32::from(c))
}

/// A colour with a share, 0 to 1, of another one in it.
pub(super) fn mixed(colour: [u8; 3], other: [u8; 3], share: f64) -> [u8; 3] {
    std::array::from_fn(|k| {
        (f64::from(colour[k]) * (1.0 - share) + f64::from(other[k]) * share).round() as u8
    })
}

/// Smooths every pixel that differs from a neighbour: half of it is its centre, half its four corners, which it shares with the pixels
/// around. `N` pictures at once; `cast` gives all of them at a place in pixels from the top left corner, on the border too; `size` is
/// their width.
pub(super) fn smoothed<const N: usize>(
    centres: &[[Rgb; N]],
    size: usize,
    cast: impl Fn(f64, f64) -> [Rgb; N] + Sync,
) -> Vec<[Rgb; N]> {
    let is_rough = |k: usize| {
        let (x, y) = (k % size, k / size);
        let around = [
            (x > 0).then(|| k - 1),
            (x + 1 < size).then(|| k + 1),
            (y > 0).then(|| k - size),
            (k + size < centres.len()).then(|| k + size),
        ];
        around
            .into_iter()
            .flatten()
            .any(|other| differ(&centres[k], &centres[other]))
    };
    let pixels = 0..centres.len();
    let rough: Vec<bool> = pixels.clone().into_par_iter().map(is_rough).collect();
    let (across, down) = (size + 1, centres.len() / size + 1);
    let corner = |c: usize| {
        let (x, y) = (c % across, c / across);
        let pixel = |x: usize, y: usize| x < size && y + 1 < down && rough[y * size + x];
        let left = x > 0 && (pixel(x - 1, y) || y > 0 && pixel(x - 1, y - 1));
        let right = pixel(x, y) || y > 0 && pixel(x, y - 1);
        (left || right).then(|| cast(x as f64, y as f64))
    };
    let corners: Vec<Option<[Rgb; N]>> = (0..across * down).into_par_iter().map(corner).collect();
    let mean = |k: usize| {
        let c = k / size * across + k % size;
        let four = [c, c + 1, c + across, c + across + 1].map(|c| corners[c]);
        std::array::from_fn(|p| {
            std::array::from_fn(|i| {
                let sum: f32 = four.iter().flatten().map(|corner| corner[p][i]).sum();
                centres[k][p][i] / 2.0 + sum / 8.0
            })
        })
    };
    pixels
        .into_par_iter()
        .map(|k| if rough[k] { mean(k) } else { centres[k] })
        .collect()
}

/// Whether two pixels, each of `N` pictures, differ by more than [`JUMP`].
pub(super) fn differ<const N: usize>(a: &[Rgb; N], b: &[Rgb; N]) -> bool {
    a.as_flattened()
        .iter()
        .zip(b.as_flattened())
        .any(|(x, y)| (x - y).abs() > JUMP)
}
