//! Model and forest before the camera of a view, under all of its lamps.

use crate::geom::ImagePlane;
use crate::render::camera::camera;
use crate::render::caster::{Caster, Meet, Term, free_skylight, sky, sun};
use crate::render::flash::Flash;
use crate::view::View;
use glam::{DVec2, DVec3};

/// Side of the measured picture, pixels. On the reference forest and the bundled one every sun's rmse is within 1.5 % of that at
/// 240, the shares of shadow within 0.013; 240 take twice as long.
pub const SIDE: usize = 160;

/// Elevations of the suns, degrees, in the order of the figures.
pub const SUNS_DEG: [f64; 3] = [15.0, 30.0, 60.0];

/// Directions that stand for the sky. With 32 the rmse of the reference forest's views is up to 2 % off that with 64; the time
/// grows with them.
pub const SKY: usize = 48;

/// The same beside the target, where nothing is measured: 16 show no bands on the pillars.
const SKY_AROUND: usize = 16;

/// Lamps of a view: a left and a right sun of each elevation, then the sky, then the flash.
const SUNS: usize = 2 * SUNS_DEG.len();
pub const SKY_LAMP: usize = SUNS;
pub const FLASH_LAMP: usize = SUNS + 1;
const LAMPS: usize = SUNS + 2;

/// What every lamp does at a place.
pub type Lit = [Term; LAMPS];

/// Model and forest before the camera, under the lamps.
pub struct Stage<'a> {
    bodies: [Caster<'a>; 2],
    plane: ImagePlane,
    /// Tangent of half the field of view.
    half: f64,
    suns: [DVec3; SUNS],
    flash: Flash,
    sky: Vec<DVec3>,
    /// For places beside the target, which are drawn but not measured.
    sky_around: Vec<DVec3>,
}

impl<'a> Stage<'a> {
    pub fn new(view: &View, bodies: [Caster<'a>; 2]) -> Self {
        let (plane, half) = camera(view);
        let sun = |k: usize| sun(&plane, SUNS_DEG[k / 2], k.is_multiple_of(2));
        Self {
            bodies,
            plane,
            half,
            suns: std::array::from_fn(sun),
            flash: Flash::beside(&plane, bodies[0].mesh, true),
            sky: sky(SKY),
            sky_around: sky(SKY_AROUND),
        }
    }

    /// Light on model and forest at the middles of the pixels of row `y`, counted from the top.
    pub fn row(&self, y: usize) -> Vec<[Option<Lit>; 2]> {
        let pixel = |x: usize| {
            let [model, forest] = self.meets(x as f64 + 0.5, y as f64 + 0.5);
            let sky = if model.is_some() {
                &self.sky
            } else {
                &self.sky_around
            };
            [
                model.map(|m| self.lit(0, &m, sky)),
                forest.map(|m| self.lit(1, &m, sky)),
            ]
        };
        (0..SIDE).map(pixel).collect()
    }

    /// The same at any place, in pixels from the top left corner, near the middle of a pixel whose light is known, but for the
    /// right suns. How much of the sky a place sees changes slowly: it is that of the middle.
    pub fn lit_near(&self, x: f64, y: f64, middle: &[Option<Lit>; 2]) -> [Option<Lit>; 2] {
        let meets = self.meets(x, y);
        [0, 1].map(|b| {
            let meet = meets[b]?;
            let mut lit = [Term::default(); LAMPS];
            for (term, l) in lit.iter_mut().zip(&self.suns).step_by(2) {
                *term = self.bodies[b].sunlight(&meet, *l);
            }
            lit[SKY_LAMP] = Term {
                free: free_skylight(meet.normal),
                open: middle[b].map_or(1.0, |lit| lit[SKY_LAMP].open),
            };
            lit[FLASH_LAMP] = self.flash.light(&self.bodies[b], &meet);
            Some(lit)
        })
    }

    fn meets(&self, x: f64, y: f64) -> [Option<Meet>; 2] {
        let side = SIDE as f64;
        let q = DVec2::new(x - side / 2.0, side / 2.0 - y) * (2.0 * self.half / side);
        let direction = self.plane.direction(q).normalize();
        self.bodies
            .each_ref()
            .map(|body| body.meet(self.plane.eye, direction))
    }

    fn lit(&self, b: usize, meet: &Meet, sky: &[DVec3]) -> Lit {
        let body = &self.bodies[b];
        std::array::from_fn(|lamp| match self.suns.get(lamp) {
            Some(l) => body.sunlight(meet, *l),
            None if lamp == SKY_LAMP => body.skylight(meet, sky),
            None => self.flash.light(body, meet),
        })
    }
}
