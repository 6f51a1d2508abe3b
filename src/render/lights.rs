//! Real light: how a view looks under a sun, under an overcast sky and in a flash, with the shadows that are cast.
//!
//! Takes a view and the finished forest with base and all pillars. The image wanted is that of the model standing free in
//! the same light, with its own cast shadows; the image got is that of the forest. Gives figures for every light and a sheet
//! of pictures. Deterministic: rows run in parallel, sums run in the order of the pixels.
//!
//! # Light
//!
//! Surfaces are Lambertian and white; light does not bounce. `p` is a point of a surface, `n` the unit normal of its facet, and
//! `V(p, w)` is 1 if the ray from `p` in direction `w` meets nothing, else 0. The shade `s(p)` is relative to a surface that
//! faces the sun, or that lies level under the open sky:
//!
//! - sun towards the unit vector `l`:  `s(p) = V(p, l) max(0, n . l)`
//! - overcast sky, equally bright over the upper hemisphere `H`:  `s(p) = 1/pi ∫_H V(p, w) max(0, n . w) dw`. With nothing
//!   around `p` that is `(1 + n_z) / 2`: 1 for a level surface, 1/2 for a wall, 0 for one that looks down. The share of it
//!   that arrives is taken over directions `w_k` spread evenly:
//!   `s(p) = (1 + n_z) / 2  sum_k V(p, w_k) max(0, n . w_k) / sum_k max(0, n . w_k)`.
//! - flash at `f`, with `d = |f - p|` and `l = (f - p) / d`: `s(p) = V(p, f) max(0, n . l) (d0 / d)^2`, and never brighter than paper.
//!   `d0` is its distance from the vertex of the *model* nearest to it, for the forest too: both are photographed with one exposure.
//!   Where it stands: [`flash`](crate::render::flash).
//!
//! The ground below the forest is left out: it gives no light and takes none.
//!
//! Let `h` be the horizontal unit vector from the model to the eye and `r` the eye's right. The sun at the elevation `e` stands
//! 45 degrees to the left or to the right of the eye: `l = cos e (h -+ r) / sqrt 2 + sin e z`. Figures are the mean of both.
//! The flash stands to the left only, as in the paper's Fig 19.
//!
//! # Figures
//!
//! Over the pixels `i` whose ray meets the model, with the shade wanted `w_i` and the shade got `g_i`. Brightness runs from 30 in
//! full shadow to 247: `30 + 217 s`; where the forest is missed it is 255, the paper.

use crate::bvh::Bvh;
use crate::geom::ImagePlane;
use crate::mesh::TriMesh;
use crate::render::flash::Flash;
use crate::render::{camera, light_sheet};
use crate::view::View;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

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

/// Shadow rays start this far off the surface, along its normal and along the ray, millimetres: above what rounding moves a
/// hit (1e-10 mm), below the smallest step anybody prints. Without it facets would shade themselves.
const HAIR_MM: f64 = 1e-3;

/// Brightness in full shadow, and what full light adds.
pub const DARK: f64 = 30.0;
pub const SPAN: f64 = 217.0;

/// The shade that reads as 255: where there is no forest at all.
pub const PAPER: f64 = (255.0 - DARK) / SPAN;

/// Variance of a shade below which it counts as the same everywhere: rounding leaves 1e-32, one facet in ten thousand pixels 1e-9.
const FLAT: f64 = 1e-18;

/// How a view looks in one light: the forest against the model. Means of the two sides for a sun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightLikeness {
    /// `sun_15`, `sun_30`, `sun_60`, `overcast` or `flash`.
    pub light: String,
    /// Of the sun above the horizon, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevation_deg: Option<f64>,
    /// Root mean square of the difference of brightness, on the scale of 0 to 255: `217 sqrt(mean (w - g)^2)`.
    pub rmse: f64,
    /// The same with `V = 1` for both: what is left of `rmse` if nothing cast a shadow, the share of the wrong normals.
    pub rmse_unshadowed: f64,
    /// By what the forest would have to be lit more than the model to look most like it: `a = sum w g / sum g^2`.
    /// 1 if the forest is black all over.
    pub gain: f64,
    /// Root mean square of what then remains: `217 sqrt(mean (w - a g)^2)`; an eye adapts to the light.
    pub rmse_fitted: f64,
    /// Pearson's, of `w` and `g`; none if either is the same everywhere.
    pub correlation: Option<f64>,
    /// Share of the pixels that the sun or the flash lights on the model, and that face it but lie in a cast shadow on the forest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub false_shadow_share: Option<f64>,
    /// Share of the pixels that face it but lie in a cast shadow on the model, and that it lights on the forest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lost_shadow_share: Option<f64>,
}

/// Measures and draws one view in all lights: a sun of each of [`SUNS_DEG`], then the overcast sky, then the flash. The picture is
/// a sheet with a column for each (suns: the left ones), the model above the forest.
pub fn light_pictures(
    view: &View,
    forest: &TriMesh,
    forest_bvh: &Bvh,
) -> (Vec<LightLikeness>, Vec<u8>) {
    let target = view.target();
    let target_bvh = Bvh::new(&target);
    let stage = Stage::new(
        view,
        [
            Body::new(&target, &target_bvh),
            Body::new(forest, forest_bvh),
        ],
    );
    let rows: Vec<Vec<[Option<Lit>; 2]>> =
        (0..SIDE).into_par_iter().map(|y| stage.row(y)).collect();
    let pixels = rows.concat();
    let figures = figures(&pixels);
    let sheet = light_sheet::sheet(view, &stage, &pixels, &figures);
    (figures, sheet)
}

/// Lamps of a view: a left and a right sun of each elevation, then the sky, then the flash.
const SUNS: usize = 2 * SUNS_DEG.len();
pub const SKY_LAMP: usize = SUNS;
pub const FLASH_LAMP: usize = SUNS + 1;
const LAMPS: usize = SUNS + 2;

/// What every lamp does at a place.
pub type Lit = [Term; LAMPS];

/// Model and forest before the camera, under the lamps.
pub struct Stage<'a> {
    bodies: [Body<'a>; 2],
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
    fn new(view: &View, bodies: [Body<'a>; 2]) -> Self {
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
    fn row(&self, y: usize) -> Vec<[Option<Lit>; 2]> {
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

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Meet {
    pub place: DVec3,
    /// Unit, of the facet; zero if it has none.
    pub normal: DVec3,
}

/// What a light does at a place: the shade is `free * open`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Term {
    /// Shade if nothing cast a shadow.
    pub free: f64,
    /// Share of that light that arrives; 1 or 0 for a sun and the flash, 1 where there is no light to be kept off.
    pub open: f64,
}

impl Term {
    pub fn shade(&self) -> f64 {
        self.free * self.open
    }

    fn in_cast_shadow(&self) -> bool {
        self.free > 0.0 && self.open == 0.0
    }
}

/// A mesh that casts shadows on itself.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    mesh: &'a TriMesh,
    bvh: &'a Bvh,
}

impl<'a> Body<'a> {
    /// `bvh` is the mesh's.
    pub fn new(mesh: &'a TriMesh, bvh: &'a Bvh) -> Self {
        Self { mesh, bvh }
    }

    /// Where a ray from `eye` meets the mesh first.
    pub fn meet(&self, eye: DVec3, direction: DVec3) -> Option<Meet> {
        let hit = self.bvh.first_hit(eye, direction)?;
        Some(Meet {
            place: eye + hit.t * direction,
            normal: self.mesh.normal(hit.face),
        })
    }

    /// The light of a sun in direction `l` (unit).
    pub fn sunlight(&self, meet: &Meet, l: DVec3) -> Term {
        let free = meet.normal.dot(l).max(0.0);
        let open = free == 0.0 || !self.blocked(meet, l, f64::INFINITY);
        Term {
            free,
            open: f64::from(u8::from(open)),
        }
    }

    /// The light of an overcast sky given by [`sky`].
    pub fn skylight(&self, meet: &Meet, sky: &[DVec3]) -> Term {
        let (mut all, mut got) = (0.0, 0.0);
        for w in sky {
            let facing = meet.normal.dot(*w);
            if facing > 0.0 {
                all += facing;
                got += if self.blocked(meet, *w, f64::INFINITY) {
                    0.0
                } else {
                    facing
                };
            }
        }
        Term {
            free: free_skylight(meet.normal),
            open: if all > 0.0 { got / all } else { 1.0 },
        }
    }

    /// `1 - V`, for a direction on the outer side of the facet and a light so far away.
    pub fn blocked(&self, meet: &Meet, w: DVec3, distance: f64) -> bool {
        let origin = meet.place + HAIR_MM * (meet.normal + w);
        self.bvh.blocked(origin, w, distance)
    }
}

/// Unit vector towards the sun that stands `elevation_deg` above the horizon, 45 degrees to the left or to the right of the eye.
pub fn sun(plane: &ImagePlane, elevation_deg: f64, left: bool) -> DVec3 {
    let to_eye = plane.right.cross(DVec3::Z);
    let aside = if left { -plane.right } else { plane.right };
    let level = (to_eye + aside) * std::f64::consts::FRAC_1_SQRT_2;
    let (sin, cos) = elevation_deg.to_radians().sin_cos();
    cos * level + sin * DVec3::Z
}

/// `n` directions that stand for equal parts of the upper hemisphere: a spiral by the golden angle, at the middles of zones of
/// equal area.
pub fn sky(n: usize) -> Vec<DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let direction = |k: usize| {
        let z = (k as f64 + 0.5) / n as f64;
        let level = DVec2::from_angle(golden_angle * k as f64) * (1.0 - z * z).sqrt();
        level.extend(z)
    };
    (0..n).map(direction).collect()
}

/// Light of an overcast sky on a surface with nothing around it.
fn free_skylight(normal: DVec3) -> f64 {
    (1.0 + normal.z) / 2.0
}

/// All figures of a view, in the order of the sheet's columns.
fn figures(pixels: &[[Option<Lit>; 2]]) -> Vec<LightLikeness> {
    let of_lamp = |lamp: usize| {
        let pairs: Vec<Pair> = pixels
            .iter()
            .filter_map(|[model, forest]| Some((model.as_ref()?[lamp], forest.map(|f| f[lamp]))))
            .collect();
        Figures::of(&pairs)
    };
    let suns = SUNS_DEG.iter().enumerate().map(|(k, elevation)| {
        let [left, right] = [of_lamp(2 * k), of_lamp(2 * k + 1)];
        LightLikeness {
            elevation_deg: Some(*elevation),
            ..left.mean(&right).named(format!("sun_{elevation:.0}"))
        }
    });
    let sky = LightLikeness {
        false_shadow_share: None,
        lost_shadow_share: None,
        ..of_lamp(SKY_LAMP).named("overcast".into())
    };
    let flash = of_lamp(FLASH_LAMP).named("flash".into());
    suns.chain([sky, flash]).collect()
}

/// One lamp at one pixel: on the model, and on the forest where it is not missed.
type Pair = (Term, Option<Term>);

/// The figures of one lamp, as in [`LightLikeness`].
#[derive(Clone, Copy)]
struct Figures {
    rmse: f64,
    rmse_unshadowed: f64,
    gain: f64,
    rmse_fitted: f64,
    correlation: Option<f64>,
    false_shadow: f64,
    lost_shadow: f64,
}

impl Figures {
    fn of(pairs: &[Pair]) -> Self {
        let of_forest = |pick: fn(&Term) -> f64| move |p: &Pair| p.1.as_ref().map_or(PAPER, pick);
        let n = pairs.len().max(1) as f64;
        let rms = |difference: &dyn Fn(&Pair) -> f64| {
            SPAN * (pairs.iter().map(|p| difference(p).powi(2)).sum::<f64>() / n).sqrt()
        };
        let share = |of: fn(&Term, &Term) -> bool| {
            let count = pairs
                .iter()
                .filter(|(w, g)| g.as_ref().is_some_and(|g| of(w, g)))
                .count();
            count as f64 / n
        };
        let (free, shade) = (of_forest(|t| t.free), of_forest(Term::shade));
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            pairs.iter().map(|p| of(p.0.shade(), shade(p))).sum()
        };
        let squares = sum(&|_, g| g * g);
        let gain = if squares > 0.0 {
            sum(&|w, g| w * g) / squares
        } else {
            1.0
        };
        let (mean_w, mean_g) = (sum(&|w, _| w) / n, sum(&|_, g| g) / n);
        let spread_w = sum(&|w, _| (w - mean_w).powi(2));
        let spread_g = sum(&|_, g| (g - mean_g).powi(2));
        let common = sum(&|w, g| (w - mean_w) * (g - mean_g));
        Self {
            rmse: rms(&|p| p.0.shade() - shade(p)),
            rmse_unshadowed: rms(&|p| p.0.free - free(p)),
            gain,
            rmse_fitted: rms(&|p| p.0.shade() - gain * shade(p)),
            correlation: (spread_w > FLAT * n && spread_g > FLAT * n)
                .then(|| common / (spread_w * spread_g).sqrt()),
            false_shadow: share(|w, g| w.shade() > 0.0 && g.in_cast_shadow()),
            lost_shadow: share(|w, g| w.in_cast_shadow() && g.shade() > 0.0),
        }
    }

    fn mean(&self, other: &Self) -> Self {
        let mean = |a: f64, b: f64| (a + b) / 2.0;
        Self {
            rmse: mean(self.rmse, other.rmse),
            rmse_unshadowed: mean(self.rmse_unshadowed, other.rmse_unshadowed),
            gain: mean(self.gain, other.gain),
            rmse_fitted: mean(self.rmse_fitted, other.rmse_fitted),
            correlation: match (self.correlation, other.correlation) {
                (Some(a), Some(b)) => Some(mean(a, b)),
                (a, b) => a.or(b),
            },
            false_shadow: mean(self.false_shadow, other.false_shadow),
            lost_shadow: mean(self.lost_shadow, other.lost_shadow),
        }
    }

    fn named(self, light: String) -> LightLikeness {
        LightLikeness {
            light,
            elevation_deg: None,
            rmse: self.rmse,
            rmse_unshadowed: self.rmse_unshadowed,
            gain: self.gain,
            rmse_fitted: self.rmse_fitted,
            correlation: self.correlation,
            false_shadow_share: Some(self.false_shadow),
            lost_shadow_share: Some(self.lost_shadow),
        }
    }
}
