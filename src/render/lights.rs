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
use crate::mesh::TriMesh;
use crate::render::caster::Caster;
use crate::render::light_figures::{LightLikeness, figures};
use crate::render::light_sheet;
use crate::render::stage::{Lit, SIDE, Stage};
use crate::view::View;
use rayon::prelude::*;

/// Measures and draws one view in all lights: a sun of each of [`SUNS_DEG`](crate::render::stage::SUNS_DEG), then the overcast sky,
/// then the flash. The picture is a sheet with a column for each (suns: the left ones), the model above the forest.
pub fn light_pictures(
    view: &View,
    forest: &TriMesh,
    forest_bvh: &Bvh,
) -> (Vec<LightLikeness>, Vec<u8>) {
    let target = view.whole_target();
    let target_bvh = Bvh::new(&target);
    let stage = Stage::new(
        view,
        [
            Caster::new(&target, &target_bvh),
            Caster::new(forest, forest_bvh),
        ],
    );
    let rows: Vec<Vec<[Option<Lit>; 2]>> =
        (0..SIDE).into_par_iter().map(|y| stage.row(y)).collect();
    let pixels = rows.concat();
    let figures = figures(&pixels);
    let sheet = light_sheet::sheet(view, &stage, &pixels, &figures);
    (figures, sheet)
}
