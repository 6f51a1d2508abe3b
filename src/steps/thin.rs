//! Pieces too thin to print: found on a raster of the image, given to a neighbour.
//!
//! A strip between two tears that is narrower than the printer's line would be a fin where it stands out and a slit where it
//! lies deep. It joins the neighbour that costs least, drawn in to the layer: its normals turn, the strip is gone. In the final
//! program it hardly counts, so that the neighbour does not bend for it.

use super::fusion::{Functional, PatchDepths};
use super::patches::{PatchId, Patches};
use crate::groups::anchor;
use crate::index::CellId;
use crate::viewmap::{Image, Target, ViewMap};
use glam::{DVec2, IVec2};

/// Pixels across the narrowest printable strip: strips are told apart to a sixth of it.
const PIXELS: f64 = 6.0;
/// Rasters larger than this are made coarser: 16 million pixels.
const MOST_PIXELS: f64 = 16e6;
/// Sheets nearer than this in the model meet in a tear, not in a contour of the model, millimetres.
const TEAR_MM: f64 = 0.2;
/// Merging strips may leave others behind; a third round rarely finds any.
const ROUNDS: usize = 3;

/// Gives every strip narrower than `narrowest`, as the image measures, to a neighbour; which patches of the support were given away.
pub(crate) fn absorb_thin(
    image: &Image,
    functional: &Functional,
    cells: &[CellId],
    field: &mut PatchDepths,
    narrowest: f64,
) -> Vec<bool> {
    let Image { target, map, .. } = image;
    let mut absorbed = vec![false; field.len()];
    if narrowest <= 0.0 || cells.is_empty() {
        return absorbed;
    }
    let patches = functional.patches();
    let raster = Raster::new(map, patches, cells, narrowest);
    for _ in 0..ROUNDS {
        let pieces = functional.pieces(field);
        let thin = raster.thin(target, functional, &pieces);
        let mut changed = false;
        for region in functional.regions(&pieces, &thin) {
            if functional.join_cheapest(field, &region, &thin) {
                region.iter().for_each(|i| absorbed[*i] = true);
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    absorbed
}

/// The patch at every pixel of one support's part of the image.
struct Raster {
    corner: DVec2,
    pixel: f64,
    size: IVec2,
    /// Patch, row by row.
    patch: Vec<Option<PatchId>>,
}

impl Raster {
    /// `narrowest` in the image.
    fn new(map: &ViewMap, patches: &Patches, cells: &[CellId], narrowest: f64) -> Self {
        let points = || cells.iter().flat_map(|c| map.triangle(*c));
        let lo = points().fold(DVec2::INFINITY, DVec2::min);
        let hi = points().fold(DVec2::NEG_INFINITY, DVec2::max);
        let extent = hi - lo;
        let pixel = (narrowest / PIXELS).max((extent.x * extent.y / MOST_PIXELS).sqrt());
        let size = (extent / pixel).ceil().as_ivec2() + 1;
        let mut raster = Self {
            corner: lo,
            pixel,
            size,
            patch: vec![None; (size.x * size.y) as usize],
        };
        for c in cells {
            if let Some(p) = patches.of_cell[*c] {
                raster.fill(map.triangle(*c), p);
            }
        }
        raster
    }

    /// Where a pixel of the raster stands in its list.
    fn place(&self, p: IVec2) -> usize {
        (p.y * self.size.x + p.x) as usize
    }

    fn centre(&self, at: IVec2) -> DVec2 {
        self.corner + (at.as_dvec2() + 0.5) * self.pixel
    }

    /// Labels the pixels whose centres lie in a triangle.
    fn fill(&mut self, triangle: [DVec2; 3], patch: PatchId) {
        let local = triangle.map(|q| (q - self.corner) / self.pixel - 0.5);
        let lo = local[0]
            .min(local[1])
            .min(local[2])
            .ceil()
            .as_ivec2()
            .max(IVec2::ZERO);
        let hi = local[0]
            .max(local[1])
            .max(local[2])
            .floor()
            .as_ivec2()
            .min(self.size - 1);
        let inside = |p: DVec2| {
            (0..3).all(|k| (local[(k + 1) % 3] - local[k]).perp_dot(p - local[k]) >= 0.0)
        };
        for y in lo.y..=hi.y {
            for x in lo.x..=hi.x {
                if inside(DVec2::new(f64::from(x), f64::from(y))) {
                    let at = self.place(IVec2::new(x, y));
                    self.patch[at] = Some(patch);
                }
            }
        }
    }

    fn at(&self, p: IVec2) -> Option<PatchId> {
        let inside = p.cmpge(IVec2::ZERO).all() && p.cmplt(self.size).all();
        inside.then(|| self.patch[self.place(p)])?
    }

    fn pixels(&self) -> impl Iterator<Item = (IVec2, PatchId)> {
        let width = self.size.x;
        let pixel = move |(k, p): (usize, &Option<PatchId>)| {
            let k = i32::try_from(k).expect("no more than MOST_PIXELS");
            Some((IVec2::new(k % width, k / width), (*p)?))
        };
        self.patch.iter().enumerate().filter_map(pixel)
    }

    /// Whether at least half of a patch's pixels lie where no disc of the narrowest width fits between tears; index: patch
    /// of the support.
    fn thin(&self, target: &Target, functional: &Functional, pieces: &[u32]) -> Vec<bool> {
        let piece = |p: PatchId| pieces[functional.own(p)];
        let depth = |patch: PatchId, at: IVec2| {
            let face = functional.patches().patches[patch].face;
            anchor(target, face, self.centre(at)).1
        };
        let torn = |at: IVec2, p: PatchId, by: IVec2| {
            self.at(at + by).is_some_and(|q| {
                piece(q) != piece(p) && (depth(q, at) - depth(p, at)).abs() < TEAR_MM
            })
        };
        let around = [IVec2::X, IVec2::Y, IVec2::NEG_X, IVec2::NEG_Y];
        let mut edge = vec![false; self.patch.len()];
        for (at, p) in self.pixels() {
            edge[self.place(at)] = around.iter().any(|by| torn(at, p, *by));
        }
        // A disc's centre lies a radius from every torn edge of its own piece, half a pixel beyond the edge pixels.
        let radius = PIXELS / 2.0;
        let reach = radius.ceil() as i32;
        let disc =
            || (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |x| IVec2::new(x, y)));
        let within = |by: &IVec2, r: f64| f64::from(by.length_squared()) <= r * r;
        let near: Vec<IVec2> = disc().filter(|by| within(by, radius - 1.0)).collect();
        let wide: Vec<IVec2> = disc().filter(|by| within(by, radius)).collect();
        let same = |at: IVec2, p: PatchId| self.at(at).is_some_and(|q| piece(q) == piece(p));
        let mut centre = vec![false; self.patch.len()];
        for (at, p) in self.pixels() {
            centre[self.place(at)] = !near
                .iter()
                .any(|by| same(at + *by, p) && edge[self.place(at + *by)]);
        }
        let mut count = vec![(0u32, 0u32); functional.range().len()];
        for (at, p) in self.pixels() {
            let fits = wide
                .iter()
                .any(|by| same(at + *by, p) && centre[self.place(at + *by)]);
            let slot = &mut count[functional.own(p)];
            slot.0 += u32::from(!fits);
            slot.1 += 1;
        }
        count
            .iter()
            .map(|(thin, all)| *all > 0 && 2 * thin >= *all)
            .collect()
    }
}
