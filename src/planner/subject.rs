//! A view as the planner needs it: where its models stand in plan, how high, and what they look like from its eye and from
//! eyes beside it.
//!
//! Directions in plan are *bearings*: radians from the direction in which the eye looks, counter-clockwise from above.
//! Slopes are heights over horizontal distances.

use super::brief::{Pillar, Shape};
use super::contours::Contours;
use crate::bvh::Bvh;
use crate::horizon::{Shadow, Viewpoint, turn};
use crate::mesh::TriMesh;
use crate::view::View;
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Columns in which the heights of a view's models are kept.
const COLUMNS: usize = 240;
/// Samples of a portrait: half a degree of a model that fills 30 degrees is a quarter of a millimetre on it.
const PORTRAIT: [usize; 2] = [160, 160];
/// Part of a whole by which following columns of rays are staggered.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Room that rays keep from the ends of pillars, millimetres.
const END_ROOM_MM: f64 = 0.3;

/// What one eye sees of its models, by bearing and slope.
#[derive(Clone, Debug)]
pub struct Portrait {
    /// First bearing and slope, and their steps.
    from: DVec2,
    step: DVec2,
    /// Columns by rising bearing, each by rising slope: normals, zero where no model is.
    normals: Vec<Vec3>,
}

impl Portrait {
    pub fn column(&self, bearing: f64) -> Option<usize> {
        let column = (bearing - self.from.x) / self.step.x;
        (column >= 0.0 && column < PORTRAIT[0] as f64).then_some(column as usize)
    }

    /// Unit normal of what is seen there; `None` beside the models.
    pub fn normal(&self, column: usize, slope: f64) -> Option<Vec3> {
        let row = (slope - self.from.y) / self.step.y;
        if !(row >= 0.0 && row < PORTRAIT[1] as f64) {
            return None;
        }
        let normal = self.normals[column * PORTRAIT[1] + row as usize];
        (normal != Vec3::ZERO).then_some(normal)
    }
}

/// What an eye elsewhere would see of the models: columns of rays, each in one vertical plane.
#[derive(Clone, Debug)]
pub struct Outlook {
    pub eye: DVec3,
    pub columns: Vec<OutlookColumn>,
}

#[derive(Clone, Debug)]
pub struct OutlookColumn {
    /// Unit.
    pub way: DVec2,
    /// Slope and unit normal of every ray that meets the models.
    pub rays: Vec<(f64, Vec3)>,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Subject {
    pub eye: DVec3,
    /// The eye in plan, and the unit direction in which it looks.
    pub o: DVec2,
    pub ahead: DVec2,
    /// Disjoint intervals of bearings at which models stand, rising.
    pub spans: Vec<[f64; 2]>,
    /// Smallest and largest slope in each of [`COLUMNS`] columns between the first and the last bearing.
    slopes: Vec<[f64; 2]>,
    pub portrait: Portrait,
    pub(crate) contours: Contours,
    /// Middle of the models' box.
    pub middle: DVec3,
    /// Width of all models square to the view, millimetres.
    pub width: f64,
}

impl Subject {
    /// Prepares a view's target, which are its models in place: all but the portrait.
    pub fn in_plan(view: &View, target: &TriMesh) -> Self {
        let o = view.eye.truncate();
        let ahead = (view.look_at.truncate() - o).normalize_or(DVec2::X);
        let mut subject = Self {
            eye: view.eye,
            o,
            ahead,
            spans: Vec::new(),
            slopes: vec![[f64::INFINITY, f64::NEG_INFINITY]; COLUMNS],
            portrait: Portrait {
                from: DVec2::ZERO,
                step: DVec2::ONE,
                normals: Vec::new(),
            },
            contours: Contours::new(view.eye, ahead, target),
            middle: target
                .bounds()
                .map_or(view.look_at, |(lo, hi)| (lo + hi) / 2.0),
            width: 0.0,
        };
        let bodies = view.models.iter().map(|m| &m.mesh.vertices);
        subject.spans = subject
            .viewpoint()
            .spans(bodies.map(|b| b.iter().map(|v| v.truncate())));
        let across = ahead.perp();
        let along = target.vertices.iter().map(|v| v.truncate().dot(across));
        let (lo, hi) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        });
        subject.width = (hi - lo).max(0.0);
        subject.fill_slopes(target);
        subject
    }

    /// The same with the portrait; `bvh` is the target's.
    pub fn new(view: &View, target: &TriMesh, bvh: &Bvh) -> Self {
        let mut subject = Self::in_plan(view, target);
        subject.portrait = subject.portrait_of(target, bvh);
        subject
    }

    /// First and last bearing of all models.
    pub fn range(&self) -> [f64; 2] {
        match (self.spans.first(), self.spans.last()) {
            (Some(first), Some(last)) => [first[0], last[1]],
            _ => [0.0, 0.0],
        }
    }

    /// The eye in plan. One at infinity stands [very far away](crate::geom::FAR_MM) in plans too.
    pub fn viewpoint(&self) -> Viewpoint {
        Viewpoint::At {
            place: self.o,
            ahead: self.ahead,
        }
    }

    pub fn bearing(&self, p: DVec2) -> f64 {
        self.viewpoint().bearing(p)
    }

    pub fn way(&self, bearing: f64) -> DVec2 {
        self.viewpoint().ray(bearing).way
    }

    pub fn point(&self, bearing: f64, distance: f64) -> DVec2 {
        self.viewpoint().ray(bearing).at(distance)
    }

    /// The pillar as the eye sees it with nothing else in the way.
    pub fn shadow(&self, pillar: &Pillar, shape: &Shape) -> Shadow {
        Shadow::new(&self.viewpoint(), &shape.obstacle(pillar.at))
    }

    /// By how much the rays between two bearings miss a pillar of this height at horizontal distances `near..far`, above or
    /// below, millimetres; 0 if they all meet it.
    pub fn beyond_ends(&self, from: f64, to: f64, near: f64, far: f64, shape: &Shape) -> f64 {
        let top = shape.heights[1] - END_ROOM_MM;
        self.columns(from, to).fold(0.0, |worst: f64, [low, high]| {
            let highest = self.eye.z + (high * near).max(high * far);
            let lowest = self.eye.z + (low * near).min(low * far);
            worst.max(highest - top).max(END_ROOM_MM - lowest)
        })
    }

    /// Whether all rays to the models pass above a pillar of this shape and shadow.
    pub fn passes_over(&self, shadow: &Shadow, shape: &Shape) -> bool {
        let (far, top) = (shadow.distance + shape.reach, shape.heights[1]);
        // Mostly the eye is no higher than the pillars.
        self.eye.z > top
            && self
                .columns(shadow.from, shadow.to)
                .all(|[low, _]| self.eye.z + low * far > top + END_ROOM_MM)
    }

    /// Height of the lowest pillar at horizontal distances `near..far` that all rays between two bearings meet.
    pub fn height_needed(&self, from: f64, to: f64, near: f64, far: f64) -> f64 {
        self.columns(from, to).fold(0.0, |most: f64, [_, high]| {
            most.max(self.eye.z + (high * near).max(high * far) + END_ROOM_MM)
        })
    }

    /// Slopes of the columns between two bearings.
    fn columns(&self, from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let [a, b] = self.range();
        let column = |bearing: f64| (bearing - a) / (b - a) * COLUMNS as f64;
        let first = column(from).floor().max(0.0) as usize;
        let last = (column(to).ceil().max(0.0) as usize).min(COLUMNS);
        let of_columns = self.slopes.get(first.min(last)..last).unwrap_or(&[]);
        of_columns.iter().copied().filter(|s| s[0] <= s[1])
    }

    /// Extremes over each column lie at vertices or where edges cross the borders of columns.
    fn fill_slopes(&mut self, target: &TriMesh) {
        let [a, b] = self.range();
        let width = (b - a) / COLUMNS as f64;
        if width <= 0.0 {
            return;
        }
        let polar = |v: &DVec3| {
            let level = v.truncate() - self.o;
            (
                self.ahead.angle_to(level),
                (v.z - self.eye.z) / level.length(),
            )
        };
        let points: Vec<(f64, f64)> = target.vertices.iter().map(polar).collect();
        let mut note = |column: usize, slope: f64| {
            let range = &mut self.slopes[column.min(COLUMNS - 1)];
            *range = [range[0].min(slope), range[1].max(slope)];
        };
        let column = |bearing: f64| (((bearing - a) / width).max(0.0) as usize).min(COLUMNS - 1);
        for (bearing, slope) in &points {
            note(column(*bearing), *slope);
        }
        for face in &target.faces {
            for k in 0..3 {
                let (i, j) = (face[k], face[(k + 1) % 3]);
                let (from, to) = (column(points[i].0), column(points[j].0));
                for border in from.min(to) + 1..=from.max(to) {
                    let way = DVec2::from_angle(a + width * border as f64).rotate(self.ahead);
                    let (p, q) = (target.vertices[i], target.vertices[j]);
                    let (sp, sq) = (
                        way.perp_dot(p.truncate() - self.o),
                        way.perp_dot(q.truncate() - self.o),
                    );
                    let t = sp / (sp - sq);
                    if !(0.0..=1.0).contains(&t) {
                        continue;
                    }
                    let at = p.lerp(q, t);
                    let slope = (at.z - self.eye.z) / (at.truncate() - self.o).length();
                    note(border - 1, slope);
                    note(border, slope);
                }
            }
        }
    }

    fn slope_range(&self) -> [f64; 2] {
        let all = self.slopes.iter().filter(|s| s[0] <= s[1]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |r, s| {
            [r[0].min(s[0]), r[1].max(s[1])]
        })
    }

    fn portrait_of(&self, target: &TriMesh, bvh: &Bvh) -> Portrait {
        let ([a, b], [low, high]) = (self.range(), self.slope_range());
        let from = DVec2::new(a, low);
        let size = DVec2::new(PORTRAIT[0] as f64, PORTRAIT[1] as f64);
        let step = (DVec2::new(b, high) - from) / size;
        let cells: Vec<usize> = (0..PORTRAIT[0] * PORTRAIT[1]).collect();
        let normals = cells
            .par_iter()
            .map(|k| {
                let place = DVec2::new((k / PORTRAIT[1]) as f64, (k % PORTRAIT[1]) as f64) + 0.5;
                let at = from + step * place;
                let way = self.way(at.x).extend(at.y);
                let hit = bvh.first_hit(self.eye, way);
                hit.map_or(Vec3::ZERO, |h| target.normal_against(h.face, way).as_vec3())
            })
            .collect();
        Portrait {
            from,
            step,
            normals,
        }
    }

    /// What eyes turned by `angle_deg` to both sides, and raised by `raised_deg`, about the models' middle would see of them.
    pub fn outlooks(
        &self,
        target: &TriMesh,
        bvh: &Bvh,
        [angle_deg, raised_deg]: [f64; 2],
        rays: Rays,
    ) -> Vec<Outlook> {
        let sides = if angle_deg == 0.0 {
            &[1.0][..]
        } else {
            &[-1.0, 1.0][..]
        };
        let offset = self.eye - self.middle;
        let level = offset.truncate();
        let outlook = |sign: &f64| {
            let way = DVec2::from_angle((sign * angle_deg).to_radians())
                .rotate(level.normalize_or(DVec2::X));
            let elevation = offset.z.atan2(level.length()) + raised_deg.to_radians();
            let eye =
                self.middle + offset.length() * (elevation.cos() * way).extend(elevation.sin());
            Outlook {
                eye,
                columns: columns(eye, self.middle, rays, target, bvh),
            }
        };
        sides.iter().map(outlook).collect()
    }
}

/// How many columns an outlook has, and rays in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rays {
    pub columns: usize,
    pub rows: usize,
}

fn columns(
    eye: DVec3,
    middle: DVec3,
    rays: Rays,
    target: &TriMesh,
    bvh: &Bvh,
) -> Vec<OutlookColumn> {
    let o = eye.truncate();
    let ahead = (middle.truncate() - o).normalize_or(DVec2::X);
    let polar = |v: &DVec3| {
        let level = v.truncate() - o;
        DVec2::new(turn(ahead, level), (v.z - eye.z) / level.length())
    };
    let far = DVec2::splat(f64::INFINITY);
    let (lo, hi) = target
        .vertices
        .iter()
        .map(polar)
        .filter(|p| p.x.abs() < PI / 2.0)
        .fold((far, -far), |(l, h), p| (l.min(p), h.max(p)));
    let step = (hi - lo) / DVec2::new(rays.columns as f64, rays.rows as f64);
    let column = |c: usize| {
        let way = DVec2::from_angle(lo.x + step.x * (c as f64 + 0.5)).rotate(ahead);
        // Staggered by the golden section, so that rays do not stand in rows.
        let stagger = (c as f64 * GOLDEN).fract();
        let slopes = (0..rays.rows).map(|r| lo.y + step.y * (r as f64 + stagger));
        let met = slopes.filter_map(|slope| {
            let ray = way.extend(slope);
            let hit = bvh.first_hit(eye, ray)?;
            Some((slope, target.normal_against(hit.face, ray).as_vec3()))
        });
        OutlookColumn {
            way,
            rays: met.collect(),
        }
    };
    let numbers: Vec<usize> = (0..rays.columns).collect();
    numbers.par_iter().map(|c| column(*c)).collect()
}
