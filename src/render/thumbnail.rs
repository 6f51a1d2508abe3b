//! The whole forest from above and aside, with shadows: for the 3MF's preview and for people.

use crate::bvh::Bvh;
use crate::diagram::raster;
use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::render::caster::{Caster, Meet};
use crate::render::shading::{self, Rgb, smoothed};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// From the forest's middle to the camera.
const STANDPOINT: DVec3 = DVec3::new(0.62, -1.0, 0.72);

/// Camera distance in radii of the forest: a long lens, little distortion.
const DISTANCE: f64 = 5.0;

/// Directions that probe how open a place is, in the frame of its normal. More cost time, fewer show bands.
const PROBES: usize = 8;

/// Side in pixels of the tile over which the probes' directions turn once.
const TILE: usize = 4;

/// How far the probes look, in radii of the forest.
const PROBE_REACH: f64 = 0.25;

/// A PNG of `size_px` a side (16 to 2048). `colours`, one per face, or plaster for all.
pub fn thumbnail(
    forest: &TriMesh,
    bvh: &Bvh,
    colours: Option<&[[u8; 3]]>,
    size_px: u32,
) -> Vec<u8> {
    let size = size_px.clamp(16, 2048) as usize;
    let studio = Studio::new(forest, bvh, colours, size);
    let sun = sun(&studio.plane);
    let open = openness(&studio, size);
    let cast = |x: f64, y: f64| {
        let Some(meet) = studio.meet(x, y) else {
            return [shading::BACKGROUND];
        };
        // How open a place is changes slowly: it is probed once a pixel.
        let [column, row] = [x, y].map(|at| (at as usize).min(size - 1));
        let open = open[row * size + column];
        [studio.shade(&meet, sun, open)]
    };
    let centres: Vec<[Rgb; 1]> = (0..size * size)
        .into_par_iter()
        .map(|k| cast((k % size) as f64 + 0.5, (k / size) as f64 + 0.5))
        .collect();
    let mut pixmap = raster::blank(size as u32, size as u32);
    for (slot, [rgb]) in pixmap
        .data_mut()
        .chunks_exact_mut(4)
        .zip(&smoothed(&centres, size, cast))
    {
        slot[..3].copy_from_slice(&rgb.map(|c| c.round().clamp(0.0, 255.0) as u8));
    }
    raster::encode(&pixmap)
}

/// How open the place in every pixel is, 0 to 1. Neighbours probe different directions; their mean has neither noise nor bands.
fn openness(studio: &Studio, size: usize) -> Vec<f64> {
    let meet = |k: usize| studio.meet((k % size) as f64 + 0.5, (k / size) as f64 + 0.5);
    let meets: Vec<Option<Meet>> = (0..size * size).into_par_iter().map(meet).collect();
    let turn =
        |k: usize| (TILE * (k / size % TILE) + k % size % TILE) as f64 / (TILE * TILE) as f64;
    let rough: Vec<f64> = meets
        .par_iter()
        .enumerate()
        .map(|(k, m)| m.as_ref().map_or(1.0, |m| studio.openness(m, turn(k))))
        .collect();
    let mean = |k: usize| {
        let Some(own) = &meets[k] else { return 1.0 };
        let (x, y) = (
            (k % size).saturating_sub(TILE / 2),
            (k / size).saturating_sub(TILE / 2),
        );
        let tile = (y..(y + TILE).min(size))
            .flat_map(|y| (x..(x + TILE).min(size)).map(move |x| y * size + x));
        let alike = |m: &Meet| {
            m.normal.dot(own.normal) > 0.8 && m.place.distance(own.place) < 0.1 * studio.radius
        };
        let kin = tile.filter(|&other| meets[other].as_ref().is_some_and(alike));
        let (sum, count) = kin.fold((rough[k], 1.0), |(sum, count), other| {
            (sum + rough[other], count + 1.0)
        });
        sum / count
    };
    (0..size * size).into_par_iter().map(mean).collect()
}

/// Towards the light: high, from the left behind the camera.
fn sun(plane: &ImagePlane) -> DVec3 {
    (-0.45 * plane.forward.with_z(0.0).normalize_or_zero() - 0.6 * plane.right + DVec3::Z)
        .normalize()
}

/// The forest and the camera.
struct Studio<'a> {
    forest: Caster<'a>,
    colours: Option<&'a [[u8; 3]]>,
    plane: ImagePlane,
    /// Of the picture, on the image plane.
    middle: DVec2,
    half: f64,
    /// Of the forest, millimetres.
    radius: f64,
    size: f64,
}

impl<'a> Studio<'a> {
    fn new(forest: &'a TriMesh, bvh: &'a Bvh, colours: Option<&'a [[u8; 3]]>, size: usize) -> Self {
        let (lo, hi) = forest.bounds().unwrap_or_default();
        let (centre, radius) = ((lo + hi) / 2.0, (hi - lo).length().max(1e-6) / 2.0);
        let plane =
            ImagePlane::looking_at(centre + DISTANCE * radius * STANDPOINT.normalize(), centre);
        let (middle, half) = frame(forest, &plane);
        Self {
            forest: Caster::new(forest, bvh),
            colours,
            plane,
            middle,
            half,
            radius,
            size: size as f64,
        }
    }

    /// Where the ray through a place of the picture, in pixels, meets the forest; a hair above it.
    fn meet(&self, x: f64, y: f64) -> Option<Meet> {
        let q = self.middle
            + DVec2::new(2.0 * x / self.size - 1.0, 1.0 - 2.0 * y / self.size) * self.half;
        let direction = self.plane.direction(q).normalize();
        let mut meet = self.forest.meet(self.plane.eye, direction)?;
        meet.place += 1e-4 * self.radius * meet.normal;
        Some(meet)
    }

    fn shade(&self, meet: &Meet, sun: DVec3, open: f64) -> Rgb {
        let facing = meet.normal.dot(sun).max(0.0);
        let lit = facing > 0.0 && !self.forest.bvh.blocked(meet.place, sun, f64::INFINITY);
        // The sky lights what looks up more than what looks down.
        let sky = open * (0.40 + 0.08 * meet.normal.z);
        let colour = self
            .colours
            .and_then(|c| c.get(meet.face.at()))
            .copied()
            .unwrap_or(shading::PLASTER);
        shading::scaled(colour, 0.12 + sky + if lit { 0.52 * facing } else { 0.0 })
    }

    /// Share of the directions above a facet, weighted by their cosine, that nothing near blocks.
    /// `twist`, 0 to 1, turns the directions about the normal.
    fn openness(&self, meet: &Meet, twist: f64) -> f64 {
        let (tangent, bitangent) = meet.normal.any_orthonormal_pair();
        let open = (0..PROBES).filter(|&k| {
            // Golden-angle spiral over the disc, lifted to the hemisphere.
            let (radius, turn) = (
                ((k as f64 + 0.5) / PROBES as f64).sqrt(),
                2.399_963 * k as f64 + std::f64::consts::TAU * twist,
            );
            let up = (1.0 - radius * radius).sqrt();
            let direction =
                radius * turn.cos() * tangent + radius * turn.sin() * bitangent + up * meet.normal;
            !self
                .forest
                .bvh
                .blocked(meet.place, direction, PROBE_REACH * self.radius)
        });
        open.count() as f64 / PROBES as f64
    }
}

/// Middle and half side of the square around the forest's image, with a little air.
fn frame(forest: &TriMesh, plane: &ImagePlane) -> (DVec2, f64) {
    let image = || forest.vertices.iter().filter_map(|v| plane.project(*v));
    let lo = image().fold(DVec2::INFINITY, DVec2::min);
    let hi = image().fold(DVec2::NEG_INFINITY, DVec2::max);
    if lo.is_finite() && hi.is_finite() {
        ((lo + hi) / 2.0, 0.52 * (hi - lo).max_element().max(1e-9))
    } else {
        (DVec2::ZERO, 1.0)
    }
}
