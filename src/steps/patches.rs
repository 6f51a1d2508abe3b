//! The pieces a surface may fall into: patches (parts of faces seen on one group) and the seams between them.

use super::options::{LIP_MM, StepLimits, StepOptions, UNSEEN_RAD};
use crate::geom::ImagePlane;
use crate::groups::{Anchor, Groups, anchor};
use crate::index::{CellId, FaceId, GroupId, SupportId, indices};
use crate::laplacian::FaceGeometry;
use crate::mimic::TOGETHER_MM;
use crate::sight::Sight;
use crate::viewmap::{Image, Target, ViewMap};
use glam::DVec2;
use std::ops::Range;

indices! {
    /// A patch of a view.
    PatchId
}

/// Points of the image with this weight of a corner are that corner.
const AT_CORNER: f64 = 1.0 - 1e-6;

/// The part of a face that is seen on one group.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub face: FaceId,
    pub group: GroupId,
    pub support: SupportId,
    /// Its solid angle times the square of the model's mean depth.
    pub seen_mm2: f64,
    /// `sum over k of tilt_k (y_(k+1) - y_(k+2))^2` is what the patch costs: its seen area times `tan^2 theta`, square millimetres.
    pub tilt: [f64; 3],
    /// Log relief depths over the model's that the layer, or an outline, allows at each corner's own ray.
    pub room: [(f64, f64); 3],
    /// Log relief depths that are allowed for the whole patch if it is the same everywhere; empty where the patch is too steep.
    pub even: (f64, f64),
    pub points: Vec<PatchPoint>,
    /// Largest step allowed at its sides, log depth.
    pub highest: f64,
}

/// A bounded point of a patch: `lower <= sum of weight * y <= upper` (linearised in log depth).
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchPoint {
    pub weights: [f64; 3],
    pub lower: f64,
    pub upper: f64,
}

/// A line along which two patches meet in the image.
#[derive(Clone, Debug)]
pub(crate) struct Seam {
    pub patches: [PatchId; 2],
    /// Weights of both patches' corners at both ends.
    pub ends: [[[f64; 3]; 2]; 2],
    /// At both ends: 0 where the patches hang together; else the log of the second's depth in the model over the first's.
    pub gaps: [f64; 2],
    /// Length in the image at the model's mean depth, millimetres.
    pub length_mm: f64,
    /// Both ends in the image.
    pub line: [DVec2; 2],
    /// Angle between the normals, radians.
    pub crease: f64,
    /// By how much the first and the second patch may stand before the other (log depth). More, and they are knives: see
    /// [`StepOptions::steepest`].
    pub free: [f64; 2],
    /// Largest step allowed, log depth.
    pub highest: f64,
}

/// A side where the relief ends at another support's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rim {
    pub patch: PatchId,
    /// Whether its own support is the nearer one.
    pub near: bool,
    pub length_mm: f64,
}

impl Patch {
    /// The constant `level`, drawn in to the layer at the corners.
    pub(crate) fn drawn_in(&self, level: f64) -> [f64; 3] {
        self.room.map(|(lo, hi)| level.clamp(lo, hi))
    }
}

impl Seam {
    /// Whether the model itself hangs together along all of it: no contour.
    pub(crate) fn hangs_together(&self) -> bool {
        self.gaps == [0.0; 2]
    }

    /// The jump at one end from the second patch to the first, whose corners are given.
    pub(crate) fn jump(&self, end: usize, first: &[f64; 3], second: &[f64; 3]) -> f64 {
        let [w, v] = &self.ends[end];
        mixed(w, first) - mixed(v, second)
    }
}

/// The weighted sum of a patch's corners.
pub(crate) fn mixed(weights: &[f64; 3], corners: &[f64; 3]) -> f64 {
    (0..3).map(|k| weights[k] * corners[k]).sum()
}

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct Patches {
    pub patches: Vec<Patch>,
    /// Patch of every cell of the map.
    pub of_cell: Vec<Option<PatchId>>,
    /// Rising by patches.
    pub seams: Vec<Seam>,
    pub rims: Vec<Rim>,
    /// Median width of the layers in log depth.
    pub width: f64,
    /// Mean depth of the seen model, millimetres.
    pub depth: f64,
    /// Of the image plane.
    pub focal: f64,
}

impl Patches {
    pub(crate) fn new(steps: &StepOptions, sight: &Sight) -> Self {
        let limits = &steps.limits;
        let Image { target, map, .. } = &sight.image;
        let (keys, of_cell) = numbered(map, &sight.groups);
        let depth = mean_depth(target, map);
        let scale = map.plane.scale(depth);
        let geometry = FaceGeometry::new(&target.mesh);
        let mut patches: Vec<Patch> = keys
            .iter()
            .map(|(_, group, face)| patch(sight, *group, *face))
            .collect();
        for (c, patch) in CellId::all(of_cell.len()).zip(&of_cell) {
            let Some(i) = patch else { continue };
            add_cell(&mut patches[*i], sight, c);
        }
        for p in &mut patches {
            p.highest = highest(limits, target, map.plane.focal, p);
            p.seen_mm2 *= scale * scale;
            let counted = p.seen_mm2 * target.face_weight(p.face).powi(2);
            p.tilt = tilt(target, &map.plane, &geometry, p.face, counted);
        }
        let mut widths: Vec<f64> = patches
            .iter()
            .flat_map(|p| p.points.iter().map(|b| b.upper - b.lower))
            .collect();
        widths.sort_by(f64::total_cmp);
        let stitching = Stitching {
            target,
            map,
            patches: &patches,
            scale,
            steepest: steps.steepest(),
        };
        let (seams, rims) = stitching.seams(&of_cell);
        Self {
            seams,
            rims,
            width: widths.get(widths.len() / 2).copied().unwrap_or(1.0),
            patches,
            of_cell,
            depth,
            focal: map.plane.focal,
        }
    }

    /// Patches of every support, which stand together, with its cells.
    pub(crate) fn by_support(&self) -> Vec<(Range<usize>, Vec<CellId>)> {
        let mut ranges: Vec<(Range<usize>, Vec<CellId>)> = Vec::new();
        let mut of_patch = Vec::with_capacity(self.patches.len());
        for (i, p) in self.patches.iter().enumerate() {
            if i == 0 || self.patches[i - 1].support != p.support {
                ranges.push((i..i, Vec::new()));
            }
            let last = ranges.len() - 1;
            ranges[last].0.end = i + 1;
            of_patch.push(last);
        }
        for (c, patch) in CellId::all(self.of_cell.len()).zip(&self.of_cell) {
            if let Some(p) = patch {
                ranges[of_patch[*p]].1.push(c);
            }
        }
        ranges
    }
}

/// Support, group and face of a patch.
type PatchKey = (SupportId, GroupId, FaceId);

/// The keys of all patches, rising, and the patch of every cell.
fn numbered(map: &ViewMap, groups: &Groups) -> (Vec<PatchKey>, Vec<Option<PatchId>>) {
    let key = |c: CellId| {
        let group = groups.of_cell[c]?;
        Some((groups.groups[group].support, group, map.cells[c].face?))
    };
    let mut keys: Vec<PatchKey> = CellId::all(map.cells.len()).filter_map(key).collect();
    keys.sort_unstable();
    keys.dedup();
    let find = |c| Some(PatchId::new(keys.binary_search(&key(c)?).ok()?));
    let of_cell = CellId::all(map.cells.len()).map(find).collect();
    (keys, of_cell)
}

fn mean_depth(target: &Target, map: &ViewMap) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    for (c, cell) in map.all() {
        let Some(face) = cell.face else { continue };
        let sr = map.solid_angle(c);
        let z = target.mesh.faces[face].map(|v| target.depth[v]);
        sum += sr * z.iter().sum::<f64>() / 3.0;
        weight += sr;
    }
    sum / weight
}

fn patch(sight: &Sight, group: GroupId, face: FaceId) -> Patch {
    let Sight { image, groups, .. } = sight;
    let target = &image.target;
    let support = groups.groups[group].support;
    let slab = groups.slabs[support].expect("groups lie on supports with layers");
    let room = target.mesh.faces[face].map(|v| {
        let (near, far) = image.layer_at(&slab, support, target.image[v]);
        let z = target.depth[v];
        ((near / z).ln(), (far / z).ln())
    });
    Patch {
        face,
        group,
        support,
        seen_mm2: 0.0,
        tilt: [0.0; 3],
        room,
        even: (f64::NEG_INFINITY, f64::INFINITY),
        points: Vec::new(),
        highest: f64::INFINITY,
    }
}

/// The largest step that keeps all limits wherever in the layer it lies. A step between depths `Z` and `Z e^d` is `Z (e^d - 1)`
/// high, and opens by `e (1 - e^-d) / Z` for an eye that moves sideways by `e` (design: `e |1/Z1 - 1/Z2|`); as from the reading
/// distance by `focal^2` times that.
fn highest(limits: &StepLimits, target: &Target, focal: f64, p: &Patch) -> f64 {
    let depth = target.mesh.faces[p.face].map(|v| target.depth[v]);
    let at = |k: usize, y: f64| depth[k] * y.exp();
    let nearest = (0..3)
        .map(|k| at(k, p.room[k].0))
        .fold(f64::INFINITY, f64::min);
    let farthest = (0..3).map(|k| at(k, p.room[k].1)).fold(0.0, f64::max);
    let by_height = limits
        .highest_mm
        .map_or(f64::INFINITY, |h| (h / farthest).ln_1p());
    let by_tolerance = limits.tolerance_mm.map_or(f64::INFINITY, |e| {
        let opening = UNSEEN_RAD * nearest / e / (focal * focal);
        if opening < 1.0 {
            -(-opening).ln_1p()
        } else {
            f64::INFINITY
        }
    });
    by_height.min(by_tolerance)
}

/// Adds a cell's solid angle (to `seen_mm2`, scaled when all are known) and the bounds at its corners.
fn add_cell(patch: &mut Patch, sight: &Sight, c: CellId) {
    let Sight { image, groups, .. } = sight;
    let map = &image.map;
    let support = groups.groups[patch.group].support;
    let slab = groups.slabs[support].expect("groups lie on supports with layers");
    patch.seen_mm2 += map.solid_angle(c);
    for (k, q) in map.triangle(c).into_iter().enumerate() {
        let (anchor, z) = anchor(&image.target, patch.face, q);
        let (near, far) = image.layer_in(&slab, c, k);
        let (lower, upper) = ((near / z).ln(), (far / z).ln());
        patch.even = (patch.even.0.max(lower), patch.even.1.min(upper));
        // Where an outline lies on its support, a corner has less room than the layer. Outlines on two planes of a crooked support may leave
        // none in common: then the solver is asked.
        if let Some(corner) = anchor.weights.iter().position(|w| *w > AT_CORNER)
            && slab.draws()
            && map.cells[c].outline[k]
        {
            let (lo, hi) = patch.room[corner];
            let common = (lo.max(lower), hi.min(upper));
            if common.0 <= common.1 {
                patch.room[corner] = common;
            }
        }
        patch.points.push(PatchPoint {
            weights: anchor.weights,
            lower,
            upper,
        });
    }
}

/// What a patch of `seen` square millimetres costs for differences between its corners (see `mimic::normal`).
fn tilt(
    target: &Target,
    plane: &ImagePlane,
    geometry: &FaceGeometry,
    face: FaceId,
    seen: f64,
) -> [f64; 3] {
    let h = target
        .mesh
        .normal(face)
        .dot(target.mesh.corners(face)[0] - plane.eye);
    geometry.cotangents[face].map(|cot| seen * h * h * cot / (2.0 * geometry.areas[face]))
}

/// What seams are made from.
struct Stitching<'a> {
    target: &'a Target,
    map: &'a ViewMap,
    patches: &'a [Patch],
    /// Millimetres at the model's mean depth in a unit of the image.
    scale: f64,
    /// See [`StepOptions::steepest`].
    steepest: f64,
}

impl Stitching<'_> {
    /// All seams, rising by patches (one for every side of cells between two patches of one support), and all rims.
    fn seams(&self, of_cell: &[Option<PatchId>]) -> (Vec<Seam>, Vec<Rim>) {
        let Self { map, patches, .. } = self;
        let (mut seams, mut rims) = (Vec::new(), Vec::new());
        for c in CellId::all(map.cells.len()) {
            for k in 0..3 {
                let Some(n) = map.neighbours[c][k].filter(|n| *n > c) else {
                    continue;
                };
                let (Some(i), Some(j)) = (of_cell[c], of_cell[n]) else {
                    continue;
                };
                let corners = map.triangle(c);
                let line = [corners[k], corners[(k + 1) % 3]];
                if patches[i].support != patches[j].support {
                    let i_is_near = map.cells[c].support_depth < map.cells[n].support_depth;
                    let length_mm = line[0].distance(line[1]) * self.scale;
                    rims.extend([(i, i_is_near), (j, !i_is_near)].map(|(patch, near)| Rim {
                        patch,
                        near,
                        length_mm,
                    }));
                } else if i != j {
                    let mut sides = [(i, c), (j, n)];
                    sides.sort_unstable();
                    seams.push(self.seam(sides, line));
                }
            }
        }
        seams.sort_by_key(|s| s.patches);
        (seams, rims)
    }

    /// The seam between two patches, each with its cell at the line.
    fn seam(&self, sides: [(PatchId, CellId); 2], line: [DVec2; 2]) -> Seam {
        let target = self.target;
        let pair = sides.map(|(p, _)| p);
        let faces = pair.map(|p| self.patches[p].face);
        let at = line.map(|q| faces.map(|f| anchor(target, f, q)));
        let gap = |[a, b]: [(Anchor, f64); 2]| {
            if (a.1 - b.1).abs() > TOGETHER_MM {
                (b.1 / a.1).ln()
            } else {
                0.0
            }
        };
        let [a, b] = faces.map(|f| target.mesh.normal(f));
        Seam {
            patches: pair,
            ends: at.map(|e| e.map(|(anchor, _)| anchor.weights)),
            gaps: at.map(gap),
            length_mm: line[0].distance(line[1]) * self.scale,
            line,
            crease: a.cross(b).length().atan2(a.dot(b)),
            free: sides.map(|(p, c)| self.free(p, c, line)),
            highest: pair
                .map(|p| self.patches[p].highest)
                .into_iter()
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// How far a patch may stand free along the line where its `cell` begins without being a knife, log depth.
    fn free(&self, patch: PatchId, cell: CellId, line: [DVec2; 2]) -> f64 {
        if self.recession(patch, cell, line) > self.steepest {
            let depth =
                self.target.mesh.faces[self.patches[patch].face].map(|v| self.target.depth[v]);
            LIP_MM / (depth.iter().sum::<f64>() / 3.0)
        } else {
            f64::INFINITY
        }
    }

    /// By how many millimetres a patch grows deeper in the model for each millimetre away from the line where its `cell` begins.
    fn recession(&self, patch: PatchId, cell: CellId, line: [DVec2; 2]) -> f64 {
        let (target, face) = (self.target, self.patches[patch].face);
        let [a, b, c] = target.image_of(face);
        let nearness = target.mesh.faces[face].map(|v| 1.0 / target.depth[v]);
        // The reciprocal of the depth is linear in the image.
        let (ab, ac) = (b - a, c - a);
        let (by_ab, by_ac) = (nearness[1] - nearness[0], nearness[2] - nearness[0]);
        let slope = (by_ab * ac.perp() - by_ac * ab.perp()) / -ab.perp_dot(ac);
        let inside = self.map.triangle(cell).into_iter().sum::<DVec2>() / 3.0 - line[0];
        let away = inside.reject_from(line[1] - line[0]).normalize_or_zero();
        let (_, depth) = anchor(target, face, (line[0] + line[1]) / 2.0);
        -slope.dot(away) * depth * depth / self.map.plane.scale(depth)
    }
}
