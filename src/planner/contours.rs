//! Where models begin and end from side to side, row by row: what a cut between two pillars would leave of them in a strip.
//!
//! An upright contour, as letters have them, may run just beside a cut for its whole length. What lies between the two then stands
//! at the outline of the nearer pillar as a plate, as thin as the strip is narrow; what is left of a flank alone is a knife.

use crate::index::FaceId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};

/// Cosine of the angle between a face and the sight up to which it is a flank, which makes a plate no thicker: the check of walls
/// takes two faces for a wall's if they are opposite within 30 degrees.
const FLANK: f64 = 0.5;
/// Rows from the models' lowest ray to their highest: half a millimetre on models of 60 mm, where plates of 3 mm and more matter.
const ROWS: usize = 128;
/// What is nearer in one row hangs together, as a tangent of bearings: three thousandths of a millimetre at 300 mm.
const JOINED: f64 = 1e-5;

/// A stretch of one row that models fill, in bearings (or tangents of them): from their outline over what looks at the eye to the outline
/// of the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ModelStretch {
    begins: f64,
    facing: [f64; 2],
    ends: f64,
}

impl ModelStretch {
    fn mapped(self, map: impl Fn(f64) -> f64) -> Self {
        Self {
            begins: map(self.begins),
            facing: self.facing.map(&map),
            ends: map(self.ends),
        }
    }

    /// With left and right exchanged.
    fn mirrored(self) -> Self {
        Self {
            begins: -self.ends,
            facing: [-self.facing[1], -self.facing[0]],
            ends: -self.begins,
        }
    }

    /// How thick what is left after `cut` is on average: a flank is a wedge.
    fn left_after(&self, cut: f64) -> f64 {
        let facing = self.facing[1].max(cut);
        facing - cut + (self.ends - facing) / 2.0
    }
}

/// The models' contours as one eye sees them. Bearings are as in [`Subject`](super::subject::Subject).
#[derive(Clone, Debug, Default)]
pub(crate) struct Contours {
    /// The stretches of all rows, by rising ends; and the same with left and right exchanged.
    stretches: Vec<ModelStretch>,
    mirrored: Vec<ModelStretch>,
    /// Height of a row over the distance.
    row: f64,
}

/// Where one level meets faces: all, and those that look at the eye.
#[derive(Clone, Debug, Default)]
struct Level {
    all: Vec<[f64; 2]>,
    facing: Vec<[f64; 2]>,
}

impl Level {
    /// What hangs together, as far as anything of it faces the eye.
    fn stretches(self) -> Vec<ModelStretch> {
        let facing = joined(self.facing);
        let within = |[begins, ends]: [f64; 2]| {
            let from = facing.partition_point(|f| f[1] < begins);
            let to = facing.partition_point(|f| f[0] <= ends);
            let own = facing.get(from..to)?;
            Some(ModelStretch {
                begins,
                facing: [own.first()?[0].max(begins), own.last()?[1].min(ends)],
                ends,
            })
        };
        joined(self.all).into_iter().filter_map(within).collect()
    }
}

/// What a cut would leave beside it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Strips {
    /// Heights of all rows that have one, over the distance.
    pub height: f64,
    /// Their mean width, radians.
    pub width: f64,
}

impl Contours {
    /// Those of `target` from `eye`, which looks along the unit direction `ahead` in plan.
    pub(crate) fn new(eye: DVec3, ahead: DVec2, target: &TriMesh) -> Self {
        let image = |v: &DVec3| {
            let offset = v.truncate() - eye.truncate();
            let depth = ahead.dot(offset);
            (depth > 0.0).then(|| DVec2::new(ahead.perp_dot(offset), v.z - eye.z) / depth)
        };
        let image: Vec<Option<DVec2>> = target.vertices.iter().map(image).collect();
        let heights = image.iter().flatten().map(|p| p.y);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| {
            (l.min(y), h.max(y))
        });
        let row = (high - low) / ROWS as f64;
        if row <= 0.0 {
            return Self::default();
        }
        let mut rows: Vec<Level> = vec![Level::default(); ROWS];
        for (f, face) in FaceId::all(target.faces.len()).zip(&target.faces) {
            let [Some(a), Some(b), Some(c)] = face.map(|v| image[v]) else {
                continue;
            };
            let sight = (target.vertices[face[0]] - eye).normalize();
            let is_facing = target.normal(f).dot(sight) < -FLANK;
            let (least, most) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
            // Rows lie in the middle of their heights.
            let first = ((least - low) / row - 0.5).ceil().max(0.0) as usize;
            for (k, met) in rows.iter_mut().enumerate().skip(first) {
                let y = low + (k as f64 + 0.5) * row;
                if y > most {
                    break;
                }
                let stretch = across([a, b, c], y);
                met.all.extend(stretch);
                met.facing.extend(stretch.filter(|_| is_facing));
            }
        }
        let stretches = rows.into_iter().flat_map(Level::stretches);
        let stretches: Vec<ModelStretch> = stretches.map(|s| s.mapped(f64::atan)).collect();
        let mirrored = stretches.iter().map(|s| s.mirrored()).collect();
        Self {
            stretches: by_ends(stretches),
            mirrored: by_ends(mirrored),
            row,
        }
    }

    /// What goes across a cut and is thinner than `width` after it.
    pub(crate) fn after(&self, cut: f64, width: f64) -> Strips {
        self.strips(&self.stretches, cut, width)
    }

    /// What goes across a cut and is thinner than `width` before it.
    pub(crate) fn before(&self, cut: f64, width: f64) -> Strips {
        self.strips(&self.mirrored, -cut, width)
    }

    fn strips(&self, stretches: &[ModelStretch], cut: f64, width: f64) -> Strips {
        let from = stretches.partition_point(|s| s.ends <= cut);
        // What is left is at least half as thick as it is wide.
        let near = stretches[from..].iter();
        let near = near.take_while(|s| s.ends < cut + 2.0 * width);
        let left = near.filter(|s| s.begins < cut).map(|s| s.left_after(cut));
        let thin = left.filter(|w| *w < width);
        let (rows, sum) = thin.fold((0, 0.0), |(rows, sum), w| (rows + 1, sum + w));
        Strips {
            height: f64::from(rows) * self.row,
            width: sum / f64::from(rows.max(1)),
        }
    }
}

fn by_ends(mut stretches: Vec<ModelStretch>) -> Vec<ModelStretch> {
    stretches.sort_by(|a, b| a.ends.total_cmp(&b.ends));
    stretches
}

/// Where a triangle meets the level `y`.
fn across(corners: [DVec2; 3], y: f64) -> Option<[f64; 2]> {
    let crossing = |k: usize| {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        // The same number whichever face has the side.
        let (p, q) = if (p.y, p.x) < (q.y, q.x) {
            (p, q)
        } else {
            (q, p)
        };
        (p.y <= y && y < q.y).then(|| p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y))
    };
    let mut met = (0..3).filter_map(crossing);
    let (a, b) = (met.next()?, met.next()?);
    Some([a.min(b), a.max(b)])
}

/// The stretches of one row, those that meet as one.
fn joined(mut stretches: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut whole: Vec<[f64; 2]> = Vec::new();
    for [first, last] in stretches {
        match whole.last_mut() {
            Some(w) if first <= w[1] + JOINED => w[1] = w[1].max(last),
            _ => whole.push([first, last]),
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An upright board square to an eye at the origin that looks along x, 100 mm away, from `left` to `right` (bearings rise to
    /// the left), and from 0 to `top`, millimetres.
    fn board([right, left]: [f64; 2], top: f64) -> TriMesh {
        let corners = [(right, 0.0), (left, 0.0), (left, top), (right, top)];
        let corners = corners.map(|(y, z)| DVec3::new(100.0, y, z));
        TriMesh::new(corners.to_vec(), [[0, 2, 1], [0, 3, 2]])
    }

    #[test]
    fn a_cut_leaves_the_strip_up_to_the_contour() {
        let contours = Contours::new(DVec3::ZERO, DVec2::X, &board([-10.0, 10.0], 30.0));
        let bearing = |mm: f64| (mm / 100.0).atan();
        let strips = contours.after(bearing(9.7), bearing(0.6));
        assert!((strips.height - 0.3).abs() < 1e-9, "{strips:?}");
        assert!((strips.width - (bearing(10.0) - bearing(9.7))).abs() < 1e-12);
        let other = contours.before(bearing(-9.7), bearing(0.6));
        assert!((other.width - strips.width).abs() < 1e-12, "{other:?}");
        for at in [9.3, 10.1, 0.0, -9.7] {
            assert_eq!(
                contours.after(bearing(at), bearing(0.6)),
                Strips::default(),
                "{at}"
            );
        }
    }

    /// A flank of 0.6 mm beside the front that ends at 10 mm: a cut in it leaves a wedge, and one before it that and some of the front.
    #[test]
    fn a_flank_is_half_as_thick_as_it_is_wide() {
        let mut mesh = board([-10.0, 10.0], 30.0);
        let back = [0.0, 30.0].map(|z| 1.06 * DVec3::new(100.0, 10.6, z));
        mesh.vertices.extend(back);
        let flank = TriMesh::new(Vec::new(), [[1, 2, 5], [1, 5, 4]]);
        mesh.faces.extend(flank.faces);
        let contours = Contours::new(DVec3::ZERO, DVec2::X, &mesh);
        let bearing = |mm: f64| (mm / 100.0).atan();
        for (cut, wanted) in [(10.2, 0.2), (9.9, 0.4)] {
            let found = 100.0 * contours.after(bearing(cut), bearing(0.5)).width;
            assert!((found - wanted).abs() < 0.01, "{cut}: {found}");
        }
        assert_eq!(
            contours.after(bearing(9.7), bearing(0.5)),
            Strips::default()
        );
    }

    #[test]
    fn a_thin_part_of_its_own_is_not_a_strip() {
        let contours = Contours::new(DVec3::ZERO, DVec2::X, &board([9.8, 10.0], 30.0));
        let cut = (9.7f64 / 100.0).atan();
        assert_eq!(contours.after(cut, 0.006), Strips::default());
    }
}
