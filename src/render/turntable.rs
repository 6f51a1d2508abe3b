//! The turntable: the finished solid from several sides in one strip, as the paper's Fig 12 shows a relief that gives itself away
//! from aside.
//!
//! The eye of the first view goes around the vertical axis through the middle of its models, at its own height and distance, and looks
//! at that middle; its lights go with it. Every picture has the same scale and shows all of the solid. Found by rays, as the view
//! pictures; the result does not depend on the thread count.

use crate::bvh::Bvh;
use crate::diagram::drawing::{Align, Drawing, TextStyle};
use crate::diagram::lettering::Typeface;
use crate::diagram::raster;
use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::render::camera::MARGIN;
use crate::render::inks::{QUIET, TEXT};
use crate::render::shading::{self, Lights, Rgb, smoothed};
use crate::view::View;
use glam::{DQuat, DVec2, DVec3};
use rayon::prelude::*;

/// Pictures of the strip, and the angle of the last one; the first is at its negative.
pub const PICTURES: usize = 7;
const LAST_DEG: f64 = 90.0;

/// An eye that would pass nearer to the solid on its way around is moved outward to this many radii of the solid about the axis:
/// nearer, a picture in perspective shows little of it.
const NEAREST: f64 = 1.5;

/// Widest strip, pixels.
const WIDEST: f64 = 8000.0;

/// The eyes of a strip, and what all its pictures show.
pub struct Turntable {
    pub planes: [ImagePlane; PICTURES],
    /// Corners of every picture on its image plane.
    pub lo: DVec2,
    pub hi: DVec2,
    /// Distance of the eyes from the middle they look at, millimetres.
    pub distance: f64,
    /// Whether that is farther than the view's own eye stands.
    pub moved: bool,
}

/// The angle of picture `k`, degrees; positive: the eye has gone to its right.
pub fn angle_deg(k: usize) -> f64 {
    2.0 * LAST_DEG * k as f64 / (PICTURES - 1) as f64 - LAST_DEG
}

impl Turntable {
    pub fn new(view: &View, solid: &TriMesh) -> Self {
        let middle = view
            .target()
            .bounds()
            .map_or(view.look_at, |(lo, hi)| (lo + hi) / 2.0);
        let radius = solid
            .vertices
            .iter()
            .map(|v| v.distance(middle))
            .fold(0.0, f64::max);
        let own = view.eye - middle;
        let distance = own.length().max(NEAREST * radius);
        let arm = distance * own.try_normalize().unwrap_or(DVec3::NEG_Y);
        let planes: [ImagePlane; PICTURES] = std::array::from_fn(|k| {
            let turn = DQuat::from_rotation_z(angle_deg(k).to_radians());
            ImagePlane::looking_at(middle + turn * arm, middle)
        });
        let image = || {
            let vertices = solid.vertices.iter();
            vertices.flat_map(|v| planes.iter().filter_map(|p| p.project(*v)))
        };
        let reach = image().map(|q| q.x.abs()).fold(0.0, f64::max);
        let top = image().map(|q| q.y).fold(f64::NEG_INFINITY, f64::max);
        let bottom = image().map(|q| q.y).fold(f64::INFINITY, f64::min);
        let (half, middle) = if reach > 0.0 && top > bottom {
            (
                DVec2::new(reach, (top - bottom) / 2.0),
                (top + bottom) / 2.0,
            )
        } else {
            (DVec2::ONE, 0.0)
        };
        let middle = DVec2::new(0.0, middle);
        let air = DVec2::splat((MARGIN - 1.0) * half.max_element());
        Self {
            planes,
            lo: middle - half - air,
            hi: middle + half + air,
            distance,
            moved: distance > own.length() * (1.0 + 1e-9),
        }
    }

    /// What picture `k` shows at `at`: 0 to 1 from its left and from its top.
    fn shade(&self, k: usize, at: DVec2, solid: &TriMesh, bvh: &Bvh, lights: &Lights) -> Rgb {
        let q = self.lo + (self.hi - self.lo) * DVec2::new(at.x, 1.0 - at.y);
        let plane = &self.planes[k];
        let hit = bvh.first_hit(plane.eye, plane.direction(q).normalize());
        hit.map_or(shading::BACKGROUND, |h| {
            lights.shade(solid.normal(h.face), shading::PLASTER)
        })
    }

    /// Width and height of every picture `size_px` high (16 to 2048), or lower if the strip would be too wide.
    fn size(&self, size_px: u32) -> (usize, usize) {
        let aspect = (self.hi.x - self.lo.x) / (self.hi.y - self.lo.y);
        let high = f64::from(size_px.clamp(16, 2048));
        let scale = (WIDEST / (PICTURES as f64 * high * aspect)).min(1.0);
        let pixels = |x: f64| (x * scale).round().max(8.0) as usize;
        (pixels(high * aspect), pixels(high))
    }
}

/// A PNG; `size_px` is the height of its pictures. `view` is the scene's first.
pub fn turntable(view: &View, solid: &TriMesh, bvh: &Bvh, size_px: u32) -> Vec<u8> {
    let table = Turntable::new(view, solid);
    let (wide, high) = table.size(size_px);
    let unit = high as f64 / 100.0;
    let gap = (2.0 * unit).ceil() as usize;
    let foot = (15.0 * unit).ceil() as usize;
    let across = PICTURES * (wide + gap) + gap;
    let mut pixmap = raster::blank(across as u32, (high + gap + foot) as u32);
    let mut drawing = Drawing::new(DVec2::new(across as f64, (high + gap + foot) as f64));
    for k in 0..PICTURES {
        let lights = Lights::of(&table.planes[k]);
        let cast = |x: f64, y: f64| {
            let at = DVec2::new(x / wide as f64, y / high as f64);
            [table.shade(k, at, solid, bvh, &lights)]
        };
        let centres: Vec<[Rgb; 1]> = (0..wide * high)
            .into_par_iter()
            .map(|i| cast((i % wide) as f64 + 0.5, (i / wide) as f64 + 0.5))
            .collect();
        let pixels = smoothed(&centres, wide, cast);
        let left = gap + k * (wide + gap);
        raster::put_square(&mut pixmap, (left, gap), wide, pixels.iter().map(|p| p[0]));
        let angle = format!("{:.0}°", angle_deg(k)).replace('-', "\u{2212}");
        let style = TextStyle::new(5.0 * unit, Typeface::Regular, TEXT, Align::Middle);
        let base = DVec2::new(
            left as f64 + wide as f64 / 2.0,
            (high + gap) as f64 + 5.5 * unit,
        );
        drawing.text(base, &angle, style.fitting(&angle, wide as f64));
    }
    let note = note(view, &table);
    let style = TextStyle::new(4.2 * unit, Typeface::Light, QUIET, Align::Middle);
    let below = DVec2::new(across as f64 / 2.0, (high + gap) as f64 + 11.5 * unit);
    drawing.text(
        below,
        &note,
        style.fitting(&note, (across - 2 * gap) as f64),
    );
    drawing.paint(&mut pixmap, 1.0);
    raster::encode(&pixmap)
}

fn note(view: &View, table: &Turntable) -> String {
    let (name, distance) = (&view.name, table.distance);
    let stands = if table.moved {
        format!(
            "0° is the direction of {name}'s eye, moved back to {distance:.0} mm so that all is seen"
        )
    } else {
        format!("0° is {name}'s eye, {distance:.0} mm from the middle of its models")
    };
    format!("{stands}; + to its right")
}
