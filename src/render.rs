//! View pictures: what an eye sees, found by casting rays at the finished solid. Here in even light, in [`lights`] in real light.
//!
//! Takes a view, the finished forest and the lines where it was torn, gives a picture (target | forest | normal error with the
//! lines) and the figures under it.
//! The figures use one ray through every pixel's centre; the pictures are smoothed by four more where neighbours differ.
//! Rows run in parallel; the result does not depend on the thread count.

pub mod flash;
mod light_sheet;
pub mod lights;
mod shading;
mod step_lines;
mod thumbnail;
pub mod turntable;

pub use lights::{LightLikeness, light_pictures};
pub use thumbnail::thumbnail;
pub use turntable::turntable;

use crate::bvh::Bvh;
use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::raster;
use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::steps::{StepLine, StepSummary};
use crate::view::View;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use shading::{Lights, Rgb, smoothed};
use step_lines::{Panel, step_lines};

/// The picture's half width over the model's: a little air around it.
const MARGIN: f64 = 1.05;

/// Angle in degrees at the end of the error scale; larger errors look the same.
pub const SCALE_END_DEG: f64 = 45.0;

/// Colours of the error scale at equal steps from 0 to [`SCALE_END_DEG`].
pub const HEAT: [[u8; 3]; 5] = [
    [0xDF, 0xEA, 0xF0],
    [0x9C, 0xC3, 0xD5],
    [0xF3, 0xC6, 0x4B],
    [0xE0, 0x6B, 0x2E],
    [0x8C, 0x14, 0x34],
];

/// Share of a face's own colour in the forest's panel: enough to tell the views apart, too little to hide the shading.
const TINT: f64 = 0.3;

/// A ray that should have met the forest and did not.
const MISS: [u8; 3] = [0x1A, 0x1A, 0x1A];

/// How well the forest shows its target, over the pixels whose ray meets the target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Likeness {
    /// Share of them whose ray meets the forest at all.
    pub hit: f64,
    /// Angle between the normals of target and forest in degrees; 90 where the forest is missed.
    pub mean_deg: f64,
    pub median_deg: f64,
    pub p90_deg: f64,
    pub pixels: usize,
}

/// One view's pictures, PNG.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewPictures {
    /// Target, forest and error side by side with captions.
    pub sheet: Vec<u8>,
    /// The same three one by one without captions, square.
    pub panels: [Vec<u8>; 3],
}

/// Draws and measures one view. `size_px` is the side of one of the three panels (16 to 2048), a panel being as in
/// [`camera`]. `colours`, one per face of the forest, tint its panel lightly. `steps` are drawn over the errors and told in the
/// caption: the lines where the surface was torn, if it might be.
pub fn view_pictures(
    view: &View,
    forest: &TriMesh,
    forest_bvh: &Bvh,
    colours: Option<&[[u8; 3]]>,
    steps: Option<(&[StepLine], StepSummary)>,
    size_px: u32,
) -> (Likeness, ViewPictures) {
    let size = size_px.clamp(16, 2048) as usize;
    let target = view.target();
    let target_bvh = Bvh::new(&target);
    let (plane, half) = camera(view);
    let look = |x: f64, y: f64| {
        let scale = 2.0 * half / size as f64;
        let q = DVec2::new(x - size as f64 / 2.0, size as f64 / 2.0 - y) * scale;
        let direction = plane.direction(q).normalize();
        let sight = |bvh: &Bvh| bvh.first_hit(plane.eye, direction).map(|h| h.face);
        Look {
            target: sight(&target_bvh),
            forest: sight(forest_bvh),
        }
    };
    let looks: Vec<Look> = (0..size * size)
        .into_par_iter()
        .map(|k| look((k % size) as f64 + 0.5, (k / size) as f64 + 0.5))
        .collect();
    let errors: Vec<f64> = looks
        .iter()
        .filter_map(|l| l.error_deg(&target, forest))
        .collect();
    let likeness = likeness(
        &errors,
        looks
            .iter()
            .filter(|l| l.target.is_some() && l.forest.is_some())
            .count(),
    );
    let lights = Lights::of(&plane);
    let panels = |look: Look| look.panels(&target, forest, colours, &lights);
    let centres: Vec<[Rgb; 3]> = looks.iter().map(|l| panels(*l)).collect();
    let pixels = smoothed(&centres, size, |x, y| panels(look(x, y)));
    let picture = compose(view, (plane, half), &likeness, steps, &pixels, size);
    (likeness, picture)
}

/// The camera of a view's pictures: towards the middle of its models, upright, square, with the tangent of half the
/// field of view so that the models fill the picture but for 5 %.
pub fn camera(view: &View) -> (ImagePlane, f64) {
    let target = view.target();
    let middle = target
        .bounds()
        .map_or(view.look_at, |(lo, hi)| (lo + hi) / 2.0);
    framing(view.eye, &target, middle)
}

/// The same for any eye and mesh: looking at `middle`, with all of the mesh in the picture that lies before the eye.
pub fn framing(eye: DVec3, target: &TriMesh, middle: DVec3) -> (ImagePlane, f64) {
    let plane = ImagePlane::looking_at(eye, middle);
    let reach = target
        .vertices
        .iter()
        .filter_map(|v| plane.project(*v))
        .map(|q| q.abs().max_element())
        .fold(0.0, f64::max);
    (plane, if reach > 0.0 { MARGIN * reach } else { 1.0 })
}

/// The faces that one ray meets.
#[derive(Clone, Copy)]
struct Look {
    target: Option<usize>,
    forest: Option<usize>,
}

impl Look {
    /// `None` where the ray passes the target.
    fn error_deg(&self, target: &TriMesh, forest: &TriMesh) -> Option<f64> {
        let wanted = target.normal(self.target?);
        Some(
            self.forest
                .map_or(90.0, |f| angle_deg(wanted, forest.normal(f))),
        )
    }

    fn panels(
        &self,
        target: &TriMesh,
        forest: &TriMesh,
        colours: Option<&[[u8; 3]]>,
        lights: &Lights,
    ) -> [Rgb; 3] {
        let tint = |face: usize| {
            let colour = colours.and_then(|c| c.get(face)).copied();
            colour.map_or(shading::PLASTER, |c| {
                shading::mixed(shading::PLASTER, c, TINT)
            })
        };
        let shade =
            |mesh: &TriMesh, face: usize, colour: [u8; 3]| lights.shade(mesh.normal(face), colour);
        let wanted = self
            .target
            .map_or(shading::BACKGROUND, |f| shade(target, f, shading::PLASTER));
        let got = self
            .forest
            .map_or(shading::BACKGROUND, |f| shade(forest, f, tint(f)));
        let error = match self.error_deg(target, forest) {
            None => shading::BACKGROUND,
            Some(_) if self.forest.is_none() => MISS.map(f32::from),
            Some(error) => heat(error),
        };
        [wanted, got, error]
    }
}

/// Exact for small angles, unlike the arc cosine; 90 if either is no direction.
pub fn angle_deg(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO {
        90.0
    } else {
        a.cross(b).length().atan2(a.dot(b)).to_degrees()
    }
}

/// The error scale's colour.
fn heat(degrees: f64) -> Rgb {
    let x = (degrees / SCALE_END_DEG).clamp(0.0, 1.0) * (HEAT.len() - 1) as f64;
    let k = (x as usize).min(HEAT.len() - 2);
    let share = (x - k as f64) as f32;
    std::array::from_fn(|c| {
        f32::from(HEAT[k][c]) * (1.0 - share) + f32::from(HEAT[k + 1][c]) * share
    })
}

fn likeness(errors: &[f64], hits: usize) -> Likeness {
    let mut sorted = errors.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = sorted.len().max(1) as f64;
    Likeness {
        hit: hits as f64 / n,
        mean_deg: sorted.iter().sum::<f64>() / n,
        median_deg: percentile(&sorted, 0.5),
        p90_deg: percentile(&sorted, 0.9),
        pixels: sorted.len(),
    }
}

/// Linear between neighbouring ranks; 0 of nothing.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return 0.0;
    };
    let rank = share * last as f64;
    let (low, part) = (rank.floor() as usize, rank.fract());
    sorted[low] + part * (sorted[(low + 1).min(last)] - sorted[low])
}

/// Puts the three panels side by side and writes the captions below.
fn compose(
    view: &View,
    (plane, half): (ImagePlane, f64),
    likeness: &Likeness,
    steps: Option<(&[StepLine], StepSummary)>,
    pixels: &[[Rgb; 3]],
    size: usize,
) -> ViewPictures {
    let unit = size as f64 / 100.0;
    let gap = (3.0 * unit).round() as usize;
    let caption = (13.0 * unit).round() as usize;
    let (w, h) = (3 * size + 4 * gap, size + 2 * gap + caption);
    let mut pixmap = raster::blank(w as u32, h as u32);
    let corner = |panel: usize| (gap + panel * (size + gap), gap);
    for panel in 0..3 {
        raster::put_square(
            &mut pixmap,
            corner(panel),
            size,
            pixels.iter().map(|p| p[panel]),
        );
    }
    let mut drawing = Drawing::new(DVec2::new(w as f64, h as f64));
    let column = |panel: usize| (gap + panel * (size + gap)) as f64;
    if let Some((lines, _)) = steps {
        let panel = Panel {
            plane,
            half,
            corner: DVec2::new(column(2), gap as f64),
            side: size as f64,
        };
        step_lines(&mut drawing, lines, panel);
    }
    let torn = steps.map(|(lines, summary)| step_lines::caption(lines, &summary));
    let top = (size + gap) as f64 + 6.5 * unit;
    captions(
        &mut drawing,
        view,
        likeness,
        torn.as_deref(),
        [column(0), column(1), column(2)],
        top,
        unit,
    );
    drawing.paint(&mut pixmap, 1.0);
    ViewPictures {
        sheet: raster::encode(&pixmap),
        panels: [0, 1, 2].map(|p| raster::encode(&raster::square(&pixmap, corner(p), size))),
    }
}

const TEXT: Ink = Ink::new([0x22, 0x26, 0x2B]);
const QUIET: Ink = Ink::new([0x6F, 0x73, 0x78]);

fn captions(
    drawing: &mut Drawing,
    view: &View,
    likeness: &Likeness,
    torn: Option<&str>,
    columns: [f64; 3],
    top: f64,
    unit: f64,
) {
    let head = TextStyle {
        size: 4.6 * unit,
        ink: TEXT,
        face: Typeface::Regular,
        anchor: Align::Start,
        halo: None,
    };
    let body = TextStyle {
        size: 3.4 * unit,
        ink: QUIET,
        face: Typeface::Light,
        ..head
    };
    // Below the scale's figures, which the last column's second line passes under.
    let below = top + 6.6 * unit;
    let mut put = |x: f64, y: f64, text: &str, style: TextStyle| {
        // The third column's first line ends where the scale starts.
        let most = if x < columns[2] || y > top {
            98.0
        } else {
            62.0
        };
        let fit = (most * unit / width(text, style.size, style.face).max(1e-9)).min(1.0);
        drawing.text(
            DVec2::new(x, y),
            text,
            TextStyle {
                size: style.size * fit,
                ..style
            },
        );
    };
    let files: Vec<&str> = view.models.iter().map(|m| m.file.as_str()).collect();
    put(columns[0], top, &format!("{}: the target", view.name), head);
    put(columns[0], below, &files.join(", "), body);
    let DVec3 { x, y, z } = view.eye.round() + 0.0;
    let (title, eye) = if view.orthographic {
        let DVec3 { x, y, z } = (100.0 * view.from()).round() / 100.0 + 0.0;
        let from = format!("parallel rays from {x}, {y}, {z}");
        ("the forest by parallel rays", from)
    } else {
        let eye = format!("eye at {x:.0}, {y:.0}, {z:.0} mm");
        ("the forest from its eye", eye)
    };
    put(columns[1], top, title, head);
    let eye = eye.replace('-', "\u{2212}");
    put(
        columns[1],
        below,
        &format!(
            "{eye}; {:.2} % of the target's rays meet it",
            floor2(100.0 * likeness.hit)
        ),
        body,
    );
    let Likeness {
        mean_deg,
        median_deg,
        p90_deg,
        ..
    } = *likeness;
    put(columns[2], top, "error of the normals", head);
    let torn = torn.map_or_else(String::new, |text| format!("; {text}"));
    put(
        columns[2],
        below,
        &format!("mean {mean_deg:.1}°, median {median_deg:.1}°, 90 % below {p90_deg:.1}°{torn}"),
        body,
    );
    scale(
        drawing,
        DVec2::new(columns[2] + 66.0 * unit, top - 3.3 * unit),
        unit,
    );
}

/// Rounded down, so that only a perfect share reads as 100 %.
fn floor2(x: f64) -> f64 {
    (100.0 * x).floor() / 100.0
}

/// The colours of the error scale with its ends in degrees.
fn scale(drawing: &mut Drawing, at: DVec2, unit: f64) {
    const STEPS: usize = 60;
    let (length, height) = (34.0 * unit, 2.6 * unit);
    for k in 0..STEPS {
        let lo = at + DVec2::new(length * k as f64 / STEPS as f64, 0.0);
        // Half a step wider than it must be: no seams between neighbours.
        let hi = at
            + DVec2::new(
                (length * (k as f64 + 1.5) / STEPS as f64).min(length),
                height,
            );
        let colour = heat(SCALE_END_DEG * k as f64 / (STEPS - 1) as f64).map(|c| c.round() as u8);
        drawing.rect(lo, hi, Some(Ink::new(colour)), None);
    }
    let style = TextStyle {
        size: 2.8 * unit,
        ink: QUIET,
        face: Typeface::Light,
        anchor: Align::Middle,
        halo: None,
    };
    for (share, text) in [
        (0.0, "0"),
        (1.0 / 3.0, "15"),
        (2.0 / 3.0, "30"),
        (1.0, "45° +"),
    ] {
        let anchor = match share {
            0.0 => Align::Start,
            1.0 => Align::End,
            _ => Align::Middle,
        };
        let x = at.x + share * length;
        drawing.polyline(
            &[DVec2::new(x, at.y), DVec2::new(x, at.y + height)],
            Pen::new(Ink::new([255; 3]).fade(0.6), 0.15 * unit),
        );
        drawing.text(
            DVec2::new(x, at.y + height + 3.1 * unit),
            text,
            TextStyle { anchor, ..style },
        );
    }
}
