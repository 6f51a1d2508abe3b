//! View pictures in even light.
//!
//! Takes a view, the finished forest and the lines where it was torn, gives a picture (target | forest | normal error with the
//! lines) and the figures under it.
//! The figures use one ray through every pixel's centre; the pictures are smoothed by its corners where neighbours differ.

use crate::bvh::Bvh;
use crate::diagram::drawing::Drawing;
use crate::diagram::raster;
use crate::geom::ImagePlane;
use crate::index::FaceId;
use crate::mesh::TriMesh;
use crate::render::camera::camera;
use crate::render::captions::{CaptionPlace, captions};
use crate::render::heat::heat;
use crate::render::likeness::{Likeness, MISSED_DEG, angle_deg, likeness};
use crate::render::shading::{self, Lights, Rgb, smoothed};
use crate::render::step_lines::{self, Panel, step_lines};
use crate::steps::{StepLine, StepSummary};
use crate::view::View;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Share of a face's own colour in the forest's panel: enough to tell the views apart, too little to hide the shading.
const TINT: f64 = 0.3;

/// A ray that should have met the forest and did not.
const MISS: [u8; 3] = [0x1A, 0x1A, 0x1A];

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
    let target = view.whole_target();
    let target_bvh = Bvh::new(&target);
    let (plane, half) = camera(view);
    let look = |x: f64, y: f64| {
        let scale = 2.0 * half / size as f64;
        let q = DVec2::new(x - size as f64 / 2.0, size as f64 / 2.0 - y) * scale;
        let direction = plane.direction(q).normalize();
        let sight = |bvh: &Bvh| bvh.first_hit(plane.eye, direction).map(|h| h.face);
        Look {
            direction,
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
    let centres: Vec<[Rgb; 3]> = looks.par_iter().map(|l| panels(*l)).collect();
    let pixels = smoothed(&centres, size, |x, y| panels(look(x, y)));
    let picture = compose(view, (plane, half), &likeness, steps, &pixels, size);
    (likeness, picture)
}

/// The faces that one ray meets.
#[derive(Clone, Copy)]
struct Look {
    direction: DVec3,
    target: Option<FaceId>,
    forest: Option<FaceId>,
}

impl Look {
    /// `None` where the ray passes the target.
    fn error_deg(&self, target: &TriMesh, forest: &TriMesh) -> Option<f64> {
        let wanted = target.normal_against(self.target?, self.direction);
        Some(
            self.forest
                .map_or(MISSED_DEG, |f| angle_deg(wanted, forest.normal(f))),
        )
    }

    fn panels(
        &self,
        target: &TriMesh,
        forest: &TriMesh,
        colours: Option<&[[u8; 3]]>,
        lights: &Lights,
    ) -> [Rgb; 3] {
        let tint = |face: FaceId| {
            let colour = colours.and_then(|c| c.get(face.at())).copied();
            colour.map_or(shading::PLASTER, |c| {
                shading::mixed(shading::PLASTER, c, TINT)
            })
        };
        let wanted = self.target.map_or(shading::BACKGROUND, |f| {
            lights.shade(target.normal_against(f, self.direction), shading::PLASTER)
        });
        let got = self.forest.map_or(shading::BACKGROUND, |f| {
            lights.shade(forest.normal(f), tint(f))
        });
        let error = match self.error_deg(target, forest) {
            None => shading::BACKGROUND,
            Some(_) if self.forest.is_none() => MISS.map(f32::from),
            Some(error) => heat(error),
        };
        [wanted, got, error]
    }
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
    let place = CaptionPlace {
        columns: [column(0), column(1), column(2)],
        top: (size + gap) as f64 + 6.5 * unit,
        unit,
    };
    captions(&mut drawing, &place, view, likeness, torn.as_deref());
    drawing.paint(&mut pixmap, 1.0);
    ViewPictures {
        sheet: raster::encode(&pixmap),
        panels: [0, 1, 2].map(|p| raster::encode(&raster::square(&pixmap, corner(p), size))),
    }
}
